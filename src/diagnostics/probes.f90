!> Wall pressure sensors: the pressure averaged over a disc.
!!
!! A sensor of diameter D is a disc on the wall; in two dimensions that is an average over a segment, weighted by the
!! disc's chord. Pressure at a point is interpolated with the kernel over particles and images (Shepard).
module probes
   use images, only: bottom_wall, left_wall, right_wall, top_wall
   use kernel, only: kernel_value
   use kinds, only: dp
   use model, only: model_t
   use neighbours, only: neighbours_t, ranges_around
   use particles, only: particles_t
   use strips, only: ranges_t
   implicit none
   private

   public :: sensor_t, new_sensor, measure_sensor

   !> A disc on a wall as quadrature points.
   type :: sensor_t
      real(dp), allocatable :: x(:), y(:)     !! (points)
      real(dp), allocatable :: weight(:)      !! (points), their sum is 1
   end type sensor_t

   real(dp), parameter :: pi = acos(-1.0_dp)

contains

   !> Sensor around `centre`, along the wall nearest to it.
   pure type(sensor_t) function new_sensor(model, centre, diameter) result(sensor)
      type(model_t), intent(in) :: model
      real(dp), intent(in) :: centre(2)
      real(dp), intent(in) :: diameter   !! 0 for a point
      real(dp) :: distance(4), along(2), angle
      integer :: n, k

      n = 1
      ! Two points a spacing resolve what particles can.
      if (diameter > 0) n = min(255, 3 + 2*ceiling(diameter/model%dx))
      distance = abs(centre([1, 1, 2, 2]) - model%walls%at)
      where (.not. model%walls%present) distance = huge(1.0_dp)
      along = [0.0_dp, diameter/2]
      if (minval(distance(bottom_wall:top_wall)) < minval(distance(left_wall:right_wall))) along = [diameter/2, 0.0_dp]
      allocate (sensor%x(n), sensor%y(n), sensor%weight(n))
      do k = 1, n
         ! Gauss-Chebyshev of the second kind: its weight function is the chord.
         angle = k*pi/(n + 1)
         sensor%x(k) = centre(1) + along(1)*cos(angle)
         sensor%y(k) = centre(2) + along(2)*cos(angle)
         sensor%weight(k) = 2*sin(angle)**2/(n + 1)
      end do
   end function new_sensor

   !> Pressure on the sensor in the base state; dry parts count as 0.
   pure real(dp) function measure_sensor(model, p, near, sensor) result(pressure)
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      type(neighbours_t), intent(in) :: near
      type(sensor_t), intent(in) :: sensor
      integer :: k

      pressure = 0
      do k = 1, size(sensor%x)
         pressure = pressure + sensor%weight(k)*pressure_near(model, p, near, sensor%x(k), sensor%y(k))
      end do
   end function measure_sensor

   !> sum_j p_j W V_j / max(sum_j W V_j, 1/2) at a point: the Shepard mean inside the fluid, where sum_j W V_j is 1. At a
   !! free surface it is 1/2; where it is less, the point is outside, and what is missing counts as dry. So the force of a
   !! few particles that reach a dry sensor first is not spread over all of the kernel's width.
   pure real(dp) function pressure_near(model, p, near, x, y) result(pressure)
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      type(neighbours_t), intent(in) :: near
      real(dp), intent(in) :: x, y
      real(dp), parameter :: at_surface = 0.5_dp
      type(ranges_t) :: ranges
      real(dp) :: weight, total, squared, share
      integer :: k, j

      call ranges_around(near, x, y, model%kernel%support, ranges)
      weight = 0
      total = 0
      do k = 1, ranges%n
         do j = ranges%first(k), ranges%last(k)
            squared = (p%base%x(j) - x)**2 + (p%base%y(j) - y)**2
            if (squared >= model%kernel%support**2) cycle
            share = kernel_value(model%kernel, sqrt(squared))*p%base%w(j)
            weight = weight + share
            total = total + share*p%base%s(j)
         end do
      end do
      pressure = model%c0**2*total/max(weight, at_surface)
   end function pressure_near

end module probes
