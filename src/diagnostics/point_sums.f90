!> Kernel sums over particles and images at a point.
module point_sums
   use equation_of_state, only: pressure_of
   use kernel, only: kernel_value
   use kinds, only: dp
   use model, only: model_t
   use neighbours, only: neighbours_t, ranges_around
   use particles, only: particles_t
   use strips, only: ranges_t
   implicit none
   private

   public :: sum_at

   !> sum_j W V_j where a straight free surface passes; 1 inside the fluid and at walls, because images count.
   real(dp), parameter, public :: at_surface = 0.5_dp

contains

   !> Of the base state.
   pure subroutine sum_at(model, p, near, x, y, volume, pressure)
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      type(neighbours_t), intent(in) :: near
      real(dp), intent(in) :: x, y
      real(dp), intent(out) :: volume     !! sum_j W V_j [-]
      real(dp), intent(out) :: pressure   !! sum_j p_j W V_j
      type(ranges_t) :: ranges
      real(dp) :: squared, share
      integer :: k, j

      call ranges_around(near, x, y, model%kernel%support, ranges)
      volume = 0
      pressure = 0
      do k = 1, ranges%n
         do j = ranges%first(k), ranges%last(k)
            squared = (p%base%x(j) - x)**2 + (p%base%y(j) - y)**2
            if (squared >= model%kernel%support**2) cycle
            share = kernel_value(model%kernel, sqrt(squared))*p%base%volume(j)
            volume = volume + share
            pressure = pressure + share*p%base%s(j)
         end do
      end do
      pressure = pressure_of(model%c0, pressure)   ! of the smoothed density
   end subroutine sum_at

end module point_sums
