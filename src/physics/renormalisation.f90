!> The renormalisation matrix L, which makes kernel gradients exact for linear fields.
!!
!! Source: eq. 6, L_i = [ sum_j r_ji (x) grad W V_j ]**-1.
module renormalisation
   use candidates, only: block_slots
   use first_sums, only: first_sums_t
   use kinds, only: dp
   use model, only: model_t
   use particles, only: particles_t
   implicit none
   private

   public :: matrices_t, renormalise, freeze_gradient

   !> Smallest eigenvalue of L**-1 (1 inside the fluid) below which no gradient is formed: isolated and
   !! aligned particles have none.
   real(dp), parameter, public :: singular_below = 0.05_dp

   !> L of a block's particles [1].
   type :: matrices_t
      real(dp) :: xx(block_slots), xy(block_slots), yy(block_slots)
   end type matrices_t

contains

   !> L and G of a block, eq. 6: the renormalised gradient of density.
   pure subroutine freeze_gradient(model, sums, p, i0, n, l, singular)
      type(model_t), intent(in) :: model
      type(first_sums_t), intent(in) :: sums
      type(particles_t), intent(inout) :: p   !! grad_x, grad_y of the block are set [kg/m4]
      integer, intent(in) :: i0, n            !! slot before the block's first; slots
      type(matrices_t), intent(inout) :: l    !! of its first n slots
      integer, intent(inout) :: singular      !! particles whose L**-1 could not be inverted are added
      real(dp) :: f, regular(block_slots)
      integer :: k

      f = model%kernel%gradient_factor
      !$omp simd
      do k = 1, n
         call renormalise(f, sums%matrix_xx(k), sums%matrix_xy(k), sums%matrix_yy(k), l%xx(k), l%xy(k), l%yy(k), regular(k))
         p%grad_x(i0 + k) = f*(l%xx(k)*sums%density_x(k) + l%xy(k)*sums%density_y(k))
         p%grad_y(i0 + k) = f*(l%xy(k)*sums%density_x(k) + l%yy(k)*sums%density_y(k))
      end do
      singular = singular + count(p%id(i0 + 1:i0 + n) > 0 .and. .not. regular(:n) > 0)
   end subroutine freeze_gradient

   !> L, 0 where it is singular.
   elemental subroutine renormalise(factor, matrix_xx, matrix_xy, matrix_yy, l_xx, l_xy, l_yy, regular)
      real(dp), intent(in) :: factor                            !! [1/m4] of the kernel's gradient
      real(dp), intent(in) :: matrix_xx, matrix_xy, matrix_yy   !! [m4] L**-1 without that factor
      real(dp), intent(out) :: l_xx, l_xy, l_yy                 !! [1]
      real(dp), intent(out) :: regular                          !! [1] 0 where it is singular, else 1
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
