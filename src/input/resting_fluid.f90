!> Fluid that rests in a uniform force: which force holds it, how much fluid lies above a place, what carries a body.
module resting_fluid
   use kinds, only: dp
   use settings, only: body_settings, choice_length, is_wall, settings_t
   use sorting, only: ascending
   implicit none
   private

   public :: resting_force, resting_force_t, depth_of, carried

   !> The part of gravity and acceleration that pressure can balance: along the axis on which they are larger.
   type :: resting_force_t
      integer :: axis = 2                      !! 1: along x, 2: along y
      integer :: down = -1                     !! -1 or 1: where along the axis it pulls
      real(dp) :: size = 0                     !! [m/s2]
      real(dp) :: left_over = 0                !! what acts across it [m/s2]
   end type resting_force_t

contains

   !> Along periodic sides nothing holds the fluid: no pressure balances that part of the force.
   pure type(resting_force_t) function resting_force(scene) result(force)
      type(settings_t), intent(in) :: scene
      real(dp) :: total(2)

      total = scene%force%acceleration - [0.0_dp, scene%fluid%gravity]
      where ([scene%domain%left, scene%domain%bottom] == 'periodic') total = 0
      if (abs(total(1)) > abs(total(2))) force%axis = 1
      if (total(force%axis) > 0) force%down = 1
      force%size = abs(total(force%axis))
      force%left_over = abs(total(3 - force%axis))
   end function resting_force

   !> Fluid above a place in a body [m], through all bodies of hydrostatic pressure that lie on each other there.
   pure real(dp) function depth_of(scene, force, number, place) result(depth)
      type(settings_t), intent(in) :: scene
      type(resting_force_t), intent(in) :: force
      integer, intent(in) :: number      !! of the body
      real(dp), intent(in) :: place(2)
      logical :: passed(size(scene%bodies))
      real(dp) :: top
      integer :: k

      passed = scene%bodies%pressure /= 'hydrostatic'
      k = number
      do
         passed(k) = .true.
         top = face(scene%bodies(k), force, place, up=.true.)
         k = body_at(scene, force, place, top, passed)
         if (k == 0) exit
      end do
      depth = (place(force%axis) - top)*force%down
   end function depth_of

   ! The body not passed yet that begins at a height above a place; 0 if there is none.
   pure integer function body_at(scene, force, place, height, passed) result(number)
      type(settings_t), intent(in) :: scene
      type(resting_force_t), intent(in) :: force
      real(dp), intent(in) :: place(2)
      real(dp), intent(in) :: height      !! along the axis
      logical, intent(in) :: passed(:)

      do number = 1, size(scene%bodies)
         if (passed(number)) cycle
         associate (body => scene%bodies(number), across => 3 - force%axis)
            if (place(across) < body%lower(across) .or. place(across) > body%upper(across)) cycle
            if (touch(scene, face(body, force, place, up=.false.), height)) return
         end associate
      end do
      number = 0
   end function body_at

   ! Where the line through a place along the force leaves a body, upwards or downwards.
   pure real(dp) function face(body, force, place, up)
      type(body_settings), intent(in) :: body
      type(resting_force_t), intent(in) :: force
      real(dp), intent(in) :: place(2)
      logical, intent(in) :: up
      real(dp) :: half

      associate (axis => force%axis, across => 3 - force%axis, upwards => (force%down < 0) .eqv. up)
         face = merge(body%upper(axis), body%lower(axis), upwards)
         if (body%shape /= 'disc') return
         half = sqrt(max(0.0_dp, body%radius**2 - (place(across) - body%centre(across))**2))
         face = body%centre(axis) + merge(half, -half, upwards)
      end associate
   end function face

   ! Fluid is connected where no particle fits between.
   pure logical function touch(scene, one, other)
      type(settings_t), intent(in) :: scene
      real(dp), intent(in) :: one, other

      touch = abs(one - other) < scene%spacing()/2
   end function touch

   !> Whether each body stands on a wall, or on other fluid that does. Discs count as the squares around them.
   pure function carried(scene, force) result(held)
      type(settings_t), intent(in) :: scene   !! bodies are a particle high at least
      type(resting_force_t), intent(in) :: force
      logical :: held(size(scene%bodies))
      real(dp) :: foot(size(scene%bodies)), top(size(scene%bodies)), wall   ! heights, upwards against the force
      integer :: by_foot(size(scene%bodies)), by_top(size(scene%bodies)), i, k, n
      character(choice_length) :: kinds_there(4)
      real(dp) :: tops(size(scene%bodies))   ! from the lowest up
      logical :: bounded

      associate (bodies => scene%bodies, axis => force%axis, across => 3 - force%axis, up => -force%down)
         kinds_there = scene%side_kinds()
         bounded = is_wall(kinds_there(2*axis - merge(1, 0, up > 0)))
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
