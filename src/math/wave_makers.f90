!> Linear waves on water at rest, and wave makers: which stroke makes which height.
!!
!! Source: Biesel & Suquet, La Houille Blanche 6 (1951); Dean & Dalrymple, Water Wave Mechanics (1984), eqs. 6.25 and 6.26.
module wave_makers
   use kinds, only: dp
   implicit none
   private

   public :: wave_number, piston_ratio, flap_ratio, breaking_height

   real(dp), parameter :: pi = acos(-1.0_dp)
   real(dp), parameter :: deep = 300        ! k h beyond which the ratios are taken as those there: sinh must not overflow
   real(dp), parameter :: steepest = 0.142_dp   ! height over wave length of Miche's criterion on deep water

contains

   !> k of w**2 = g k tanh(k h) [1/m], by Newton's method.
   pure real(dp) function wave_number(frequency, gravity, depth)
      real(dp), intent(in) :: frequency   !! w > 0 [1/s]
      real(dp), intent(in) :: gravity     !! > 0 [m/s2]
      real(dp), intent(in) :: depth       !! h > 0 [m]
      integer, parameter :: enough = 20   ! steps; the start is within 6 %, and each squares the error
      real(dp) :: kh, wanted, slope
      integer :: k

      wanted = frequency**2*depth/gravity
      kh = wanted/sqrt(tanh(wanted))
      do k = 1, enough
         slope = tanh(kh) + kh*(1 - tanh(kh)**2)
         kh = kh - (kh*tanh(kh) - wanted)/slope
      end do
      wave_number = kh/depth
   end function wave_number

   !> Height over stroke of a piston [-].
   elemental real(dp) function piston_ratio(kh) result(ratio)
      real(dp), intent(in) :: kh   !! > 0 [-]

      associate (x => min(kh, deep))
         ratio = 2*(cosh(2*x) - 1)/(sinh(2*x) + 2*x)
      end associate
   end function piston_ratio

   !> Height over stroke at the surface of a flap that is hinged on the floor [-].
   elemental real(dp) function flap_ratio(kh) result(ratio)
      real(dp), intent(in) :: kh   !! > 0 [-]

      associate (x => min(kh, deep))
         ratio = 4*(sinh(x)/x)*(x*sinh(x) - cosh(x) + 1)/(sinh(2*x) + 2*x)
      end associate
   end function flap_ratio

   !> Height above which a wave breaks [m]. Source: Miche 1944.
   pure real(dp) function breaking_height(k, depth) result(height)
      real(dp), intent(in) :: k       !! wave number [1/m]
      real(dp), intent(in) :: depth   !! [m]

      height = steepest*2*pi/k*tanh(k*depth)
   end function breaking_height

end module wave_makers
