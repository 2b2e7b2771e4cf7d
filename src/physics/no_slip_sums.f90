!> What no-slip walls add to the pair sums of a block: sums over the images of the particles near them.
!!
!! Source: Colagrossi & Landrini 2003's mirror images with the tangential velocity reversed, in the viscous terms and
!! the rate of strain only (docs/equations.md). All other sums take the free-slip images, so the images' state is
!! that; here are the sums over the difference, `jump`, between an image's no-slip and free-slip velocity.
module no_slip_sums
   use candidates, only: block_slots, candidates_t
   use first_sums, only: first_sums_t
   use harmonic_means, only: mean_coefficients
   use kernel, only: kernel_t, pair, squared_distance
   use kinds, only: dp
   use lanes, only: nl
   use particles, only: particles_t
   implicit none
   private

   public :: friction_sums_t, sum_jump_gradient, sum_friction

   !> Sums of a block, without the kernel's constant factor F = factor t**3.
   type :: friction_sums_t
      real(dp) :: x(block_slots)       !! [m3/s] sum_j alpha_ij pi^jump_ij x_ji t**3 V_j
      real(dp) :: y(block_slots)   !! [m3/s]
      real(dp) :: power(block_slots)   !! [m4/s2] sum_j alpha_ij pi^jump_ij U_j.r_ji t**3 V_j, U_j the velocity of the image's wall
   end type friction_sums_t

contains

   !> Adds sum_j jump_j (x) r_ji t**3 V_j to the sums of the velocity gradient.
   pure subroutine sum_jump_gradient(kernel, block, p, i0, sums)
      type(kernel_t), intent(in) :: kernel
      type(candidates_t), intent(in) :: block
      type(particles_t), intent(in) :: p
      integer, intent(in) :: i0                    !! slot before the block's first
      type(first_sums_t), intent(inout) :: sums    !! u_x, u_y, v_x, v_y change
      real(dp) :: dx, dy, g, unused
      integer :: c, k, j, l

      do c = 1, block%n_clusters
         do k = block%first_image(c), block%first(c + 1) - 1
            j = block%slot(k)
            !$omp simd private(dx, dy, g, unused)
            do l = (c - 1)*nl + 1, c*nl
               dx = p%base%x(j) - p%base%x(i0 + l)
               dy = p%base%y(j) - p%base%y(i0 + l)
               call pair(dx, dy, kernel%inverse_support, p%base%volume(j), g, unused)
               sums%u_x(l) = sums%u_x(l) + p%jump_u(j)*(g*dx)
               sums%u_y(l) = sums%u_y(l) + p%jump_u(j)*(g*dy)
               sums%v_x(l) = sums%v_x(l) + p%jump_v(j)*(g*dx)
               sums%v_y(l) = sums%v_y(l) + p%jump_v(j)*(g*dy)
            end do
         end do
      end do
   end subroutine sum_jump_gradient

   !> The viscous sum over the jumps: the walls' friction, and the power of walls that move.
   pure subroutine sum_friction(kernel, block, p, alpha, i0, sums)
      type(kernel_t), intent(in) :: kernel
      type(candidates_t), intent(in) :: block
      type(particles_t), intent(in) :: p
      real(dp), intent(in) :: alpha           !! [1] that acts everywhere
      integer, intent(in) :: i0               !! slot before the block's first
      type(friction_sums_t), intent(inout) :: sums
      real(dp) :: dx, dy, g, inverse_2, alpha_ij, unused, f
      integer :: c, k, j, l

      sums%x = 0
      sums%y = 0
      sums%power = 0
      do c = 1, block%n_clusters
         do k = block%first_image(c), block%first(c + 1) - 1
            j = block%slot(k)
            !$omp simd private(dx, dy, g, inverse_2, alpha_ij, unused, f)
            do l = (c - 1)*nl + 1, c*nl
               dx = p%base%x(j) - p%base%x(i0 + l)
               dy = p%base%y(j) - p%base%y(i0 + l)
               call pair(dx, dy, kernel%inverse_support, p%base%volume(j), g, unused)
               call mean_coefficients(p%alpha(i0 + l), p%alpha(j), 1.0_dp, 1.0_dp, squared_distance(dx, dy), alpha_ij, unused, &
                                      inverse_2)
               f = (alpha + alpha_ij)*(p%jump_u(j)*dx + p%jump_v(j)*dy)*inverse_2*g
               sums%x(l) = sums%x(l) + f*dx
               sums%y(l) = sums%y(l) + f*dy
               sums%power(l) = sums%power(l) + f*(p%wall_u(j)*dx + p%wall_v(j)*dy)
            end do
         end do
      end do
   end subroutine sum_friction

end module no_slip_sums
