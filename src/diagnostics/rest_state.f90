!> Energies of the fluid at rest in its tank, which normalise the energy budget.
!!
!! Source: the paper's Delta E_Mtot = E_M(0) - E_M(at rest), with the compressible rest state of the same mass:
!! dp/dy = -rho g with p = c0**2 (rho - rho0) gives rho = rho0 exp(g (H - y)/c0**2).
module rest_state
   use kinds, only: dp
   implicit none
   private

   public :: rest_energies, rest_height

contains

   !> Height H of the resting fluid: M/L = rho0 c0**2/g (exp(g H/c0**2) - 1).
   elemental real(dp) function rest_height(mass, width, rho0, c0, gravity) result(height)
      real(dp), intent(in) :: mass      !! per unit of the third dimension
      real(dp), intent(in) :: width     !! L of the tank
      real(dp), intent(in) :: rho0, c0, gravity   !! gravity > 0

      height = c0**2/gravity*log(1 + mass*gravity/(width*rho0*c0**2))
   end function rest_height

   !> Potential energy above the floor and elastic energy of the resting fluid.
   pure subroutine rest_energies(mass, width, rho0, c0, gravity, potential, elastic)
      real(dp), intent(in) :: mass, width, rho0, c0, gravity   !! as for rest_height
      real(dp), intent(out) :: potential   !! int rho g y dA
      real(dp), intent(out) :: elastic     !! eq. 11
      real(dp) :: x

      x = rest_height(mass, width, rho0, c0, gravity)*gravity/c0**2
      potential = width*rho0*c0**4/gravity*series(x, 2)
      elastic = width*rho0*c0**4/gravity*series(x, 3)
   end subroutine rest_energies

   ! first = 2: exp(x) - 1 - x = sum_{n>=2} x**n/n!;
   ! first = 3: (x - 2) exp(x) + 2 + x = sum_{n>=3} (n - 2) x**n/n!. Summed because x is small.
   pure real(dp) function series(x, first) result(total)
      real(dp), intent(in) :: x
      integer, intent(in) :: first
      real(dp) :: power
      integer :: n

      total = 0
      power = x
      do n = 2, 60
         power = power*x/n
         if (first == 2) total = total + power
         if (first == 3) total = total + (n - 2)*power
      end do
   end function series

end module rest_state
