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
   !! Where it is lifted against gravity, its speed falls by what it gains in height, so that the crossing adds no
   !! energy; only a particle that is too slow even to reach the floor is put there.
   pure subroutine reflect(walls, gravity, x, y, u, v, crossed)
      type(walls_t), intent(in) :: walls
      real(dp), intent(in) :: gravity              !! along -y
      real(dp), intent(inout) :: x, y, u, v
      logical, intent(out) :: crossed
      real(dp) :: depth

      crossed = .false.
      if (walls%present(left_wall)) call mirror(x, u, walls%at(left_wall), 1.0_dp, crossed)
      if (walls%present(right_wall)) call mirror(x, u, walls%at(right_wall), -1.0_dp, crossed)
      if (walls%present(bottom_wall)) then
         depth = max(0.0_dp, walls%at(bottom_wall) - y)
         if (v**2 < 4*gravity*depth) then
            ! Too slow to rise as far above the floor as it is below: it gets as high as its energy takes it.
            y = walls%at(bottom_wall) + max(0.0_dp, v**2/(2*gravity) - depth)
            v = 0
            crossed = .true.
         else
            v = sign(sqrt(v**2 - 4*gravity*depth), v)
            call mirror(y, v, walls%at(bottom_wall), 1.0_dp, crossed)
         end if
      end if
      if (walls%present(top_wall)) then
         v = sign(sqrt(v**2 + 4*gravity*max(0.0_dp, y - walls%at(top_wall))), v)
         call mirror(y, v, walls%at(top_wall), -1.0_dp, crossed)
      end if
   end subroutine reflect

   pure subroutine mirror(coordinate, velocity, wall, inward, crossed)
      real(dp), intent(inout) :: coordinate, velocity
      real(dp), intent(in) :: wall, inward   !! inward = 1 or -1: towards the fluid
      logical, intent(inout) :: crossed

      if (.not. (wall - coordinate)*inward > 0) return
      coordinate = 2*wall - coordinate
      velocity = sign(velocity, inward)
      crossed = .true.
   end subroutine mirror

end module crossing
