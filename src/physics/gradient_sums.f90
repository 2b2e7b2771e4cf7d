!> Pair sums of a step's first stage, for one cluster of particles: everything that needs no gradient
!! of a neighbour.
!!
!! Source: eqs. 5-8. Besides the flow terms these are the renormalisation matrix L**-1, the
!! gradient of density, the viscous sum and the largest |pi_ij|.
module gradient_sums
   use kinds, only: dp
   use kernel, only: closest, kernel_t, root
   use lanes, only: nl
   use particles, only: state_t
   use strips, only: ranges_t
   implicit none
   private

   public :: gradient_sums_t, sum_gradients

   !> The sums of a cluster, without the kernel's constant factor F = factor t**3.
   type :: gradient_sums_t
      real(dp) :: divergence(nl)   !! sum_j u_ji . r_ji t**3 V_j
      real(dp) :: matrix_xx(nl)    !! sum_j x_ji x_ji t**3 V_j, and so on: L**-1
      real(dp) :: matrix_xy(nl)
      real(dp) :: matrix_yy(nl)
      real(dp) :: density_x(nl)    !! sum_j (s_j - s_i) x_ji t**3 V_j
      real(dp) :: density_y(nl)
      real(dp) :: density_0(nl)    !! sum_j (s_j - s_i) t**3 V_j
      real(dp) :: kernel_x(nl)     !! sum_j x_ji t**3 V_j: the sum of grad W
      real(dp) :: kernel_y(nl)
      real(dp) :: viscous_x(nl)    !! sum_j pi_ij x_ji t**3 V_j
      real(dp) :: viscous_y(nl)
      real(dp) :: crowd(nl)        !! sum_j t**3 V_j, the particle and its own images left out
      real(dp) :: largest_pi(nl)   !! max_j |pi_ij|, with r >= closest h; the particle's own images left out
   end type gradient_sums_t

contains

   !> Sums over all slots in the cluster's ranges; the lanes of the inner loop are the cluster's particles.
   pure subroutine sum_gradients(kernel, ranges, state, owner, i0, sums)
      type(kernel_t), intent(in) :: kernel
      type(ranges_t), intent(in) :: ranges    !! slots to visit
      type(state_t), intent(in) :: state      !! of all slots
      real(dp), intent(in), contiguous :: owner(:)   !! (n_slots) slot of the particle, or of the image's source
      integer, intent(in) :: i0               !! slot before the cluster's first
      type(gradient_sums_t), intent(out) :: sums

      call lane_loop(ranges%n, ranges%first, ranges%last, size(state%x), state%x, state%y, state%u, state%v, &
                     state%s, state%w, owner, i0, kernel%inverse_support, sums)
   end subroutine sum_gradients

   ! Explicit shapes and accumulators of fixed length keep the sums in vector registers.
   pure subroutine lane_loop(n_ranges, first, last, n, x, y, u, v, s, w, owner, i0, inverse_support, sums)
      integer, intent(in) :: n_ranges, first(n_ranges), last(n_ranges), n, i0
      real(dp), intent(in) :: x(n), y(n), u(n), v(n), s(n), w(n), owner(n), inverse_support
      type(gradient_sums_t), intent(out) :: sums
      real(dp), dimension(nl) :: xi, yi, ui, vi, si, oi
      real(dp), dimension(nl) :: div, mxx, mxy, myy, bx, by, b0, kx, ky, fx, fy, crowd, pi_max
      real(dp) :: dx, dy, r, inverse, t, g, gx, gy, ds, du_dr, pi_ij, other, most
      integer :: k, j, l

      xi = x(i0 + 1:i0 + nl)
      yi = y(i0 + 1:i0 + nl)
      ui = u(i0 + 1:i0 + nl)
      vi = v(i0 + 1:i0 + nl)
      si = s(i0 + 1:i0 + nl)
      oi = owner(i0 + 1:i0 + nl)
      div = 0
      mxx = 0
      mxy = 0
      myy = 0
      bx = 0
      by = 0
      b0 = 0
      kx = 0
      ky = 0
      fx = 0
      fy = 0
      crowd = 0
      pi_max = 0
      most = (2*inverse_support/closest)**2
      do k = 1, n_ranges
         do j = first(k), last(k)
            !$omp simd private(dx, dy, r, inverse, t, g, gx, gy, ds, du_dr, pi_ij, other)
            do l = 1, nl
               dx = x(j) - xi(l)
               dy = y(j) - yi(l)
               call root(dx*dx + (dy*dy + tiny(1.0_dp)), r, inverse)
               t = max(0.0_dp, 1 - inverse_support*r)
               g = t*t*(t*w(j))
               gx = g*dx
               gy = g*dy
               mxx(l) = mxx(l) + gx*dx
               mxy(l) = mxy(l) + gx*dy
               myy(l) = myy(l) + gy*dy
               kx(l) = kx(l) + gx
               ky(l) = ky(l) + gy
               ds = s(j) - si(l)
               b0(l) = b0(l) + ds*g
               bx(l) = bx(l) + ds*gx
               by(l) = by(l) + ds*gy
               du_dr = (u(j) - ui(l))*dx + (v(j) - vi(l))*dy
               div(l) = div(l) + du_dr*g
               pi_ij = du_dr*inverse*inverse
               fx(l) = fx(l) + pi_ij*gx
               fy(l) = fy(l) + pi_ij*gy
               ! 1 for another particle within the support, else 0, without a branch: with one, nothing here is vectorised.
               other = min(1.0_dp, huge(1.0_dp)*min(t, abs(owner(j) - oi(l))))
               crowd(l) = crowd(l) + other*g
               pi_max(l) = max(pi_max(l), other*abs(du_dr)*min(inverse*inverse, most))
            end do
         end do
      end do
      sums = gradient_sums_t(div, mxx, mxy, myy, bx, by, b0, kx, ky, fx, fy, crowd, pi_max)
   end subroutine lane_loop

end module gradient_sums
