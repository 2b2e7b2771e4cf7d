!> Spectrum of a field on a regular grid against the magnitude of the wavenumber.
!!
!! With a window w and the field's weighted mean taken away, f' = f - sum(w f)/sum(w), each mode has the power
!! |sum w f' exp(-i k.r)|**2/(n**2 mean(w**2)), so that the sum over all modes is mean((w f')**2)/mean(w**2): Parseval.
!! Rings gather the modes up to the Nyquist wavenumber pi/dx. They are dk = 2 pi/min(Lx, Ly) wide, the distance of modes in the
!! shorter direction; below dk/2 there are only modes of the longer direction, and rings are as narrow as their distance. Beyond
!! pi/dx are the corners of the square, which no ring has and the sums do.
module plane_spectrum
   use fourier, only: transform_plane
   use kinds, only: dp
   use windows, only: window_values
   implicit none
   private

   public :: rings_t, new_rings, add_spectrum, power_above

   real(dp), parameter :: pi = acos(-1.0_dp)

   !> Power of one or more fields over rings of wavenumber.
   type :: rings_t
      real(dp) :: nyquist = 0                !! pi/dx [1/m]
      real(dp) :: total = 0                  !! of all modes, corners too
      real(dp), allocatable :: k(:)          !! (rings) middle
      real(dp), allocatable :: width(:)      !! (rings)
      real(dp) :: fine = 0, coarse = 0       !! distance of modes in the longer and the shorter direction
      integer :: n_fine = 0                  !! rings of width `fine`
      real(dp), allocatable :: power(:)      !! (rings) sum over a ring's modes
      real(dp), allocatable :: mode_k(:, :)      !! (nx/2 + 1, ny) of every mode of the half plane
      real(dp), allocatable :: mode_power(:, :)  !! the same, counting a mode's mirror image with it
   end type rings_t

contains

   !> Empty rings of a grid of n(1) x n(2) points.
   pure subroutine new_rings(n, spacing, rings)
      integer, intent(in) :: n(2)
      real(dp), intent(in) :: spacing
      type(rings_t), intent(out) :: rings
      integer :: i, j, m

      rings%fine = 2*pi/(maxval(n)*spacing)
      rings%coarse = 2*pi/(minval(n)*spacing)
      rings%nyquist = pi/spacing
      rings%n_fine = max(0, floor((rings%coarse/rings%fine - 1)/2 + 1.0e-9_dp))
      m = rings%n_fine + floor(rings%nyquist/rings%coarse + 1.0e-9_dp)
      allocate (rings%k(m), rings%width(m), rings%power(m), rings%mode_k(n(1)/2 + 1, n(2)), rings%mode_power(n(1)/2 + 1, n(2)))
      associate (f => rings%n_fine, edge => (rings%n_fine + 0.5_dp)*rings%fine)
         rings%k(:f) = rings%fine*[(i, i=1, f)]
         rings%width(:f) = rings%fine
         rings%k(f + 1:) = rings%coarse*[(i, i=1, m - f)]
         rings%width(f + 1:) = rings%coarse
         ! The first wide ring begins where the narrow ones end.
         rings%width(f + 1) = 1.5_dp*rings%coarse - edge
         rings%k(f + 1) = 1.5_dp*rings%coarse - rings%width(f + 1)/2
      end associate
      rings%power = 0
      rings%mode_power = 0
      do j = 1, n(2)
         do i = 1, n(1)/2 + 1
            rings%mode_k(i, j) = 2*pi/spacing*hypot((i - 1)/real(n(1), dp), (modulo(j - 1 + n(2)/2, n(2)) - n(2)/2)/real(n(2), dp))
         end do
      end do
   end subroutine new_rings

   !> Adds factor |f'|**2.
   subroutine add_spectrum(rings, field, window, factor)
      type(rings_t), intent(inout) :: rings
      real(dp), intent(in) :: field(:, :)      !! (nx, ny)
      character(*), intent(in) :: window       !! one of windows.window_names
      real(dp), intent(in) :: factor
      real(dp), allocatable :: w(:, :), power(:, :)
      integer :: i, j, ring

      associate (nx => size(field, 1), ny => size(field, 2))
         w = spread(window_values(window, nx), 2, ny)*spread(window_values(window, ny), 1, nx)
         allocate (power(nx/2 + 1, ny))
         power = abs(transform_plane(w*(field - sum(w*field)/sum(w))))**2*factor/(real(nx, dp)*ny*sum(w**2))
         ! Columns whose mirror image is not among those kept count twice.
         power(2:(nx + 1)/2, :) = 2*power(2:(nx + 1)/2, :)
      end associate
      rings%mode_power = rings%mode_power + power
      rings%total = rings%total + sum(power)
      do j = 1, size(power, 2)
         do i = 1, size(power, 1)
            ring = ring_of(rings, rings%mode_k(i, j))
            if (ring >= 1 .and. ring <= size(rings%k)) rings%power(ring) = rings%power(ring) + power(i, j)
         end do
      end do
   end subroutine add_spectrum

   !> The ring of a wavenumber; 0 for none.
   pure integer function ring_of(rings, k) result(ring)
      type(rings_t), intent(in) :: rings
      real(dp), intent(in) :: k

      ring = nint(k/rings%fine)
      if (ring > rings%n_fine) ring = rings%n_fine + max(1, nint(k/rings%coarse))
   end function ring_of

   !> Power of all modes above a wavenumber.
   pure real(dp) function power_above(rings, k)
      type(rings_t), intent(in) :: rings
      real(dp), intent(in) :: k

      power_above = sum(rings%mode_power, rings%mode_k > k)
   end function power_above

end module plane_spectrum
