!> The box: its sides, what they are, where they are and how they move at a time; and particles that leave it.
!!
!! What lies beyond the sides, as the sums see it, is made of it in module `images`. Source of the crossing: ours,
!! docs/equations.md (Reflection, Periodic sides).
module box
   use kinds, only: dp
   implicit none
   private

   public :: box_t, inertia_t, find_bounds, is_wall, reflect, way_back, wrap

   integer, parameter, public :: left_wall = 1, right_wall = 2, bottom_wall = 3, top_wall = 4
   integer, parameter, public :: axis_of(4) = [1, 1, 2, 2]      !! that a side is across
   integer, parameter, public :: opposite(4) = [2, 1, 4, 3]
   integer, parameter, public :: inward(4) = [1, -1, 1, -1]     !! direction along its axis, from a side to the fluid

   integer, parameter, public :: open_side = 0        !! nothing
   integer, parameter, public :: free_slip_wall = 1   !! a mirror plane
   integer, parameter, public :: no_slip_wall = 2     !! one that the viscous terms see the tangential velocity reversed beyond
   integer, parameter, public :: periodic_side = 3    !! the same line as the opposite side

   !> What acts on the fluid because the box itself is moved, as it sees it: besides what would act if it stood.
   type :: inertia_t
      real(dp) :: pull(2) = 0     !! [m/s2] the same everywhere
      real(dp) :: spin = 0        !! [rad/s] of the box, counter-clockwise
      real(dp) :: spin_rate = 0   !! [rad/s2]
      real(dp) :: centre(2) = 0   !! [m] that it turns about
   contains
      procedure :: at => inertia_at
      procedure :: acts => inertia_acts
   end type inertia_t

   !> The sides in the order left, right, bottom, top, at one time.
   type :: box_t
      real(dp) :: time = 0                 !! [s] that it is for
      integer :: kind(4) = open_side
      real(dp) :: at(4) = 0                !! [m] x of left and right, y of bottom and top
      real(dp) :: velocity(2, 4) = 0       !! [m/s] of a wall's surface
      real(dp) :: density_slope(2) = 0     !! [kg/m4] rho0 g/c0**2, the gradient of rho across walls; 0 for the pure mirror
      type(inertia_t) :: inertia           !! where the box is moved
   contains
      procedure :: after
      procedure :: normal_velocity
      procedure :: has_wall
      procedure :: is_periodic
   end type box_t

