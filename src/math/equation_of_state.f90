!> The equation of state of weakly compressible fluid, p = c0**2 (rho - rho0) (eq. 3 of the paper), by s = rho - rho0.
module equation_of_state
   use kinds, only: dp
   implicit none
   private

   public :: pressure_of, excess_density, specific_pressure

contains

   !> p [Pa].
   elemental real(dp) function pressure_of(c0, s)
      real(dp), intent(in) :: c0   !! [m/s] speed of sound
      real(dp), intent(in) :: s    !! [kg/m3] rho - rho0

      pressure_of = c0**2*s
   end function pressure_of

   !> rho - rho0 [kg/m3].
   elemental real(dp) function excess_density(c0, p)
      real(dp), intent(in) :: c0   !! [m/s] speed of sound
      real(dp), intent(in) :: p    !! [Pa] pressure

      excess_density = p/c0**2
   end function excess_density

   !> p/rho [m2/s2].
   elemental real(dp) function specific_pressure(c0, rho0, s)
      real(dp), intent(in) :: c0     !! [m/s] speed of sound
      real(dp), intent(in) :: rho0   !! [kg/m3] density where p = 0
      real(dp), intent(in) :: s      !! [kg/m3] rho - rho0

      specific_pressure = pressure_of(c0, s)/(rho0 + s)
   end function specific_pressure

end module equation_of_state
