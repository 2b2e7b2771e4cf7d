!> Kernel sums over particles and images at a point.
module point_sums
   use equation_of_state, only: pressure_of
   use kernel, only: kernel_value
   use kinds, only: dp
   use model, only: model_t
   use neighbours, only: neighbours_t, ranges_around
   use particles, only: particles_t
   use strips, only: add_ranges, extent_t, ranges_t
   implicit none
   private

   public :: sum_at, sum_with_solids

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

      call ranges_around(near, x, y, model%kernel%support, ranges)
      call sum_ranges(model, p, ranges, x, y, volume, pressure)
   end subroutine sum_at

   !> The same, and in solids: their ghosts count as images do, for no more volume than the fluid has there. So a few particles that
   !! reach a dry face do not press on all of it.
   pure subroutine sum_with_solids(model, p, near, x, y, volume, pressure)
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      type(neighbours_t), intent(in) :: near
      real(dp), intent(in) :: x, y
      real(dp), intent(out) :: volume     !! [-]
      real(dp), intent(out) :: pressure
      real(dp) :: of_ghosts(2), share
      type(ranges_t) :: ranges

      call sum_at(model, p, near, x, y, volume, pressure)
      if (.not. near%ghosts%exist()) return
      call ghosts_around(near, x, y, model%kernel%support, ranges)
      call sum_ranges(model, p, ranges, x, y, of_ghosts(1), of_ghosts(2))
      if (.not. of_ghosts(1) > 0) return
      share = min(1.0_dp, volume/of_ghosts(1))
      volume = volume + share*of_ghosts(1)
      pressure = pressure + share*of_ghosts(2)
   end subroutine sum_with_solids

   ! Ghosts and their images that may be closer than `reach` to a point in the base state.
   pure subroutine ghosts_around(near, x, y, reach, ranges)
      type(neighbours_t), intent(in) :: near
      real(dp), intent(in) :: x, y, reach
      type(ranges_t), intent(out) :: ranges
      type(extent_t) :: point
      real(dp) :: time

      ! They were sorted by where they will be at `tau`, and go there with the velocity that they had then but for acceleration;
      ! those that walls cut stand elsewhere in their cells.
      associate (ghosts => near%ghosts)
         time = near%tau + near%age
         point = extent_t(lower=[x, y], upper=[x, y], slowest=0.0_dp, fastest=0.0_dp, &
                          slack=2*ghosts%strips%bin_height + ghosts%acceleration*time**2 + ghosts%creep*time)
         call add_ranges(ghosts%strips, point, reach, abs(near%tau - near%age), ranges)
         call add_ranges(ghosts%images%strips, point, reach, abs(near%tau - near%age), ranges)
      end associate
   end subroutine ghosts_around

   ! Over the slots of ranges.
   pure subroutine sum_ranges(model, p, ranges, x, y, volume, pressure)
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      type(ranges_t), intent(in) :: ranges
      real(dp), intent(in) :: x, y
      real(dp), intent(out) :: volume, pressure
      real(dp) :: squared, share
      integer :: k, j

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
   end subroutine sum_ranges

end module point_sums
