!> How often something is done: every n steps, every T in time, every T of the clock on the wall, or never.
!!
!! Whether an output is due follows from the counts of steps and of time alone,
!! not from when the last one was written: nothing accumulates, and a restarted
!! run writes what the unbroken one would have written.
module cadence
   use kinds, only: dp
   use text, only: lower_case, parse_integer, parse_real, quoted, to_text
   implicit none
   private

   public :: cadence_t

   integer, parameter :: kind_never = 0, kind_steps = 1, kind_time = 2, kind_clock = 3
   character(*), parameter :: wanted = "write '10 steps', '0.05 time' or 'never'"
   character(*), parameter :: wanted_or_clock = "write '10 minutes' (seconds, hours), '10 steps', '0.05 time' or 'never'"

   !> When a repeated action is due.
   type :: cadence_t
      private
      integer :: kind_of = kind_never
      integer :: step_interval = 1          ! steps
      real(dp) :: time_interval = 1.0_dp    ! of the flow, or of the clock [s]
   contains
      procedure :: parse
      procedure :: is_due
      procedure :: is_due_by_clock
      procedure :: is_never
      procedure :: interval
      procedure :: number => number_of_times
      procedure, private :: whole_intervals
   end type cadence_t

contains

   !> Reads '10 steps', '0.05 time' or 'never'; where the clock may rule too, '10 minutes'.
   subroutine parse(self, phrase, message, by_clock)
      class(cadence_t), intent(out) :: self
      character(*), intent(in) :: phrase
      character(:), allocatable, intent(out) :: message   !! '' when understood, else why not
      logical, intent(in), optional :: by_clock
      character(:), allocatable :: number, word, hint
      logical :: clock

      clock = .false.
      if (present(by_clock)) clock = by_clock
      hint = wanted
      if (clock) hint = wanted_or_clock
      call split_phrase(phrase, number, word)
      message = ''
      if (word == 'never' .and. number == '') return
      select case (word)
      case ('step', 'steps')
         call read_steps(number, self, message)
      case ('time')
         call read_time(number, 'time', 1.0_dp, kind_time, self, message)
      case ('second', 'seconds', 'minute', 'minutes', 'hour', 'hours')
         if (clock) call read_time(number, word, seconds_in(word), kind_clock, self, message)
         if (.not. clock) message = quoted(phrase)//' is not a cadence'
      case default
         message = quoted(phrase)//' is not a cadence'
      end select
      if (message /= '') message = message//'; '//hint
   end subroutine parse

   pure real(dp) function seconds_in(word) result(seconds)
      character(*), intent(in) :: word

      seconds = 1
      if (index(word, 'minute') == 1) seconds = 60
      if (index(word, 'hour') == 1) seconds = 3600
   end function seconds_in

   !> Parts '10 steps' into '10' and 'steps', 'never' into '' and 'never'.
   pure subroutine split_phrase(phrase, number, word)
      character(*), intent(in) :: phrase
      character(:), allocatable, intent(out) :: number, word

      character(:), allocatable :: rest
      integer :: gap

      rest = trim(adjustl(lower_case(phrase)))
      gap = index(rest, ' ')
      if (gap == 0) then
         number = ''
         word = rest
      else
         number = rest(:gap - 1)
         word = trim(adjustl(rest(gap:)))
      end if
   end subroutine split_phrase

   !> Takes the number of steps between two outputs.
   pure subroutine read_steps(number, self, message)
      character(*), intent(in) :: number
      type(cadence_t), intent(inout) :: self
      character(:), allocatable, intent(out) :: message

      integer :: steps

      call parse_integer(number, steps, message)
      if (message == '' .and. steps < 1) message = to_text(steps)//' steps is less than one'
      if (message /= '') return
      self%kind_of = kind_steps
      self%step_interval = steps
   end subroutine read_steps

   !> Takes the time between two outputs.
   pure subroutine read_time(number, word, unit, kind_of, self, message)
      character(*), intent(in) :: number, word
      real(dp), intent(in) :: unit       !! what the word means
      integer, intent(in) :: kind_of
      type(cadence_t), intent(inout) :: self
      character(:), allocatable, intent(out) :: message

      real(dp) :: interval

      call parse_real(number, interval, message)
      if (message == '' .and. interval <= 0.0_dp) message = to_text(interval)//' '//word//' is not above 0'
      if (message /= '') return
      self%kind_of = kind_of
      self%time_interval = interval*unit
   end subroutine read_time

   !> Whether the action is due at the state (step, time), reached from the state at time_before.
   !! The first one is due at step 0, time 0.
   pure logical function is_due(self, step, time, time_before)
      class(cadence_t), intent(in) :: self
      integer, intent(in) :: step               !! steps done since time 0
      real(dp), intent(in) :: time              !! time of the state [s]
      real(dp), intent(in) :: time_before       !! time one step earlier; ignored at step 0 [s]

      select case (self%kind_of)
      case (kind_steps)
         is_due = mod(step, self%step_interval) == 0
      case (kind_time)
         is_due = step == 0
         if (step > 0) is_due = self%whole_intervals(time) > self%whole_intervals(time_before)
      case default
         is_due = .false.
      end select
   end function is_due

   !> Whether the action is due so long after the last one.
   pure logical function is_due_by_clock(self, seconds)
      class(cadence_t), intent(in) :: self
      real(dp), intent(in) :: seconds   !! of the clock on the wall

      is_due_by_clock = self%kind_of == kind_clock .and. seconds >= self%time_interval
   end function is_due_by_clock

   !> Number of whole intervals that have passed at a time: k once k T is reached.
   !! The guess time/T is put right against k*T itself, because the rounded
   !! quotient of a time that is exactly k*T may lie just below k. A real holds
   !! the number: an interval far below the time step must not overflow.
   pure real(dp) function whole_intervals(self, time)
      class(cadence_t), intent(in) :: self
      real(dp), intent(in) :: time   !! [s]

      whole_intervals = aint(time/self%time_interval)
      if ((whole_intervals + 1.0_dp)*self%time_interval <= time) whole_intervals = whole_intervals + 1.0_dp
      if (whole_intervals*self%time_interval > time) whole_intervals = whole_intervals - 1.0_dp
   end function whole_intervals

   !> True when the action is never due.
   elemental logical function is_never(self)
      class(cadence_t), intent(in) :: self

      is_never = self%kind_of == kind_never
   end function is_never

   !> The interval in time, endless where it is not one in time [s].
   pure real(dp) function interval(self)
      class(cadence_t), intent(in) :: self

      interval = huge(1.0_dp)
      if (self%kind_of == kind_time) interval = self%time_interval
   end function interval

   !> How often a run of so many steps to a time does it, its start and end included.
   pure real(dp) function number_of_times(self, steps, end_time) result(number)
      class(cadence_t), intent(in) :: self
      real(dp), intent(in) :: steps, end_time

      number = 0
      if (self%kind_of == kind_steps) number = 1 + steps/self%step_interval
      if (self%kind_of == kind_time) number = 1 + min(steps, end_time/self%time_interval)
   end function number_of_times

end module cadence
