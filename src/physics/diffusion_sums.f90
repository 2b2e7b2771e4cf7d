!> Pair sum of the density diffusion that needs the neighbours' gradients, for one cluster.
!!
!! Source: eqs. 5 and 6 with constant delta. As D_ij . grad W = 2 [(rho_j - rho_i) - (G_i + G_j).r_ji/2] F,
!! the 1/r**2 of eq. 6 cancels and of the sum only sum_j G_j . r_ji F V_j is left for this second pass.
module diffusion_sums
   use kinds, only: dp
   use kernel, only: kernel_t, root
   use lanes, only: nl
   use particles, only: particles_t
   use strips, only: ranges_t
   implicit none
   private

   public :: sum_diffusion

contains

   !> Sums over all slots in the cluster's ranges, without the kernel's constant factor.
   pure subroutine sum_diffusion(kernel, ranges, p, i0, neighbour_gradient)
      type(kernel_t), intent(in) :: kernel
      type(ranges_t), intent(in) :: ranges    !! slots to visit
      type(particles_t), intent(in) :: p      !! base state and G of all slots
      integer, intent(in) :: i0               !! slot before the cluster's first
      real(dp), intent(out) :: neighbour_gradient(nl)   !! sum_j G_j . r_ji t**3 V_j

      call lane_loop(ranges%n, ranges%first, ranges%last, size(p%base%x), p%base%x, p%base%y, p%base%w, &
                     p%grad_x, p%grad_y, i0, kernel%inverse_support, neighbour_gradient)
   end subroutine sum_diffusion

   ! Explicit shapes and accumulators of fixed length keep the sums in vector registers.
   pure subroutine lane_loop(n_ranges, first, last, n, x, y, w, gx, gy, i0, inverse_support, total)
      integer, intent(in) :: n_ranges, first(n_ranges), last(n_ranges), n, i0
      real(dp), intent(in) :: x(n), y(n), w(n), gx(n), gy(n), inverse_support
      real(dp), intent(out) :: total(nl)
      real(dp) :: xi(nl), yi(nl)
      real(dp) :: dx, dy, r, inverse, t
      integer :: k, j, l

      xi = x(i0 + 1:i0 + nl)
      yi = y(i0 + 1:i0 + nl)
      total = 0
      do k = 1, n_ranges
         do j = first(k), last(k)
            !$omp simd private(dx, dy, r, inverse, t)
            do l = 1, nl
               dx = x(j) - xi(l)
               dy = y(j) - yi(l)
               call root(dx*dx + (dy*dy + tiny(1.0_dp)), r, inverse)
               t = max(0.0_dp, 1 - inverse_support*r)
               total(l) = total(l) + (gx(j)*dx + gy(j)*dy)*(t*t*(t*w(j)))
            end do
         end do
      end do
   end subroutine lane_loop

end module diffusion_sums
