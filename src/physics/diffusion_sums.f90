!> Pair sum of the density diffusion that needs the neighbours' gradients, for a block of clusters.
!!
!! Source: eqs. 5 and 6 with constant delta. As D_ij . grad W = 2 [(rho_j - rho_i) - (G_i + G_j).r_ji/2] F,
!! the 1/r**2 of eq. 6 cancels and of the sum only sum_j G_j . r_ji F V_j is left for this second pass.
module diffusion_sums
   use candidates, only: block_slots, candidates_t
   use kernel, only: kernel_t, pair
   use kinds, only: dp
   use lanes, only: nl
   use particles, only: particles_t
   implicit none
   private

   public :: sum_diffusion

contains

   !> Sums over all candidates, without the kernel's constant factor.
   pure subroutine sum_diffusion(kernel, block, p, i0, neighbour_gradient)
      type(kernel_t), intent(in) :: kernel
      type(candidates_t), intent(in) :: block
      type(particles_t), intent(in) :: p      !! base state and G of all slots
      integer, intent(in) :: i0               !! slot before the block's first
      real(dp), intent(inout) :: neighbour_gradient(block_slots)   !! [kg/m] sum_j G_j . r_ji t**3 V_j
      integer :: c, k

      do c = 1, block%n_clusters
         k = (c - 1)*nl
         call lane_loop(block%first(c + 1) - block%first(c), block%slot(block%first(c):block%first(c + 1) - 1), &
                        size(p%base%x), p%base%x, p%base%y, p%base%volume, p%grad_x, p%grad_y, i0 + k, kernel%inverse_support, &
                        neighbour_gradient(k + 1:k + nl))
      end do
   end subroutine sum_diffusion

   ! Explicit shapes and accumulators of fixed length keep the sums in vector registers.
   pure subroutine lane_loop(n_near, near, n, x, y, volume, gx, gy, i0, inverse_support, neighbour_gradient)
      integer, intent(in) :: n_near, near(n_near), n, i0
      real(dp), intent(in) :: x(n), y(n), volume(n), gx(n), gy(n), inverse_support
      real(dp), intent(out) :: neighbour_gradient(nl)
      real(dp) :: xi(nl), yi(nl), total(nl)
      real(dp) :: dx, dy, g, unused
      integer :: k, j, l

      xi = x(i0 + 1:i0 + nl)
      yi = y(i0 + 1:i0 + nl)
      total = 0
      do k = 1, n_near
         j = near(k)
         !$omp simd private(dx, dy, g, unused)
         do l = 1, nl
            dx = x(j) - xi(l)
            dy = y(j) - yi(l)
            call pair(dx, dy, inverse_support, volume(j), g, unused)
            total(l) = total(l) + (gx(j)*dx + gy(j)*dy)*g
         end do
      end do
      neighbour_gradient = total
   end subroutine lane_loop

end module diffusion_sums
