!> Cost of a step, by phase, for one thread and for all, and how far it is from what its design could reach.
!!
!! usage: dynsph-bench SCENE.nml START_TIME STEPS [--set group.key=value ...]
!!
!! Runs the scene to the start time, then times the same steps from the same state in turns, and takes medians of five: on one
!! thread, on all, and on all with a run of its own for each. What the particles are after the timed steps must not depend on the
!! threads. The pair loops are timed alone too, with the lists of neighbours and with lists that leave no lane idle: the limit.
program bench
   use, intrinsic :: iso_fortran_env, only: output_unit
   use command_line, only: command_line_t, parse_command_line
   use errors, only: end_program, exit_input, exit_numerics, failure
   use kinds, only: dp
   use lanes, only: nl, root_name
   use model, only: model_t
   use neighbours, only: neighbours_t
   use omp_lib, only: omp_get_max_threads, omp_set_num_threads
   use pair_passes, only: all_passes, count_lanes, lanes_t, shorten_lists
   use parallel_clock, only: parallel_seconds
   use particles, only: bytes_per_slot, particles_t
   use process_start, only: start_process
   use program_arguments, only: take_arguments
   use scene_input, only: read_settings
   use scene_setup, only: set_up_model, set_up_particles
   use settings, only: settings_t
   use solution_register, only: solutions_t
   use standard_output, only: errors_for_signals
   use step_state, only: step_t
   use text, only: short
   use time_step, only: advance, refresh
   use timers, only: timers_t, wall_seconds
   implicit none

   integer, parameter :: repeats = 5
   character(*), parameter :: phases(4) = [character(32) :: 'sort, images, neighbours', 'gradients, viscosity', &
                                           'density diffusion, stage 1', 'later stages']
   !> Median figures, ns per particle-step of wall time.
   type :: figures_t
      real(dp) :: phases(4, 2) = 0          !! on one thread, on all
      real(dp) :: step(2) = 0
      real(dp) :: least(2) = 0, most(2) = 0
      real(dp) :: parallel = 0              !! of a step on one thread, in parallel regions
      real(dp) :: apart = 0                 !! of all threads with a run each, for one particle of one of them
      real(dp) :: pairs = 0, limit = 0      !! pair loops on one thread; with all lanes useful
   end type figures_t

   type(settings_t) :: scene
   type(failure) :: problem
   real(dp) :: start_time
   integer :: steps

   call read_arguments()
   if (problem%raised()) call end_program(problem)
   call measure()
   call end_program(problem)

