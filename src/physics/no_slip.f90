!> Friction at no-slip walls: added to the frozen viscous acceleration.
module no_slip
   use candidates, only: candidates_t
   use kinds, only: dp
   use model, only: model_t
   use no_slip_sums, only: friction_sums_t, sum_friction
   use particles, only: particles_t
   use strips, only: group_slots
   implicit none
   private

   public :: add_friction

contains

   !> Adds the friction of a block's walls to its viscous acceleration.
   pure subroutine add_friction(model, block, p, i0, n, power)
      type(model_t), intent(in) :: model
      type(candidates_t), intent(in) :: block
      type(particles_t), intent(inout) :: p   !! visc_x, visc_y of the block change
      integer, intent(in) :: i0, n            !! slot before the block's first; slots
      real(dp), intent(inout) :: power(:)     !! (groups) [W/m] what moving walls give is added
      type(friction_sums_t) :: sums
      real(dp) :: factor
      integer :: g, k

      if (.not. any(block%first_image(:block%n_clusters) < block%first(2:block%n_clusters + 1))) return
      call sum_friction(model%kernel, block, p, model%alpha, i0, sums)
      do k = 1, n
         factor = model%kernel%h*model%c0*model%kernel%gradient_factor*model%rho0/(model%rho0 + p%base%s(i0 + k))
         p%visc_x(i0 + k) = p%visc_x(i0 + k) + factor*sums%x(k)
         p%visc_y(i0 + k) = p%visc_y(i0 + k) + factor*sums%y(k)
         g = 1 + (k - 1)/group_slots
         power(g) = power(g) + p%m(i0 + k)*factor*sums%power(k)
      end do
   end subroutine add_friction

end module no_slip
