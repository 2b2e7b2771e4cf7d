!> The diffusive terms of a step, block by block: computed at its first stage and frozen, with either model.
!!
!! Source: eqs. 5-8; the dynamic model's coefficients are eqs. 19-26. The sums over neighbours are in src/physics.
module frozen_terms
   use blocks, only: block_t
   use candidates, only: block_slots
   use diffusion, only: begin_density_diffusion, freeze_density_diffusion, freeze_viscosity
   use diffusion_sums, only: sum_diffusion
   use eddy, only: freeze_coefficients, freeze_eddy_terms
   use eddy_sums, only: eddy_sums_t, sum_eddy
   use first_sums, only: first_sums_t, pass_constant, pass_diffusive, pass_dynamic, pass_flow, pass_viscous, sum_first
   use flow, only: flow_rates, rates_t
   use kinds, only: dp
   use lanes, only: nl
   use model, only: model_t
   use neighbours, only: neighbours_t
   use no_slip, only: add_friction
   use no_slip_sums, only: sum_jump_gradient
   use particles, only: features_t, particles_t
   use renormalisation, only: freeze_gradient, matrices_t
   use solid_friction, only: reflected_sums_t, sum_solid_friction
   use solid_terms, only: add_solid_strain, add_solids
   implicit none
   private

   public :: first_pass, begin_frozen_terms, complete_frozen_terms

contains

   !> Which first pass a scene needs.
   pure integer function first_pass(model, features) result(pass)
      type(model_t), intent(in) :: model
      type(features_t), intent(in) :: features

      if (model%dynamic) then
         pass = pass_dynamic
      else if (features%diffusion .and. features%viscosity) then
         pass = pass_constant
      else if (features%diffusion) then
         pass = pass_diffusive
      else if (features%viscosity) then
         pass = pass_viscous
      else
         pass = pass_flow
      end if
   end function first_pass

   !> L, grad rho, coefficients and the first stage's rates of a block, and of its frozen terms what needs no
   !! gradient and no coefficient of a neighbour.
   subroutine begin_frozen_terms(model, p, near, b, block)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p     !! `next` keeps the rates
      type(neighbours_t), intent(in) :: near
      integer, intent(in) :: b                  !! number of the block
      type(block_t), intent(inout) :: block
      type(first_sums_t) :: sums
      type(rates_t) :: rates
      type(reflected_sums_t) :: reflected
      type(matrices_t) :: l
      integer :: i0, n

      i0 = near%blocks(b)%before
      n = nl*near%blocks(b)%n_clusters
      call sum_first(first_pass(model, p%features), model%kernel, near%blocks(b), p, near%images%source, i0, sums)
      if (near%ghosts%exist()) call add_solids(model, near, p%base, b, sums, block%solid_power)
      call flow_rates(model, p%base, i0, n, sums, rates)
      p%next%u(i0 + 1:i0 + n) = rates%u(:n)
      p%next%v(i0 + 1:i0 + n) = rates%v(:n)
      p%next%s(i0 + 1:i0 + n) = rates%s(:n)
      block%largest_pi = max(block%largest_pi, largest(n, sums%largest_pi))
      if (p%features%diffusion) call freeze_gradient(model, sums, p, i0, n, l, block%singular)
      if (model%dynamic) then
         if (p%features%no_slip) call sum_jump_gradient(model%kernel, near%blocks(b), p, i0, sums)
         if (near%ghosts%are_near(b)) then
            call sum_solid_friction(model%kernel, near%ghosts, b, p%base, reflected)
            call add_solid_strain(model, n, reflected, sums, l)
            block%rubbed = reshape([reflected%viscous_x(:n), reflected%viscous_y(:n)], [n, 2])
         end if
         call freeze_coefficients(model, sums, l, p, i0, n)
         block%largest_alpha = max(block%largest_alpha, largest(n, p%alpha(i0 + 1:i0 + n)))
         block%largest_delta = max(block%largest_delta, &
                                   largest(n, p%delta(i0 + 1:i0 + n)*crowding(model, sums%crowd(:n))))
      else
         if (near%ghosts%are_near(b) .and. p%features%viscosity) then
            call sum_solid_friction(model%kernel, near%ghosts, b, p%base, reflected)
            sums%viscous_x(:n) = sums%viscous_x(:n) + reflected%viscous_x(:n)
            sums%viscous_y(:n) = sums%viscous_y(:n) + reflected%viscous_y(:n)
         end if
         if (p%features%viscosity) call freeze_viscosity(model, model%alpha, sums%viscous_x, sums%viscous_y, p, i0, n)
         if (.not. p%features%diffusion) return
         call begin_density_diffusion(sums, p, i0, n)
         block%largest_delta = max(block%largest_delta, model%delta*crowding(model, largest(n, sums%crowd)))
      end if
   end subroutine begin_frozen_terms

   ! maxval, as a loop that is vectorised.
   pure real(dp) function largest(n, values)
      integer, intent(in) :: n
      real(dp), intent(in) :: values(n)
      integer :: k

      largest = 0
      !$omp simd reduction(max:largest)
      do k = 1, n
         largest = max(largest, values(k))
      end do
   end function largest

   ! The sum of F_ij V_j, to which the rate of density diffusion is proportional, over that of the lattice that its limit is for.
   ! Where it is less, as at a surface, the step is not longer for it.
   elemental real(dp) function crowding(model, crowd)
      type(model_t), intent(in) :: model
      real(dp), intent(in) :: crowd   !! sum_j t**3 V_j

      crowding = max(1.0_dp, crowd/model%lattice_crowd)
   end function crowding

   !> Completes a block's frozen terms, when all gradients and coefficients are there.
   subroutine complete_frozen_terms(model, p, near, b, block)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      type(neighbours_t), intent(in) :: near
      integer, intent(in) :: b                  !! number of the block
      type(block_t), intent(inout) :: block
      real(dp) :: neighbour_gradient(block_slots)
      type(eddy_sums_t) :: eddy
      integer :: i0, n

      i0 = near%blocks(b)%before
      n = nl*near%blocks(b)%n_clusters
      if (model%dynamic) then
         call sum_eddy(model%kernel, near%blocks(b), p, model%alpha, i0, eddy)
         if (allocated(block%rubbed)) then   ! alpha_i is for both of a pair
            eddy%viscous_x(:n) = eddy%viscous_x(:n) + (model%alpha + p%alpha(i0 + 1:i0 + n))*block%rubbed(:, 1)
            eddy%viscous_y(:n) = eddy%viscous_y(:n) + (model%alpha + p%alpha(i0 + 1:i0 + n))*block%rubbed(:, 2)
         end if
         call freeze_eddy_terms(model, eddy, p, i0, n)
      else if (p%features%diffusion) then
         call sum_diffusion(model%kernel, near%blocks(b), p, i0, neighbour_gradient)
         call freeze_density_diffusion(model, neighbour_gradient, p, i0, n)
      end if
      if (p%features%no_slip .and. p%features%viscosity) &
         call add_friction(model, near%blocks(b), p, i0, n, block%wall_power)
   end subroutine complete_frozen_terms

end module frozen_terms
