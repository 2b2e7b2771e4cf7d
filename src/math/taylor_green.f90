!> Decaying Taylor-Green vortices in a periodic square.
!!
!! Source: Taylor & Green, Proc. R. Soc. A 158 (1937); an exact solution of the incompressible Navier-Stokes equations,
!!
!!     u = -U cos(kx) sin(ky) e,   v = U sin(kx) cos(ky) e,   e = exp(-2 nu k**2 t)
!!     p = -rho U**2/4 (cos(2kx) + cos(2ky)) e**2
!!
!! With k = 2 pi and Re = 1/nu the rate is -8 pi**2/Re. Its rate of strain is D_xx = -D_yy = U k sin(kx) sin(ky) e, D_xy = 0.
module taylor_green
   use kinds, only: dp
   implicit none
   private

   public :: vortices_t

   !> Vortices of given strength.
   type :: vortices_t
      real(dp) :: k = 1       !! wave number
      real(dp) :: speed = 1   !! U
      real(dp) :: decay = 0   !! 2 nu k**2
   contains
      procedure :: velocity
      procedure :: pressure
      procedure :: strain_norm
      procedure :: amplitude
   end type vortices_t

contains

   !> exp(-2 nu k**2 t).
   elemental real(dp) function amplitude(self, time)
      class(vortices_t), intent(in) :: self
      real(dp), intent(in) :: time

      amplitude = exp(-self%decay*time)
   end function amplitude

   !> Velocity at a place.
   pure function velocity(self, x, y, time) result(u)
      class(vortices_t), intent(in) :: self
      real(dp), intent(in) :: x, y   !! from the square's lower left corner
      real(dp), intent(in) :: time
      real(dp) :: u(2)

      u = self%speed*self%amplitude(time)*[-cos(self%k*x)*sin(self%k*y), sin(self%k*x)*cos(self%k*y)]
   end function velocity

   !> p/rho at a place; its mean is 0.
   elemental real(dp) function pressure(self, x, y, time) result(p)
      class(vortices_t), intent(in) :: self
      real(dp), intent(in) :: x, y   !! from the square's lower left corner
      real(dp), intent(in) :: time

      p = -(self%speed*self%amplitude(time))**2/4*(cos(2*self%k*x) + cos(2*self%k*y))
   end function pressure

   !> ||D|| = sqrt(2 D:D) = 2 U k |sin(kx) sin(ky)| exp(-2 nu k**2 t) at a place.
   elemental real(dp) function strain_norm(self, x, y, time) result(norm)
      class(vortices_t), intent(in) :: self
      real(dp), intent(in) :: x, y   !! from the square's lower left corner
      real(dp), intent(in) :: time

      norm = 2*self%k*abs(self%speed*sin(self%k*x)*sin(self%k*y))*self%amplitude(time)
   end function strain_norm

end module taylor_green