contains

   !> Whether a kind of side is a wall.
   elemental logical function is_wall(kind)
      integer, intent(in) :: kind

      is_wall = kind == free_slip_wall .or. kind == no_slip_wall
   end function is_wall

   !> The box some time later; all sides move uniformly.
   pure type(box_t) function after(self, time) result(later)
      class(box_t), intent(in) :: self
      real(dp), intent(in) :: time   !! [s]

      later = self
      later%time = self%time + time
      later%at = self%at + time*self%normal_velocity()
   end function after

   !> Centrifugal, Euler and Coriolis force, and what acts everywhere [m/s2].
   pure function inertia_at(self, place, velocity) result(force)
      class(inertia_t), intent(in) :: self
      real(dp), intent(in) :: place(2), velocity(2)   !! in the box [m], as it sees it [m/s]
      real(dp) :: force(2), arm(2)

      arm = place - self%centre
      force = self%pull + self%spin**2*arm + self%spin_rate*[arm(2), -arm(1)] + 2*self%spin*[velocity(2), -velocity(1)]
   end function inertia_at

   !> Whether the box is moved so that something acts.
   pure logical function inertia_acts(self) result(acts)
      class(inertia_t), intent(in) :: self

      acts = any(abs([self%pull, self%spin, self%spin_rate]) > 0)
   end function inertia_acts

   !> Velocity of each side along the axis that it is across [m/s].
   pure function normal_velocity(self) result(velocity)
      class(box_t), intent(in) :: self
      real(dp) :: velocity(4)
      integer :: side

      velocity = [(self%velocity(axis_of(side), side), side=1, 4)]
   end function normal_velocity

   !> Whether a side is a wall.
   elemental logical function has_wall(self, side)
      class(box_t), intent(in) :: self
      integer, intent(in) :: side

      has_wall = is_wall(self%kind(side))
   end function has_wall

   !> Whether the sides across an axis are the same line.
   elemental logical function is_periodic(self, axis)
      class(box_t), intent(in) :: self
      integer, intent(in) :: axis   !! 1 or 2

      is_periodic = self%kind(2*axis) == periodic_side
   end function is_periodic

   !> Where particles may be without having crossed a side: from `lower` to `upper`.
   pure subroutine find_bounds(box, lower, upper)
      type(box_t), intent(in) :: box
      real(dp), intent(out) :: lower(2), upper(2)

      lower = merge(-huge(lower), box%at([left_wall, bottom_wall]), box%kind([left_wall, bottom_wall]) == open_side)
      upper = merge(huge(upper), box%at([right_wall, top_wall]), box%kind([right_wall, top_wall]) == open_side)
   end subroutine find_bounds

   !> Moves a particle that left through a periodic side back into the box, by whole periods.
   pure subroutine wrap(box, place)
      type(box_t), intent(in) :: box
      real(dp), intent(inout) :: place(2)
      integer :: axis

      do axis = 1, 2
         if (.not. box%is_periodic(axis)) cycle
         ! A coordinate inside keeps all its bits.
         associate (lower => box%at(2*axis - 1), upper => box%at(2*axis))
            if (place(axis) < lower .or. place(axis) > upper) place(axis) = lower + modulo(place(axis) - lower, upper - lower)
         end associate
      end do
   end subroutine wrap

   !> By how much a place beyond a periodic side is to be moved to be in the box, in whole periods.
   pure function way_back(box, place) result(way)
      type(box_t), intent(in) :: box
      real(dp), intent(in) :: place(2)
      real(dp) :: way(2)
      integer :: axis

      way = 0
      do axis = 1, 2
         if (.not. box%is_periodic(axis)) cycle
         associate (lower => box%at(2*axis - 1), period => box%at(2*axis) - box%at(2*axis - 1))
            way(axis) = -period*floor((place(axis) - lower)/period)
         end associate
      end do
   end function way_back

   !> Puts a particle that crossed a wall back inside, its normal velocity, as the wall sees it, pointing inwards.
   !!
   !! Where it is lifted against a force, its speed falls by what that takes, so that the crossing adds no energy; only a
   !! particle that is too slow even to reach the wall is put there.
   pure subroutine reflect(box, force, place, velocity, crossed)
      type(box_t), intent(in) :: box
      real(dp), intent(in) :: force(2)             !! gravity and all else that acts at the wall [m/s2]
      real(dp), intent(inout) :: place(2), velocity(2)
      logical, intent(out) :: crossed
      real(dp) :: relative
      integer :: side

      crossed = .false.
      do side = 1, 4
         if (.not. box%has_wall(side)) cycle
         associate (axis => axis_of(side), wall_speed => box%velocity(axis_of(side), side))
            if (.not. (box%at(side) - place(axis))*inward(side) > 0) cycle
            relative = velocity(axis) - wall_speed
            call mirror(place(axis), relative, box%at(side), inward(side), -inward(side)*force(axis))
            velocity(axis) = wall_speed + relative
            crossed = .true.
         end associate
      end do
   end subroutine reflect

   pure subroutine mirror(coordinate, velocity, wall, inward, pull)
      real(dp), intent(inout) :: coordinate, velocity
      real(dp), intent(in) :: wall
      integer, intent(in) :: inward       !! 1 or -1: towards the fluid
      real(dp), intent(in) :: pull        !! force towards the wall
      real(dp) :: depth

      depth = (wall - coordinate)*inward
      if (velocity**2 < 4*pull*depth) then
         ! Too slow to rise as far above the wall as it is below: it gets as high as its energy takes it.
         coordinate = wall + inward*max(0.0_dp, velocity**2/(2*pull) - depth)
         velocity = 0
      else
         velocity = sign(sqrt(velocity**2 - 4*pull*depth), real(inward, dp))
         coordinate = 2*wall - coordinate
      end if
   end subroutine mirror

end module box
