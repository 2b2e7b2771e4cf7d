!> The diffusive terms of a step, cluster by cluster: computed at its first stage and frozen, with either model.
!!
!! Source: eqs. 5-8; the dynamic model's coefficients are eqs. 19-26. The sums over neighbours are in src/physics.
module frozen_terms
   use diffusion, only: freeze_density_diffusion, freeze_gradient, freeze_viscosity
   use diffusion_sums, only: sum_diffusion
   use eddy, only: freeze_coefficients, freeze_eddy_terms
   use eddy_sums, only: eddy_sums_t, sum_eddy
   use flow, only: as_flow_sums, flow_rates, rates_t
   use flow_sums, only: flow_sums_t
   use gradient_sums, only: gradient_sums_t, sum_gradients
   use kinds, only: dp
   use lanes, only: nl
   use model, only: model_t
   use neighbours, only: neighbours_t
   use no_slip, only: add_friction, add_wall_shear
   use particles, only: particles_t
   use runge_kutta, only: block_t
   use strain_sums, only: strain_sums_t, sum_strain
   use viscous_sums, only: sum_viscous
   implicit none
   private

   public :: begin_frozen_terms, complete_frozen_terms

contains

   !> L, grad rho, coefficients and the first stage's rates of a cluster, and of its frozen terms what needs no
   !! gradient and no coefficient of a neighbour.
   subroutine begin_frozen_terms(model, p, near, c, block)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p   !! `next` keeps the rates
      type(neighbours_t), intent(in) :: near
      integer, intent(in) :: c                !! cluster
      type(block_t), intent(inout) :: block

      if (model%dynamic) then
         call begin_dynamic(model, p, near, c, block)
      else if (p%features%diffusion) then
         call begin_constant(model, p, near, c, block)
      else
         call begin_viscous(model, p, near, c, block)
      end if
   end subroutine begin_frozen_terms

   ! Without density diffusion: no gradients.
   subroutine begin_viscous(model, p, near, c, block)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      type(neighbours_t), intent(in) :: near
      integer, intent(in) :: c
      type(block_t), intent(inout) :: block
      type(flow_sums_t) :: sums
      type(rates_t) :: rates
      real(dp) :: viscous_x(nl), viscous_y(nl), largest_pi(nl)
      integer :: i0

      i0 = (c - 1)*nl
      call sum_viscous(model%kernel, near%ranges(c), p%base, p%owner, i0, sums, viscous_x, viscous_y, largest_pi)
      call flow_rates(model, p%base, i0, sums, rates)
      call keep_rates(p, i0, rates)
      if (p%features%viscosity) call freeze_viscosity(model, viscous_x, viscous_y, p, i0)
      block%largest_pi = max(block%largest_pi, maxval(largest_pi))
   end subroutine begin_viscous

   ! With density diffusion, coefficients constant.
   subroutine begin_constant(model, p, near, c, block)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      type(neighbours_t), intent(in) :: near
      integer, intent(in) :: c
      type(block_t), intent(inout) :: block
      type(gradient_sums_t) :: sums
      type(rates_t) :: rates
      integer :: i0, singular

      i0 = (c - 1)*nl
      call sum_gradients(model%kernel, near%ranges(c), p%base, p%owner, i0, sums)
      call flow_rates(model, p%base, i0, as_flow_sums(sums, p%base, i0), rates)
      call keep_rates(p, i0, rates)
      if (p%features%viscosity) call freeze_viscosity(model, sums%viscous_x, sums%viscous_y, p, i0)
      call freeze_gradient(model, sums, p, i0, singular)
      block%singular = block%singular + singular
      block%largest_pi = max(block%largest_pi, maxval(sums%largest_pi))
      block%largest_delta = max(block%largest_delta, model%delta*maxval(crowding(model, sums%crowd)))
   end subroutine begin_constant

   ! With the dynamic model.
   subroutine begin_dynamic(model, p, near, c, block)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      type(neighbours_t), intent(in) :: near
      integer, intent(in) :: c
      type(block_t), intent(inout) :: block
      type(strain_sums_t) :: sums
      type(rates_t) :: rates
      integer :: i0, singular

      i0 = (c - 1)*nl
      call sum_strain(model%kernel, near%ranges(c), p%base, p%owner, i0, sums)
      call flow_rates(model, p%base, i0, as_flow_sums(sums, p%base, i0), rates)
      call keep_rates(p, i0, rates)
      if (p%features%no_slip) call add_wall_shear(model, near%ranges(c), p, i0, sums)
      call freeze_coefficients(model, sums, p, i0, singular)
      block%singular = block%singular + singular
      block%largest_pi = max(block%largest_pi, maxval(sums%largest_pi))
      block%largest_alpha = max(block%largest_alpha, maxval(p%alpha(i0 + 1:i0 + nl)))
      block%largest_delta = max(block%largest_delta, maxval(p%delta(i0 + 1:i0 + nl)*crowding(model, sums%crowd)))
   end subroutine begin_dynamic

   ! The sum of F_ij V_j, to which the rate of density diffusion is proportional, over that of the lattice that its limit is for.
   ! Where it is less, as at a surface, the step is not longer for it.
   pure function crowding(model, crowd) result(k)
      type(model_t), intent(in) :: model
      real(dp), intent(in) :: crowd(nl)
      real(dp) :: k(nl)

      k = max(1.0_dp, crowd/model%lattice_crowd)
   end function crowding

   pure subroutine keep_rates(p, i0, rates)
      type(particles_t), intent(inout) :: p
      integer, intent(in) :: i0
      type(rates_t), intent(in) :: rates

      p%next%u(i0 + 1:i0 + nl) = rates%u
      p%next%v(i0 + 1:i0 + nl) = rates%v
      p%next%s(i0 + 1:i0 + nl) = rates%s
   end subroutine keep_rates

   !> Completes a cluster's frozen terms, when all gradients and coefficients are there.
   subroutine complete_frozen_terms(model, p, near, c, block)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      type(neighbours_t), intent(in) :: near
      integer, intent(in) :: c
      type(block_t), intent(inout) :: block
      real(dp) :: neighbour_gradient(nl)
      type(eddy_sums_t) :: eddy
      integer :: i0

      i0 = (c - 1)*nl
      if (model%dynamic) then
         call sum_eddy(model%kernel, near%ranges(c), p, model%alpha, i0, eddy)
         call freeze_eddy_terms(model, eddy, p, i0)
      else if (p%features%diffusion) then
         call sum_diffusion(model%kernel, near%ranges(c), p, i0, neighbour_gradient)
         call freeze_density_diffusion(model, neighbour_gradient, p, i0)
      end if
      if (p%features%no_slip .and. p%features%viscosity) &
         call add_friction(model, near%ranges(c), p, i0, block%wall_power)
   end subroutine complete_frozen_terms

end module frozen_terms
