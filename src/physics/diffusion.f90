!> The diffusive terms of eq. 5 with constant coefficients, frozen over the step.
!!
!! Source: eqs. 5-7. L, G and both diffusive sums are computed at the step's first
!! stage and held. Every reader of the paper's frozen terms finds them here:
!! `visc_x`, `visc_y` (rho0/rho_i alpha h c0 sum pi_ij grad W V) and `diff_s` (delta h c0 sum D_ij.grad W V).
module diffusion
   use gradient_sums, only: gradient_sums_t
   use kinds, only: dp
   use lanes, only: nl
   use model, only: model_t
   use particles, only: particles_t
   use renormalisation, only: renormalisation_t, renormalise
   implicit none
   private

   public :: freeze_viscosity, freeze_gradient, freeze_density_diffusion

contains

   !> The viscous acceleration, eq. 5 with eq. 7.
   pure subroutine freeze_viscosity(model, viscous_x, viscous_y, p, i0)
      type(model_t), intent(in) :: model
      real(dp), intent(in) :: viscous_x(nl)   !! sum_j pi_ij x_ji t**3 V_j
      real(dp), intent(in) :: viscous_y(nl)
      type(particles_t), intent(inout) :: p   !! visc_x, visc_y of the cluster are set
      integer, intent(in) :: i0               !! slot before the cluster's first
      real(dp) :: factor(nl)

      factor = model%alpha*model%kernel%h*model%c0*model%kernel%gradient_factor &
               *model%rho0/(model%rho0 + p%base%s(i0 + 1:i0 + nl))
      p%visc_x(i0 + 1:i0 + nl) = factor*viscous_x
      p%visc_y(i0 + 1:i0 + nl) = factor*viscous_y
   end subroutine freeze_viscosity

   !> G of eq. 6, and the part of the density diffusion that needs no neighbour's gradient.
   pure subroutine freeze_gradient(model, sums, p, i0, singular)
      type(model_t), intent(in) :: model
      type(gradient_sums_t), intent(in) :: sums
      type(particles_t), intent(inout) :: p   !! grad_x, grad_y and diff_s of the cluster are set
      integer, intent(in) :: i0               !! slot before the cluster's first
      integer, intent(out) :: singular        !! particles whose L**-1 could not be inverted
      type(renormalisation_t) :: l

      associate (f => model%kernel%gradient_factor, gx => p%grad_x(i0 + 1:i0 + nl), &
                 gy => p%grad_y(i0 + 1:i0 + nl), diff_s => p%diff_s(i0 + 1:i0 + nl))
         l = renormalise(f, sums%matrix_xx, sums%matrix_xy, sums%matrix_yy)
         gx = f*(l%xx*sums%density_x + l%xy*sums%density_y)
         gy = f*(l%xy*sums%density_x + l%yy*sums%density_y)
         diff_s = 2*sums%density_0 - gx*sums%kernel_x - gy*sums%kernel_y
      end associate
      singular = count(p%id(i0 + 1:i0 + nl) > 0 .and. .not. l%regular)
   end subroutine freeze_gradient

   !> The density-diffusion rate: closes `diff_s` with the sum over the neighbours' gradients.
   pure subroutine freeze_density_diffusion(model, neighbour_gradient, p, i0)
      type(model_t), intent(in) :: model
      real(dp), intent(in) :: neighbour_gradient(nl)   !! sum_j G_j . r_ji t**3 V_j
      type(particles_t), intent(inout) :: p
      integer, intent(in) :: i0                        !! slot before the cluster's first

      p%diff_s(i0 + 1:i0 + nl) = model%delta*model%kernel%h*model%c0*model%kernel%gradient_factor &
                                 *(p%diff_s(i0 + 1:i0 + nl) - neighbour_gradient)
   end subroutine freeze_density_diffusion

end module diffusion
