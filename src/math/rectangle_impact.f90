!> The energy that two rectangles of fluid lose when they hit each other.
!!
!! Source: Marrone, Colagrossi, Di Mascio & Le Touze, J. Fluids Struct. 54 (2015): "Prediction of energy losses in water impacts
!! using incompressible and weakly compressible models". Two blocks, each L wide and H thick, meet along L with the speeds
!! +U and -U. The pressure impulse P solves Laplace's equation with P = 0 on the free sides and dP/dn = rho U at the contact;
!! it takes U/2 int P dx of each block's energy rho U**2 L H/2.
module rectangle_impact
   use kinds, only: dp
   implicit none
   private

   public :: lost_share

contains

   !> Share of the kinetic energy, (8 L/(pi**3 H)) sum_{n odd} tanh(n pi H/L)/n**3.
   elemental real(dp) function lost_share(slenderness) result(share)
      real(dp), intent(in) :: slenderness   !! H/L, > 0
      real(dp), parameter :: pi = acos(-1.0_dp)
      real(dp), parameter :: zeta = 1.0517997902646450_dp   ! sum_{n odd} n**-3 = 7/8 zeta(3)
      real(dp) :: deficit
      integer :: n

      ! tanh = 1 - 2/(exp(2z) + 1): what is left to sum falls off exponentially.
      deficit = 0
      do n = 1, 100001, 2
         associate (z => n*pi*slenderness)
            if (z > 20) exit
            deficit = deficit + 2/((exp(2*z) + 1)*real(n, dp)**3)
         end associate
      end do
      share = 8/(pi**3*slenderness)*(zeta - deficit)
   end function lost_share

end module rectangle_impact
