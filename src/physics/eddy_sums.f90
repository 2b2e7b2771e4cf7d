!> Pair sums of the diffusive terms with the dynamic model, for a block of clusters.
!!
!! Source: eqs. 5-7 with the pair coefficients of eqs. 20 and 24, alpha_ij besides the real viscosity's alpha.
!! As D_ij . grad W = [2 (s_j - s_i) - (G_i + G_j) . r_ji] F, the 1/r**2 of eq. 6 cancels.
module eddy_sums
   use candidates, only: block_slots, candidates_t
   use harmonic_means, only: mean_coefficients
   use kernel, only: kernel_t, pair, squared_distance
   use kinds, only: dp
   use lanes, only: nl
   use particles, only: particles_t
   implicit none
   private

   public :: eddy_sums_t, sum_eddy

   !> The sums of a block, without the kernel's constant factor F = factor t**3.
   type :: eddy_sums_t
      real(dp) :: diffusion(block_slots)   !! [kg/m] sum_j delta_ij D_ij . r_ji t**3 V_j
      real(dp) :: viscous_x(block_slots)   !! [m3/s] sum_j (alpha + alpha_ij) pi_ij x_ji t**3 V_j
      real(dp) :: viscous_y(block_slots)   !! [m3/s]
   end type eddy_sums_t

contains

   !> Sums over all candidates; the lanes of the inner loop are a cluster's particles.
   pure subroutine sum_eddy(kernel, block, p, alpha, i0, sums)
      type(kernel_t), intent(in) :: kernel
      type(candidates_t), intent(in) :: block
      type(particles_t), intent(in) :: p      !! base state, G, alpha_i and delta_i of all slots
      real(dp), intent(in) :: alpha           !! [1] that acts everywhere: the real viscosity's
      integer, intent(in) :: i0               !! slot before the block's first
      type(eddy_sums_t), intent(inout) :: sums
      integer :: c, k

      do c = 1, block%n_clusters
         k = (c - 1)*nl
         call lane_loop(block%first(c + 1) - block%first(c), block%slot(block%first(c):block%first(c + 1) - 1), &
                        size(p%base%x), p%base%x, p%base%y, p%base%u, p%base%v, p%base%s, p%base%volume, p%grad_x, p%grad_y, &
                        p%alpha, p%delta, alpha, i0 + k, kernel%inverse_support, sums%diffusion(k + 1:k + nl), &
                        sums%viscous_x(k + 1:k + nl), sums%viscous_y(k + 1:k + nl))
      end do
   end subroutine sum_eddy

   ! Explicit shapes and accumulators of fixed length keep the sums in vector registers.
   pure subroutine lane_loop(n_near, near, n, x, y, u, v, s, volume, gx, gy, a, d, alpha, i0, inverse_support, diffusion, &
                             viscous_x, viscous_y)
      integer, intent(in) :: n_near, near(n_near), n, i0
      real(dp), intent(in) :: x(n), y(n), u(n), v(n), s(n), volume(n), gx(n), gy(n), a(n), d(n), alpha, inverse_support
      real(dp), dimension(nl), intent(out) :: diffusion, viscous_x, viscous_y
      real(dp), dimension(nl) :: xi, yi, ui, vi, si, gxi, gyi, ai, di, total, ax, ay
      real(dp) :: dx, dy, g, unused, inverse_2, d_ij, pi_ij, alpha_ij, delta_ij
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
      total = 0
      ax = 0
      ay = 0
      do k = 1, n_near
         j = near(k)
         !$omp simd private(dx, dy, g, unused, inverse_2, d_ij, pi_ij, alpha_ij, delta_ij)
         do l = 1, nl
            dx = x(j) - xi(l)
            dy = y(j) - yi(l)
            call pair(dx, dy, inverse_support, volume(j), g, unused)
            call mean_coefficients(ai(l), a(j), di(l), d(j), squared_distance(dx, dy), alpha_ij, delta_ij, inverse_2)
            d_ij = 2*(s(j) - si(l)) - ((gxi(l) + gx(j))*dx + (gyi(l) + gy(j))*dy)
            total(l) = total(l) + delta_ij*(d_ij*g)
            pi_ij = ((u(j) - ui(l))*dx + (v(j) - vi(l))*dy)*inverse_2
            pi_ij = (alpha + alpha_ij)*(pi_ij*g)
            ax(l) = ax(l) + pi_ij*dx
            ay(l) = ay(l) + pi_ij*dy
         end do
      end do
      diffusion = total
      viscous_x = ax
      viscous_y = ay
   end subroutine lane_loop

end module eddy_sums
