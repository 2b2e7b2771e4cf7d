!> Power that each particle of a cluster dissipates, for the fields of dissipated energy (Figs. 10 and 11).
!!
!! Source: eqs. 12 and 13 (27 and 28 with the dynamic model), each pair's power given to its two particles in halves:
!! P_i = V_i h c0 sum_j [ rho0 alpha_ij pi_ij u_ji + delta_ij (p_j/rho_j - p_i/rho_i) D_ij ] . grad W V_j / 2.
!! The viscous part is never negative, the other one is not in leading order.
module dissipation_sums
   use kinds, only: dp
   use kernel, only: kernel_t, root
   use lanes, only: nl
   use model, only: model_t
   use particles, only: particles_t
   use strips, only: ranges_t
   implicit none
   private

   public :: sum_dissipation

contains

   !> Dissipated power of each particle of a cluster at the base state.
   pure subroutine sum_dissipation(model, ranges, p, i0, power)
      type(model_t), intent(in) :: model
      type(ranges_t), intent(in) :: ranges    !! slots to visit
      type(particles_t), intent(in) :: p      !! base state and G; alpha_i and delta_i with the dynamic model
      integer, intent(in) :: i0               !! slot before the cluster's first
      real(dp), intent(out) :: power(nl)
      real(dp) :: alpha(nl), delta(nl), total(nl), e_i(nl), e_j, jump(2), factor
      integer :: k, j

      e_i = p%base%s(i0 + 1:i0 + nl)/(model%rho0 + p%base%s(i0 + 1:i0 + nl))
      total = 0
      alpha = model%alpha
      delta = model%delta
      jump = 0
      do k = 1, ranges%n
         do j = ranges%first(k), ranges%last(k)
            if (model%dynamic) then
               alpha = model%alpha + harmonic(p%alpha(i0 + 1:i0 + nl), p%alpha(j))
               delta = harmonic(p%delta(i0 + 1:i0 + nl), p%delta(j))
            end if
            if (p%features%no_slip) jump = [p%jump_u(j), p%jump_v(j)]
            ! p/rho = c0**2 e
            e_j = p%base%s(j)/(model%rho0 + p%base%s(j))
            call add_slot(model%kernel, p, i0, j, jump, model%rho0*alpha, model%c0**2*delta*(e_j - e_i), total)
         end do
      end do
      factor = model%kernel%h*model%c0*model%kernel%gradient_factor/2
      power = factor*p%base%w(i0 + 1:i0 + nl)*total
   end subroutine sum_dissipation

   ! The pairs of a cluster with one slot.
   pure subroutine add_slot(kernel, p, i0, j, jump, viscous, diffusive, total)
      type(kernel_t), intent(in) :: kernel
      type(particles_t), intent(in) :: p
      integer, intent(in) :: i0, j
      real(dp), intent(in) :: jump(2)                      !! of the slot's velocity at a no-slip wall
      real(dp), intent(in) :: viscous(nl), diffusive(nl)   !! factors of pi_ij u_ji.r_ji and of D_ij.r_ji
      real(dp), intent(inout) :: total(nl)
      real(dp) :: dx, dy, r, inverse, t, d_ij, du_dr
      integer :: i, l

      !$omp simd private(i, dx, dy, r, inverse, t, d_ij, du_dr)
      do l = 1, nl
         i = i0 + l
         dx = p%base%x(j) - p%base%x(i)
         dy = p%base%y(j) - p%base%y(i)
         call root(dx*dx + (dy*dy + tiny(1.0_dp)), r, inverse)
         t = max(0.0_dp, 1 - kernel%inverse_support*r)
         d_ij = 2*(p%base%s(j) - p%base%s(i)) - ((p%grad_x(i) + p%grad_x(j))*dx + (p%grad_y(i) + p%grad_y(j))*dy)
         du_dr = (p%base%u(j) + jump(1) - p%base%u(i))*dx + (p%base%v(j) + jump(2) - p%base%v(i))*dy
         total(l) = total(l) + (viscous(l)*(du_dr*inverse)**2 + diffusive(l)*d_ij)*(t*t*(t*p%base%w(j)))
      end do
   end subroutine add_slot

   ! 2 a b/(a + b), 0 where both are 0.
   elemental real(dp) function harmonic(a, b)
      real(dp), intent(in) :: a, b   !! >= 0

      harmonic = 2*a*b/(a + b + tiny(1.0_dp))
   end function harmonic

end module dissipation_sums
