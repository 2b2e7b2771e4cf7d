!> Pair sums of the inviscid flow terms, for one cluster of particles.
!!
!! Source: eq. 5 without its diffusive sums. The Runge-Kutta stages after the first need nothing else.
module flow_sums
   use kinds, only: dp
   use kernel, only: kernel_t, root
   use lanes, only: nl
   use particles, only: state_t
   use strips, only: ranges_t
   implicit none
   private

   public :: flow_sums_t, sum_flow

   !> The sums of a cluster, without the kernel's constant factor F = factor t**3.
   type :: flow_sums_t
      real(dp) :: divergence(nl)   !! sum_j u_ji . r_ji t**3 V_j
      real(dp) :: force_x(nl)      !! sum_j (s_i + s_j) x_ji t**3 V_j
      real(dp) :: force_y(nl)      !! sum_j (s_i + s_j) y_ji t**3 V_j
   end type flow_sums_t

contains

   !> Sums over all slots in the cluster's ranges; the lanes of the inner loop are the cluster's particles.
   pure subroutine sum_flow(kernel, ranges, state, i0, sums)
      type(kernel_t), intent(in) :: kernel
      type(ranges_t), intent(in) :: ranges    !! slots to visit
      type(state_t), intent(in) :: state      !! of all slots
      integer, intent(in) :: i0               !! slot before the cluster's first
      type(flow_sums_t), intent(out) :: sums

      call lane_loop(ranges%n, ranges%first, ranges%last, size(state%x), state%x, state%y, state%u, state%v, &
                     state%s, state%w, i0, kernel%inverse_support, sums%divergence, sums%force_x, sums%force_y)
   end subroutine sum_flow

   ! Explicit shapes and accumulators of fixed length keep the sums in vector registers.
   pure subroutine lane_loop(n_ranges, first, last, n, x, y, u, v, s, w, i0, inverse_support, div, fx, fy)
      integer, intent(in) :: n_ranges, first(n_ranges), last(n_ranges), n, i0
      real(dp), intent(in) :: x(n), y(n), u(n), v(n), s(n), w(n), inverse_support
      real(dp), intent(out) :: div(nl), fx(nl), fy(nl)
      real(dp) :: xi(nl), yi(nl), ui(nl), vi(nl), si(nl)
      real(dp) :: dx, dy, r, inverse, t, g, gx, gy, s_sum
      integer :: k, j, l

      xi = x(i0 + 1:i0 + nl)
      yi = y(i0 + 1:i0 + nl)
      ui = u(i0 + 1:i0 + nl)
      vi = v(i0 + 1:i0 + nl)
      si = s(i0 + 1:i0 + nl)
      div = 0
      fx = 0
      fy = 0
      do k = 1, n_ranges
         do j = first(k), last(k)
            !$omp simd private(dx, dy, r, inverse, t, g, gx, gy, s_sum)
            do l = 1, nl
               dx = x(j) - xi(l)
               dy = y(j) - yi(l)
               call root(dx*dx + (dy*dy + tiny(1.0_dp)), r, inverse)
               t = max(0.0_dp, 1 - inverse_support*r)
               g = t*t*(t*w(j))
               gx = g*dx
               gy = g*dy
               div(l) = div(l) + (u(j) - ui(l))*gx + (v(j) - vi(l))*gy
               s_sum = s(j) + si(l)
               fx(l) = fx(l) + s_sum*gx
               fy(l) = fy(l) + s_sum*gy
            end do
         end do
      end do
   end subroutine lane_loop

end module flow_sums
