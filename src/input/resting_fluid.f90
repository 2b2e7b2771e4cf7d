!> Fluid that rests in a uniform force: which force holds it, what carries a body.
module resting_fluid
   use kinds, only: dp
   use settings, only: is_wall, settings_t
   use sorting, only: ascending
   implicit none
   private

   public :: held_force, resting_force, resting_force_t, touch, carried

   !> The part of gravity and acceleration that pressure can balance: along the axis on which they are larger.
   type :: resting_force_t
      integer :: axis = 2                      !! 1: along x, 2: along y
      integer :: down = -1                     !! -1 or 1: where along the axis it pulls
      real(dp) :: size = 0                     !! [m/s2]
      real(dp) :: left_over = 0                !! what acts across it [m/s2]
   end type resting_force_t

contains

   !> Gravity and acceleration [m/s2]. Along periodic sides nothing holds the fluid: no pressure balances that part of the force.
   pure function held_force(scene) result(force)
      type(settings_t), intent(in) :: scene
      real(dp) :: force(2)

      force = scene%force%acceleration - [0.0_dp, scene%fluid%gravity]
      where ([scene%domain%left, scene%domain%bottom] == 'periodic') force = 0
   end function held_force

   !> That force along its larger component.
   pure type(resting_force_t) function resting_force(scene) result(force)
      type(settings_t), intent(in) :: scene
      real(dp) :: total(2)

      total = held_force(scene)
      if (abs(total(1)) > abs(total(2))) force%axis = 1
      if (total(force%axis) > 0) force%down = 1
      force%size = abs(total(force%axis))
      force%left_over = abs(total(3 - force%axis))
   end function resting_force

   !> Fluid is connected where no particle fits between two heights.
   pure logical function touch(scene, one, other)
      type(settings_t), intent(in) :: scene
      real(dp), intent(in) :: one, other   !! [m]

      touch = abs(one - other) < scene%spacing()/2
   end function touch

   !> Whether each body stands on a wall, or on other fluid that does. Discs count as the squares around them.
   pure function carried(scene, force) result(held)
      type(settings_t), intent(in) :: scene   !! bodies are a particle high at least
      type(resting_force_t), intent(in) :: force
      logical :: held(size(scene%bodies))
      real(dp) :: foot(size(scene%bodies)), top(size(scene%bodies)), wall   ! heights, upwards against the force
      real(dp) :: tops(size(scene%bodies))   ! from the lowest up
      integer :: by_foot(size(scene%bodies)), by_top(size(scene%bodies)), i, k, n
      logical :: walls(4), bounded

      associate (bodies => scene%bodies, axis => force%axis, across => 3 - force%axis, up => -force%down)
         walls = is_wall(scene%side_kinds())
         bounded = walls(2*axis - merge(1, 0, up > 0))
         wall = min(up*scene%domain%lower(axis), up*scene%domain%upper(axis))
         foot = min(up*bodies%lower(axis), up*bodies%upper(axis))
         top = max(up*bodies%lower(axis), up*bodies%upper(axis))
         by_foot = ascending(foot)
         by_top = ascending(top)
         tops = top(by_top)
         held = .false.
         ! What a body stands on has a lower foot: it is known by then.
         do n = 1, size(bodies)
            i = by_foot(n)
            held(i) = bounded .and. touch(scene, foot(i), wall)
            do k = first_above(tops, foot(i) - scene%spacing()), size(bodies)
               if (held(i) .or. tops(k) > foot(i) + scene%spacing()) exit
               associate (one => bodies(i), below => bodies(by_top(k)))
                  held(i) = held(by_top(k)) .and. touch(scene, tops(k), foot(i)) .and. &
                            one%lower(across) < below%upper(across) .and. one%upper(across) > below%lower(across)
               end associate
            end do
         end do
      end associate
   end function carried

   ! The first of ascending values that is above a bound.
   pure integer function first_above(values, bound) result(first)
      real(dp), intent(in) :: values(:), bound
      integer :: last, middle

      first = 1
      last = size(values) + 1
      do while (first < last)
         middle = (first + last)/2
         if (values(middle) > bound) then
            last = middle
         else
            first = middle + 1
         end if
      end do
   end function first_above

end module resting_fluid
