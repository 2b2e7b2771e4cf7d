!> Where solids are drawn, and how they move: what their settings mean, in numbers.
module solid_outlines
   use kinds, only: dp
   use motions, only: free, motion_t, move_point, oscillating, pose_t, tabulated, uniform
   use polygons, only: polygon_area, polygon_centroid, polygon_second_moment, regular_polygon, turned
   use rigid_bodies, only: rigid_body_t
   use settings, only: motion_settings, settings_t, solid_settings
   use smooth_tables, only: new_acceleration_table, new_smooth_table
   implicit none
   private

   public :: n_corners, solid_outline, starting_outline, motion_of, body_of, shape_centroid, homogeneous_inertia, solid_radius

   real(dp), parameter :: pi = acos(-1.0_dp)
   real(dp), parameter :: degree = pi/180
   integer, parameter :: corners_range(2) = [24, 720]   ! of a polygon that stands for a disc
   integer, parameter :: per_spacing = 2                ! such corners for each dx of its circumference

contains

   !> How many vertices the outline of a solid has.
   pure integer function n_corners(scene, solid) result(n)
      type(settings_t), intent(in) :: scene
      type(solid_settings), intent(in) :: solid
      real(dp) :: corners

      select case (solid%shape)
      case ('rectangle')
         n = 4
      case ('disc')
         corners = min(real(corners_range(2), dp), per_spacing*2*pi*solid%radius/scene%spacing())
         n = max(corners_range(1), ceiling(corners))
      case default
         n = solid%vertices%n()/2
      end select
   end function n_corners

   !> A solid as it is drawn: turned by its angle about its pivot, not yet moved. Counter-clockwise if its vertices are; a disc
   !! is a regular polygon of the same area.
   pure function solid_outline(scene, solid) result(vertices)
      type(settings_t), intent(in) :: scene
      type(solid_settings), intent(in) :: solid          !! its pivot is known
      real(dp) :: vertices(2, n_corners(scene, solid))   !! [m]

      vertices = turned(shape_of(scene, solid), solid%pivot, solid%angle*degree)
   end function solid_outline

   !> A solid where it is at t = 0.
   pure function starting_outline(scene, solid, time) result(vertices)
      type(settings_t), intent(in) :: scene
      type(solid_settings), intent(in) :: solid
      real(dp), intent(in), optional :: time             !! [s] other than 0
      real(dp) :: vertices(2, n_corners(scene, solid))   !! [m]
      real(dp) :: place(2), velocity(2), acceleration(2)
      type(motion_t) :: motion
      type(pose_t) :: pose
      integer :: k

      vertices = solid_outline(scene, solid)
      motion = motion_of(solid)
      pose = motion%at(0.0_dp)
      if (present(time)) pose = motion%at(time)
      do k = 1, size(vertices, 2)
         call move_point(pose, solid%pivot, vertices(:, k), place, velocity, acceleration)
         vertices(:, k) = place
      end do
   end function starting_outline

   !> How a solid, or the tank, moves from where it is drawn.
   pure type(motion_t) function motion_of(moved) result(motion)
      class(motion_settings), intent(in) :: moved   !! with its table, if it follows one
      real(dp), allocatable :: rows(:, :)

      select case (moved%motion)
      case ('uniform', 'free')
         motion%kind = merge(free, uniform, moved%motion == 'free')
         motion%velocity = moved%velocity
         motion%spin = moved%spin*degree
      case ('oscillation', 'piston', 'flap')
         motion%kind = oscillating
         motion%amplitude = moved%amplitude
         motion%swing = moved%swing*degree
         motion%period = moved%period
         motion%phase = moved%phase*degree
         motion%ramp = moved%ramp
      case ('table')
         motion%kind = tabulated
         rows = transpose(reshape(moved%table%values, [4, moved%table%n()/4]))
         rows(:, 4) = rows(:, 4)*degree
         if (moved%table_of == 'acceleration') then
            motion%table = new_acceleration_table(rows(:, 1), rows(:, 2:))
         else
            motion%table = new_smooth_table(rows(:, 1), rows(:, 2:))
         end if
      end select
   end function motion_of

   !> What forces move of a solid.
   pure type(rigid_body_t) function body_of(solid) result(body)
      type(solid_settings), intent(in) :: solid   !! its moment of inertia is known

      if (solid%motion /= 'free') return
      associate (freedoms => solid%freedoms(:solid%n_freedoms))
         body%moves = [any(freedoms == 'x'), any(freedoms == 'y'), any(freedoms == 'angle')]
      end associate
      body%mass = solid%mass
      body%inertia = solid%moment_of_inertia
      body%stiffness = solid%stiffness
      body%damping = solid%damping
   end function body_of

   !> Moment of inertia of a solid about its pivot, if its mass is the same everywhere in its shape [kg m].
   pure real(dp) function homogeneous_inertia(scene, solid) result(inertia)
      type(settings_t), intent(in) :: scene
      type(solid_settings), intent(in) :: solid   !! its pivot is known
      real(dp) :: vertices(2, n_corners(scene, solid))

      vertices = shape_of(scene, solid)
      inertia = 0
      if (abs(polygon_area(vertices)) > 0) &
         inertia = solid%mass*polygon_second_moment(vertices, solid%pivot)/polygon_area(vertices)
   end function homogeneous_inertia

   !> Centroid of a solid's shape, not turned [m].
   pure function shape_centroid(scene, solid) result(centre)
      type(settings_t), intent(in) :: scene
      type(solid_settings), intent(in) :: solid
      real(dp) :: centre(2)

      select case (solid%shape)
      case ('rectangle')
         centre = (solid%lower + solid%upper)/2
      case ('disc')
         centre = solid%centre
      case default
         centre = polygon_centroid(shape_of(scene, solid))
      end select
   end function shape_centroid

   !> Largest distance of a solid's points from its pivot [m].
   pure real(dp) function solid_radius(scene, solid) result(radius)
      type(settings_t), intent(in) :: scene
      type(solid_settings), intent(in) :: solid
      real(dp) :: vertices(2, n_corners(scene, solid))
      integer :: k

      vertices = shape_of(scene, solid)
      radius = 0
      do k = 1, size(vertices, 2)
         radius = max(radius, norm2(vertices(:, k) - solid%pivot))
      end do
   end function solid_radius

   ! The vertices of a solid, not turned.
   pure function shape_of(scene, solid) result(vertices)
      type(settings_t), intent(in) :: scene
      type(solid_settings), intent(in) :: solid
      real(dp) :: vertices(2, n_corners(scene, solid))   ! [m]

      select case (solid%shape)
      case ('rectangle')
         vertices(1, :) = [solid%lower(1), solid%upper(1), solid%upper(1), solid%lower(1)]
         vertices(2, :) = [solid%lower(2), solid%lower(2), solid%upper(2), solid%upper(2)]
      case ('disc')
         vertices = regular_polygon(solid%centre, solid%radius, size(vertices, 2))
      case default
         vertices = reshape(solid%vertices%values, shape(vertices))
      end select
   end function shape_of

end module solid_outlines
