!> dynsph [options] scene.nml
program main
   use, intrinsic :: iso_fortran_env, only: compiler_options, compiler_version, output_unit
   use build_info, only: build_type, git_id, version
   use communication, only: is_first, library_words, n_processes, start_processes, tell_all
   use command_line, only: command_line_t, parse_command_line, write_help
   use cost, only: cost_t, estimate_cost
   use errors, only: end_program, failure
   use lanes, only: how_chosen, nl, root_name
   use model, only: model_t
   use preliminary, only: preliminary_text
   use process_start, only: start_process
   use program_arguments, only: take_arguments
   use report, only: start_box
   use resumed_run, only: resume_run
   use run_log, only: log_t
   use key_writer, only: shortest_input, tables, template
   use scene_input, only: load_scene, read_settings_text
   use room, only: check_room
   use scene_run, only: output_directory, run_into_directory
   use scene_setup, only: check_fluid, count_particles, set_up_model
   use settings, only: settings_t
   use solution_register, only: solutions_t
   use stop_signals, only: stop_signals_t
   use standard_output, only: check_screen, errors_for_signals, print_text
   use text, only: to_text
   use threads, only: limit_threads
   implicit none

   type(command_line_t) :: options
   type(failure) :: problem
   type(stop_signals_t) :: signals
   character(:), allocatable :: arguments(:)

   call start_process()
   ! Threads that come with MPI leave signals to ours.
   call signals%hold()
   call start_processes()
   call signals%release()
   call errors_for_signals(pipes=.false.)
   call take_arguments(arguments)
   call parse_command_line(arguments, options, problem)
   if (problem%raised()) call end_program(problem)
   if (options%help) then
      if (is_first()) call write_help(output_unit)
      call check_screen(problem)
   else if (options%version) then
      call write_version()
      call check_screen(problem)
   else if (options%template) then
      call print_text(template(solutions_t()), problem)
   else if (options%keys) then
      call print_text(tables(solutions_t()), problem)
   else if (options%resume /= '') then
      call errors_for_signals(pipes=.true.)
      call resume_run(options, problem)
   else
      call run_scene(options, problem)
   end if
   call end_program(problem)

contains

   subroutine write_version()
      if (.not. is_first()) return
      write (output_unit, '(a)') 'dynsph '//version//' ('//git_id//', '//build_type//')'
      write (output_unit, '(a)') compiler_version()
      write (output_unit, '(a)') compiler_options()
      if (library_words() /= '') write (output_unit, '(a, i0)') 'on many machines by '//library_words()//'; ranks here: ', &
         n_processes()
      write (output_unit, '(a, i0, a)') 'clusters of ', nl, ' particles, root by '//root_name//' ('//how_chosen//')'
   end subroutine write_version

   !> Reads the scene, then prints, checks or runs it.
   subroutine run_scene(options, problem)
      type(command_line_t), intent(in) :: options
      type(failure), intent(inout) :: problem
      type(settings_t) :: scene
      type(model_t) :: model
      type(log_t) :: screen
      type(cost_t) :: costs
      character(:), allocatable :: content, warnings(:)
      integer :: k

      content = ''
      if (is_first()) call load_scene(options%scene, content, problem)
      call problem%tell()
      call tell_all(content, 0)
      if (problem%raised()) return
      call read_settings_text(content, options%scene, options%overrides, solutions_t(), scene, warnings, problem)
      if (problem%raised()) return
      if (options%shortest) then
         call print_text(shortest_input(solutions_t(), scene), problem)
         return
      end if
      call check_fluid(scene, problem)
      if (problem%raised()) return
      if (.not. options%check) then
         call errors_for_signals(pipes=.true.)
         call run_into_directory(options, content, scene, warnings, problem)
         return
      end if
      call screen%open(options%quiet)
      ! Each is a kind of its own, so that all are shown.
      do k = 1, size(warnings)
         call screen%warn('input '//to_text(k), trim(warnings(k)))
      end do
      model = set_up_model(scene)
      call limit_threads(count_particles(scene))
      costs = estimate_cost(scene, model, count_particles(scene))
      call start_box(screen, scene, model, costs)
      call check_room(scene, costs, output_directory(options), screen, problem)
      call problem%tell()
      if (scene%fluid%find_reference_speed) call screen%line(preliminary_text(scene))
      if (.not. problem%raised()) call screen%line(options%scene//' is valid; nothing was run')
      if (.not. options%quiet) call check_screen(problem)
   end subroutine run_scene

end program main
