!> Pressure of a body at t = 0.
module initial_pressure
   use hydrostatics, only: hydrostatic_pressure
   use kinds, only: dp
   use resting_fluid, only: resting_force, resting_force_t, touch
   use settings, only: body_settings, settings_t
   implicit none
   private

   public :: pressure_at, pushed_column, released_column

   real(dp), parameter :: pi = acos(-1.0_dp)
   integer, parameter :: terms = 2000   !! of a series, at most

contains

   !> Pressure at a position in a body, by the body's choice.
   pure real(dp) function pressure_at(scene, number, position) result(p)
      type(settings_t), intent(in) :: scene
      integer, intent(in) :: number          !! of the body
      real(dp), intent(in) :: position(2)
      type(resting_force_t) :: force
      real(dp) :: x, y, away
      logical :: on_wall(2)

      p = 0
      associate (body => scene%bodies(number), fluid => scene%fluid, acceleration => scene%force%acceleration)
         select case (body%pressure)
         case ('hydrostatic')
            force = resting_force(scene)
            p = hydrostatic_pressure(depth_of(scene, force, number, position), fluid%density, fluid%sound_speed, force%size)
         case ('incompressible')
            ! x is the distance from the side wall that the column leans on.
            x = position(1) - body%lower(1)
            y = position(2) - body%lower(2)
            away = acceleration(1)
            on_wall = scene%leans(body)
            if (on_wall(2)) then
               x = body%upper(1) - position(1)
               away = -away
            end if
            associate (width => body%upper(1) - body%lower(1), height => body%upper(2) - body%lower(2))
               p = fluid%density*(fluid%gravity - acceleration(2))*released_column(x, y, width, height)
               if (abs(away) > 0) p = p - fluid%density*away*pushed_column(x, y, width, height)
            end associate
         end select
      end associate
   end function pressure_at

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

   !> p/(rho g) in a column of incompressible fluid at the moment its gate is gone.
   !!
   !! Solves Laplace's equation with p = 0 at the top and the free side: H - y - sum_n 2/(H k_n**2)
   !! cosh(k_n x)/cosh(k_n W) cos(k_n y), k_n = (n + 1/2) pi/H, x from the wall.
   elemental real(dp) function released_column(x, y, width, height) result(head)
      real(dp), intent(in) :: x, y            !! from the foot of the wall
      real(dp), intent(in) :: width, height   !! W, H
      real(dp) :: k, ratio
      integer :: n

      head = height - y
      do n = 0, terms
         k = (n + 0.5_dp)*pi/height
         ratio = exp(-k*(width - x))*(1 + exp(-2*k*x))/(1 + exp(-2*k*width))
         head = head - 2/(height*k**2)*ratio*cos(k*y)
         if (ratio < 1.0e-14_dp) exit
      end do
   end function released_column

   !> -p/(rho a) in the same column by a force a away from the wall: the part that does not depend on gravity.
   !!
   !! dp/dx = rho a at the wall, dp/dy = 0 on the floor: sum_n (-1)**n 2/(H k_n**2) sinh(k_n (W - x))/cosh(k_n W) cos(k_n y).
   elemental real(dp) function pushed_column(x, y, width, height) result(head)
      real(dp), intent(in) :: x, y            !! from the foot of the wall
      real(dp), intent(in) :: width, height   !! W, H
      real(dp) :: k, ratio
      integer :: n

      head = 0
      do n = 0, terms
         k = (n + 0.5_dp)*pi/height
         ratio = exp(-k*x)*(1 - exp(-2*k*(width - x)))/(1 + exp(-2*k*width))
         head = head + merge(2, -2, mod(n, 2) == 0)/(height*k**2)*ratio*cos(k*y)
         if (ratio < 1.0e-14_dp) exit
      end do
   end function pushed_column

end module initial_pressure
