!> Signals that ask a run to stop. While they are held they wait until they are looked for, between two steps, and interrupt
!! nothing: there is no handler, and so nothing that a handler must not do.
!!
!! A signal that the process ignores (SIGHUP under nohup, SIGINT in the background of a script) stays ignored.
module stop_signals
   use, intrinsic :: iso_c_binding, only: c_int, c_intptr_t, c_long, c_null_ptr, c_ptr
   implicit none
   private

   public :: stop_signals_t

   integer, parameter :: n_known = 5
   character(*), parameter :: names(n_known) = [character(7) :: 'SIGTERM', 'SIGINT', 'SIGHUP', 'SIGXCPU', 'SIGUSR1']
   integer(c_int), parameter :: numbers(n_known) = [15_c_int, 2_c_int, 1_c_int, 24_c_int, 10_c_int]   ! of Linux
   integer, parameter :: cpu_time = 4   !! SIGXCPU, which comes again every second

   integer(c_int), parameter :: block = 0, unblock = 1   ! SIG_BLOCK, SIG_UNBLOCK
   integer(c_intptr_t), parameter :: ignored = 1         ! SIG_IGN
   integer, parameter :: set_words = 16                  ! of the C library's sigset_t
   integer, parameter :: action_words = 64               ! more than its struct sigaction; the handler comes first

   !> Which signals are held.
   type :: stop_signals_t
      private
      logical :: held(n_known) = .false.
   contains
      procedure :: hold
      procedure :: arrived
      procedure :: release
   end type stop_signals_t

   interface
      integer(c_int) function c_sigemptyset(set) bind(c, name='sigemptyset')
         import :: c_int, c_long
         integer(c_long), intent(inout) :: set(*)
      end function c_sigemptyset

      integer(c_int) function c_sigaddset(set, number) bind(c, name='sigaddset')
         import :: c_int, c_long
         integer(c_long), intent(inout) :: set(*)
         integer(c_int), value :: number
      end function c_sigaddset

      integer(c_int) function c_sigismember(set, number) bind(c, name='sigismember')
         import :: c_int, c_long
         integer(c_long), intent(in) :: set(*)
         integer(c_int), value :: number
      end function c_sigismember

      integer(c_int) function c_sigpending(set) bind(c, name='sigpending')
         import :: c_int, c_long
         integer(c_long), intent(inout) :: set(*)
      end function c_sigpending

      integer(c_int) function c_sigwait(set, number) bind(c, name='sigwait')
         import :: c_int, c_long
         integer(c_long), intent(in) :: set(*)
         integer(c_int), intent(out) :: number
      end function c_sigwait

      integer(c_int) function c_sigmask(how, set, before) bind(c, name='pthread_sigmask')
         import :: c_int, c_long, c_ptr
         integer(c_int), value :: how
         integer(c_long), intent(in) :: set(*)
         type(c_ptr), value :: before
      end function c_sigmask

      integer(c_int) function c_sigaction(number, new, old) bind(c, name='sigaction')
         import :: c_int, c_intptr_t, c_ptr
         integer(c_int), value :: number
         type(c_ptr), value :: new
         integer(c_intptr_t), intent(inout) :: old(*)
      end function c_sigaction
   end interface

contains

   !> From here on signals wait, in all threads.
   subroutine hold(self)
      class(stop_signals_t), intent(inout) :: self
      integer(c_intptr_t) :: action(action_words)
      integer :: k

      do k = 1, n_known
         action = ignored
         self%held(k) = c_sigaction(numbers(k), c_null_ptr, action) == 0
         self%held(k) = self%held(k) .and. action(1) /= ignored
      end do
      call set_mask(block, self%held)
   end subroutine hold

   !> The name of a signal that has arrived, '' if none has. It is taken: the next signal ends the program at once.
   function arrived(self) result(name)
      class(stop_signals_t), intent(inout) :: self
      character(:), allocatable :: name
      integer(c_long) :: waiting(set_words)
      integer(c_int) :: number, status
      logical :: chosen(n_known)
      integer :: k

      name = ''
      if (.not. any(self%held)) return
      if (c_sigpending(waiting) /= 0) return
      do k = 1, n_known
         if (.not. self%held(k)) cycle
         if (c_sigismember(waiting, numbers(k)) /= 1) cycle
         name = trim(names(k))
         chosen = .false.
         chosen(k) = .true.
         status = c_sigwait(set_of(chosen), number)
         call self%release(but=cpu_time)
         return
      end do
   end function arrived

   !> Signals act as they did before.
   subroutine release(self, but)
      class(stop_signals_t), intent(inout) :: self
      integer, intent(in), optional :: but   !! which one goes on waiting
      logical :: freed(n_known)

      freed = self%held
      if (present(but)) freed(but) = .false.
      call set_mask(unblock, freed)
      self%held = self%held .and. .not. freed
   end subroutine release

   ! Each thread has a mask of its own; a signal goes to any thread that does not block it.
   subroutine set_mask(how, marked)
      integer(c_int), intent(in) :: how
      logical, intent(in) :: marked(n_known)
      integer(c_long) :: set(set_words)
      integer(c_int) :: status

      set = set_of(marked)
      !$omp parallel default(none) shared(how, set) private(status)
      status = c_sigmask(how, set, c_null_ptr)
      !$omp end parallel
   end subroutine set_mask

   function set_of(marked) result(set)
      logical, intent(in) :: marked(n_known)
      integer(c_long) :: set(set_words)
      integer(c_int) :: status
      integer :: k

      set = 0
      status = c_sigemptyset(set)
      do k = 1, n_known
         if (marked(k)) status = c_sigaddset(set, numbers(k))
      end do
   end function set_of

end module stop_signals
