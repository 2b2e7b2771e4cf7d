!> Cost of a step, by phase, for one thread and for all.
!!
!! usage: dynsph-bench SCENE.nml START_TIME STEPS [--set group.key=value ...]
!!
!! Runs the scene to the start time, then times the same steps from the same state, one thread and all threads in
!! turn, and takes the median of five. What the particles are after the timed steps must not depend on the threads.
program bench
   use, intrinsic :: iso_fortran_env, only: output_unit
   use command_line, only: command_line_t, parse_command_line
   use errors, only: end_program, exit_input, exit_numerics, failure
   use kinds, only: dp
   use model, only: model_t
   use neighbours, only: neighbours_t
   use omp_lib, only: omp_get_max_threads, omp_set_num_threads
   use particles, only: bytes_per_slot, particles_t
   use program_arguments, only: take_arguments
   use scene_input, only: read_settings
   use scene_setup, only: set_up_model, set_up_particles
   use settings, only: settings_t
   use time_step, only: advance, refresh, step_t
   use timers, only: timers_t, wall_seconds
   implicit none

   integer, parameter :: repeats = 5
   character(*), parameter :: phases(4) = [character(32) :: 'sort, images, neighbours', 'gradients, viscosity', &
                                           'density diffusion, stage 1', 'later stages']
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
      call read_settings(trim(options%scene), options%overrides, scene, warnings, problem)
   end subroutine read_arguments

   ! Brings the scene to its start time and prints the table.
   subroutine measure()
      type(model_t) :: model
      type(particles_t) :: p
      type(neighbours_t) :: near
      type(step_t) :: run
      type(timers_t) :: timers
      real(dp) :: table(5, repeats, 2), ns(5, 2), started
      real(dp), allocatable :: x(:), u(:)
      logical :: equal
      integer :: k, n_threads

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
      equal = .true.
      do k = 1, repeats
         call time_steps(model, p, near, run, 1, table(:, k, 1), x, u, equal)
         call time_steps(model, p, near, run, n_threads, table(:, k, 2), x, u, equal)
      end do
      do k = 1, 5
         ns(k, 1) = median(table(k, :, 1))
         ns(k, 2) = median(table(k, :, 2))
      end do
      call print_table(ns, table, n_threads, p, equal)
      if (.not. equal) call problem%raise(exit_numerics, 'dynsph-bench: the result depends on the number of threads')
   end subroutine measure

   ! ns per particle-step of wall time, by phase and in all, from copies of the state.
   subroutine time_steps(model, p, near, run, n_threads, ns, x, u, equal)
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      type(neighbours_t), intent(in) :: near
      type(step_t), intent(in) :: run
      integer, intent(in) :: n_threads
      real(dp), intent(out) :: ns(5)
      real(dp), allocatable, intent(inout) :: x(:), u(:)   !! what the first timed steps gave
      logical, intent(inout) :: equal
      type(particles_t) :: p_copy
      type(neighbours_t) :: near_copy
      type(step_t) :: run_copy
      type(timers_t) :: timers
      real(dp) :: started
      integer :: k

      call omp_set_num_threads(n_threads)
      p_copy = p
      near_copy = near
      run_copy = run
      call timers%initialise(phases)
      started = wall_seconds()
      do k = 1, steps
         call advance(model, p_copy, near_copy, run_copy, huge(1.0_dp), timers)
         call refresh(model, p_copy, near_copy, run_copy, timers)
      end do
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

   pure real(dp) function median(values)
      real(dp), intent(in) :: values(:)
      integer :: k

      median = values(1)
      do k = 1, size(values)
         ! As many above as below, for an odd number of values.
         if (count(values < values(k)) <= size(values)/2 .and. count(values > values(k)) <= size(values)/2) median = values(k)
      end do
   end function median

   subroutine print_table(ns, table, n_threads, p, equal)
      real(dp), intent(in) :: ns(5, 2), table(5, repeats, 2)
      integer, intent(in) :: n_threads
      type(particles_t), intent(in) :: p
      logical, intent(in) :: equal
      integer :: k

      write (output_unit, '(a, i0, a)') 'ns per particle-step of wall time, median of 5 x ', steps, ' steps:'
      write (output_unit, '(a32, a12, i10, a)') '', '1 thread', n_threads, ' threads'
      do k = 1, 4
         write (output_unit, '(a32, f12.1, f18.1)') phases(k), ns(k, :)
      end do
      write (output_unit, '(a32, f12.1, f18.1)') 'in all', ns(5, :)
      write (output_unit, '(a32, 2f6.0, 2f9.0)') 'least and most', minval(table(5, :, 1)), maxval(table(5, :, 1)), &
         minval(table(5, :, 2)), maxval(table(5, :, 2))
      write (output_unit, '(a32, es12.3, es18.3)') 'particle-steps per second', 1.0e9_dp/ns(5, :)
      write (output_unit, '(a, f0.2)') 'speed-up ', ns(5, 1)/ns(5, 2)
      write (output_unit, '(a, l1)') 'bit-equal ', equal
      write (output_unit, '(a, f0.0)') 'bytes per particle in particle arrays ', real(bytes_per_slot(p%features), dp)*p%capacity/p%n
   end subroutine print_table

end program bench
