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
   implicit none
   private

   public :: freeze_viscosity, begin_density_diffusion, freeze_density_diffusion

contains

   !> The viscous acceleration, eq. 5 with eq. 7.
   pure subroutine freeze_viscosity(model, alpha, viscous_x, viscous_y, p, i0, n)
      type(model_t), intent(in) :: model
      real(dp), intent(in) :: alpha                    !! [1] 1 if it is in the sums
      real(dp), intent(in) :: viscous_x(block_slots)   !! [m3/s] sum_j pi_ij x_ji t**3 V_j
      real(dp), intent(in) :: viscous_y(block_slots)   !! [m3/s]
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

   !> The part of the density diffusion that needs no neighbour's gradient.
   pure subroutine begin_density_diffusion(sums, p, i0, n)
      type(first_sums_t), intent(in) :: sums
      type(particles_t), intent(inout) :: p   !! G is there; diff_s of the block is set, without its factor
      integer, intent(in) :: i0, n            !! slot before the block's first; slots
      integer :: k

      !$omp simd
      do k = 1, n
         p%diff_s(i0 + k) = 2*sums%density_0(k) - p%grad_x(i0 + k)*sums%kernel_x(k) - p%grad_y(i0 + k)*sums%kernel_y(k)
      end do
   end subroutine begin_density_diffusion

   !> The density-diffusion rate: closes `diff_s` with the sum over the neighbours' gradients.
   pure subroutine freeze_density_diffusion(model, neighbour_gradient, p, i0, n)
      type(model_t), intent(in) :: model
      real(dp), intent(in) :: neighbour_gradient(block_slots)   !! [kg/m] sum_j G_j . r_ji t**3 V_j
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
