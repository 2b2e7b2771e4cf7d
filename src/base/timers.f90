!> Wall-clock time by phase of the run.
module timers
   use kinds, only: dp, i8
   implicit none
   private

   public :: timers_t, wall_seconds

   !> One stop watch for each phase; phases are the caller's integer constants 1, 2, ...
   !!
   !! To be used outside of parallel regions. Two calls of the system clock make one
   !! interval, about 50 ns.
   type :: timers_t
      private
      character(:), allocatable :: names(:)
      integer(i8), allocatable :: ticks(:), started(:), calls(:)
   contains
      procedure :: initialise
      procedure :: start
      procedure :: stop => stop_phase
      procedure :: seconds
      procedure :: count => count_phase
      procedure :: table
   end type timers_t

contains

   !> Sets all watches to zero.
   subroutine initialise(self, names)
      class(timers_t), intent(inout) :: self
      character(*), intent(in) :: names(:)   !! (number of phases) for the table

      self%names = names
      if (allocated(self%ticks)) deallocate (self%ticks, self%started, self%calls)
      allocate (self%ticks(size(names)), self%started(size(names)), self%calls(size(names)), source=0_i8)
   end subroutine initialise

   subroutine start(self, phase)
      class(timers_t), intent(inout) :: self
      integer, intent(in) :: phase

      call system_clock(self%started(phase))
   end subroutine start

   !> Adds the time since `start` of the same phase.
   subroutine stop_phase(self, phase)
      class(timers_t), intent(inout) :: self
      integer, intent(in) :: phase
      integer(i8) :: now

      call system_clock(now)
      self%ticks(phase) = self%ticks(phase) + (now - self%started(phase))
      self%calls(phase) = self%calls(phase) + 1
   end subroutine stop_phase

   !> Wall time spent in a phase [s].
   real(dp) function seconds(self, phase)
      class(timers_t), intent(in) :: self
      integer, intent(in) :: phase
      integer(i8) :: rate

      call system_clock(count_rate=rate)
      seconds = real(self%ticks(phase), dp)/real(rate, dp)
   end function seconds

   !> How often a phase was stopped.
   pure integer(i8) function count_phase(self, phase)
      class(timers_t), intent(in) :: self
      integer, intent(in) :: phase

      count_phase = self%calls(phase)
   end function count_phase

   !> Lines `name  seconds  share` for the phases that ran, and what no watch saw.
   function table(self, total) result(lines)
      class(timers_t), intent(in) :: self
      real(dp), intent(in) :: total             !! wall time of the run [s]
      character(80), allocatable :: lines(:)
      real(dp) :: seen
      integer :: phase

      allocate (lines(0))
      seen = 0.0_dp
      do phase = 1, size(self%calls)
         if (self%calls(phase) == 0) cycle
         seen = seen + self%seconds(phase)
         lines = [lines, table_line(self%names(phase), self%seconds(phase), total)]
      end do
      lines = [lines, table_line('other', max(0.0_dp, total - seen), total)]
   end function table

   pure function table_line(name, seconds, total) result(line)
      character(*), intent(in) :: name
      real(dp), intent(in) :: seconds, total   !! [s]
      character(80) :: line
      character(32) :: column

      column = name
      write (line, '(a, f12.2, a, f7.1, a)') column, seconds, ' s', 100.0_dp*seconds/max(total, tiny(total)), ' %'
   end function table_line

   !> Wall-clock time from an arbitrary origin [s].
   real(dp) function wall_seconds()
      integer(i8) :: now, rate

      call system_clock(now, rate)
      wall_seconds = real(now, dp)/real(rate, dp)
   end function wall_seconds

end module timers
