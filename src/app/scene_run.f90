!> A scene from its settings to a directory with its results.
module scene_run
   use command_line, only: command_line_t
   use errors, only: failure
   use key_writer, only: complete_input
   use linear_stability, only: margins_t
   use preliminary, only: find_reference_speed
   use result_directory, only: result_directory_t
   use run_log, only: log_t
   use scene_input, only: read_settings_text
   use scene_setup, only: set_up_model
   use settings, only: settings_t
   use simulation, only: beginning_t, simulate
   use solution_register, only: solutions_t
   use stopping, only: stopping_t
   use text, only: short, to_text
   implicit none
   private

   public :: output_directory, run_into_directory

contains

   !> Runs a scene that was read.
   subroutine run_into_directory(options, content, scene, warnings, problem, margins)
      type(command_line_t), intent(in) :: options
      character(*), intent(in) :: content        !! of the scene's file
      type(settings_t), intent(inout) :: scene   !! on return with the reference speed that was used
      character(*), intent(in) :: warnings(:)
      type(failure), intent(inout) :: problem
      type(margins_t), intent(in), optional :: margins   !! of the step rule, other than the safe ones
      type(result_directory_t) :: directory
      type(log_t) :: log
      type(beginning_t) :: beginning
      type(stopping_t) :: stop
      character(:), allocatable :: input_text
      logical :: began
      integer :: k

      call directory%prepare(output_directory(options), options%overwrite, problem)
      if (problem%raised()) return
      call log%open(options%quiet)
      call stop%begin(scene%time%max_wall_time, directory)
      do k = 1, size(warnings)
         call log%warn('input '//to_text(k), trim(warnings(k)))
      end do
      if (scene%fluid%find_reference_speed) call find_and_check(options, content, scene, warnings, stop, &
                                                                       directory, log, problem)
      if (present(margins)) call log%line('margins of the time step: sound '//short(margins%sound)//', diffusion ' &
         //short(margins%diffusion)//', viscous '//short(margins%viscous)//' of a lattice''s limits; warnings about cfl mean ' &
         //'those of dynsph')
      began = .false.
      if (.not. problem%raised()) then
         beginning%input = complete_input(solutions_t(), scene)
         beginning%origin = ''
         input_text = beginning%input
         if (present(margins)) beginning%input = ''   ! dynsph would go on with its own
         call simulate(scene, set_up_model(scene, margins), input_text, beginning, stop, directory, log, began, problem)
      end if
      call log%close(problem)
      call stop%finish()
      ! A run that could not start leaves nothing behind, and what was there before.
      if (began) call directory%release()
      if (.not. began) call directory%discard(problem)
   end subroutine run_into_directory

   !> Finds the reference speed, and checks the scene with it: so far it was checked with a guess.
   subroutine find_and_check(options, content, scene, told, stop, directory, log, problem)
      type(command_line_t), intent(in) :: options
      character(*), intent(in) :: content        !! of the scene's file
      type(settings_t), intent(inout) :: scene   !! find_reference_speed is .true.; on return with the speed found
      character(*), intent(in) :: told(:)        !! warnings
      type(stopping_t), intent(inout) :: stop
      type(result_directory_t), intent(inout) :: directory
      type(log_t), intent(inout) :: log
      type(failure), intent(inout) :: problem    !! exit_numerics: a coarse run failed; exit_stopped; exit_input
      character(:), allocatable :: overrides(:), warnings(:), found
      integer :: k, n

      call find_reference_speed(scene, stop, directory, log, problem)
      if (problem%raised()) return
      found = 'fluid.reference_speed='//to_text(scene%fluid%reference_speed)
      n = size(options%overrides)
      allocate (character(max(len(found), len(options%overrides))) :: overrides(n + 1))
      overrides(:n) = options%overrides
      overrides(n + 1) = found
      call read_settings_text(content, options%scene, overrides, solutions_t(), scene, warnings, problem)
      if (problem%raised()) return
      do k = 1, size(warnings)
         if (.not. any(told == warnings(k))) call log%warn('input '//to_text(size(told) + k), trim(warnings(k)))
      end do
   end subroutine find_and_check

   !> --output, or results/ and the name of the scene file.
   function output_directory(options) result(path)
      type(command_line_t), intent(in) :: options
      character(:), allocatable :: path
      integer :: dot

      path = options%output
      if (path /= '') return
      path = options%scene(index(options%scene, '/', back=.true.) + 1:)
      dot = index(path, '.', back=.true.)
      if (dot > 1) path = path(:dot - 1)
      path = 'results/'//path
   end function output_directory

end module scene_run
