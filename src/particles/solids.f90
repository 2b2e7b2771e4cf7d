!> Rigid bodies in the fluid: their outlines, where they are at a time, and particles that got into them.
!!
!! Source: ours (docs/equations.md, Solid bodies).
module solids
   use box, only: axis_of, box_t, inward, is_wall
   use kinds, only: dp
   use motions, only: motion_t, move_point, pose_t
   use polygons, only: edge_normal, is_inside, nearest_edge
   use rigid_bodies, only: rigid_body_t
   implicit none
   private

   public :: solid_t, obstacle_t, new_obstacle, obstacles_in, walls_crossed, cover, push_out

   !> A solid as it is drawn: before its motion.
   type :: solid_t
      real(dp), allocatable :: outline(:, :)   !! (2, n) [m] corners, counter-clockwise
      real(dp) :: pivot(2) = 0                 !! [m] that it turns about, and that moments are about
      real(dp) :: angle = 0                    !! [rad] that its shape was turned by
      logical :: no_slip = .false.             !! the fluid sticks to it
      type(motion_t) :: motion
      type(rigid_body_t) :: body               !! what forces move, if they do
   contains
      procedure :: radius
   end type solid_t

   !> A solid at one time.
   type :: obstacle_t
      integer :: number = 0                    !! of the solid
      type(pose_t) :: pose
      real(dp) :: pivot(2) = 0                 !! [m] at this time
      real(dp), allocatable :: outline(:, :)   !! (2, n) [m]
      real(dp), allocatable :: normal(:, :)    !! (2, n) of edges, outwards
      logical, allocatable :: is_face(:)       !! (n) of edges: fluid can be beyond it
      real(dp) :: lower(2) = 0, upper(2) = 0   !! [m] around it
   contains
      procedure :: velocity_at
      procedure :: covers
      procedure :: reaches_through
   end type obstacle_t

