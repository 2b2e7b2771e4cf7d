!> A run that goes on from its latest checkpoint, in its own directory or, changed, in another.
module resumed_run
   use build_info, only: git_id, version
   use cadence, only: cadence_t
   use changed_keys, only: change_t, list_changes
   use checkpoint_file, only: checkpoint_file_t
   use checkpoints, only: latest_checkpoint
   use command_line, only: command_line_t
   use common_files, only: exists_for_all, read_for_all, same_for_all
   use errors, only: exit_files, exit_input, failure
   use key_writer, only: complete_input
   use result_directory, only: checkpoint_names, input_name, result_directory_t, summary_name
   use run_log, only: log_t
   use scene_input, only: read_settings_text
   use scene_run, only: run_into_directory
   use scene_setup, only: set_up_model
   use settings, only: settings_t
   use simulation, only: beginning_t, simulate
   use solution_register, only: solutions_t
   use stopping, only: stopping_t
   use text, only: has_control_characters, short, to_text
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
      type(stopping_t) :: stop
      type(change_t), allocatable :: changes(:)
      character(:), allocatable :: input_text, remarks
      logical :: began

      call source%reopen(options%resume, options%fork /= '', problem)
      if (problem%raised()) return
      call latest_checkpoint(source, beginning%file, beginning%turn, remarks)
      if (beginning%turn == 0) then
         call begin_again(options, source, remarks, problem)
         return
      end if
      beginning%forked = options%fork /= ''
      if (.not. beginning%forked) call check_origin(source, beginning, problem)
      if (.not. problem%raised()) call read_changed(options, beginning, scene, changes, log, problem)
      directory = source
      if (beginning%forked .and. .not. problem%raised()) call prepare_fork(options, source, beginning, directory, problem)
      began = .false.
      if (.not. problem%raised()) then
         input_text = with_origin(beginning%origin, beginning%input)
         call say_where_it_goes_on(log, beginning, remarks, changes)
         call stop%begin(scene%time%max_wall_time, directory)
         call simulate(scene, set_up_model(scene), input_text, beginning, stop, directory, log, began, problem)
         call log%close(problem)
         call stop%finish()
      end if
      call beginning%file%close()
      if (beginning%forked .and. .not. began) call directory%discard(problem)
      call directory%release()
   end subroutine resume_run

   ! The complete input as input_used.nml has it.
   pure function with_origin(origin, input) result(text)
      character(*), intent(in) :: origin, input
      character(:), allocatable :: text

      text = input
      if (origin /= '') text = '! Forked from '//origin//new_line('a')//input
   end function with_origin

   ! Refuses a checkpoint of another run. The input is that of the latest checkpoint, or of the one before if the run was killed
   ! between the two.
   subroutine check_origin(directory, beginning, problem)
      type(result_directory_t), intent(in) :: directory
      type(beginning_t), intent(in) :: beginning
      type(failure), intent(inout) :: problem   !! exit_files
      type(checkpoint_file_t) :: before
      character(:), allocatable :: content, reason
      logical :: fits

      if (.not. exists_for_all(directory%file(input_name))) return
      call read_for_all(directory%file(input_name), content, problem)
      if (problem%raised()) return
      fits = content == with_origin(beginning%file%origin, beginning%file%input)
      if (.not. fits) then
         call before%open(directory%file(trim(checkpoint_names(3 - beginning%turn))), reason)
         if (reason == '') fits = content == with_origin(before%origin, before%input)
         call before%close()
      end if
      if (.not. fits) call problem%raise(exit_files, "cannot go on from '"//beginning%file%path &
         //"': it is of another input than '"//directory%file(input_name)//"'")
   end subroutine check_origin

   ! The directory of a fork, which has nothing from where it is from but the state.
   subroutine prepare_fork(options, source, beginning, directory, problem)
      type(command_line_t), intent(in) :: options
      type(result_directory_t), intent(in) :: source
      type(beginning_t), intent(inout) :: beginning
      type(result_directory_t), intent(inout) :: directory
      type(failure), intent(inout) :: problem

      if (same_for_all(options%fork, source%path)) then
         call problem%raise(exit_input, "'"//options%fork//"' is the directory of the run itself: leave out --fork, or choose " &
                            //'another directory')
         return
      end if
      call directory%prepare(options%fork, options%overwrite, problem)
      beginning%turn = 0
      beginning%origin = fork_text(source, beginning)
   end subroutine prepare_fork

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
         if (scene%time%end_time <= file%time) call problem%raise(exit_input, 'the checkpoint is of t = '//to_text(file%time) &
            //', and the run shall end at t = '//to_text(scene%time%end_time)//': give a later end with --set time.end_time=T')
         if (scene%time%max_steps > 0 .and. scene%time%max_steps <= file%step) call problem%raise(exit_input, &
            'the checkpoint is of step '//to_text(file%step)//', and the run shall end after '//to_text(scene%time%max_steps) &
            //': give a larger number with --set time.max_steps=N, or 0')
         if (scene%fluid%find_reference_speed) call problem%raise(exit_input, &
            "reference_speed = 'auto' is found at the beginning of a run: give it a number")
         beginning%origin = file%origin
      end associate
      beginning%changed = size(changes) > 0
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

      words = on_one_line(source%path)//' at step '//to_text(beginning%file%step)//', t = '//to_text(beginning%file%time)
      if (beginning%origin /= '') words = words//', which was forked from '//beginning%origin
   end function fork_text

   pure function on_one_line(path) result(line)
      character(*), intent(in) :: path
      character(len(path)) :: line
      integer :: i

      line = path
      do i = 1, len(line)
         if (has_control_characters(line(i:i))) line(i:i) = '?'
      end do
   end function on_one_line

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

   ! A run that was broken off before its first checkpoint, which comes with the first steps, has lost nothing. Where there are
   ! more results than that somebody has taken the checkpoints away, and they are not touched.
   subroutine begin_again(options, directory, remarks, problem)
      type(command_line_t), intent(in) :: options
      type(result_directory_t), intent(inout) :: directory   !! on return given free
      character(*), intent(in) :: remarks
      type(failure), intent(inout) :: problem
      integer, parameter :: later_snapshot = 12   ! none of the first steps
      type(command_line_t) :: anew
      type(settings_t) :: scene
      type(change_t), allocatable :: changes(:)
      character(:), allocatable :: content, ignored, warnings(:)
      type(cadence_t) :: when
      logical :: begun, later

      begun = exists_for_all(directory%file(input_name))
      later = exists_for_all(directory%file(summary_name))
      if (later) then
         ! It ended; but one whose disk was full had not begun well.
         call read_for_all(directory%file(summary_name), content, problem)
         later = index(content, 'status = failed: output') == 0
      end if
      if (.not. later) later = exists_for_all(directory%snapshot_path(later_snapshot))
      content = ''
      if (begun .and. .not. later .and. options%fork == '' .and. remarks == '') &
         call read_for_all(directory%file(input_name), content, problem)
      call directory%release()
      if (problem%raised()) return
      if (index(content, 'checkpoint = ') == 0) content = ''   ! of a version that had none
      if (content /= '') then
         call copy_overrides(options, anew)
         anew%scene = directory%file(input_name)
         anew%output = directory%path
         call read_settings_text(content, anew%scene, anew%overrides, solutions_t(), scene, warnings, problem)
         if (problem%raised()) return
         call list_changes(content, complete_input(solutions_t(), scene), changes)
         call check_changes(changes, .false., problem)
         if (problem%raised()) return
         call when%parse(trim(scene%output%checkpoint), ignored, by_clock=.true.)
         if (.not. when%is_never()) then
            call run_into_directory(anew, content, scene, warnings, problem)
            return
         end if
      end if
      call problem%raise(exit_files, remarks//"there is no checkpoint in '"//directory%path//"' to go on from")
   end subroutine begin_again

   ! Component by component: gfortran 12 loses the length of the overrides in an assignment of the whole.
   subroutine copy_overrides(options, anew)
      type(command_line_t), intent(in) :: options
      type(command_line_t), intent(out) :: anew

      anew%fork = ''
      anew%resume = ''
      anew%quiet = options%quiet
      anew%overwrite = .true.
      allocate (character(len(options%overrides)) :: anew%overrides(size(options%overrides)))
      anew%overrides(:) = options%overrides
   end subroutine copy_overrides

end module resumed_run
