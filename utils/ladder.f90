!> Cost of a step with more or less of what a scene may ask for: variants of one scene, from one flowing state.
!!
!! usage: dynsph-ladder SCENE.nml START_TIME STEPS REPEATS DIR [--set group.key=value ...] < VARIANTS
!!
!! Runs the scene to the start time. Then each variant takes the same number of steps from there, one variant after the
!! other and then all again, forwards and backwards in turn, so that what disturbs the machine disturbs all alike. A
!! variant is a line 'name | scene.nml | group.key=value | ...' of the same particles. Its tables and snapshots go to
!! DIR/NAME. Prints for each variant and repeat: name, repeat, particles, bytes of a slot, bytes per particle of all
!! arrays, ns of processor time per particle-step, steps repeated, and ns of wall time by phase. For one thread.
program ladder
   use, intrinsic :: iso_fortran_env, only: input_unit, iostat_end, output_unit
   use command_line, only: command_line_t, parse_command_line
   use errors, only: end_program, exit_input, exit_numerics, failure
   use kinds, only: dp
   use model, only: model_t
   use neighbours, only: neighbours_t
   use particles, only: allocate_particles, particles_t, reserve_slots
   use process_start, only: start_process
   use program_arguments, only: take_arguments
   use recorder, only: recorder_t
   use result_directory, only: result_directory_t
   use scene_input, only: read_settings
   use scene_setup, only: needed_features, set_up_model, set_up_particles
   use settings, only: settings_t
   use solution_register, only: solutions_t
   use standard_output, only: errors_for_signals
   use step_state, only: step_t
   use text, only: behind
   use time_step, only: advance, refresh
   use timers, only: timers_t
   implicit none

   integer, parameter :: phase_output = 5
   integer, parameter :: longest_line = 512
   character(*), parameter :: phases(5) = [character(8) :: 'sort', 'first', 'second', 'stages', 'output']

   !> A variant, ready to go on from the flowing state.
   type :: variant_t
      character(64) :: name = ''
      type(settings_t) :: scene
      type(model_t) :: model
      type(particles_t) :: p      !! flowing state in `next`
      type(step_t) :: run
      type(recorder_t) :: recorder
      type(result_directory_t) :: directory
   end type variant_t

   type(command_line_t) :: options
   type(variant_t), allocatable :: variants(:)
   type(failure) :: problem
   character(:), allocatable :: directory
   real(dp) :: start_time
   integer :: steps, repeats

   call read_arguments()
   if (.not. problem%raised()) call read_variants()
   if (.not. problem%raised()) call flow()
   if (.not. problem%raised()) call measure()
   call end_program(problem)