contains

   subroutine read_arguments()
      type(command_line_t) :: options
      character(:), allocatable :: words(:)
      character(:), allocatable :: warnings(:)
      integer :: status(2)

      call start_process()
      call errors_for_signals(pipes=.false.)
      call take_arguments(words)
      if (size(words) < 3) then
         call problem%raise(exit_input, 'usage: dynsph-bench SCENE.nml START_TIME STEPS [--set group.key=value ...]')
         return
      end if
      read (words(2), *, iostat=status(1)) start_time
      read (words(3), *, iostat=status(2)) steps
      if (any(status /= 0) .or. steps < 1) then
         call problem%raise(exit_input, 'dynsph-bench: START_TIME and STEPS must be numbers, steps at least 1')
         return
      end if
      call parse_command_line([words(1), words(4:)], options, problem)
      if (problem%raised()) return
      call read_settings(trim(options%scene), options%overrides, solutions_t(), scene, warnings, problem)
      if (.not. problem%raised() .and. .not. (start_time >= 0 .and. start_time <= scene%time%end_time)) &
         call problem%raise(exit_input, &
         'dynsph-bench: START_TIME must be from 0 to the end_time of the scene, '//short(scene%time%end_time))
   end subroutine read_arguments

   ! Brings the scene to its start time and prints the table.
   subroutine measure()
      type(model_t) :: model
      type(particles_t) :: p
      type(neighbours_t) :: near
      type(step_t) :: run
      type(timers_t) :: timers
      real(dp) :: started
      integer :: n_threads

      n_threads = omp_get_max_threads()
      started = wall_seconds()
      model = set_up_model(scene)
      call set_up_particles(scene, model, p)
      call timers%initialise(phases)
      call refresh(model, p, near, run, timers)
      do while (run%time < start_time)
         call advance(model, p, near, run, start_time, timers)
         if (run%lost_slot > 0 .or. run%scattered) then
            call problem%raise(exit_numerics, 'dynsph-bench: the run failed before its start time')
            return
         end if
         call refresh(model, p, near, run, timers)
      end do
      write (output_unit, '(a, i0, a, i0, a, f0.3, a, i0, a, f0.1, a)') trim(scene%scene%title)//', ', p%n, &
         ' particles, ', run%step, ' steps to t = ', run%time, ' on ', n_threads, ' threads in ', wall_seconds() - started, ' s'
      call time_all(model, p, near, run, n_threads)
   end subroutine measure

   ! All timings in turns, so that what disturbs the machine disturbs all alike.
   subroutine time_all(model, p, near, run, n_threads)
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      type(neighbours_t), intent(in) :: near
      type(step_t), intent(in) :: run
      integer, intent(in) :: n_threads
      type(neighbours_t) :: shortened
      type(figures_t) :: figures
      type(lanes_t) :: counted
      type(step_t) :: after
      real(dp), allocatable :: x(:), u(:)
      real(dp) :: table(5, repeats, 2), parallel(repeats), apart(repeats), pairs(repeats), limit(repeats), before
      logical :: equal
      integer :: k, t

      call count_lanes(model, p, near, counted)
      shortened = near
      call shorten_lists(model, p, shortened)
      equal = .true.
      do k = 1, repeats
         before = parallel_seconds()
         call time_steps(model, p, near, run, 1, table(:, k, 1), after, x, u, equal)
         parallel(k) = (parallel_seconds() - before)*1.0e9_dp/(real(steps, dp)*p%n)
         call time_steps(model, p, near, run, n_threads, table(:, k, 2), after, x, u, equal)
         call time_apart(model, p, near, run, n_threads, apart(k))
         call time_passes(model, p, near, pairs(k))
         call time_passes(model, p, shortened, limit(k))
      end do
      do t = 1, 2
         figures%phases(:, t) = [(median(table(k, :, t)), k=1, 4)]
         figures%step(t) = median(table(5, :, t))
         figures%least(t) = minval(table(5, :, t))
         figures%most(t) = maxval(table(5, :, t))
      end do
      figures%parallel = median(parallel*figures%step(1)/table(5, :, 1))
      figures%apart = median(apart)
      ! Of what was timed within the same seconds.
      figures%pairs = median(pairs*figures%step(1)/table(5, :, 1))
      figures%limit = median(limit*figures%step(1)/table(5, :, 1))
      call print_figures(figures, n_threads, p)
      write (output_unit, '(a, l1)') 'bit-equal ', equal
      call print_lanes(figures, counted, real(after%step - run%step, dp)/max(1, int(after%sorted - run%sorted)))
      call print_serial(figures)
      if (.not. equal) call problem%raise(exit_numerics, 'dynsph-bench: the result depends on the number of threads')
   end subroutine time_all

   ! ns per particle-step of wall time, by phase and in all, from copies of the state.
   subroutine time_steps(model, p, near, run, n_threads, ns, run_copy, x, u, equal)
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      type(neighbours_t), intent(in) :: near
      type(step_t), intent(in) :: run
      integer, intent(in) :: n_threads
      real(dp), intent(out) :: ns(5)
      type(step_t), intent(out) :: run_copy
      real(dp), allocatable, intent(inout) :: x(:), u(:)   !! what the first timed steps gave
      logical, intent(inout) :: equal
      type(particles_t) :: p_copy
      type(neighbours_t) :: near_copy
      type(timers_t) :: timers
      real(dp) :: started
      integer :: k

      call omp_set_num_threads(n_threads)
      p_copy = p
      near_copy = near
      run_copy = run
      call timers%initialise(phases)
      started = wall_seconds()
      call take_steps(model, p_copy, near_copy, run_copy, timers)
      ns(5) = (wall_seconds() - started)*1.0e9_dp/(real(steps, dp)*p%n)
      do k = 1, 4
         ns(k) = timers%seconds(k)*1.0e9_dp/(real(steps, dp)*p%n)
      end do
      if (allocated(x)) then
         equal = equal .and. all(transfer(x, [0]) == transfer(p_copy%base%x(1:p_copy%n_own), [0])) &
                 .and. all(transfer(u, [0]) == transfer(p_copy%base%u(1:p_copy%n_own), [0]))
      else
         x = p_copy%base%x(1:p_copy%n_own)
         u = p_copy%base%u(1:p_copy%n_own)
      end if
   end subroutine time_steps

   subroutine take_steps(model, p, near, run, timers)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      type(neighbours_t), intent(inout) :: near
      type(step_t), intent(inout) :: run
      type(timers_t), intent(inout) :: timers
      integer :: k

      do k = 1, steps
         call advance(model, p, near, run, huge(1.0_dp), timers)
         call refresh(model, p, near, run, timers)
      end do
   end subroutine take_steps

   ! The same steps as many times as there are threads, each thread with a run of its own.
   subroutine time_apart(model, p, near, run, n_threads, ns)
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      type(neighbours_t), intent(in) :: near
      type(step_t), intent(in) :: run
      integer, intent(in) :: n_threads
      real(dp), intent(out) :: ns
      type(particles_t), allocatable :: p_copies(:)
      type(neighbours_t), allocatable :: near_copies(:)
      type(step_t) :: run_copy
      type(timers_t) :: timers
      real(dp) :: started
      integer :: k

      allocate (p_copies(n_threads), near_copies(n_threads))
      do k = 1, n_threads
         p_copies(k) = p
         near_copies(k) = near
      end do
      started = wall_seconds()
      !$omp parallel do default(none) shared(model, p_copies, near_copies, run, n_threads) private(run_copy, timers) &
      !$omp num_threads(n_threads) schedule(static, 1)
      do k = 1, n_threads
         run_copy = run
         call timers%initialise(phases)
         call take_steps(model, p_copies(k), near_copies(k), run_copy, timers)
      end do
      !$omp end parallel do
      ns = (wall_seconds() - started)*1.0e9_dp/(real(steps, dp)*p%n)
   end subroutine time_apart

   ! The pair loops of as many steps, on one thread.
   subroutine time_passes(model, p, near, ns)
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      type(neighbours_t), intent(in) :: near
      real(dp), intent(out) :: ns
      real(dp) :: started, check
      integer :: k

      check = 0
      started = wall_seconds()
      do k = 1, steps
         call all_passes(model, p, near, check)
      end do
      ns = (wall_seconds() - started)*1.0e9_dp/(real(steps, dp)*p%n)
      ! So that no pass can be left out.
      if (.not. abs(check) < huge(check)) write (output_unit, '(a)') 'some sums are not finite'
   end subroutine time_passes

   pure real(dp) function median(values)
      real(dp), intent(in) :: values(:)
      integer :: k

      median = values(1)
      do k = 1, size(values)
         ! As many above as below, for an odd number of values.
         if (count(values < values(k)) <= size(values)/2 .and. count(values > values(k)) <= size(values)/2) median = values(k)
      end do
   end function median

   subroutine print_figures(figures, n_threads, p)
      type(figures_t), intent(in) :: figures
      integer, intent(in) :: n_threads
      type(particles_t), intent(in) :: p
      real(dp) :: gained, reachable
      integer :: k

      associate (f => figures)
         write (output_unit, '(a, i0, a)') 'ns per particle-step of wall time, median of 5 x ', steps, ' steps:'
         write (output_unit, '(a32, a12, i10, a)') '', '1 thread', n_threads, ' threads'
         do k = 1, 4
            write (output_unit, '(a32, f12.1, f18.1)') phases(k), f%phases(k, :)
         end do
         write (output_unit, '(a32, f12.1, f18.1)') 'in all', f%step
         write (output_unit, '(a32, 2f6.0, 2f9.0)') 'least and most', f%least(1), f%most(1), f%least(2), f%most(2)
         write (output_unit, '(a32, es12.3, es18.3)') 'particle-steps per second', 1.0e9_dp/f%step
         gained = f%step(1)/f%step(2)
         reachable = n_threads*f%step(1)/f%apart
         write (output_unit, '(a, f0.2, a, f0.2, a, i0, a)') 'speed-up ', gained, ' of ', reachable, &
            ' that as many runs on one thread each reach at once (', nint(100*gained/reachable), ' %)'
         write (output_unit, '(a, f0.0)') 'bytes per particle in particle arrays ', &
            real(bytes_per_slot(p%features), dp)*p%capacity/p%n
      end associate
   end subroutine print_figures

   subroutine print_lanes(figures, counted, kept)
      type(figures_t), intent(in) :: figures
      type(lanes_t), intent(in) :: counted
      real(dp), intent(in) :: kept   !! steps between two sorts

      associate (f => figures, c => counted)
         write (output_unit, '(a, i0, a, f0.1, a, f0.1, a, f0.2, a)') 'clusters of ', nl, ', root by '//root_name//': ', &
            c%candidates/c%clusters, ' candidates a cluster, ', 100*c%pairs/(nl*c%candidates), &
            ' % of lanes useful; sorted every ', kept, ' steps'
         write (output_unit, '(a, f0.1, a, f0.1, a, f0.1, a)') 'pair loops on one thread ', f%pairs, ' ns, all else ', &
            f%step(1) - f%pairs, ' ns (', 100*(1 - f%pairs/f%step(1)), ' % of the step)'
         write (output_unit, '(a, f0.1, a, f0.2, a)') 'limit of the pair loops, all lanes useful: ', f%limit, &
            ' ns; the step takes ', f%step(1)/f%limit, ' times that'
      end associate
   end subroutine print_lanes

   ! What is outside parallel regions, and what that lets many threads reach at best.
   subroutine print_serial(figures)
      type(figures_t), intent(in) :: figures
      integer, parameter :: threads(3) = [16, 64, 128]
      real(dp) :: serial

      serial = max(0.0_dp, 1 - figures%parallel/figures%step(1))
      write (output_unit, '(a, f0.1, a, f0.2, a, 3(i0, a, f0.1, a))') 'serial ', serial*figures%step(1), ' ns (', 100*serial, &
         ' %): at best ', threads(1), ' threads ', 1/(serial + (1 - serial)/threads(1)), ' times as fast, ', &
         threads(2), ' threads ', 1/(serial + (1 - serial)/threads(2)), ', ', &
         threads(3), ' threads ', 1/(serial + (1 - serial)/threads(3)), ''
   end subroutine print_serial

end program bench
