!> Pair sums of the diffusive terms with the dynamic model, for one cluster of particles.
!!
!! Source: eqs. 5-7 with the pair coefficients of eqs. 25 and 26,
!! delta_ij = 2 delta_i delta_j/(delta_i + delta_j) and alpha_ij = alpha + 2 alpha_i alpha_j/(alpha_i + alpha_j).
!! As D_ij . grad W = [2 (s_j - s_i) - (G_i + G_j) . r_ji] F, the 1/r**2 of eq. 6 cancels.
module eddy_sums
   use kinds, only: dp
   use kernel, only: kernel_t, root
   use lanes, only: nl
   use particles, only: particles_t
   use strips, only: ranges_t
   implicit none
   private

   public :: eddy_sums_t, sum_eddy

   !> The sums of a cluster, without the kernel's constant factor F = factor t**3.
   type :: eddy_sums_t
      real(dp) :: diffusion(nl)   !! sum_j delta_ij D_ij . r_ji t**3 V_j
      real(dp) :: viscous_x(nl)   !! sum_j alpha_ij pi_ij x_ji t**3 V_j
      real(dp) :: viscous_y(nl)
   end type eddy_sums_t

contains

   !> Sums over all slots in the cluster's ranges; the lanes of the inner loop are the cluster's particles.
   pure subroutine sum_eddy(kernel, ranges, p, alpha, i0, sums)
      type(kernel_t), intent(in) :: kernel
      type(ranges_t), intent(in) :: ranges    !! slots to visit
      type(particles_t), intent(in) :: p      !! base state, G, alpha_i and delta_i of all slots
      real(dp), intent(in) :: alpha           !! that acts everywhere: the real viscosity's
      integer, intent(in) :: i0               !! slot before the cluster's first
      type(eddy_sums_t), intent(out) :: sums

      call lane_loop(ranges%n, ranges%first, ranges%last, size(p%base%x), p%base%x, p%base%y, p%base%u, p%base%v, &
                     p%base%s, p%base%w, p%grad_x, p%grad_y, p%alpha, p%delta, alpha, i0, kernel%inverse_support, sums)
   end subroutine sum_eddy

   ! Explicit shapes and accumulators of fixed length keep the sums in vector registers. One division serves both
   ! harmonic means: 1/[(alpha_i + alpha_j)(delta_i + delta_j)]; `nothing` makes the mean of 0 and 0 vanish without a
   ! trace in the other one.
   pure subroutine lane_loop(n_ranges, first, last, n, x, y, u, v, s, w, gx, gy, a, d, alpha, i0, inverse_support, sums)
      integer, intent(in) :: n_ranges, first(n_ranges), last(n_ranges), n, i0
      real(dp), intent(in) :: x(n), y(n), u(n), v(n), s(n), w(n), gx(n), gy(n), a(n), d(n), alpha, inverse_support
      type(eddy_sums_t), intent(out) :: sums
      real(dp), parameter :: nothing = 1.0e-150_dp   ! its square can be divided by
      real(dp), dimension(nl) :: xi, yi, ui, vi, si, gxi, gyi, ai, di, diffusion, fx, fy
      real(dp) :: dx, dy, r, inverse, t, g, d_ij, pi_ij, a_sum, d_sum, both, f
      integer :: k, j, l

      xi = x(i0 + 1:i0 + nl)
      yi = y(i0 + 1:i0 + nl)
      ui = u(i0 + 1:i0 + nl)
      vi = v(i0 + 1:i0 + nl)
      si = s(i0 + 1:i0 + nl)
      gxi = gx(i0 + 1:i0 + nl)
      gyi = gy(i0 + 1:i0 + nl)
      ai = a(i0 + 1:i0 + nl)
      di = d(i0 + 1:i0 + nl)
      diffusion = 0
      fx = 0
      fy = 0
      do k = 1, n_ranges
         do j = first(k), last(k)
            !$omp simd private(dx, dy, r, inverse, t, g, d_ij, pi_ij, a_sum, d_sum, both, f)
            do l = 1, nl
               dx = x(j) - xi(l)
               dy = y(j) - yi(l)
               call root(dx*dx + (dy*dy + tiny(1.0_dp)), r, inverse)
               t = max(0.0_dp, 1 - inverse_support*r)
               g = t*t*(t*w(j))
               a_sum = ai(l) + a(j) + nothing
               d_sum = di(l) + d(j) + nothing
               both = 2/(a_sum*d_sum)
               d_ij = 2*(s(j) - si(l)) - ((gxi(l) + gx(j))*dx + (gyi(l) + gy(j))*dy)
               diffusion(l) = diffusion(l) + (di(l)*d(j))*(a_sum*both)*(d_ij*g)
               pi_ij = ((u(j) - ui(l))*dx + (v(j) - vi(l))*dy)*(inverse*inverse)
               f = (alpha + (ai(l)*a(j))*(d_sum*both))*(pi_ij*g)
               fx(l) = fx(l) + f*dx
               fy(l) = fy(l) + f*dy
            end do
         end do
      end do
      sums = eddy_sums_t(diffusion, fx, fy)
   end subroutine lane_loop

end module eddy_sums
