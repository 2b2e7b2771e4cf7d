!> Tables of quantities over time, read with continuous first and second derivatives.
module smooth_tables
   use kinds, only: dp
   implicit none
   private

   public :: smooth_table_t, new_smooth_table

   !> Cubic splines through the entries of each column.
   type :: smooth_table_t
      private
      real(dp), allocatable :: time(:)        ! (n) [s]
      real(dp), allocatable :: values(:, :)   ! (n, m)
      real(dp), allocatable :: second(:, :)   ! (n, m) second derivatives in time, linear in between
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
      table%second = second_derivatives(time, values)
   end function new_smooth_table

   !> Values and their derivatives; before and after the table the end values at rest.
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

   !> The largest magnitude of each first derivative at any time.
   pure function largest_slope(self) result(slopes)
      class(smooth_table_t), intent(in) :: self
      real(dp) :: slopes(size(self%values, 2)), extreme(size(self%values, 2)), before, after
      integer :: k, j

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

   !> The largest magnitude of each second derivative at any time.
   pure function largest_curvature(self) result(curvatures)
      class(smooth_table_t), intent(in) :: self
      real(dp) :: curvatures(size(self%values, 2))

      curvatures = maxval(abs(self%second), dim=1)
   end function largest_curvature

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

   ! Equal slopes from both sides of each knot, 0 at the ends: tridiagonal and diagonally dominant.
   pure function second_derivatives(time, values) result(second)
      real(dp), intent(in) :: time(:), values(:, :)
      real(dp) :: second(size(time), size(values, 2))
      real(dp) :: chord(0:size(time), size(values, 2)), h(0:size(time)), pivot(size(time))
      integer :: k, n

      n = size(time)
      second = 0
      if (n < 2) return
      h = 0
      chord = 0
      do k = 1, n - 1
         h(k) = time(k+1) - time(k)
         chord(k, :) = (values(k+1, :) - values(k, :))/h(k)
      end do
      pivot(1) = h(1)/3
      second(1, :) = chord(1, :)
      do k = 2, n
         pivot(k) = (h(k-1) + h(k))/3 - (h(k-1)/6)**2/pivot(k-1)
         second(k, :) = chord(k, :) - chord(k-1, :) - second(k-1, :)*(h(k-1)/6)/pivot(k-1)
      end do
      second(n, :) = second(n, :)/pivot(n)
      do k = n - 1, 1, -1
         second(k, :) = (second(k, :) - second(k+1, :)*h(k)/6)/pivot(k)
      end do
   end function second_derivatives

end module smooth_tables
