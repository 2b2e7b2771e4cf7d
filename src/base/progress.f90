!> How far a run is, how fast, and how long it will still take.
module progress
   use kinds, only: dp, i8
   use run_log, only: log_t
   use timers, only: wall_seconds
   implicit none
   private

   public :: duration_text, progress_t

   real(dp), parameter :: sample_interval = 1.0_dp   !! between samples, and lines on a terminal [s]
   real(dp), parameter :: memory = 30.0_dp           !! over which rates are smoothed [s]
   real(dp), parameter :: plain_interval = 10.0_dp   !! between lines in a file, at least [s]
   real(dp), parameter :: plain_share = 0.05_dp      !! between lines in a file, at least

   !> Smoothed rates of a run towards its end, whichever of its limits ends it first.
   type :: progress_t
      private
      real(dp) :: start_time = 0.0_dp, end_time = 0.0_dp   !! of the simulation
      real(dp) :: start_wall = 0.0_dp, max_wall = huge(1.0_dp)   !! [s]
      integer :: start_step = 0, max_steps = huge(1)
      integer :: particles = 0
      real(dp) :: last_time = 0.0_dp, last_wall = 0.0_dp
      integer :: last_step = 0
      real(dp) :: weight = 0.0_dp       !! of all samples so far, towards 1
      real(dp) :: time_rate = 0.0_dp    !! weight * simulated time per second
      real(dp) :: step_rate = 0.0_dp    !! weight * steps per second
      real(dp) :: plain_wall = 0.0_dp, plain_done = 0.0_dp   !! at the last line in a file
   contains
      procedure :: start
      procedure :: limit
      procedure :: update
      procedure :: sample
      procedure :: share_done
      procedure :: seconds_left
      procedure :: text
   end type progress_t

