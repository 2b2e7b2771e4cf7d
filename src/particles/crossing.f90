!> Particles that left the box in a step: put back behind walls, moved by a period at periodic sides.
!!
!! Source: ours, docs/equations.md (Reflection, Periodic sides).
module crossing
   use images, only: bottom_wall, left_wall, right_wall, top_wall, walls_t
   use kinds, only: dp
   implicit none
   private

   public :: outside, reflect, wrap

contains

   !> Whether a position is behind a wall or beyond a periodic side.
   elemental logical function outside(walls, x, y)
      type(walls_t), intent(in) :: walls
      real(dp), intent(in) :: x, y

      outside = ((walls%present(left_wall) .or. walls%periodic(1)) .and. x < walls%at(left_wall)) &
                .or. ((walls%present(right_wall) .or. walls%periodic(1)) .and. x > walls%at(right_wall)) &
                .or. ((walls%present(bottom_wall) .or. walls%periodic(2)) .and. y < walls%at(bottom_wall)) &
                .or. ((walls%present(top_wall) .or. walls%periodic(2)) .and. y > walls%at(top_wall))
   end function outside

   !> Moves a particle that left through a periodic side back into the box, by whole periods.
   pure subroutine wrap(walls, x, y)
      type(walls_t), intent(in) :: walls
      real(dp), intent(inout) :: x, y

      if (walls%periodic(1)) call wrap_one(walls%at(left_wall), walls%at(right_wall), x)
      if (walls%periodic(2)) call wrap_one(walls%at(bottom_wall), walls%at(top_wall), y)
   end subroutine wrap

   ! A coordinate inside keeps all its bits.
   pure subroutine wrap_one(lower, upper, coordinate)
      real(dp), intent(in) :: lower, upper
      real(dp), intent(inout) :: coordinate

      if (coordinate < lower .or. coordinate > upper) coordinate = lower + modulo(coordinate - lower, upper - lower)
   end subroutine wrap_one

   !> Puts a particle that crossed a wall back inside, its normal velocity pointing inwards.
   !!
   !! Where it is lifted against a force, its speed falls by what that takes, so that the crossing adds no energy; only a
   !! particle that is too slow even to reach the wall is put there.
   pure subroutine reflect(walls, force, x, y, u, v, crossed)
      type(walls_t), intent(in) :: walls
      real(dp), intent(in) :: force(2)             !! gravity and all else that acts at the wall [length/time^2]
      real(dp), intent(inout) :: x, y, u, v
      logical, intent(out) :: crossed

      crossed = .false.
      if (walls%present(left_wall)) call mirror(x, u, walls%at(left_wall), 1, -force(1), crossed)
      if (walls%present(right_wall)) call mirror(x, u, walls%at(right_wall), -1, force(1), crossed)
      if (walls%present(bottom_wall)) call mirror(y, v, walls%at(bottom_wall), 1, -force(2), crossed)
      if (walls%present(top_wall)) call mirror(y, v, walls%at(top_wall), -1, force(2), crossed)
   end subroutine reflect

   pure subroutine mirror(coordinate, velocity, wall, inward, pull, crossed)
      real(dp), intent(inout) :: coordinate, velocity
      real(dp), intent(in) :: wall
      integer, intent(in) :: inward       !! 1 or -1: towards the fluid
      real(dp), intent(in) :: pull        !! force towards the wall
      logical, intent(inout) :: crossed
      real(dp) :: depth

      depth = (wall - coordinate)*inward
      if (.not. depth > 0) return
      crossed = .true.
      if (velocity**2 < 4*pull*depth) then
         ! Too slow to rise as far above the wall as it is below: it gets as high as its energy takes it.
         coordinate = wall + inward*max(0.0_dp, velocity**2/(2*pull) - depth)
         velocity = 0
      else
         velocity = sign(sqrt(velocity**2 - 4*pull*depth), real(inward, dp))
         coordinate = 2*wall - coordinate
      end if
   end subroutine mirror

end module crossing
