!> What no-slip walls add to the pair sums of one cluster of particles near them.
!!
!! Source: Colagrossi & Landrini 2003's mirror images with the tangential velocity reversed, in the viscous terms and
!! the rate of strain only (docs/equations.md). All other sums take the free-slip images, so the images' state is
!! that; here are the sums over the difference, `jump`, between an image's no-slip and free-slip velocity.
module no_slip_sums
   use kinds, only: dp
   use kernel, only: kernel_t, root
   use lanes, only: nl
   use particles, only: particles_t
   use strips, only: ranges_t
   implicit none
   private

   public :: friction_sums_t, sum_jump_gradient, sum_friction

   !> Sums of a cluster, without the kernel's constant factor F = factor t**3.
   type :: friction_sums_t
      real(dp) :: x(nl)       !! sum_j alpha_ij pi^jump_ij x_ji t**3 V_j
      real(dp) :: y(nl)
      real(dp) :: power(nl)   !! sum_j alpha_ij pi^jump_ij U_j.r_ji t**3 V_j, U_j the velocity of the image's wall
   end type friction_sums_t

contains

   !> Adds sum_j jump_j (x) r_ji t**3 V_j to the sums of the velocity gradient.
   pure subroutine sum_jump_gradient(kernel, ranges, p, i0, u_x, u_y, v_x, v_y)
      type(kernel_t), intent(in) :: kernel
      type(ranges_t), intent(in) :: ranges
      type(particles_t), intent(in) :: p
      integer, intent(in) :: i0               !! slot before the cluster's first
      real(dp), intent(inout), dimension(nl) :: u_x, u_y, v_x, v_y
      real(dp) :: dx, dy, r, inverse, t, g
      integer :: k, j, l

      do k = 1, ranges%n
         do j = max(ranges%first(k), p%n_own + 1), ranges%last(k)
            !$omp simd private(dx, dy, r, inverse, t, g)
            do l = 1, nl
               dx = p%base%x(j) - p%base%x(i0 + l)
               dy = p%base%y(j) - p%base%y(i0 + l)
               call root(dx*dx + (dy*dy + tiny(1.0_dp)), r, inverse)
               t = max(0.0_dp, 1 - kernel%inverse_support*r)
               g = t*t*(t*p%base%w(j))
               u_x(l) = u_x(l) + p%jump_u(j)*(g*dx)
               u_y(l) = u_y(l) + p%jump_u(j)*(g*dy)
               v_x(l) = v_x(l) + p%jump_v(j)*(g*dx)
               v_y(l) = v_y(l) + p%jump_v(j)*(g*dy)
            end do
         end do
      end do
   end subroutine sum_jump_gradient

   !> The viscous sum over the jumps: the walls' friction, and the power of walls that move.
   pure subroutine sum_friction(kernel, ranges, p, alpha, i0, sums)
      type(kernel_t), intent(in) :: kernel
      type(ranges_t), intent(in) :: ranges
      type(particles_t), intent(in) :: p
      real(dp), intent(in) :: alpha           !! that acts everywhere
      integer, intent(in) :: i0               !! slot before the cluster's first
      type(friction_sums_t), intent(out) :: sums
      real(dp) :: dx, dy, r, inverse, t, f
      integer :: k, j, l

      sums = friction_sums_t(0.0_dp, 0.0_dp, 0.0_dp)
      do k = 1, ranges%n
         do j = max(ranges%first(k), p%n_own + 1), ranges%last(k)
            !$omp simd private(dx, dy, r, inverse, t, f)
            do l = 1, nl
               dx = p%base%x(j) - p%base%x(i0 + l)
               dy = p%base%y(j) - p%base%y(i0 + l)
               call root(dx*dx + (dy*dy + tiny(1.0_dp)), r, inverse)
               t = max(0.0_dp, 1 - kernel%inverse_support*r)
               f = (p%jump_u(j)*dx + p%jump_v(j)*dy)*(inverse*inverse)*(t*t*(t*p%base%w(j)))
               f = f*(alpha + 2*p%alpha(i0 + l)*p%alpha(j)/(p%alpha(i0 + l) + p%alpha(j) + tiny(1.0_dp)))
               sums%x(l) = sums%x(l) + f*dx
               sums%y(l) = sums%y(l) + f*dy
               sums%power(l) = sums%power(l) + f*(p%wall_u(j)*dx + p%wall_v(j)*dy)
            end do
         end do
      end do
   end subroutine sum_friction

end module no_slip_sums
