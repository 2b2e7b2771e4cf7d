!> Pair sums of the inviscid flow terms, for a block of clusters.
!!
!! Source: eq. 5 without its diffusive sums. The Runge-Kutta stages after the first need nothing else.
module flow_sums
   use candidates, only: block_slots, candidates_t
   use kernel, only: kernel_t, pair
   use kinds, only: dp
   use lanes, only: nl
   use particles, only: state_t
   implicit none
   private

   public :: flow_sums_t, sum_flow

   !> The sums of a block, without the kernel's constant factor F = factor t**3.
   type :: flow_sums_t
      real(dp) :: divergence(block_slots)   !! [m4/s] sum_j u_ji . r_ji t**3 V_j
      real(dp) :: force_x(block_slots)      !! [kg] sum_j (s_i + s_j) x_ji t**3 V_j
      real(dp) :: force_y(block_slots)      !! [kg] sum_j (s_i + s_j) y_ji t**3 V_j
   end type flow_sums_t

contains

   !> Sums over all candidates; the lanes of the inner loop are a cluster's particles.
   pure subroutine sum_flow(kernel, block, state, i0, sums)
      type(kernel_t), intent(in) :: kernel
      type(candidates_t), intent(in) :: block
      type(state_t), intent(in) :: state      !! of all slots
      integer, intent(in) :: i0               !! slot before the block's first
      type(flow_sums_t), intent(inout) :: sums
      integer :: c, k

      do c = 1, block%n_clusters
         k = (c - 1)*nl
         call lane_loop(block%first(c + 1) - block%first(c), block%slot(block%first(c):block%first(c + 1) - 1), size(state%x), &
                        state%x, state%y, state%u, state%v, state%s, state%volume, i0 + k, kernel%inverse_support, &
                        sums%divergence(k + 1:k + nl), sums%force_x(k + 1:k + nl), sums%force_y(k + 1:k + nl))
      end do
   end subroutine sum_flow

   ! Explicit shapes and accumulators of fixed length keep the sums in vector registers.
   pure subroutine lane_loop(n_near, near, n, x, y, u, v, s, volume, i0, inverse_support, divergence, force_x, force_y)
      integer, intent(in) :: n_near, near(n_near), n, i0
      real(dp), intent(in) :: x(n), y(n), u(n), v(n), s(n), volume(n), inverse_support
      real(dp), dimension(nl), intent(out) :: divergence, force_x, force_y
      real(dp), dimension(nl) :: xi, yi, ui, vi, si, div, fx, fy
      real(dp) :: dx, dy, g, gx, gy, unused
      integer :: k, j, l

      xi = x(i0 + 1:i0 + nl)
      yi = y(i0 + 1:i0 + nl)
      ui = u(i0 + 1:i0 + nl)
      vi = v(i0 + 1:i0 + nl)
      si = s(i0 + 1:i0 + nl)
      div = 0
      fx = 0
      fy = 0
      do k = 1, n_near
         j = near(k)
         !$omp simd private(dx, dy, g, gx, gy, unused)
         do l = 1, nl
            dx = x(j) - xi(l)
            dy = y(j) - yi(l)
            call pair(dx, dy, inverse_support, volume(j), g, unused)
            gx = g*dx
            gy = g*dy
            div(l) = div(l) + (u(j) - ui(l))*gx + (v(j) - vi(l))*gy
            fx(l) = fx(l) + (s(j) + si(l))*gx
            fy(l) = fy(l) + (s(j) + si(l))*gy
         end do
      end do
      divergence = div
      force_x = fx
      force_y = fy
   end subroutine lane_loop

end module flow_sums
