!> A run that goes on from its latest checkpoint, in its own directory or, changed, in another.
module resumed_run
   use build_info, only: git_id, version
   use changed_keys, only: change_t, list_changes
   use checkpoints, only: latest_checkpoint
   use command_line, only: command_line_t
   use errors, only: exit_files, exit_input, failure
   use file_system, only: path_exists, read_whole_file
   use key_writer, only: complete_input
   use result_directory, only: input_name, result_directory_t, summary_name
   use run_log, only: log_t
   use scene_input, only: read_settings_text
   use scene_run, only: run_into_directory
   use scene_setup, only: set_up_model
   use settings, only: settings_t
   use simulation, only: beginning_t, simulate
   use solution_register, only: solutions_t
   use text, only: short, to_text
   implicit none
   private

   public :: resume_run

contains

   !> Goes on with the run in options%resume. Changes nothing there unless the run can go on.
   subroutine resume_run(options, problem)
      type(command_line_t), intent(in) :: options
      type(failure), intent(inout) :: problem   !! exit_input, exit_files, and what a run raises
      type(result_directory_t) :: source, directory
      type(beginning_t) :: beginning
      type(settings_t) :: scene
      type(log_t) :: log
      type(change_t), allocatable :: changes(:)
      character(:), allocatable :: input_text, remarks
      logical :: began

      call source%reopen(options%resume, problem)
      if (problem%raised()) return
      call latest_checkpoint(source, beginning%file, beginning%turn, remarks)
      if (beginning%turn == 0) then
         call begin_again(options, source, remarks, problem)
         return
      end if
      call read_changed(options, beginning, scene, changes, log, problem)
      directory = source
      beginning%forked = options%fork /= ''
      if (beginning%forked .and. .not. problem%raised()) then
         ! The source is read only until the particles are there.
         call directory%prepare(options%fork, options%overwrite, problem)
         beginning%turn = 0
         beginning%origin = fork_text(source, beginning)
      end if
      began = .false.
      if (.not. problem%raised()) then
         input_text = beginning%input
         if (beginning%origin /= '') input_text = '! '//beginning%origin//new_line('a')//input_text
         call say_where_it_goes_on(log, beginning, remarks, changes)
         call simulate(scene, set_up_model(scene), input_text, beginning, directory, log, began, problem)
         call log%close(problem)
         if (beginning%forked .and. .not. began) call directory%discard(problem)
         if (beginning%forked) call directory%release()
      end if
      call source%release()
   end subroutine resume_run

   ! The scene of a checkpoint with the changes that are asked for.
   subroutine read_changed(options, beginning, scene, changes, log, problem)
      type(command_line_t), intent(in) :: options
      type(beginning_t), intent(inout) :: beginning
      type(settings_t), intent(out) :: scene
      type(change_t), allocatable, intent(out) :: changes(:)
      type(log_t), intent(inout) :: log
      type(failure), intent(inout) :: problem   !! exit_input
      character(:), allocatable :: warnings(:)
      integer :: k

      allocate (changes(0))
      associate (file => beginning%file)
         call read_settings_text(file%input, 'input of '//file%path, options%overrides, solutions_t(), scene, warnings, problem)
         if (problem%raised()) return
         beginning%input = complete_input(solutions_t(), scene)
         call list_changes(file%input, beginning%input, changes)
         call check_changes(changes, options%fork /= '', problem)
         if (scene%time%end_time <= file%time) call problem%raise(exit_input, 'the checkpoint is of t = '//short(file%time) &
            //', and the run shall end at t = '//short(scene%time%end_time)//': give a later end with --set time.end_time=T')
         beginning%origin = file%origin
      end associate
      call log%open(options%quiet)
      do k = 1, size(warnings)
         call log%warn('input '//to_text(k), trim(warnings(k)))
      end do
   end subroutine read_changed

   ! Refuses what cannot be changed, all of it at once.
   subroutine check_changes(changes, fork, problem)
      type(change_t), intent(in) :: changes(:)
      logical, intent(in) :: fork
      type(failure), intent(inout) :: problem
      logical :: fits
      integer :: k

      do k = 1, size(changes)
         if (fork .and. .not. changes(k)%may_fork()) then
            call problem%raise(exit_input, changes(k)%words()//': the particles of the checkpoint are of the old one; ' &
                               //'begin a run of its own')
         else if (.not. fork) then
            fits = changes(k)%may_go_on()
            if (.not. fits) call problem%raise(exit_input, changes(k)%words()//': one result would be of two scenes; with ' &
                                               //'--fork DIR2 it goes on in another directory')
         end if
      end do
   end subroutine check_changes

   function fork_text(source, beginning) result(words)
      type(result_directory_t), intent(in) :: source
      type(beginning_t), intent(in) :: beginning
      character(:), allocatable :: words

      words = 'Forked from '//source%path//' at step '//to_text(beginning%file%step)//', t = '//to_text(beginning%file%time)
      if (beginning%origin /= '') words = words//'. '//beginning%origin
   end function fork_text

   subroutine say_where_it_goes_on(log, beginning, remarks, changes)
      type(log_t), intent(inout) :: log
      type(beginning_t), intent(in) :: beginning
      character(*), intent(in) :: remarks   !! lines on checkpoints that are not used
      type(change_t), intent(in) :: changes(:)
      integer :: k

      associate (file => beginning%file)
         call log%line('goes on from '//file%path//': step '//to_text(file%step)//', t = '//short(file%time))
         if (remarks /= '') call log%warn('checkpoint', remarks(:len(remarks) - 1))
         if (file%version//file%git_id /= version//git_id) call log%warn('version', 'the checkpoint is of dynsph '//file%version &
            //' ('//file%git_id//'), this is '//version//' ('//git_id//'): the last bits may be others than without a stop')
      end associate
      do k = 1, size(changes)
         call log%line('changed: '//changes(k)%words())
      end do
   end subroutine say_where_it_goes_on

   ! A run that was broken off before its first checkpoint has lost nothing but the minutes until then.
   subroutine begin_again(options, directory, remarks, problem)
      type(command_line_t), intent(in) :: options
      type(result_directory_t), intent(inout) :: directory   !! on return given free
      character(*), intent(in) :: remarks
      type(failure), intent(inout) :: problem
      type(command_line_t) :: anew
      type(settings_t) :: scene
      character(:), allocatable :: content, warnings(:)
      logical :: begun, ended

      begun = path_exists(directory%file(input_name))
      ended = path_exists(directory%file(summary_name))
      content = ''
      if (begun .and. .not. ended .and. options%fork == '' .and. remarks == '') &
         call read_whole_file(directory%file(input_name), content, problem)
      call directory%release()
      if (problem%raised()) return
      ! Whether it would have made checkpoints: a long run that made none must not be lost.
      if (index(content, 'checkpoint = ') == 0 .or. index(content, "checkpoint = 'never'") > 0) then
         call problem%raise(exit_files, remarks//"there is no checkpoint in '"//directory%path//"' to go on from")
         return
      end if
      anew = options
      anew%scene = directory%file(input_name)
      anew%output = directory%path
      anew%overwrite = .true.
      call read_settings_text(content, anew%scene, anew%overrides, solutions_t(), scene, warnings, problem)
      if (problem%raised()) return
      call run_into_directory(anew, content, scene, warnings, problem)
   end subroutine begin_again

end module resumed_run
