!> Tables of quantities over time, read with continuous first and second derivatives.
module smooth_tables
   use kinds, only: dp
   implicit none
   private

   public :: smooth_table_t, new_smooth_table, new_acceleration_table

   integer, parameter :: parts = 16   ! of an interval, in which a largest slope is looked for

   !> Cubic splines through the entries of each column. Of accelerations they are the second derivatives of what is looked up.
   type :: smooth_table_t
      private
      real(dp), allocatable :: time(:)        ! (n) [s]
      real(dp), allocatable :: values(:, :)   ! (n, m)
      real(dp), allocatable :: second(:, :)   ! (n, m) second derivatives in time, linear in between
      real(dp), allocatable :: speeds(:, :)   ! (n, m) of accelerations: their integrals, 0 at first,
      real(dp), allocatable :: places(:, :)   ! (n, m) and the integrals of these
   contains
      procedure :: look_up
      procedure :: largest_slope
      procedure :: largest_curvature
   end type smooth_table_t

contains

   !> Splines with slope 0 at both ends, so that what is tabulated may rest before and after.
   pure type(smooth_table_t) function new_smooth_table(time, values) result(table)
      real(dp), intent(in) :: time(:)        !! (n) strictly increasing, n > 0 [s]
      real(dp), intent(in) :: values(:, :)   !! (n, m)

      allocate (table%time(size(time)), table%values(size(time), size(values, 2)))
      table%time = time
      table%values = values
      allocate (table%second(size(time), size(values, 2)))
      table%second = second_derivatives(time, values, 1, size(time))
   end function new_smooth_table

   !> Splines of accelerations without curvature at both ends, integrated twice exactly, from 0 and rest at the first time.
   pure type(smooth_table_t) function new_acceleration_table(time, accelerations) result(table)
      real(dp), intent(in) :: time(:)               !! (n) strictly increasing, n > 0 [s]
      real(dp), intent(in) :: accelerations(:, :)   !! (n, m) [1/s2]
      real(dp) :: place(size(accelerations, 2)), speed(size(accelerations, 2))
      integer :: k, n

      n = size(time)
      allocate (table%time(n), table%values(n, size(accelerations, 2)), table%second(n, size(accelerations, 2)))
      table%time = time
      table%values = accelerations
      table%second = second_derivatives(time, accelerations, 2, n - 1)
      allocate (table%speeds(n, size(accelerations, 2)), table%places(n, size(accelerations, 2)), source=0.0_dp)
      do k = 1, n - 1
         call integrate(table, k, time(k+1) - time(k), place, speed)
         table%places(k+1, :) = place
         table%speeds(k+1, :) = speed
      end do
   end function new_acceleration_table

   !> Values and their derivatives; before and after the table the end values at rest. Of accelerations the last speed goes on.
   pure subroutine look_up(self, time, values, slopes, curvatures)
      class(smooth_table_t), intent(in) :: self
      real(dp), intent(in) :: time             !! [s]
      real(dp), intent(out) :: values(:)       !! (m)
      real(dp), intent(out) :: slopes(:)       !! (m) first derivatives [1/s]
      real(dp), intent(out) :: curvatures(:)   !! (m) second derivatives [1/s2]
      real(dp) :: h, a, b
      integer :: k, n

      n = size(self%time)
      slopes = 0
      curvatures = 0
      if (allocated(self%places)) then
         values = 0
         if (time < self%time(1)) return
         k = n
         if (time <= self%time(n) .and. n > 1) k = interval_of(self%time, time)
         call integrate(self, k, time - self%time(k), values, slopes, curvatures)
         return
      end if
      if (n == 1 .or. time < self%time(1)) then
         values = self%values(1, :)
         return
      else if (time > self%time(n)) then
         values = self%values(n, :)
         return
      end if
      k = interval_of(self%time, time)
      h = self%time(k+1) - self%time(k)
      a = (self%time(k+1) - time)/h
      b = (time - self%time(k))/h
      values = a*self%values(k, :) + b*self%values(k+1, :) &
         + ((a**3 - a)*self%second(k, :) + (b**3 - b)*self%second(k+1, :))*h**2/6
      slopes = slopes_within(self, k, b)
      curvatures = a*self%second(k, :) + b*self%second(k+1, :)
   end subroutine look_up

   !> The largest magnitude of each first derivative at any time; of accelerations a bound that is hardly more.
   pure function largest_slope(self) result(slopes)
      class(smooth_table_t), intent(in) :: self
      real(dp) :: slopes(size(self%values, 2)), extreme(size(self%values, 2)), before, after
      integer :: k, j

      if (allocated(self%places)) then
         slopes = largest_speed(self)
         return
      end if
      ! At the knots and where the curvature passes 0.
      slopes = 0
      do k = 1, size(self%time) - 1
         slopes = max(slopes, abs(slopes_within(self, k, 0.0_dp)), abs(slopes_within(self, k, 1.0_dp)))
         do j = 1, size(slopes)
            before = self%second(k, j)
            after = self%second(k+1, j)
            if (.not. (min(before, after) < 0 .and. max(before, after) > 0)) cycle
            extreme = slopes_within(self, k, before/(before - after))
            slopes(j) = max(slopes(j), abs(extreme(j)))
         end do
      end do
   end function largest_slope

   !> The largest magnitude of each second derivative at any time; of accelerations a bound that is hardly more.
   pure function largest_curvature(self) result(curvatures)
      class(smooth_table_t), intent(in) :: self
      real(dp) :: curvatures(size(self%values, 2))
      integer :: k

      if (.not. allocated(self%places)) then
         curvatures = maxval(abs(self%second), dim=1)
         return
      end if
      curvatures = abs(self%values(1, :))
      do k = 1, size(self%time) - 1
         curvatures = max(curvatures, largest_within(self, k))
      end do
   end function largest_curvature

   ! A bound of the accelerations in an interval: a spline is at most h**2/8 max |second| away from the straight line.
   pure function largest_within(self, k) result(most)
      class(smooth_table_t), intent(in) :: self
      integer, intent(in) :: k
      real(dp) :: most(size(self%values, 2))

      most = maxval(abs(self%values(k:k+1, :)), dim=1) &
             + maxval(abs(self%second(k:k+1, :)), dim=1)*(self%time(k+1) - self%time(k))**2/8
   end function largest_within

   ! A bound of the integrals of accelerations: between two of many times they change by less than the acceleration lets them.
   pure function largest_speed(self) result(speeds)
      class(smooth_table_t), intent(in) :: self
      real(dp) :: speeds(size(self%values, 2)), places(size(self%values, 2)), there(size(self%values, 2)), h
      integer :: k, part

      speeds = 0
      do k = 1, size(self%time) - 1
         h = self%time(k+1) - self%time(k)
         do part = 0, parts
            call integrate(self, k, h*part/parts, places, there)
            speeds = max(speeds, abs(there) + h/(2*parts)*largest_within(self, k))
         end do
      end do
   end function largest_speed

   ! The integrals of accelerations some time after a knot: of a cubic, behind the last knot of 0.
   pure subroutine integrate(self, k, t, places, speeds, accelerations)
      class(smooth_table_t), intent(in) :: self
      integer, intent(in) :: k
      real(dp), intent(in) :: t   ! since the knot [s]
      real(dp), intent(out) :: places(:), speeds(:)
      real(dp), intent(out), optional :: accelerations(:)
      real(dp) :: c(0:3, size(self%values, 2)), h

      c = 0
      if (k < size(self%time)) then
         h = self%time(k+1) - self%time(k)
         c(0, :) = self%values(k, :)
         c(1, :) = (self%values(k+1, :) - self%values(k, :))/h - (2*self%second(k, :) + self%second(k+1, :))*h/6
         c(2, :) = self%second(k, :)/2
         c(3, :) = (self%second(k+1, :) - self%second(k, :))/(6*h)
      end if
      places = self%places(k, :) + t*(self%speeds(k, :) + t*(c(0, :)/2 + t*(c(1, :)/6 + t*(c(2, :)/12 + t*c(3, :)/20))))
      speeds = self%speeds(k, :) + t*(c(0, :) + t*(c(1, :)/2 + t*(c(2, :)/3 + t*c(3, :)/4)))
      if (present(accelerations)) accelerations = c(0, :) + t*(c(1, :) + t*(c(2, :) + t*c(3, :)))
   end subroutine integrate

   ! First derivatives at a fraction of an interval.
   pure function slopes_within(self, k, fraction) result(slopes)
      class(smooth_table_t), intent(in) :: self
      integer, intent(in) :: k
      real(dp), intent(in) :: fraction
      real(dp) :: slopes(size(self%values, 2)), h

      h = self%time(k+1) - self%time(k)
      slopes = (self%values(k+1, :) - self%values(k, :))/h &
         + ((3*fraction**2 - 1)*self%second(k+1, :) - (3*(1 - fraction)**2 - 1)*self%second(k, :))*h/6
   end function slopes_within

   ! The interval, from its number to the next, that a time is in; the table has at least one.
   pure integer function interval_of(times, time) result(lower)
      real(dp), intent(in) :: times(:), time
      integer :: upper, middle

      lower = 1
      upper = size(times)
      do while (upper - lower > 1)
         middle = (lower + upper)/2
         if (times(middle) <= time) then
            lower = middle
         else
            upper = middle
         end if
      end do
   end function interval_of

   ! Equal slopes from both sides of the knots from `first` to `last`, 0 where these are the ends; second derivatives 0 at others.
   ! Tridiagonal and diagonally dominant.
   pure function second_derivatives(time, values, first, last) result(second)
      real(dp), intent(in) :: time(:), values(:, :)
      integer, intent(in) :: first, last
      real(dp) :: second(size(time), size(values, 2))
      real(dp) :: chord(0:size(time), size(values, 2)), h(0:size(time)), pivot(size(time))
      integer :: k, n

      n = size(time)
      second = 0
      if (n < 2 .or. last < first) return
      h = 0
      chord = 0
      do k = 1, n - 1
         h(k) = time(k+1) - time(k)
         chord(k, :) = (values(k+1, :) - values(k, :))/h(k)
      end do
      pivot(first) = (h(first-1) + h(first))/3
      second(first, :) = chord(first, :) - chord(first-1, :)
      do k = first + 1, last
         pivot(k) = (h(k-1) + h(k))/3 - (h(k-1)/6)**2/pivot(k-1)
         second(k, :) = chord(k, :) - chord(k-1, :) - second(k-1, :)*(h(k-1)/6)/pivot(k-1)
      end do
      second(last, :) = second(last, :)/pivot(last)
      do k = last - 1, first, -1
         second(k, :) = (second(k, :) - second(k+1, :)*h(k)/6)/pivot(k)
      end do
   end function second_derivatives

end module smooth_tables
