!> The kernel's Fourier transform: what is left of a wave that the kernel has smoothed.
module kernel_transform
   use kernel, only: kernel_t, kernel_value, new_kernel
   use kinds, only: dp
   implicit none
   private

   public :: transform_of_kernel

contains

   !> int W(r) J0(k r) 2 pi r dr, 1 at k = 0; for a lattice or disorder finer than 1/k.
   elemental real(dp) function transform_of_kernel(h, k) result(factor)
      real(dp), intent(in) :: h   !! smoothing length
      real(dp), intent(in) :: k   !! wavenumber
      integer, parameter :: n = 400
      real(dp), parameter :: pi = acos(-1.0_dp)
      type(kernel_t) :: kernel
      real(dp) :: r
      integer :: i

      kernel = new_kernel(h)
      factor = 0
      do i = 1, n
         r = kernel%support*(i - 0.5_dp)/n
         factor = factor + kernel_value(kernel, r)*bessel_j0(k*r)*2*pi*r*kernel%support/n
      end do
   end function transform_of_kernel

end module kernel_transform
