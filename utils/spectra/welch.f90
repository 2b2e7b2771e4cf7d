!> Power spectral density by Welch's method (IEEE Trans. Audio Electroacoust. 15 (1967), 70-73).
!!
!! The signal is cut into segments that overlap. Of each its trend is removed, it is multiplied by the window w and
!! transformed; squares of the transforms are averaged:
!! S_k = c_k abs(X_k)**2/(rate sum_j w_j**2), c_k = 2, but 1 at zero and at the Nyquist frequency.
!! So sum_k S_k df is the mean square of the windowed segment over that of the window.
module welch
   use fitting, only: line_fit
   use fourier, only: transform_line
   use kinds, only: dp
   implicit none
   private

   public :: spectrum_t, welch_spectrum, count_segments

   !> One-sided power spectral density.
   type :: spectrum_t
      real(dp) :: spacing = 0                  !! of the frequencies, df = rate/length
      real(dp), allocatable :: frequency(:)    !! (length/2 + 1) from 0
      real(dp), allocatable :: density(:)      !! (length/2 + 1) unit of the signal squared over unit of frequency
      integer :: segments = 0
      real(dp) :: freedom = 0                  !! degrees of freedom of each value, of noise
   contains
      procedure :: power_above
      procedure :: peak
   end type spectrum_t

contains

   !> Segments that fit.
   pure integer function count_segments(samples, length, overlap)
      integer, intent(in) :: samples, length
      real(dp), intent(in) :: overlap

      count_segments = 0
      if (samples >= length) count_segments = (samples - length)/shift(length, overlap) + 1
   end function count_segments

   !> From the start of a segment to that of the next.
   pure integer function shift(length, overlap)
      integer, intent(in) :: length
      real(dp), intent(in) :: overlap

      shift = max(1, floor(length*(1 - overlap) + 1.0e-6_dp))   ! round-off apart
   end function shift

   !> The spectrum of a signal with even steps; samples behind the last whole segment are left out.
   type(spectrum_t) function welch_spectrum(values, rate, overlap, window, straight) result(spectrum)
      real(dp), intent(in) :: values(:)      !! (samples)
      real(dp), intent(in) :: rate           !! samples per unit of time
      real(dp), intent(in) :: overlap        !! share of a segment that the next one has too, 0 <= overlap < 1
      real(dp), intent(in) :: window(:)      !! (length) length <= samples
      logical, intent(in) :: straight        !! the trend is a straight line; else the mean
      complex(dp) :: transform(size(window)/2 + 1)
      real(dp) :: segment(size(window))
      integer :: first, k, length

      length = size(window)
      spectrum%spacing = rate/length
      allocate (spectrum%frequency(length/2 + 1), spectrum%density(length/2 + 1))
      do k = 0, length/2
         spectrum%frequency(k + 1) = k*spectrum%spacing
      end do
      spectrum%density = 0
      spectrum%segments = count_segments(size(values), length, overlap)
      do k = 1, spectrum%segments
         first = 1 + (k - 1)*shift(length, overlap)
         segment = window*without_trend(values(first:first + length - 1), straight)
         transform = transform_line(segment)
         spectrum%density = spectrum%density + real(transform)**2 + aimag(transform)**2
      end do
      spectrum%density = spectrum%density/(spectrum%segments*rate*sum(window**2))
      ! The other half of the transform has the same power. Zero, and Nyquist if length is even, are there once.
      spectrum%density(2:(length + 1)/2) = 2*spectrum%density(2:(length + 1)/2)
      spectrum%freedom = freedom_of(window, shift(length, overlap), spectrum%segments)
   end function welch_spectrum

   pure function without_trend(values, straight) result(rest)
      real(dp), intent(in) :: values(:)
      logical, intent(in) :: straight
      real(dp) :: rest(size(values)), place(size(values)), offset, slope
      logical :: found
      integer :: i

      if (straight) then
         place = [(real(i, dp), i=1, size(values))]
         call line_fit(place, values, offset, slope, found)
         rest = values - (offset + slope*place)
      else
         rest = values - sum(values)/size(values)
      end if
   end function without_trend

   !> Degrees of freedom of the mean of K segments: 2 K/(1 + 2 sum_m (1 - m/K) rho_m), where
   !! rho_m = (sum_j w_j w_(j + m shift)/sum_j w_j**2)**2 is how much segments m apart have in common (Welch).
   pure real(dp) function freedom_of(window, shift, segments) result(freedom)
      real(dp), intent(in) :: window(:)
      integer, intent(in) :: shift, segments
      integer :: m
      real(dp) :: common, rho

      common = 1
      do m = 1, segments - 1
         if (m*shift >= size(window)) exit
         rho = (sum(window(1 + m*shift:)*window(:size(window) - m*shift))/sum(window**2))**2
         common = common + 2*(1 - real(m, dp)/segments)*rho
      end do
      freedom = 2*segments/common
   end function freedom_of

   !> Power above a frequency: each value stands for df about its frequency.
   pure real(dp) function power_above(self, frequency) result(power)
      class(spectrum_t), intent(in) :: self
      real(dp), intent(in) :: frequency        !! 0 or less: all

      power = sum(self%density*min(1.0_dp, max(0.0_dp, (self%frequency - frequency)/self%spacing + 0.5_dp)))*self%spacing
      if (.not. frequency > 0) power = sum(self%density)*self%spacing
   end function power_above

   !> Frequency of the highest maximum inside the spectrum: of the parabola through the logarithms of three values.
   !! 0 if there is none. A maximum at the first frequency above zero is none: it is due to the trend removed.
   pure real(dp) function peak(self)
      class(spectrum_t), intent(in) :: self
      real(dp) :: highest, log_of(3)
      integer :: k

      peak = 0
      highest = 0
      do k = 3, size(self%density) - 1
         associate (s => self%density(k - 1:k + 1))
            if (.not. (s(2) > highest .and. s(2) > s(1) .and. s(2) >= s(3))) cycle
            highest = s(2)
            log_of = log(max(s, tiny(1.0_dp)))
            peak = self%frequency(k) + self%spacing*(log_of(1) - log_of(3))/(2*(log_of(1) - 2*log_of(2) + log_of(3)))
         end associate
      end do
   end function peak

end module welch
