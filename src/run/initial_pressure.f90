!> Pressure of a body at t = 0.
module initial_pressure
   use hydrostatics, only: hydrostatic_pressure
   use kinds, only: dp
   use settings, only: body_settings, settings_t
   implicit none
   private

   public :: pressure_at, released_column

   real(dp), parameter :: pi = acos(-1.0_dp)

contains

   !> Pressure at a position in a body, by the body's choice.
   pure real(dp) function pressure_at(scene, body, position) result(p)
      type(settings_t), intent(in) :: scene
      type(body_settings), intent(in) :: body
      real(dp), intent(in) :: position(2)
      real(dp) :: x
      logical :: on_wall(2)

      select case (body%pressure)
      case ('hydrostatic')
         associate (fluid => scene%fluid)
            p = hydrostatic_pressure(body%upper(2) - position(2), fluid%density, fluid%sound_speed, fluid%gravity)
         end associate
      case ('incompressible')
         ! x is the distance from the side wall that the column leans on.
         x = position(1) - body%lower(1)
         on_wall = scene%leans(body)
         if (on_wall(2)) x = body%upper(1) - position(1)
         p = scene%fluid%density*scene%fluid%gravity &
             *released_column(x, position(2) - body%lower(2), body%upper(1) - body%lower(1), body%upper(2) - body%lower(2))
      case default
         p = 0
      end select
   end function pressure_at

   !> p/(rho g) in a column of incompressible fluid at the moment its gate is gone.
   !!
   !! Solves Laplace's equation with p = 0 at the top and the free side: H - y - sum_n 2/(H k_n**2)
   !! cosh(k_n x)/cosh(k_n W) cos(k_n y), k_n = (n + 1/2) pi/H, x from the wall.
   elemental real(dp) function released_column(x, y, width, height) result(head)
      real(dp), intent(in) :: x, y            !! from the foot of the wall
      real(dp), intent(in) :: width, height   !! W, H
      integer, parameter :: terms = 2000
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

end module initial_pressure