contains

   subroutine read_arguments()
      character(:), allocatable :: words(:)
      integer :: status(3)

      call start_process()
      call errors_for_signals(pipes=.false.)
      call take_arguments(words)
      status = 1
      if (size(words) >= 5) then
         read (words(2), *, iostat=status(1)) start_time
         read (words(3), *, iostat=status(2)) steps
         read (words(4), *, iostat=status(3)) repeats
      end if
      if (any(status /= 0)) then
         call problem%raise(exit_input, &
                            'usage: dynsph-ladder SCENE.nml START_TIME STEPS REPEATS DIR [--set group.key=value ...] < VARIANTS')
         return
      end if
      directory = trim(words(5))
      call parse_command_line([words(1), words(6:)], options, problem)
   end subroutine read_arguments

   ! One a line; the first variant, without a name, is the scene as it is.
   subroutine read_variants()
      character(longest_line) :: line
      integer :: status

      allocate (variants(1))
      call read_variant(' | '//options%scene, variants(1))
      do while (.not. problem%raised())
         read (input_unit, '(a)', iostat=status) line
         if (status == iostat_end) exit
         if (line == '') cycle
         variants = [variants, variant_t()]
         call read_variant(line, variants(size(variants)))
      end do
   end subroutine read_variants

   subroutine read_variant(line, variant)
      character(*), intent(in) :: line
      type(variant_t), intent(inout) :: variant
      character(longest_line), allocatable :: overrides(:)
      character(:), allocatable :: warnings(:), rest, path
      integer :: bar

      allocate (overrides(size(options%overrides)))
      overrides = options%overrides
      bar = index(line//'|', '|')
      variant%name = line(:bar - 1)
      rest = trim(line(bar + 1:))//'|'
      path = trim(adjustl(rest(:index(rest, '|') - 1)))
      rest = behind(rest, index(rest, '|'))
      do while (rest /= '')
         bar = index(rest, '|')
         overrides = [character(longest_line) :: overrides, adjustl(rest(:bar - 1))]
         rest = behind(rest, bar)
      end do
      call read_settings(path, overrides, solutions_t(), variant%scene, warnings, problem)
      if (.not. problem%raised()) variant%model = set_up_model(variant%scene)
   end subroutine read_variant

   ! Brings the scene to its start time and gives all variants its state.
   subroutine flow()
      type(particles_t) :: p
      type(neighbours_t) :: near
      type(step_t) :: run
      type(timers_t) :: timers
      integer :: k

      call timers%initialise(phases)
      associate (model => variants(1)%model)
         call set_up_particles(variants(1)%scene, model, p)
         call refresh(model, p, near, run, timers)
         do while (run%time < start_time)
            call advance(model, p, near, run, start_time, timers)
            if (run%lost_slot > 0 .or. run%scattered) then
               call problem%raise(exit_numerics, 'dynsph-ladder: the run failed before its start time')
               return
            end if
            call refresh(model, p, near, run, timers)
         end do
      end associate
      ! The last step, cut short to end at the start time, says nothing about the next.
      run%dt = variants(1)%model%longest_step()
      do k = 1, size(variants)
         call take_over(p, run, variants(k))
         call open_tables(variants(k))
      end do
   end subroutine flow

   subroutine take_over(p, run, variant)
      type(particles_t), intent(in) :: p   !! base state
      type(step_t), intent(in) :: run
      type(variant_t), intent(inout) :: variant

      variant%run = run
      associate (new => variant%p, n => p%n_own)
         call allocate_particles(new, p%n, needed_features(variant%scene, variant%model))
         call reserve_slots(new, n)
         new%n_own = n
         new%id(:n) = p%id(:n)
         new%m(:n) = p%m(:n)
         new%next%x(:n) = p%base%x(:n)
         new%next%y(:n) = p%base%y(:n)
         new%next%u(:n) = p%base%u(:n)
         new%next%v(:n) = p%base%v(:n)
         new%next%s(:n) = p%base%s(:n)
         new%next%volume(:n) = p%base%volume(:n)
      end associate
   end subroutine take_over

   subroutine open_tables(variant)
      type(variant_t), intent(inout) :: variant
      type(particles_t) :: p
      type(neighbours_t) :: near
      type(step_t) :: run
      type(timers_t) :: timers

      if (variant%name == '' .or. problem%raised()) return
      call variant%directory%prepare(directory//'/'//variant%name, .true., problem)
      if (problem%raised()) return
      call timers%initialise(phases)
      p = variant%p
      run = variant%run
      call refresh(variant%model, p, near, run, timers)
      call variant%directory%clear(problem)
      call variant%recorder%start(variant%scene, '', variant%model, p)
      call variant%recorder%open(variant%scene, variant%model, variant%directory, only_check=.false., problem=problem)
   end subroutine open_tables

   subroutine measure()
      integer :: k, repeat

      do repeat = 1, repeats
         do k = 2, size(variants)
            call time_steps(variants(merge(k, size(variants) + 2 - k, mod(repeat, 2) == 1)), repeat)
            if (problem%raised()) return
         end do
      end do
      do k = 2, size(variants)
         call variants(k)%recorder%finish(variants(k)%directory, problem)
         call variants(k)%directory%release()
      end do
   end subroutine measure

   ! Times a variant's steps from the flowing state, and prints what they cost.
   subroutine time_steps(variant, repeat)
      type(variant_t), intent(inout) :: variant
      integer, intent(in) :: repeat
      type(particles_t) :: p
      type(neighbours_t) :: near
      type(step_t) :: run
      type(timers_t) :: timers
      real(dp) :: started, ended, ns
      integer :: k

      associate (model => variant%model)
         p = variant%p
         run = variant%run
         run%step = 1   ! the next one is as long as the last; cadences count from here
         call timers%initialise(phases)
         call refresh(model, p, near, run, timers)
         call timers%initialise(phases)
         call cpu_time(started)
         do k = 1, steps
            call advance(model, p, near, run, huge(1.0_dp), timers)
            if (run%lost_slot > 0 .or. run%scattered) &
               call problem%raise(exit_numerics, 'dynsph-ladder: '//trim(variant%name)//' failed')
            if (problem%raised()) return
            call refresh(model, p, near, run, timers)
            call timers%start(phase_output)
            call variant%recorder%record(variant%scene, model, p, near, run, variant%directory, .false., problem)
            call timers%stop(phase_output)
         end do
         call cpu_time(ended)
         ns = 1.0e9_dp/(real(steps, dp)*p%n)
         write (output_unit, '(a, 3(1x, i0), 2(1x, f0.2), 1x, i0, 5(1x, f0.2))') trim(variant%name), repeat, p%n, &
            p%bytes_per_slot, real(p%bytes() + near%bytes(), dp)/p%n, ns*(ended - started), run%repeated - variant%run%repeated, &
            (ns*timers%seconds(k), k=1, size(phases))
      end associate
   end subroutine time_steps

end program ladder
