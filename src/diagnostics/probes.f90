!> Wall pressure sensors: the pressure averaged over a disc or a segment.
!!
!! A sensor of diameter D is a disc on the wall; in two dimensions that is an average over a segment, weighted by the
!! disc's chord. Pressure at a point is interpolated with the kernel over particles and images (Shepard).
module probes
   use communication, only: largest_of_all
   use box, only: bottom_wall, is_wall, left_wall, right_wall, top_wall
   use kinds, only: dp
   use model, only: model_t
   use neighbours, only: neighbours_t
   use particles, only: particles_t
   use point_sums, only: at_surface, sum_at
   use settings, only: probe_settings
   implicit none
   private

   public :: sensor_t, new_sensor, measure_sensors

   !> A disc or segment on a wall as quadrature points.
   type :: sensor_t
      real(dp), allocatable :: x(:), y(:)     !! (points)
      real(dp), allocatable :: weight(:)      !! (points), their sum is 1
   end type sensor_t

   real(dp), parameter :: pi = acos(-1.0_dp)

contains

   !> Along the wall nearest to the probe's position.
   pure type(sensor_t) function new_sensor(model, probe) result(sensor)
      type(model_t), intent(in) :: model
      type(probe_settings), intent(in) :: probe   !! a point if it has no size
      real(dp) :: distance(4), along(2), size_along, offset
      integer :: n, k

      size_along = max(probe%diameter, probe%length)
      n = 1
      ! Two points a spacing resolve what particles can.
      if (size_along > 0) n = min(255, 3 + 2*ceiling(size_along/model%dx))
      distance = abs(probe%position([1, 1, 2, 2]) - model%box%at)
      where (.not. is_wall(model%box%kind)) distance = huge(1.0_dp)
      along = [0.0_dp, size_along/2]
      if (minval(distance(bottom_wall:top_wall)) < minval(distance(left_wall:right_wall))) along = [size_along/2, 0.0_dp]
      allocate (sensor%x(n), sensor%y(n), sensor%weight(n))
      do k = 1, n
         if (probe%length > 0) then
            offset = (2*k - n - 1)/real(n, dp)   ! midpoints of n equal pieces
            sensor%weight(k) = 1.0_dp/n
         else
            ! Gauss-Chebyshev of the second kind: its weight function is the chord.
            offset = cos(k*pi/(n + 1))
            sensor%weight(k) = 2*(1 - offset**2)/(n + 1)
         end if
         sensor%x(k) = probe%position(1) + along(1)*offset
         sensor%y(k) = probe%position(2) + along(2)*offset
      end do
   end function new_sensor

   !> Pressure on each sensor in the base state; dry parts count as 0.
   function measure_sensors(model, p, near, sensors) result(pressure)
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      type(neighbours_t), intent(in) :: near
      type(sensor_t), intent(in) :: sensors(:)
      real(dp) :: pressure(size(sensors))
      real(dp), allocatable :: values(:)   ! at all points
      integer :: k, m, n

      n = sum([(size(sensors(k)%x), k=1, size(sensors))])
      allocate (values(n))
      n = 0
      do k = 1, size(sensors)
         do m = 1, size(sensors(k)%x)
            n = n + 1
            values(n) = -huge(1.0_dp)
            associate (x => sensors(k)%x(m), y => sensors(k)%y(m))
               if (near%computes(x)) values(n) = pressure_near(model, p, near, x, y)
            end associate
         end do
      end do
      call largest_of_all(n, values)   ! each is known to one process
      n = 0
      do k = 1, size(sensors)
         pressure(k) = 0
         do m = 1, size(sensors(k)%x)
            n = n + 1
            pressure(k) = pressure(k) + sensors(k)%weight(m)*values(n)
         end do
      end do
   end function measure_sensors

   !> sum_j p_j W V_j / max(sum_j W V_j, 1/2) at a point: the Shepard mean inside the fluid. Where the sum is less than at a
   !! free surface the point is outside, and what is missing counts as dry. So the pressure of a few particles that
   !! reach a dry sensor first is not spread over all of the kernel's width.
   pure real(dp) function pressure_near(model, p, near, x, y) result(pressure)
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      type(neighbours_t), intent(in) :: near
      real(dp), intent(in) :: x, y
      real(dp) :: volume

      call sum_at(model, p, near, x, y, volume, pressure)
      pressure = pressure/max(volume, at_surface)
   end function pressure_near

end module probes
