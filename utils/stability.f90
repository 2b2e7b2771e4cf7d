!> Whether waves on a still periodic lattice grow, measured with the solver's own steps and by von Neumann analysis.
!!
!! usage: dynsph-stability --delta D --alpha A [--cfl C] [options]     (--help lists them)
!!
!! Small random velocities and densities take steps of fixed length; the limits of the step rule are off. With --cfl: by how much
!! what is there grows in a step. Without: the cfl from which on it does.
program stability
   use, intrinsic :: iso_fortran_env, only: output_unit
   use errors, only: end_program, exit_input, exit_numerics, failure
   use integrators, only: integrator_names
   use kinds, only: dp, i8
   use linear_stability, only: stability_t
   use model, only: model_t
   use neighbours, only: neighbours_t
   use options, only: options_t
   use particles, only: particles_t
   use process_start, only: start_process
   use program_arguments, only: take_arguments
   use scene_setup, only: set_up_model, set_up_particles
   use settings, only: body_settings, settings_t
   use standard_output, only: check_screen, errors_for_signals
   use step_state, only: step_t
   use time_step, only: advance, refresh
   use timers, only: timers_t
   use von_neumann, only: growth, lattice_waves, stable_cfl, wave_t
   use threads, only: limit_threads
   implicit none

   integer, parameter :: across = 24                     ! particles
   integer, parameter :: longest = 400                   ! steps
   real(dp), parameter :: noise = 1.0e-10_dp             ! share of c0 and rho0
   real(dp), parameter :: enough = 1.0e5_dp              ! growth that says all
   real(dp), parameter :: some_growth = 1.0e-3_dp        ! in a step, which cannot be missed in half the steps
   type(settings_t) :: scene
   type(options_t) :: given
   type(failure) :: problem
   character(:), allocatable :: arguments(:)
   type(wave_t) :: waves(across*(across + 3)/2)
   real(dp) :: cfl, theory, edge

   call declare_options(given)
   call start_process()
   call errors_for_signals(pipes=.false.)
   call take_arguments(arguments)
   call given%parse(arguments, problem)
   call limit_threads(across**2)
   if (given%help) then
      write (output_unit, '(a)') 'usage: dynsph-stability --delta D --alpha A [--cfl C]', ''
      call given%write_help(output_unit)
      call check_screen(problem)
      call end_program(problem)
   end if
   call set_up(given, scene, problem)
   if (given%given('--cfl') .and. .not. problem%raised()) then
      cfl = given%real_number('--cfl', problem)
      if (.not. problem%raised() .and. .not. (cfl > 0 .and. cfl <= 10)) &
         call problem%raise(exit_input, 'dynsph-stability: --cfl must be above 0 and at most 10')
   end if
   if (problem%raised()) call end_program(problem)
   waves = lattice_waves(scene%model%smoothing_ratio, across)
   associate (alpha => scene%model%alpha, delta => scene%model%delta, model => set_up_model(scene))
      if (given%given('--cfl')) then
         write (output_unit, '(a)') '# delta, alpha, cfl, growth in a step by theory, measured'
         theory = growth(waves, model%integrator, model%frozen, delta, alpha, cfl)
         write (output_unit, '(3f9.4, 2f11.6)') delta, alpha, cfl, theory, measured_growth(cfl)
      else
         theory = stable_cfl(waves, model%integrator, model%frozen, delta, alpha)
         edge = measured_edge(theory)
         write (output_unit, '(a)') '# delta, alpha, largest stable cfl by theory, measured'
         if (.not. problem%raised()) write (output_unit, '(2f9.4, 2f11.5)') delta, alpha, theory, edge
      end if
   end associate
   if (.not. problem%raised()) call check_screen(problem)
   call end_program(problem)

