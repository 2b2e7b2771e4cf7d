!> Power that each particle of a block dissipates, for the fields of dissipated energy (Figs. 10 and 11).
!!
!! Source: eqs. 12 and 13 (27 and 28 with the dynamic model), each pair's power given to its two particles in halves:
!! P_i = V_i h c0 sum_j [ rho0 alpha_ij pi_ij u_ji + delta_ij (p_j/rho_j - p_i/rho_i) D_ij ] . grad W V_j / 2.
!! The viscous part is never negative, the other one is not in leading order.
module dissipation_sums
   use candidates, only: candidates_t
   use equation_of_state, only: specific_pressure
   use harmonic_means, only: mean_coefficients
   use kernel, only: kernel_t, pair
   use kinds, only: dp
   use lanes, only: nl
   use model, only: model_t
   use particles, only: particles_t
   implicit none
   private

   public :: sum_dissipation

contains

   !> Dissipated power of each particle of a block at the base state: `dissipating` of its slots.
   pure subroutine sum_dissipation(model, block, p, i0)
      type(model_t), intent(in) :: model
      type(candidates_t), intent(in) :: block
      type(particles_t), intent(inout) :: p   !! base state and G; alpha_i and delta_i with the dynamic model
      integer, intent(in) :: i0               !! slot before the block's first
      real(dp) :: factor, total(nl)
      integer :: c, i

      factor = model%kernel%h*model%c0*model%kernel%gradient_factor/2
      do c = 1, block%n_clusters
         i = i0 + (c - 1)*nl
         call sum_cluster(model, block, p, c, i, total)
         p%dissipating(i + 1:i + nl) = factor*p%base%volume(i + 1:i + nl)*total
      end do
   end subroutine sum_dissipation

   pure subroutine sum_cluster(model, block, p, c, i0, total)
      type(model_t), intent(in) :: model
      type(candidates_t), intent(in) :: block
      type(particles_t), intent(in) :: p
      integer, intent(in) :: c, i0
      real(dp), intent(out) :: total(nl)
      real(dp) :: alpha(nl), delta(nl), unused(nl), jump(2)
      real(dp) :: pressure_i(nl), pressure_j   ! p/rho
      integer :: k, j

      pressure_i = specific_pressure(model%c0, model%rho0, p%base%s(i0 + 1:i0 + nl))
      total = 0
      alpha = model%alpha
      delta = model%delta
      do k = block%first(c), block%first(c + 1) - 1
         j = block%slot(k)
         if (model%dynamic) then
            call mean_coefficients(p%alpha(i0 + 1:i0 + nl), p%alpha(j), p%delta(i0 + 1:i0 + nl), p%delta(j), 1.0_dp, alpha, delta, &
                                   unused)
            alpha = model%alpha + alpha
         end if
         jump = 0
         if (p%features%no_slip .and. k >= block%first_image(c)) jump = [p%jump_u(j), p%jump_v(j)]
         pressure_j = specific_pressure(model%c0, model%rho0, p%base%s(j))
         call add_slot(model%kernel, p, i0, j, jump, model%rho0*alpha, delta*(pressure_j - pressure_i), total)
      end do
   end subroutine sum_cluster

   ! The pairs of a cluster with one slot.
   pure subroutine add_slot(kernel, p, i0, j, jump, viscous, diffusive, total)
      type(kernel_t), intent(in) :: kernel
      type(particles_t), intent(in) :: p
      integer, intent(in) :: i0, j
      real(dp), intent(in) :: jump(2)                      !! [m/s] of the slot's velocity at a no-slip wall
      real(dp), intent(in) :: viscous(nl), diffusive(nl)   !! [kg/m3, m2/s2] factors of pi_ij u_ji.r_ji and of D_ij.r_ji
      real(dp), intent(inout) :: total(nl)
      real(dp) :: dx, dy, g, inverse_2, d_ij, du_dr
      integer :: i, l

      !$omp simd private(i, dx, dy, g, inverse_2, d_ij, du_dr)
      do l = 1, nl
         i = i0 + l
         dx = p%base%x(j) - p%base%x(i)
         dy = p%base%y(j) - p%base%y(i)
         call pair(dx, dy, kernel%inverse_support, p%base%volume(j), g, inverse_2)
         d_ij = 2*(p%base%s(j) - p%base%s(i)) - ((p%grad_x(i) + p%grad_x(j))*dx + (p%grad_y(i) + p%grad_y(j))*dy)
         du_dr = (p%base%u(j) + jump(1) - p%base%u(i))*dx + (p%base%v(j) + jump(2) - p%base%v(i))*dy
         total(l) = total(l) + (viscous(l)*du_dr**2*inverse_2 + diffusive(l)*d_ij)*g
      end do
   end subroutine add_slot

end module dissipation_sums