contains

   !> Sets out.
   subroutine start(self, time, end_time, step, particles, wall)
      class(progress_t), intent(out) :: self
      real(dp), intent(in) :: time, end_time    !! of the simulation, here and at its end
      integer, intent(in) :: step               !! steps done before
      integer, intent(in) :: particles
      real(dp), intent(in), optional :: wall    !! clock [s]; for tests

      self%start_time = time
      self%end_time = end_time
      self%start_step = step
      self%particles = particles
      self%start_wall = wall_seconds()
      if (present(wall)) self%start_wall = wall
      self%last_time = time
      self%last_wall = self%start_wall
      self%last_step = step
      self%plain_wall = self%start_wall
   end subroutine start

   !> Names other limits that may end the run before its end time.
   subroutine limit(self, max_steps, max_wall)
      class(progress_t), intent(inout) :: self
      integer, intent(in) :: max_steps    !! steps of this run; 0: no limit
      real(dp), intent(in) :: max_wall    !! [s] since the start; 0: no limit

      if (max_steps > 0) self%max_steps = max_steps
      if (max_wall > 0.0_dp) self%max_wall = max_wall
   end subroutine limit

   !> Called at every step; shows a line about once a second on a terminal, and in a file
   !! every 5 % of the run but not within 10 s of the last.
   subroutine update(self, log, time, dt, step)
      class(progress_t), intent(inout) :: self
      type(log_t), intent(inout) :: log
      real(dp), intent(in) :: time, dt
      integer, intent(in) :: step
      real(dp) :: now

      now = wall_seconds()
      if (now - self%last_wall < sample_interval) return
      call self%sample(time, step, now)
      call log%transient(self%text(time, dt))
      if (now - self%plain_wall < plain_interval) return
      if (self%share_done() - self%plain_done < plain_share) return
      call log%note(self%text(time, dt))
      self%plain_wall = now
      self%plain_done = self%share_done()
   end subroutine update

   !> Takes the speed since the last sample into the smoothed rates.
   subroutine sample(self, time, step, wall)
      class(progress_t), intent(inout) :: self
      real(dp), intent(in) :: time, wall   !! simulated; clock [s]
      integer, intent(in) :: step
      real(dp) :: elapsed, keep

      elapsed = wall - self%last_wall
      if (elapsed <= 0.0_dp) return
      keep = exp(-elapsed/memory)
      self%weight = keep*self%weight + (1.0_dp - keep)
      self%time_rate = keep*self%time_rate + (1.0_dp - keep)*(time - self%last_time)/elapsed
      self%step_rate = keep*self%step_rate + (1.0_dp - keep)*(step - self%last_step)/elapsed
      self%last_time = time
      self%last_step = step
      self%last_wall = wall
   end subroutine sample

   !> Share of the run that was done at the last sample, 0 to 1, towards the limit that is nearest.
   pure real(dp) function share_done(self)
      class(progress_t), intent(in) :: self

      share_done = (self%last_time - self%start_time)/max(self%end_time - self%start_time, tiny(1.0_dp))
      share_done = max(share_done, real(self%last_step - self%start_step, dp)/max(1, self%max_steps))
      share_done = max(share_done, (self%last_wall - self%start_wall)/self%max_wall)
      share_done = min(1.0_dp, max(0.0_dp, share_done))
   end function share_done

   !> Wall time left at the smoothed speed [s]; huge before the first sample.
   pure real(dp) function seconds_left(self)
      class(progress_t), intent(in) :: self

      seconds_left = self%max_wall - (self%last_wall - self%start_wall)
      if (self%time_rate > 0.0_dp) &
         seconds_left = min(seconds_left, self%weight*(self%end_time - self%last_time)/self%time_rate)
      if (self%step_rate > 0.0_dp) seconds_left = min(seconds_left, &
         self%weight*(real(self%max_steps, dp) - real(self%last_step - self%start_step, dp))/self%step_rate)
      seconds_left = max(0.0_dp, seconds_left)
   end function seconds_left

   !> The progress line, 80 columns at most.
   function text(self, time, dt)
      class(progress_t), intent(in) :: self
      real(dp), intent(in) :: time, dt
      character(:), allocatable :: text
      character(120) :: line
      real(dp) :: steps_per_second

      steps_per_second = self%step_rate/max(self%weight, tiny(1.0_dp))
      write (line, '(f5.1, 2a, a, es7.1e2, 5a)') 100.0_dp*self%share_done(), '%  t ', trim(time_text(time)), '  dt ', dt, '  ', &
         scaled_text(steps_per_second), ' steps/s  ', scaled_text(steps_per_second*self%particles), ' particle-steps/s'
      text = trim(line)//'  '//duration_text(self%seconds_left())//' left'
   end function text

   !> A simulated time with three decimals, or as a power of ten where that says nothing.
   pure function time_text(time) result(text)
      real(dp), intent(in) :: time
      character(12) :: text

      if (abs(time) < 1.0e5_dp .and. (abs(time) >= 0.1_dp .or. abs(time) < tiny(time))) then
         write (text, '(f12.3)') time
      else
         write (text, '(es10.3e2)') time
      end if
      text = adjustl(text)
   end function time_text

   !> A rate with three digits and k, M or G.
   pure function scaled_text(rate) result(text)
      real(dp), intent(in) :: rate
      character(:), allocatable :: text
      character(4), parameter :: suffixes = ' kMG'
      character(16) :: number
      real(dp) :: scaled
      integer :: i

      scaled = rate
      do i = 1, len(suffixes) - 1
         if (scaled < 999.5_dp) exit
         scaled = scaled/1000.0_dp
      end do
      if (scaled < 9.995_dp) then
         write (number, '(f4.2)') scaled
      else if (scaled < 99.95_dp) then
         write (number, '(f4.1)') scaled
      else
         write (number, '(i0)') nint(min(scaled, 1.0e8_dp))
      end if
      text = trim(adjustl(number))//trim(suffixes(i:i))
   end function scaled_text

   !> A duration as m:ss or h:mm:ss; '-:--' when it is not known.
   pure function duration_text(seconds) result(text)
      real(dp), intent(in) :: seconds
      character(:), allocatable :: text
      character(24) :: buffer
      integer(i8) :: whole

      if (.not. (seconds >= 0.0_dp .and. seconds < 1.0e10_dp)) then
         text = '-:--'
         return
      end if
      whole = nint(seconds, i8)
      if (whole < 3600) then
         write (buffer, '(i0, ":", i2.2)') whole/60, mod(whole, 60_i8)
      else
         write (buffer, '(i0, ":", i2.2, ":", i2.2)') whole/3600, mod(whole/60, 60_i8), mod(whole, 60_i8)
      end if
      text = trim(buffer)
   end function duration_text

end module progress
