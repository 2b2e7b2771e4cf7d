!> Pair sums of a step's first stage where no density diffusion acts, for one cluster of particles.
!!
!! Source: eq. 5 without its diffusive sum, eq. 7, and the largest |pi_ij| of eq. 8. With density diffusion `gradient_sums` or
!! `strain_sums` is the first pass. Without viscosity its sum is taken all the same: a loop of its own would save 2 % of a step.
module viscous_sums
   use flow_sums, only: flow_sums_t
   use kinds, only: dp
   use kernel, only: closest, kernel_t, root
   use lanes, only: nl
   use particles, only: state_t
   use strips, only: ranges_t
   implicit none
   private

   public :: sum_viscous

contains

   !> Sums over all slots in the cluster's ranges; the lanes of the inner loop are the cluster's particles.
   pure subroutine sum_viscous(kernel, ranges, state, owner, i0, sums, viscous_x, viscous_y, largest_pi)
      type(kernel_t), intent(in) :: kernel
      type(ranges_t), intent(in) :: ranges    !! slots to visit
      type(state_t), intent(in) :: state      !! of all slots
      real(dp), intent(in), contiguous :: owner(:)   !! (n_slots) slot of the particle, or of the image's source
      integer, intent(in) :: i0               !! slot before the cluster's first
      type(flow_sums_t), intent(out) :: sums
      real(dp), intent(out) :: viscous_x(nl)  !! sum_j pi_ij x_ji t**3 V_j
      real(dp), intent(out) :: viscous_y(nl)
      real(dp), intent(out) :: largest_pi(nl) !! max_j |pi_ij|, with r >= closest h; the particle's own images left out

      call lane_loop(ranges%n, ranges%first, ranges%last, size(state%x), state%x, state%y, state%u, state%v, state%s, state%w, &
                     owner, i0, kernel%inverse_support, sums%divergence, sums%force_x, sums%force_y, viscous_x, viscous_y, &
                     largest_pi)
   end subroutine sum_viscous

   ! Explicit shapes and accumulators of fixed length keep the sums in vector registers.
   pure subroutine lane_loop(n_ranges, first, last, n, x, y, u, v, s, w, owner, i0, inverse_support, div, fx, fy, vx, vy, &
                             pi_max)
      integer, intent(in) :: n_ranges, first(n_ranges), last(n_ranges), n, i0
      real(dp), intent(in) :: x(n), y(n), u(n), v(n), s(n), w(n), owner(n), inverse_support
      real(dp), intent(out) :: div(nl), fx(nl), fy(nl), vx(nl), vy(nl), pi_max(nl)
      real(dp), dimension(nl) :: xi, yi, ui, vi, si, oi
      real(dp) :: dx, dy, r, inverse, t, g, s_sum, du_dr, pi_ij, other, most
      integer :: k, j, l

      xi = x(i0 + 1:i0 + nl)
      yi = y(i0 + 1:i0 + nl)
      ui = u(i0 + 1:i0 + nl)
      vi = v(i0 + 1:i0 + nl)
      si = s(i0 + 1:i0 + nl)
      oi = owner(i0 + 1:i0 + nl)
      div = 0
      fx = 0
      fy = 0
      vx = 0
      vy = 0
      pi_max = 0
      most = (2*inverse_support/closest)**2
      do k = 1, n_ranges
         do j = first(k), last(k)
            !$omp simd private(dx, dy, r, inverse, t, g, s_sum, du_dr, pi_ij, other)
            do l = 1, nl
               dx = x(j) - xi(l)
               dy = y(j) - yi(l)
               call root(dx*dx + (dy*dy + tiny(1.0_dp)), r, inverse)
               t = max(0.0_dp, 1 - inverse_support*r)
               g = t*t*(t*w(j))
               du_dr = (u(j) - ui(l))*dx + (v(j) - vi(l))*dy
               div(l) = div(l) + du_dr*g
               s_sum = (s(j) + si(l))*g
               fx(l) = fx(l) + s_sum*dx
               fy(l) = fy(l) + s_sum*dy
               pi_ij = du_dr*inverse*inverse*g
               vx(l) = vx(l) + pi_ij*dx
               vy(l) = vy(l) + pi_ij*dy
               other = min(t, abs(owner(j) - oi(l)))
               pi_max(l) = max(pi_max(l), merge(abs(du_dr)*min(inverse*inverse, most), 0.0_dp, other > 0))
            end do
         end do
      end do
   end subroutine lane_loop

end module viscous_sums
