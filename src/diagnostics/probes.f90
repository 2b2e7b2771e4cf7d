!> Pressure sensors on walls and solids: the pressure averaged over a disc or a segment.
!!
!! A sensor of diameter D is a disc on the wall or face; in two dimensions that is an average over a segment, weighted by the
!! disc's chord. Pressure at a point is interpolated with the kernel over particles and images (Shepard),
!! and ghosts of solids.
module probes
   use communication, only: largest_of_all
   use box, only: bottom_wall, is_wall, left_wall, right_wall, top_wall, way_back
   use kinds, only: dp
   use model, only: model_t
   use motions, only: move_point
   use neighbours, only: neighbours_t
   use particles, only: particles_t
   use point_sums, only: at_surface, sum_with_solids
   use polygons, only: nearest_edge
   use settings, only: probe_settings
   use solids, only: new_obstacle, obstacle_t
   implicit none
   private

   public :: sensor_t, new_sensor, measure_sensors

   !> A disc or segment on a wall or solid as quadrature points.
   type :: sensor_t
      integer :: solid = 0                    !! that it is on and moves with; 0: it is on a wall
      real(dp), allocatable :: x(:), y(:)     !! (points) [m]; on a solid, where it is drawn
      real(dp), allocatable :: weight(:)      !! (points), their sum is 1
   end type sensor_t

   real(dp), parameter :: pi = acos(-1.0_dp)

contains

   !> Along the wall or face of a solid, as drawn, that is nearest to the probe's position.
   pure type(sensor_t) function new_sensor(model, probe) result(sensor)
      type(model_t), intent(in) :: model
      type(probe_settings), intent(in) :: probe   !! a point if it has no size
      real(dp) :: along(2), size_along, offset
      integer :: n, k

      size_along = max(probe%diameter, probe%length)
      n = 1
      ! Two points a spacing resolve what particles can.
      if (size_along > 0) n = min(255, 3 + 2*ceiling(size_along/model%dx))
      call find_support(model, probe%position, sensor%solid, along)
      along = along*size_along/2
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

   ! What a probe is on, and the direction along that.
   pure subroutine find_support(model, position, solid, along)
      type(model_t), intent(in) :: model
      real(dp), intent(in) :: position(2)
      integer, intent(out) :: solid       ! 0: a wall
      real(dp), intent(out) :: along(2)   ! of length 1
      type(obstacle_t) :: at_start
      real(dp) :: distance(4), nearest, gap, foot(2), normal(2)
      integer :: edge, k

      distance = abs(position([1, 1, 2, 2]) - model%box%at)
      where (.not. is_wall(model%box%kind)) distance = huge(1.0_dp)
      along = [0.0_dp, 1.0_dp]
      if (minval(distance(bottom_wall:top_wall)) < minval(distance(left_wall:right_wall))) along = [1.0_dp, 0.0_dp]
      solid = 0
      if (.not. model%has_solids()) return
      nearest = minval(distance)
      do k = 1, size(model%solids)
         at_start = new_obstacle(model%solids(k), model%solids(k)%motion%at(0.0_dp), model%box)
         call nearest_edge(model%solids(k)%outline, at_start%is_face, position, edge, gap, foot, normal)
         if (edge == 0 .or. gap >= nearest) cycle
         nearest = gap
         solid = k
         along = [-normal(2), normal(1)]
      end do
   end subroutine find_support

   !> Pressure on each sensor in the base state; dry parts count as 0.
   function measure_sensors(model, p, near, sensors) result(pressure)
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      type(neighbours_t), intent(in) :: near
      type(sensor_t), intent(in) :: sensors(:)
      real(dp) :: pressure(size(sensors))
      real(dp), allocatable :: values(:)   ! at all points
      real(dp) :: place(2)
      integer :: k, m, n

      n = sum([(size(sensors(k)%x), k=1, size(sensors))])
      allocate (values(n))
      n = 0
      do k = 1, size(sensors)
         do m = 1, size(sensors(k)%x)
            n = n + 1
            values(n) = -huge(1.0_dp)
            place = place_at(model, near, sensors(k), m)
            if (near%computes(place(1))) values(n) = pressure_near(model, p, near, place(1), place(2))
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

   ! Where a sensor's point is.
   pure function place_at(model, near, sensor, m) result(place)
      type(model_t), intent(in) :: model
      type(neighbours_t), intent(in) :: near
      type(sensor_t), intent(in) :: sensor
      integer, intent(in) :: m
      real(dp) :: place(2), drawn(2), velocity(2), acceleration(2)

      place = [sensor%x(m), sensor%y(m)]
      if (sensor%solid == 0) return
      drawn = place
      associate (solid => model%solids(sensor%solid))
         call move_point(near%ghosts%poses(sensor%solid), solid%pivot, drawn, place, velocity, acceleration)
         place = place + way_back(model%box, place)
      end associate
   end function place_at

   !> sum_j p_j W V_j / max(sum_j W V_j, 1/2) at a point: the Shepard mean inside the fluid. Where the sum is less than at a
   !! free surface the point is outside, and what is missing counts as dry. So the pressure of a few particles that
   !! reach a dry sensor first is not spread over all of the kernel's width.
   pure real(dp) function pressure_near(model, p, near, x, y) result(pressure)
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      type(neighbours_t), intent(in) :: near
      real(dp), intent(in) :: x, y
      real(dp) :: volume

      call sum_with_solids(model, p, near, x, y, volume, pressure)
      pressure = pressure/max(volume, at_surface)
   end function pressure_near

end module probes
