!> The renormalisation matrix L, which makes kernel gradients exact for linear fields.
!!
!! Source: eq. 6, L_i = [ sum_j r_ji (x) grad W V_j ]**-1.
module renormalisation
   use kinds, only: dp
   implicit none
   private

   public :: renormalise

   !> Smallest eigenvalue of L**-1 (1 inside the fluid) below which no gradient is formed: isolated and
   !! aligned particles have none.
   real(dp), parameter, public :: singular_below = 0.05_dp

contains

   !> L, 0 where it is singular.
   elemental subroutine renormalise(factor, matrix_xx, matrix_xy, matrix_yy, l_xx, l_xy, l_yy, regular)
      real(dp), intent(in) :: factor                            !! of the kernel's gradient
      real(dp), intent(in) :: matrix_xx, matrix_xy, matrix_yy   !! L**-1 without that factor
      real(dp), intent(out) :: l_xx, l_xy, l_yy
      real(dp), intent(out) :: regular                          !! 1, or 0 where it is singular
      real(dp) :: xx, xy, yy, inverse

      xx = factor*matrix_xx
      xy = factor*matrix_xy
      yy = factor*matrix_yy
      regular = merge(1.0_dp, 0.0_dp, (xx + yy)/2 - sqrt((xx - yy)**2/4 + xy**2) > singular_below)
      ! Without a branch, so that loops over particles are vectorised. The determinant is 0 only where it is not used.
      inverse = regular/((xx*yy - xy**2)*regular + (1 - regular))
      l_xx = yy*inverse
      l_xy = -xy*inverse
      l_yy = xx*inverse
   end subroutine renormalise

end module renormalisation
