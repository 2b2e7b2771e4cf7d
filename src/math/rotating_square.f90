!> A rectangle of incompressible fluid that starts to rotate as a rigid body, without walls or gravity.
!!
!! Source: Colagrossi, PhD thesis (2005); Le Touze et al., Int. J. Numer. Methods Fluids 73 (2013). With the velocity
!! Omega (-y, x) about the centre, Laplace p = 2 rho Omega**2 and p = 0 on the edges at t = 0: the pressure is negative
!! everywhere inside. Later there is no formula, but energy and angular momentum stay what they are.
module rotating_square
   use kinds, only: dp
   implicit none
   private

   public :: rigid_velocity, square_pressure

   real(dp), parameter :: pi = acos(-1.0_dp)

contains

   !> Velocity at a place relative to the centre.
   pure function rigid_velocity(x, y, rotation) result(u)
      real(dp), intent(in) :: x, y
      real(dp), intent(in) :: rotation   !! Omega, counterclockwise
      real(dp) :: u(2)

      u = rotation*[-y, x]
   end function rigid_velocity

   !> p/(rho Omega**2) at a place relative to the centre of a rectangle W wide and H high.
   !!
   !! -[(W/2)**2 - x**2] + (8 W**2/pi**3) sum_{n odd} (-1)**((n-1)/2)/n**3 cos(n pi x/W) cosh(n pi y/W)/cosh(n pi H/(2W)): the
   !! parabola has the right Laplacian and vanishes at the left and right edge; the series takes it off the other two.
   elemental real(dp) function square_pressure(x, y, width, height) result(p)
      real(dp), intent(in) :: x, y
      real(dp), intent(in) :: width, height   !! W, H
      integer, parameter :: last = 2001
      real(dp) :: k, ratio
      integer :: n, sign_of

      p = x**2 - width**2/4
      sign_of = 1
      do n = 1, last, 2
         k = n*pi/width
         ! cosh(k y)/cosh(k H/2) without overflow
         ratio = exp(-k*(height/2 - abs(y)))*(1 + exp(-2*k*abs(y)))/(1 + exp(-k*height))
         p = p + sign_of*8*width**2/(n*pi)**3*cos(k*x)*ratio
         if (ratio < 1.0e-15_dp) exit
         sign_of = -sign_of
      end do
   end function square_pressure

end module rotating_square
