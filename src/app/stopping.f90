!> Why a run shall stop before its end: a signal, a file STOP in its directory, or max_wall_time. It can go on from a checkpoint.
module stopping
   use communication, only: is_first
   use errors, only: failure, text_of_any
   use file_system, only: delete_file, is_directory, path_exists
   use kinds, only: dp
   use result_directory, only: result_directory_t, stop_name
   use stop_signals, only: stop_signals_t
   use timers, only: wall_seconds
   implicit none
   private

   public :: stopping_t

   real(dp), parameter :: look_interval = 0.2_dp   !! [s] between looks at the directory

   !> What was asked for.
   type :: stopping_t
      character(:), allocatable :: reason   !! '' while the run shall go on
      type(stop_signals_t), private :: signals
      real(dp), private :: started = 0, last_look = 0   ! [s] of the clock
      real(dp), private :: longest = 0                  ! [s] max_wall_time; 0: endless
   contains
      procedure :: begin
      procedure :: watch
      procedure :: agree
      procedure :: finish
   end type stopping_t

contains

   !> From here on signals wait until they are looked for. A file STOP that is there was meant for another run.
   subroutine begin(self, longest, directory)
      class(stopping_t), intent(inout) :: self
      real(dp), intent(in) :: longest   !! wall time from now on [s]; 0: endless
      type(result_directory_t), intent(in) :: directory
      character(:), allocatable :: ignored

      if (is_first()) call delete_file(directory%file(stop_name), ignored)
      self%reason = ''
      self%longest = longest
      self%started = wall_seconds()
      self%last_look = -huge(1.0_dp)
      call self%signals%hold()
   end subroutine begin

   !> Looks whether the run shall stop; a reason that was found stays. Of this process: to be called often, because a second signal
   !! acts at once, and the directory's lock must not look dead.
   subroutine watch(self, directory)
      class(stopping_t), intent(inout) :: self
      type(result_directory_t), intent(inout) :: directory

      if (self%reason == '') call find_reason(self, directory)
   end subroutine watch

   !> What one process has seen all know. To be called by all.
   subroutine agree(self)
      class(stopping_t), intent(inout) :: self

      call text_of_any(self%reason)
   end subroutine agree

   subroutine find_reason(self, directory)
      class(stopping_t), intent(inout) :: self
      type(result_directory_t), intent(inout) :: directory
      character(:), allocatable :: ignored
      real(dp) :: now
      logical :: asked

      now = wall_seconds()
      self%reason = self%signals%arrived()
      if (self%reason == '' .and. self%longest > 0 .and. now - self%started > self%longest) self%reason = 'max_wall_time'
      if (self%reason /= '' .or. now - self%last_look < look_interval .or. .not. is_first()) return
      self%last_look = now
      call directory%keep_alive()
      asked = path_exists(directory%file(stop_name))
      if (asked) asked = .not. is_directory(directory%file(stop_name))
      if (.not. asked) return
      self%reason = 'file '//stop_name
      call delete_file(directory%file(stop_name), ignored)   ! it has been seen; the next run shall not stop for it
   end subroutine find_reason

   !> Signals act as they did before; those that have come meanwhile are too late.
   subroutine finish(self)
      class(stopping_t), intent(inout) :: self

      do while (self%signals%arrived() /= '')
      end do
      call self%signals%release()
   end subroutine finish

end module stopping
