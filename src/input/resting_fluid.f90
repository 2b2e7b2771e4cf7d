!> Fluid that rests in a uniform force: which force holds it, how much fluid lies above a place, what carries a body.
module resting_fluid
   use kinds, only: dp
   use settings, only: body_settings, choice_length, is_wall, settings_t
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
   pure type(resting_force_t) function resting_force(setup) result(force)
      type(settings_t), intent(in) :: setup
      real(dp) :: total(2)

      total = setup%force%acceleration - [0.0_dp, setup%fluid%gravity]
      where ([setup%domain%left, setup%domain%bottom] == 'periodic') total = 0
      if (abs(total(1)) > abs(total(2))) force%axis = 1
      if (total(force%axis) > 0) force%down = 1
      force%size = abs(total(force%axis))
      force%left_over = abs(total(3 - force%axis))
   end function resting_force

   !> Fluid above a place in a body [m], through all bodies of hydrostatic pressure that lie on each other there.
   pure real(dp) function depth_of(setup, force, number, place) result(depth)
      type(settings_t), intent(in) :: setup
      type(resting_force_t), intent(in) :: force
      integer, intent(in) :: number      !! of the body
      real(dp), intent(in) :: place(2)
      logical :: passed(size(setup%bodies))
      real(dp) :: top
      integer :: k

      passed = setup%bodies%pressure /= 'hydrostatic'
      k = number
      do
         passed(k) = .true.
         top = face(setup%bodies(k), force, place, up=.true.)
         k = body_at(setup, force, place, top, passed)
         if (k == 0) exit
      end do
      depth = (place(force%axis) - top)*force%down
   end function depth_of

   ! The body not passed yet that begins at a height above a place; 0 if there is none.
   pure integer function body_at(setup, force, place, height, passed) result(number)
      type(settings_t), intent(in) :: setup
      type(resting_force_t), intent(in) :: force
      real(dp), intent(in) :: place(2)
      real(dp), intent(in) :: height      !! along the axis
      logical, intent(in) :: passed(:)

      do number = 1, size(setup%bodies)
         if (passed(number)) cycle
         associate (body => setup%bodies(number), across => 3 - force%axis)
            if (place(across) < body%lower(across) .or. place(across) > body%upper(across)) cycle
            if (touch(setup, face(body, force, place, up=.false.), height)) return
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
   pure logical function touch(setup, one, other)
      type(settings_t), intent(in) :: setup
      real(dp), intent(in) :: one, other

      touch = abs(one - other) < setup%spacing()/2
   end function touch

   !> Whether each body stands on a wall, or on other fluid that does. Discs count as the squares around them.
   pure function carried(setup, force) result(held)
      type(settings_t), intent(in) :: setup
      type(resting_force_t), intent(in) :: force
      logical :: held(size(setup%bodies))
      real(dp) :: foot, wall
      integer :: i, k
      logical :: is_held(size(setup%bodies)), bounded
      character(choice_length) :: kinds_there(4)

      associate (bodies => setup%bodies, axis => force%axis, domain => setup%domain)
         wall = merge(domain%upper(axis), domain%lower(axis), force%down > 0)
         kinds_there = setup%side_kinds()
         bounded = is_wall(kinds_there(2*axis - merge(0, 1, force%down > 0)))
         held = .false.
         ! A stack of n bodies is known after n rounds.
         do k = 1, size(bodies)
            is_held = held
            do i = 1, size(bodies)
               foot = merge(bodies(i)%upper(axis), bodies(i)%lower(axis), force%down > 0)
               is_held(i) = held(i) .or. (bounded .and. touch(setup, foot, wall)) .or. any(held .and. bodies_below(i, foot))
            end do
            if (all(is_held .eqv. held)) return
            held = is_held
         end do
      end associate

   contains

      ! Bodies whose upper face lies at the foot of one, below part of it.
      pure function bodies_below(i, foot) result(below)
         integer, intent(in) :: i
         real(dp), intent(in) :: foot
         logical :: below(size(setup%bodies))
         real(dp) :: top
         integer :: j

         associate (bodies => setup%bodies, across => 3 - force%axis)
            do j = 1, size(bodies)
               top = merge(bodies(j)%lower(force%axis), bodies(j)%upper(force%axis), force%down > 0)
               below(j) = j /= i .and. touch(setup, top, foot) .and. bodies(i)%lower(across) < bodies(j)%upper(across) &
                          .and. bodies(i)%upper(across) > bodies(j)%lower(across)
            end do
         end associate
      end function bodies_below

   end function carried

end module resting_fluid