contains

   subroutine declare_options(list)
      type(options_t), intent(out) :: list

      list%command = 'dynsph-stability'
      call list%add('--delta', 'D', '0', 'coefficient of the density diffusion')
      call list%add('--alpha', 'A', '0', 'coefficient of the viscous term')
      call list%add('--cfl', 'C', '', 'dt c0/h; without it the largest stable one is looked for')
      call list%add('--integrator', 'NAME', 'rk4', 'rk4, rk3 or rk2')
      call list%add('--diffusion', 'WHEN', 'frozen', 'frozen or every_stage')
      call list%add('--smoothing-ratio', 'R', '2', 'h/dx, from 1.2 to 4')
   end subroutine declare_options

   !> A periodic square of fluid at rest, without gravity.
   subroutine set_up(list, scene, problem)
      type(options_t), intent(in) :: list
      type(settings_t), intent(out) :: scene
      type(failure), intent(inout) :: problem

      call list%check_choice('--integrator', integrator_names, problem)
      call list%check_choice('--diffusion', [character(11) :: 'frozen', 'every_stage'], problem)
      scene%model%diffusion = 'constant'
      scene%model%delta = list%real_number('--delta', problem)
      scene%model%alpha = list%real_number('--alpha', problem)
      scene%model%smoothing_ratio = list%real_number('--smoothing-ratio', problem)
      if (size(list%files) > 0) call problem%raise(exit_input, 'dynsph-stability: there is no '//trim(list%files(1))// &
                                                   '; --help lists the options')
      if (problem%raised()) return
      if (.not. (min(scene%model%delta, scene%model%alpha) >= 0 .and. max(scene%model%delta, scene%model%alpha) <= 100)) &
         call problem%raise(exit_input, 'dynsph-stability: --delta and --alpha must be from 0 to 100')
      if (.not. (scene%model%smoothing_ratio >= 1.2_dp .and. scene%model%smoothing_ratio <= 4)) &
         call problem%raise(exit_input, 'dynsph-stability: --smoothing-ratio must be from 1.2 to 4')
      scene%time%integrator = list%word('--integrator')
      scene%time%diffusion = list%word('--diffusion')
      scene%scene%resolution = across
      scene%domain%upper = 1
      scene%domain%left = 'periodic'
      scene%domain%right = 'periodic'
      scene%domain%bottom = 'periodic'
      scene%domain%top = 'periodic'
      scene%fluid%gravity = 0
      scene%fluid%sound_speed = 1
      allocate (scene%bodies(1), scene%solids(0), scene%probes(0), scene%gauges(0))
      scene%bodies(1)%upper = 1
      scene%bodies(1)%pressure = 'zero'
   end subroutine set_up

   !> Cfl from which on something grows, between three quarters and five quarters of what theory says.
   real(dp) function measured_edge(theory) result(stable)
      real(dp), intent(in) :: theory
      real(dp) :: beyond, below, above
      integer :: bisection

      stable = 0.75_dp*theory
      beyond = 1.25_dp*theory
      below = measured_growth(stable)
      above = measured_growth(beyond)
      if (below > 1 + some_growth .or. above < 1 + some_growth) then
         call problem%raise(exit_numerics, 'dynsph-stability: the edge is not within 25 % of the theory''s')
         return
      end if
      do bisection = 1, 7
         cfl = (stable + beyond)/2
         if (measured_growth(cfl) > 1 + some_growth) then
            beyond = cfl
         else
            stable = cfl
         end if
      end do
      stable = (stable + beyond)/2
   end function measured_edge

   !> Factor by which disturbances grow in a step, in the mean over the second half of the steps.
   real(dp) function measured_growth(cfl) result(factor)
      real(dp), intent(in) :: cfl
      type(model_t) :: model
      type(particles_t) :: p
      type(neighbours_t) :: near
      type(step_t) :: run
      type(timers_t) :: timers
      real(dp) :: amplitude(0:longest)
      integer :: n

      model = set_up_model(scene)
      model%stability = stability_t(sound=huge(1.0_dp), times_delta=huge(1.0_dp), times_alpha=huge(1.0_dp))
      model%cfl = cfl
      call timers%initialise([character(9) :: 'sort', 'gradients', 'diffusion', 'stages'])
      call set_up_particles(scene, model, p)
      call disturb(p)
      call refresh(model, p, near, run, timers)
      amplitude(0) = disturbance(p)
      do n = 1, longest
         call advance(model, p, near, run, huge(1.0_dp), timers)
         call refresh(model, p, near, run, timers)
         amplitude(n) = disturbance(p)
         if (.not. amplitude(n) < enough*amplitude(0)) exit
      end do
      n = min(n, longest)
      factor = (amplitude(n)/amplitude(n/2))**(1.0_dp/(n - n/2))
   end function measured_growth

   ! The same noise each time.
   subroutine disturb(p)
      type(particles_t), intent(inout) :: p   !! `next`, with c0 = rho0 = 1
      integer(i8) :: state
      integer :: i

      state = 20190101
      do i = 1, p%n
         p%next%u(i) = noise*random(state)
         p%next%v(i) = noise*random(state)
         p%next%s(i) = noise*random(state)
         p%next%volume(i) = p%m(i)/(1 + p%next%s(i))
      end do
   end subroutine disturb

   ! Between -1 and 1.
   real(dp) function random(state)
      integer(i8), intent(inout) :: state

      state = mod(16807_i8*state, 2147483647_i8)
      random = 2*(real(state, dp)/2147483647.0_dp) - 1
   end function random

   ! Root of the energy of sound.
   real(dp) function disturbance(p)
      type(particles_t), intent(in) :: p

      associate (base => p%base, own => p%id(1:p%n_own) > 0, n => p%n_own)
         disturbance = sqrt(sum(base%u(1:n)**2 + base%v(1:n)**2 + base%s(1:n)**2, mask=own))
      end associate
   end function disturbance

end program stability
