!> Friction at no-slip walls: added to the frozen viscous acceleration.
module no_slip
   use kinds, only: dp
   use lanes, only: nl
   use model, only: model_t
   use no_slip_sums, only: friction_sums_t, sum_friction, sum_jump_gradient
   use particles, only: particles_t
   use strain_sums, only: strain_sums_t
   use strips, only: ranges_t
   implicit none
   private

   public :: add_friction, add_wall_shear

contains

   !> Adds the friction of a cluster's walls to its viscous acceleration.
   pure subroutine add_friction(model, ranges, p, i0, power)
      type(model_t), intent(in) :: model
      type(ranges_t), intent(in) :: ranges
      type(particles_t), intent(inout) :: p   !! visc_x, visc_y of the cluster change
      integer, intent(in) :: i0               !! slot before the cluster's first
      real(dp), intent(inout) :: power        !! what moving walls give is added
      type(friction_sums_t) :: sums
      real(dp) :: factor(nl)

      if (ranges%n == 0) return
      if (ranges%last(ranges%n) <= p%n_own) return
      call sum_friction(model%kernel, ranges, p, model%alpha, i0, sums)
      factor = model%kernel%h*model%c0*model%kernel%gradient_factor*model%rho0/(model%rho0 + p%base%s(i0 + 1:i0 + nl))
      p%visc_x(i0 + 1:i0 + nl) = p%visc_x(i0 + 1:i0 + nl) + factor*sums%x
      p%visc_y(i0 + 1:i0 + nl) = p%visc_y(i0 + 1:i0 + nl) + factor*sums%y
      power = power + sum(p%m(i0 + 1:i0 + nl)*factor*sums%power)
   end subroutine add_friction

   !> Adds what a cluster's no-slip walls change in its velocity gradient.
   pure subroutine add_wall_shear(model, ranges, p, i0, sums)
      type(model_t), intent(in) :: model
      type(ranges_t), intent(in) :: ranges
      type(particles_t), intent(in) :: p
      integer, intent(in) :: i0
      type(strain_sums_t), intent(inout) :: sums

      if (ranges%n == 0) return
      if (ranges%last(ranges%n) <= p%n_own) return
      call sum_jump_gradient(model%kernel, ranges, p, i0, sums%u_x, sums%u_y, sums%v_x, sums%v_y)
   end subroutine add_wall_shear

end module no_slip
