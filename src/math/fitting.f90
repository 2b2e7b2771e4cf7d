!> Numbers out of sampled curves: crossings, maxima, straight lines, damped oscillations.
!!
!! Each procedure says by `found` whether the samples held what was asked for.
module fitting
   use kinds, only: dp
   implicit none
   private

   public :: line_fit, zero_crossings, first_maximum, unwrapped, oscillation_t, fit_oscillation, fit_approach, solve

   !> y = exp(-decay t) (cosine cos(frequency t) + sine sin(frequency t)).
   type :: oscillation_t
      real(dp) :: cosine = 0, sine = 0
      real(dp) :: frequency = 0
      real(dp) :: decay = 0
   contains
      procedure :: amplitude
   end type oscillation_t

contains

   !> Largest value at t = 0 that the phase allows.
   pure real(dp) function amplitude(self)
      class(oscillation_t), intent(in) :: self

      amplitude = hypot(self%cosine, self%sine)
   end function amplitude

   !> y = offset + slope t with the least sum of squares.
   pure subroutine line_fit(t, y, offset, slope, found)
      real(dp), intent(in) :: t(:), y(:)   !! (samples)
      real(dp), intent(out) :: offset, slope
      logical, intent(out) :: found        !! there are two different times
      real(dp) :: centre, spread

      offset = 0
      slope = 0
      found = size(t) >= 2
      if (.not. found) return
      centre = sum(t)/size(t)
      spread = sum((t - centre)**2)
      found = spread > 0
      if (.not. found) return
      slope = sum((t - centre)*y)/spread
      offset = sum(y)/size(y) - slope*centre
   end subroutine line_fit

   !> Times at which y changes its sign, by straight lines between the samples; a zero at the first sample is none.
   pure function zero_crossings(t, y) result(times)
      real(dp), intent(in) :: t(:), y(:)   !! (samples), t rising
      real(dp), allocatable :: times(:)
      integer :: i

      allocate (times(0))
      do i = 2, size(t)
         if (y(i - 1)*y(i) < 0 .or. (.not. abs(y(i)) > 0 .and. abs(y(i - 1)) > 0)) &
            times = [times, t(i - 1) + (t(i) - t(i - 1))*y(i - 1)/(y(i - 1) - y(i))]
      end do
   end function zero_crossings

   !> The first sample that is larger than all before and both next to it, refined by a parabola through the three.
   pure subroutine first_maximum(t, y, time, value, found)
      real(dp), intent(in) :: t(:), y(:)   !! (samples), t rising
      real(dp), intent(out) :: time, value
      logical, intent(out) :: found
      real(dp) :: left, right, curvature, slope
      integer :: i

      time = 0
      value = 0
      found = .false.
      do i = 2, size(t) - 1
         found = y(i) >= y(i - 1) .and. y(i) > y(i + 1)
         if (.not. found) cycle
         ! Newton's divided differences
         left = (y(i) - y(i - 1))/(t(i) - t(i - 1))
         right = (y(i + 1) - y(i))/(t(i + 1) - t(i))
         curvature = (right - left)/(t(i + 1) - t(i - 1))
         slope = left + curvature*(t(i) - t(i - 1))
         time = t(i) - slope/(2*curvature)
         value = y(i) - slope**2/(4*curvature)
         return
      end do
   end subroutine first_maximum

   !> Angles without jumps of 2 pi.
   pure function unwrapped(angles) result(smooth)
      real(dp), intent(in) :: angles(:)
      real(dp) :: smooth(size(angles))
      real(dp), parameter :: turn = 2*acos(-1.0_dp)
      integer :: i

      smooth = angles
      do i = 2, size(angles)
         smooth(i) = angles(i) - turn*nint((angles(i) - smooth(i - 1))/turn)
      end do
   end function unwrapped

   !> The damped oscillation nearest to the samples.
   !!
   !! For given frequency and decay the best cosine and sine are a linear problem. All four are then improved by
   !! Gauss and Newton's method, each step halved until it lowers the sum of squares.
   pure subroutine fit_oscillation(t, y, guess, fit, found)
      real(dp), intent(in) :: t(:), y(:)         !! (samples)
      real(dp), intent(in) :: guess              !! frequency, right to within a quarter turn over the samples
      type(oscillation_t), intent(out) :: fit
      logical, intent(out) :: found              !! converged, over at least a period
      integer, parameter :: most_steps = 60, most_halvings = 20
      real(dp), parameter :: converged = 1.0e-12_dp
      real(dp) :: old(4), change(4), before
      integer :: k, n

      found = .false.
      if (size(t) < 8) return
      if ((maxval(t) - minval(t))*guess < 2*acos(-1.0_dp)) return
      fit%frequency = guess
      call best_linear(t, y, fit)
      do k = 1, most_steps
         old = [fit%cosine, fit%sine, fit%frequency, fit%decay]
         before = squares(t, y, fit)
         call newton_step(t, y, fit, change, found)
         if (.not. found) return
         do n = 0, most_halvings
            call set(fit, old + change/2**n)
            if (squares(t, y, fit) <= before) exit
         end do
         found = maxval(abs(change(3:4))) < converged*guess .or. n > most_halvings
         if (found) exit
      end do
      found = found .and. fit%frequency > 0
   end subroutine fit_oscillation

   pure subroutine set(fit, values)
      type(oscillation_t), intent(inout) :: fit
      real(dp), intent(in) :: values(4)

      fit%cosine = values(1)
      fit%sine = values(2)
      fit%frequency = values(3)
      fit%decay = values(4)
   end subroutine set

   pure real(dp) function squares(t, y, fit)
      real(dp), intent(in) :: t(:), y(:)
      type(oscillation_t), intent(in) :: fit

      squares = sum((y - exp(-fit%decay*t)*(fit%cosine*cos(fit%frequency*t) + fit%sine*sin(fit%frequency*t)))**2)
   end function squares

   ! Cosine and sine for the frequency and decay that `fit` has.
   pure subroutine best_linear(t, y, fit)
      real(dp), intent(in) :: t(:), y(:)
      type(oscillation_t), intent(inout) :: fit
      real(dp) :: c(size(t)), s(size(t)), determinant

      c = exp(-fit%decay*t)*cos(fit%frequency*t)
      s = exp(-fit%decay*t)*sin(fit%frequency*t)
      determinant = sum(c*c)*sum(s*s) - sum(c*s)**2
      if (.not. abs(determinant) > 0) return
      fit%cosine = (sum(y*c)*sum(s*s) - sum(y*s)*sum(c*s))/determinant
      fit%sine = (sum(y*s)*sum(c*c) - sum(y*c)*sum(c*s))/determinant
   end subroutine best_linear

   ! Change of (cosine, sine, frequency, decay) that the linearised problem asks for.
   pure subroutine newton_step(t, y, fit, change, found)
      real(dp), intent(in) :: t(:), y(:)
      type(oscillation_t), intent(in) :: fit
      real(dp), intent(out) :: change(4)
      logical, intent(out) :: found
      real(dp) :: by(size(t), 4), c(size(t)), s(size(t)), value(size(t)), matrix(4, 4), right(4)

      c = exp(-fit%decay*t)*cos(fit%frequency*t)
      s = exp(-fit%decay*t)*sin(fit%frequency*t)
      value = fit%cosine*c + fit%sine*s
      by(:, 1) = c
      by(:, 2) = s
      by(:, 3) = t*(fit%sine*c - fit%cosine*s)
      by(:, 4) = -t*value
      matrix = matmul(transpose(by), by)
      right = matmul(transpose(by), y - value)
      call solve(matrix, right, found)
      change = right
   end subroutine newton_step

   !> The rate of y = limit (1 - exp(-rate t)) nearest to the samples, limit = source/rate if `source` is given.
   !!
   !! One unknown: Gauss and Newton's method on the rate.
   pure subroutine fit_approach(t, y, guess, rate, found, limit, source)
      real(dp), intent(in) :: t(:), y(:)         !! (samples)
      real(dp), intent(in) :: guess              !! of the rate, > 0
      real(dp), intent(out) :: rate
      logical, intent(out) :: found              !! converged to a rate > 0
      real(dp), intent(in), optional :: limit    !! known value at late times; or
      real(dp), intent(in), optional :: source   !! known slope at t = 0
      integer, parameter :: most_steps = 60
      real(dp), parameter :: converged = 1.0e-12_dp
      real(dp) :: curve(size(t)), by_rate(size(t)), change, steepness
      integer :: k

      rate = guess
      found = .false.
      do k = 1, most_steps
         if (present(limit)) then
            curve = limit*(1 - exp(-rate*t))
            by_rate = limit*t*exp(-rate*t)
         else
            curve = source/rate*(1 - exp(-rate*t))
            by_rate = source*t*exp(-rate*t)/rate - curve/rate
         end if
         steepness = sum(by_rate**2)
         if (.not. steepness > 0) return
         change = sum(by_rate*(y - curve))/steepness
         rate = max(rate + change, rate/2)
         found = abs(change) < converged*guess
         if (found) exit
      end do
   end subroutine fit_approach

   !> Gauss elimination with pivots of the rows; `right` becomes the solution, if the matrix is regular.
   pure subroutine solve(matrix, right, regular)
      real(dp), intent(inout) :: matrix(:, :), right(:)
      logical, intent(out) :: regular
      real(dp) :: row(size(right)), factor, swap
      integer :: i, j, pivot, n

      n = size(right)
      regular = .false.
      do i = 1, n
         pivot = i - 1 + maxloc(abs(matrix(i:, i)), 1)
         if (.not. abs(matrix(pivot, i)) > tiny(1.0_dp)) return
         row = matrix(i, :)
         matrix(i, :) = matrix(pivot, :)
         matrix(pivot, :) = row
         swap = right(i)
         right(i) = right(pivot)
         right(pivot) = swap
         do j = i + 1, n
            factor = matrix(j, i)/matrix(i, i)
            matrix(j, i:) = matrix(j, i:) - factor*matrix(i, i:)
            right(j) = right(j) - factor*right(i)
         end do
      end do
      do i = n, 1, -1
         right(i) = (right(i) - dot_product(matrix(i, i + 1:), right(i + 1:)))/matrix(i, i)
      end do
      regular = .true.
   end subroutine solve

end module fitting
