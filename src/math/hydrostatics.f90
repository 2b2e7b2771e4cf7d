!> Pressure of weakly-compressible fluid at rest.
!!
!! dp/dy = -rho g with p = c0**2 (rho - rho0) gives rho = rho0 exp(g depth/c0**2).
module hydrostatics
   use kinds, only: dp
   implicit none
   private

   public :: hydrostatic_pressure

contains

   !> p = rho0 c0**2 (exp(g depth/c0**2) - 1) at a depth below the surface.
   elemental real(dp) function hydrostatic_pressure(depth, rho0, c0, gravity) result(p)
      real(dp), intent(in) :: depth           !! below the surface, where p = 0
      real(dp), intent(in) :: rho0, c0, gravity
      real(dp) :: x

      x = gravity*depth/c0**2
      ! exp(x) - 1 by its series where the difference would lose digits
      if (abs(x) < 1.0e-3_dp) then
         p = rho0*c0**2*x*(1 + x/2*(1 + x/3*(1 + x/4)))
      else
         p = rho0*c0**2*(exp(x) - 1)
      end if
   end function hydrostatic_pressure

end module hydrostatics
