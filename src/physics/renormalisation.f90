!> The renormalisation matrix L, which makes kernel gradients exact for linear fields.
!!
!! Source: eq. 6, L_i = [ sum_j r_ji (x) grad W V_j ]**-1.
module renormalisation
   use kinds, only: dp
   use lanes, only: nl
   implicit none
   private

   public :: renormalisation_t, renormalise

   !> Smallest eigenvalue of L**-1 (1 inside the fluid) below which no gradient is formed: isolated and
   !! aligned particles have none.
   real(dp), parameter, public :: singular_below = 0.05_dp

   !> L of a cluster, 0 where it is singular.
   type :: renormalisation_t
      real(dp) :: xx(nl), xy(nl), yy(nl)
      logical :: regular(nl)
   end type renormalisation_t

contains

   !> Inverts the matrices of a cluster.
   pure type(renormalisation_t) function renormalise(factor, matrix_xx, matrix_xy, matrix_yy) result(l)
      real(dp), intent(in) :: factor   !! of the kernel's gradient
      real(dp), intent(in), dimension(nl) :: matrix_xx, matrix_xy, matrix_yy   !! L**-1 without that factor
      real(dp), dimension(nl) :: xx, xy, yy, inverse

      xx = factor*matrix_xx
      xy = factor*matrix_xy
      yy = factor*matrix_yy
      l%regular = (xx + yy)/2 - sqrt((xx - yy)**2/4 + xy**2) > singular_below
      inverse = merge(1/merge(xx*yy - xy**2, 1.0_dp, l%regular), 0.0_dp, l%regular)
      l%xx = yy*inverse
      l%xy = -xy*inverse
      l%yy = xx*inverse
   end function renormalise

end module renormalisation
