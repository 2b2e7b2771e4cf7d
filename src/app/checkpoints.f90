!> When a checkpoint is written, and how: two files in turn, so that one is whole at any time.
module checkpoints
   use cadence, only: cadence_t
   use checkpoint_file, only: checkpoint_file_t
   use common_files, only: exists_for_all
   use communication, only: is_first
   use errors, only: failure
   use file_system, only: longest_path, secure_path
   use kinds, only: dp, i8
   use model, only: model_t
   use result_directory, only: checkpoint_names, result_directory_t
   use run_state, only: run_state_t
   use search_margins, only: plan_t
   use settings, only: settings_t
   use time_step, only: plan_next
   use timers, only: wall_seconds
   implicit none
   private

   public :: checkpoints_t, latest_checkpoint

   integer, parameter :: last_steps = 10           !! before max_steps; lists are seldom kept for longer
   real(dp), parameter :: last_spans = 1.7_dp      !! before end_time, in spans of the lists, which are never kept for longer

   !> What is due.
   type :: checkpoints_t
      character(:), allocatable :: input    !! complete input of the run
      character(:), allocatable :: origin   !! where it was forked from
      type(cadence_t), private :: when
      real(dp), private :: last = 0         ! [s] of the clock
      integer, private :: turn = 1          ! which file comes next
      integer(i8), private :: number = 0    ! of those written before
      logical, private :: due = .false.
   contains
      procedure :: start
      procedure :: watch
      procedure :: is_due_by_clock
      procedure :: write => write_checkpoint
      procedure :: wanted
      procedure :: any_written
   end type checkpoints_t

contains

   !> Sets out, with `turn` the file that is written first. The first checkpoint comes with the first steps: then a run that has
   !! none has nothing to lose.
   subroutine start(self, scene, input, origin, turn, number)
      class(checkpoints_t), intent(inout) :: self
      type(settings_t), intent(in) :: scene
      character(*), intent(in) :: input, origin
      integer, intent(in) :: turn
      integer(i8), intent(in) :: number   !! of those that the run has written before
      character(:), allocatable :: ignored

      call self%when%parse(trim(scene%output%checkpoint), ignored, by_clock=.true.)
      self%input = input
      self%origin = origin
      self%turn = turn
      self%number = number
      self%due = number == 0 .and. .not. self%when%is_never()
      self%last = wall_seconds()
   end subroutine start

   !> Whether the run can go on from one.
   pure logical function any_written(self)
      class(checkpoints_t), intent(in) :: self

      any_written = self%number > 0
   end function any_written

   !> Looks whether one is due; it is written as soon as the particles are about to be sorted.
   subroutine watch(self, step, time, time_before, by_clock)
      class(checkpoints_t), intent(inout) :: self
      integer, intent(in) :: step
      real(dp), intent(in) :: time, time_before
      logical, intent(in) :: by_clock   !! of some process, as all know by now

      self%due = self%due .or. by_clock .or. self%when%is_due(step, time, time_before)
   end subroutine watch

   !> Whether one is due by the clock of this process.
   logical function is_due_by_clock(self)
      class(checkpoints_t), intent(in) :: self

      is_due_by_clock = self%when%is_due_by_clock(wall_seconds() - self%last)
   end function is_due_by_clock

   !> Whether one is to be written where the particles are about to be sorted. At the end of a run this comes shortly before it,
   !! because the last step may be shorter than one of a run that goes on.
   logical function wanted(self, scene, model, state, stop)
      class(checkpoints_t), intent(in) :: self
      type(settings_t), intent(in) :: scene
      type(model_t), intent(in) :: model
      type(run_state_t), intent(in) :: state   !! before the sort
      logical, intent(in) :: stop              !! the run shall stop here

      wanted = .false.
      if (state%step%time >= scene%time%end_time) return
      wanted = stop .or. self%due
      if (.not. (wanted .or. self%when%is_never())) wanted = ends_soon(scene, model, state)
   end function wanted

   ! Whether the run may end before the particles are sorted once more.
   logical function ends_soon(scene, model, state)
      type(settings_t), intent(in) :: scene
      type(model_t), intent(in) :: model
      type(run_state_t), intent(in) :: state
      type(plan_t) :: plan

      plan = plan_next(model, state%near, state%step)
      ends_soon = scene%time%end_time - state%step%time <= last_spans*plan%span
      if (scene%time%max_steps > 0) ends_soon = ends_soon .or. scene%time%max_steps - state%step%step <= last_steps
   end function ends_soon

   !> Writes the state, which is about to be sorted as planned, with all tables and snapshots until here.
   subroutine write_checkpoint(self, state, directory, problem)
      class(checkpoints_t), intent(inout) :: self
      type(run_state_t), intent(inout) :: state
      type(result_directory_t), intent(in) :: directory
      type(failure), intent(inout) :: problem   !! exit_files
      type(checkpoint_file_t) :: file
      character(:), allocatable :: ignored

      call state%recorder%secure(directory, problem)
      if (problem%raised()) return
      file%number = self%number
      file%input = self%input
      file%origin = self%origin
      file%particles = int(state%p%n, i8)
      file%step = int(state%step%step, i8)
      file%time = state%step%time
      call file%write_head(directory%file(trim(checkpoint_names(self%turn))))
      call state%archive(file)
      call file%finish(problem)
      if (problem%raised()) return
      if (is_first()) call secure_path(directory%path, ignored)   ! some file systems cannot
      self%turn = 3 - self%turn
      self%number = self%number + 1
      self%due = .false.
      self%last = wall_seconds()
   end subroutine write_checkpoint

   !> Opens the latest checkpoint of a directory that is whole. `remarks` has a line for each that is not.
   subroutine latest_checkpoint(directory, file, turn, remarks)
      type(result_directory_t), intent(in) :: directory
      type(checkpoint_file_t), intent(out) :: file
      integer, intent(out) :: turn   !! which of the two; 0 if there is none
      character(:), allocatable, intent(out) :: remarks
      type(checkpoint_file_t) :: candidate
      character(longest_path) :: path
      character(:), allocatable :: reason
      logical :: there
      integer :: k

      turn = 0
      remarks = ''
      do k = 1, size(checkpoint_names)
         path = directory%file(trim(checkpoint_names(k)))
         there = exists_for_all(path)
         if (.not. there) cycle   ! none yet
         call candidate%open(trim(path), reason)
         if (reason /= '') then
            remarks = remarks//"'"//trim(path)//"' cannot be used: "//reason//new_line('a')
         else if (turn > 0 .and. candidate%number < file%number) then
            call candidate%close()
         else
            call file%close()
            file = candidate
            turn = k
         end if
      end do
   end subroutine latest_checkpoint

end module checkpoints
