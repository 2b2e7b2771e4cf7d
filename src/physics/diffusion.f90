!> The diffusive terms of eq. 5 with constant coefficients, frozen over the step.
!!
!! Source: eqs. 5-7. L, G and both diffusive sums are computed at the step's first
!! stage and held. Every reader of the paper's frozen terms finds them here:
!! `visc_x`, `visc_y` (rho0/rho_i alpha h c0 sum pi_ij grad W V) and `diff_s` (delta h c0 sum D_ij.grad W V).
module diffusion
   use candidates, only: block_slots
   use first_sums, only: first_sums_t
   use kinds, only: dp
   use model, only: model_t
   use particles, only: particles_t
   use renormalisation, only: renormalise
   implicit none
   private

   public :: freeze_viscosity, freeze_gradient, freeze_density_diffusion

contains

   !> The viscous acceleration, eq. 5 with eq. 7.
   pure subroutine freeze_viscosity(model, alpha, viscous_x, viscous_y, p, i0, n)
      type(model_t), intent(in) :: model
      real(dp), intent(in) :: alpha                    !! 1 if it is in the sums
      real(dp), intent(in) :: viscous_x(block_slots)   !! sum_j pi_ij x_ji t**3 V_j
      real(dp), intent(in) :: viscous_y(block_slots)
      type(particles_t), intent(inout) :: p            !! visc_x, visc_y of the block are set
      integer, intent(in) :: i0, n                     !! slot before the block's first; slots
      real(dp) :: factor
      integer :: k

      !$omp simd private(factor)
      do k = 1, n
         factor = alpha*model%kernel%h*model%c0*model%kernel%gradient_factor*model%rho0/(model%rho0 + p%base%s(i0 + k))
         p%visc_x(i0 + k) = factor*viscous_x(k)
         p%visc_y(i0 + k) = factor*viscous_y(k)
      end do
   end subroutine freeze_viscosity

   !> G of eq. 6, and the part of the density diffusion that needs no neighbour's gradient.
   pure subroutine freeze_gradient(model, sums, p, i0, n, singular)
      type(model_t), intent(in) :: model
      type(first_sums_t), intent(in) :: sums
      type(particles_t), intent(inout) :: p   !! grad_x, grad_y and diff_s of the block are set
      integer, intent(in) :: i0, n            !! slot before the block's first; slots
      integer, intent(inout) :: singular      !! particles whose L**-1 could not be inverted are added
      real(dp) :: f, l_xx, l_xy, l_yy, gx, gy, regular(block_slots)
      integer :: k

      f = model%kernel%gradient_factor
      !$omp simd private(l_xx, l_xy, l_yy, gx, gy)
      do k = 1, n
         call renormalise(f, sums%matrix_xx(k), sums%matrix_xy(k), sums%matrix_yy(k), l_xx, l_xy, l_yy, regular(k))
         gx = f*(l_xx*sums%density_x(k) + l_xy*sums%density_y(k))
         gy = f*(l_xy*sums%density_x(k) + l_yy*sums%density_y(k))
         p%grad_x(i0 + k) = gx
         p%grad_y(i0 + k) = gy
         p%diff_s(i0 + k) = 2*sums%density_0(k) - gx*sums%kernel_x(k) - gy*sums%kernel_y(k)
      end do
      singular = singular + count(p%id(i0 + 1:i0 + n) > 0 .and. .not. regular(:n) > 0)
   end subroutine freeze_gradient

   !> The density-diffusion rate: closes `diff_s` with the sum over the neighbours' gradients.
   pure subroutine freeze_density_diffusion(model, neighbour_gradient, p, i0, n)
      type(model_t), intent(in) :: model
      real(dp), intent(in) :: neighbour_gradient(block_slots)   !! sum_j G_j . r_ji t**3 V_j
      type(particles_t), intent(inout) :: p
      integer, intent(in) :: i0, n                              !! slot before the block's first; slots
      real(dp) :: factor
      integer :: k

      factor = model%delta*model%kernel%h*model%c0*model%kernel%gradient_factor
      !$omp simd
      do k = 1, n
         p%diff_s(i0 + k) = factor*(p%diff_s(i0 + k) - neighbour_gradient(k))
      end do
   end subroutine freeze_density_diffusion

end module diffusion