contains

   !> The farthest that a corner is from the pivot [m].
   pure real(dp) function radius(self)
      class(solid_t), intent(in) :: self

      radius = sqrt(maxval((self%outline(1, :) - self%pivot(1))**2 + (self%outline(2, :) - self%pivot(2))**2))
   end function radius

   !> The solid in a pose.
   pure type(obstacle_t) function new_obstacle(solid, pose, box) result(self)
      type(solid_t), intent(in) :: solid
      type(pose_t), intent(in) :: pose
      type(box_t), intent(in) :: box
      real(dp) :: velocity(2), acceleration(2)
      integer :: k

      self%pose = pose
      self%pivot = solid%pivot + self%pose%shift
      associate (n => size(solid%outline, 2))
         allocate (self%outline(2, n), self%normal(2, n), self%is_face(n))
      end associate
      do k = 1, size(solid%outline, 2)
         call move_point(self%pose, solid%pivot, solid%outline(:, k), self%outline(:, k), velocity, acceleration)
      end do
      do k = 1, size(self%outline, 2)
         self%normal(:, k) = edge_normal(self%outline, k)
      end do
      self%is_face(:) = reachable_faces(self%outline, box)
      self%lower = minval(self%outline, 2)
      self%upper = maxval(self%outline, 2)
   end function new_obstacle

   !> All solids in their poses; where sides are periodic, as often as they reach into the box, or a little beside it.
   pure function obstacles_in(solids, poses, box) result(obstacles)
      type(solid_t), intent(in) :: solids(:)
      type(pose_t), intent(in) :: poses(:)     !! (solids)
      type(box_t), intent(in) :: box
      type(obstacle_t), allocatable :: obstacles(:)
      real(dp), parameter :: beside = 0.1_dp   ! of the box: more than a particle has left it by in a step
      type(obstacle_t) :: one
      real(dp) :: lower(2), upper(2), period(2)
      integer :: first(2), last(2), i, j, k

      allocate (obstacles(0))
      period = box%at([2, 4]) - box%at([1, 3])
      lower = box%at([1, 3]) - beside*period
      upper = box%at([2, 4]) + beside*period
      do k = 1, size(solids)
         one = new_obstacle(solids(k), poses(k), box)
         one%number = k
         first = 0
         last = 0
         where (box%is_periodic([1, 2]))
            first = ceiling((lower - one%upper)/period)
            last = floor((upper - one%lower)/period)
         end where
         do j = first(2), last(2)
            do i = first(1), last(1)
               obstacles = [obstacles, moved_by(one, [i*period(1), j*period(2)])]
            end do
         end do
      end do
   end function obstacles_in

   ! The same elsewhere. A way of 0 changes no bit.
   pure type(obstacle_t) function moved_by(obstacle, way) result(moved)
      type(obstacle_t), intent(in) :: obstacle
      real(dp), intent(in) :: way(2)

      moved = obstacle
      moved%pivot = obstacle%pivot + way
      moved%outline = obstacle%outline + spread(way, 2, size(obstacle%outline, 2))
      moved%lower = obstacle%lower + way
      moved%upper = obstacle%upper + way
   end function moved_by

   ! Edges that are not on, or beyond, a wall of the box.
   pure function reachable_faces(outline, box) result(is_face)
      real(dp), intent(in) :: outline(:, :)
      type(box_t), intent(in) :: box
      logical :: is_face(size(outline, 2))
      real(dp), parameter :: rounding = 1.0e-9_dp   ! of the box's size
      integer :: k, side
      real(dp) :: margin

      margin = rounding*max(box%at(2) - box%at(1), box%at(4) - box%at(3))
      is_face = .true.
      do side = 1, 4
         if (.not. is_wall(box%kind(side))) cycle
         do k = 1, size(outline, 2)
            associate (from => outline(axis_of(side), k), to => outline(axis_of(side), mod(k, size(outline, 2)) + 1))
               if (max(inward(side)*(from - box%at(side)), inward(side)*(to - box%at(side))) <= margin) is_face(k) = .false.
            end associate
         end do
      end do
   end function reachable_faces

   !> Velocity of a point that moves with the solid [m/s].
   pure function velocity_at(self, place) result(velocity)
      class(obstacle_t), intent(in) :: self
      real(dp), intent(in) :: place(2)
      real(dp) :: velocity(2)

      velocity = self%pose%velocity + self%pose%spin*[self%pivot(2) - place(2), place(1) - self%pivot(1)]
   end function velocity_at

   !> Whether a point is in it.
   pure logical function covers(self, place)
      class(obstacle_t), intent(in) :: self
      real(dp), intent(in) :: place(2)

      covers = all(place >= self%lower .and. place <= self%upper)
      if (covers) covers = is_inside(self%outline, place)
   end function covers

   !> Which walls the solid reaches through.
   pure function reaches_through(self, box) result(through)
      class(obstacle_t), intent(in) :: self
      type(box_t), intent(in) :: box   !! at the solid's time
      logical :: through(4)

      through = walls_crossed(box, self%lower, self%upper)
   end function reaches_through

   !> Walls that something reaches beyond.
   pure function walls_crossed(box, lower, upper) result(crossed)
      type(box_t), intent(in) :: box
      real(dp), intent(in) :: lower(2), upper(2)   !! [m] corners of the box around it
      logical :: crossed(4)

      crossed = is_wall(box%kind) .and. [lower(1) < box%at(1), upper(1) > box%at(2), lower(2) < box%at(3), upper(2) > box%at(4)]
   end function walls_crossed

   !> Which solid a point is in; 0 for none.
   pure integer function cover(obstacles, place) result(number)
      type(obstacle_t), intent(in) :: obstacles(:)
      real(dp), intent(in) :: place(2)

      do number = 1, size(obstacles)
         if (obstacles(number)%covers(place)) return
      end do
      number = 0
   end function cover

   !> Puts a particle that got into a solid back, as far before the nearest face as it was behind it; its normal velocity, as the
   !! face sees it, points outwards then, and is less by what lifting it takes.
   pure subroutine push_out(obstacle, force, place, velocity)
      type(obstacle_t), intent(in) :: obstacle
      real(dp), intent(in) :: force(2)             !! gravity and all else that acts there [m/s2]
      real(dp), intent(inout) :: place(2), velocity(2)
      real(dp) :: foot(2), normal(2), wall(2), distance, normal_speed
      integer :: edge

      call nearest_edge(obstacle%outline, obstacle%is_face, place, edge, distance, foot, normal)
      if (edge == 0) return
      wall = obstacle%velocity_at(foot)
      normal_speed = dot_product(velocity - wall, normal)
      velocity = velocity + normal*(sqrt(max(0.0_dp, normal_speed**2 + 4*distance*dot_product(force, normal))) - normal_speed)
      place = foot + distance*normal
   end subroutine push_out

end module solids
