!> dynsph [options] scene.nml
program main
   use, intrinsic :: iso_fortran_env, only: compiler_options, compiler_version, output_unit
   use build_info, only: build_type, git_id, version
   use command_line, only: command_line_t, parse_command_line, write_help
   use errors, only: end_program, failure
   use file_system, only: write_whole_file
   use lanes, only: nl
   use model, only: model_t
   use preliminary, only: find_reference_speed, preliminary_text
   use report, only: estimate, start_box
   use result_directory, only: input_name, log_name, result_directory_t
   use run_log, only: log_t
   use scene_input, only: echo_text, load_scene, read_settings_text, write_markdown, write_shortest, write_template
   use scene_setup, only: count_particles, set_up_model
   use settings, only: settings_t
   use simulation, only: simulate
   use text, only: to_text
   implicit none

   type(command_line_t) :: options
   type(failure) :: problem

   call parse_command_line(arguments(), options, problem)
   if (problem%raised()) call end_program(problem)
   if (options%help) then
      call write_help(output_unit)
   else if (options%version) then
      call write_version()
   else if (options%template) then
      call write_template(output_unit)
   else if (options%keys) then
      call write_markdown(output_unit)
   else
      call run_scene(options, problem)
   end if
   call end_program(problem)

contains

   function arguments() result(list)
      character(:), allocatable :: list(:)
      integer :: k, length, longest

      longest = 0
      do k = 1, command_argument_count()
         call get_command_argument(k, length=length)
         longest = max(longest, length)
      end do
      allocate (character(longest) :: list(command_argument_count()))
      do k = 1, size(list)
         call get_command_argument(k, list(k))
      end do
   end function arguments

   subroutine write_version()
      write (output_unit, '(a)') 'dynsph '//version//' ('//git_id//', '//build_type//')'
      write (output_unit, '(a)') compiler_version()
      write (output_unit, '(a)') compiler_options()
      write (output_unit, '(a, i0, a)') 'clusters of ', nl, ' particles'
   end subroutine write_version

   !> Reads the scene, then prints, checks or runs it.
   subroutine run_scene(options, problem)
      type(command_line_t), intent(in) :: options
      type(failure), intent(inout) :: problem
      type(settings_t) :: scene
      type(model_t) :: model
      type(log_t) :: screen
      character(:), allocatable :: content, warnings(:)
      integer :: k

      call load_scene(options%scene, content, problem)
      if (problem%raised()) return
      call read_settings_text(content, options%scene, options%overrides, scene, warnings, problem)
      if (problem%raised()) return
      if (options%shortest) then
         call write_shortest(output_unit, scene)
         return
      end if
      if (.not. options%check) then
         call run_into_directory(options, content, scene, warnings, problem)
         return
      end if
      call screen%open('', options%quiet, problem)
      ! Each is a kind of its own, so that all are shown.
      do k = 1, size(warnings)
         call screen%warn('input '//to_text(k), trim(warnings(k)))
      end do
      model = set_up_model(scene)
      call start_box(screen, scene, model, estimate(scene, model, count_particles(scene)))
      if (scene%fluid%find_reference_speed) call screen%line(preliminary_text(scene))
      call screen%line(options%scene//' is valid; nothing was run')
   end subroutine run_scene

   subroutine run_into_directory(options, content, scene, warnings, problem)
      type(command_line_t), intent(in) :: options
      character(*), intent(in) :: content        !! of the scene's file
      type(settings_t), intent(inout) :: scene   !! on return with the reference speed that was used
      character(*), intent(in) :: warnings(:)
      type(failure), intent(inout) :: problem
      type(result_directory_t) :: directory
      type(log_t) :: log
      character(:), allocatable :: input_text
      logical :: began
      integer :: k

      call directory%prepare(output_directory(options), options%overwrite, problem)
      if (problem%raised()) return
      call log%open(directory%file(log_name), options%quiet, problem)
      if (problem%raised()) then
         call directory%discard_if_empty()
         return
      end if
      do k = 1, size(warnings)
         call log%warn('input '//to_text(k), trim(warnings(k)))
      end do
      if (scene%fluid%find_reference_speed) call find_and_check(options, content, scene, warnings, log, problem)
      if (.not. problem%raised()) then
         input_text = echo_text(scene)
         call write_whole_file(directory%file(input_name), input_text, problem)
      end if
      if (problem%raised()) then
         call log%close()
         call directory%discard(problem)
         return
      end if
      call simulate(scene, input_text, directory, log, began, problem)
      call log%close()
      ! A run that could not start leaves nothing behind.
      if (.not. began) call directory%discard(problem)
   end subroutine run_into_directory

   !> Finds the reference speed, and checks the scene with it: so far it was checked with a guess.
   subroutine find_and_check(options, content, scene, told, log, problem)
      type(command_line_t), intent(in) :: options
      character(*), intent(in) :: content        !! of the scene's file
      type(settings_t), intent(inout) :: scene   !! find_reference_speed is .true.; on return with the speed found
      character(*), intent(in) :: told(:)        !! warnings
      type(log_t), intent(inout) :: log
      type(failure), intent(inout) :: problem    !! exit_numerics: a coarse run failed; exit_input
      character(:), allocatable :: overrides(:), warnings(:), found
      integer :: k, n

      call find_reference_speed(scene, log, problem)
      if (problem%raised()) return
      found = 'fluid.reference_speed='//to_text(scene%fluid%reference_speed)
      n = size(options%overrides)
      allocate (character(max(len(found), len(options%overrides))) :: overrides(n + 1))
      overrides(:n) = options%overrides
      overrides(n + 1) = found
      call read_settings_text(content, options%scene, overrides, scene, warnings, problem)
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

end program main
