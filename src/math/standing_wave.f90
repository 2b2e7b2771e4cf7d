!> A standing gravity wave of small height over a flat floor.
!!
!! Source: Antuono & Colagrossi, Int. J. Numer. Methods Fluids 72 (2013): potential flow of a wave with a flat surface at
!! t = 0, whose amplitude decays as exp(-b t). With w**2 = g k tanh(kH) and B = eps g H/(2 w),
!!
!!     u =  B k cosh(ky)/cosh(kH) sin(kx) cos(wt) exp(-b t)
!!     v = -B k sinh(ky)/cosh(kH) cos(kx) cos(wt) exp(-b t)
!!
!! b = 2 nu k**2 is the decay to first order in nu. The next order, the vortical layer under the surface, takes
!! 1/sqrt(2) sqrt(nu k**2/w) of it: 11 % at nu k**2/w = 0.022. So b is taken from Lamb's linear theory of viscous waves
!! (Hydrodynamics, art. 349), with s = (-b + i w')/w and d = nu k**2/w:
!!
!!     (s + 2d)**2 + 1 = 4 d**2 sqrt(1 + s/d)
!!
!! It is for deep water; the layer is thin, and with w of finite depth it holds as long as tanh(kH) is near 1.
!! y from the floor, x from a side wall. To first order in eps the pressure is rho g (H - y) - rho B w cosh(ky)/cosh(kH)
!! cos(kx) sin(wt) exp(..): hydrostatic at t = 0, where all the energy is kinetic.
module standing_wave
   use kinds, only: dp
   implicit none
   private

   public :: standing_wave_t, new_standing_wave, viscous_root

   !> A wave of given geometry.
   type :: standing_wave_t
      real(dp) :: k = 1           !! wave number
      real(dp) :: depth = 1       !! H
      real(dp) :: gravity = 1
      real(dp) :: height = 0      !! eps = wave height/H
      real(dp) :: frequency = 1   !! w
      real(dp) :: first_order_decay = 0   !! 2 nu k**2
      real(dp) :: decay = 0       !! b, of the amplitude
   contains
      procedure :: velocity
      procedure :: dynamic_pressure
      procedure :: kinetic_energy
      procedure :: amplitude
   end type standing_wave_t

contains

   !> The wave over a floor `depth` below the surface.
   pure type(standing_wave_t) function new_standing_wave(k, depth, gravity, height, viscosity) result(self)
      real(dp), intent(in) :: k, depth, gravity
      real(dp), intent(in) :: height      !! eps, wave height/depth
      real(dp), intent(in) :: viscosity   !! kinematic, nu

      self = standing_wave_t(k=k, depth=depth, gravity=gravity, height=height, frequency=sqrt(gravity*k*tanh(k*depth)), &
                             first_order_decay=2*viscosity*k**2)
      if (viscosity > 0) self%decay = -self%frequency*real(viscous_root(viscosity*k**2/self%frequency), dp)
   end function new_standing_wave

   !> Root s of (s + 2d)**2 + 1 = 4 d**2 sqrt(1 + s/d) that tends to i - 2d for small d > 0, by Newton's method.
   elemental complex(dp) function viscous_root(d) result(s)
      real(dp), intent(in) :: d   !! nu k**2/w; beyond about 0.5 waves don't oscillate any more
      complex(dp) :: root, change
      integer :: n

      s = cmplx(-2*d, 1.0_dp, dp)
      do n = 1, 50
         root = sqrt(1 + s/d)
         change = ((s + 2*d)**2 + 1 - 4*d**2*root)/(2*(s + 2*d) - 2*d/root)
         s = s - change
         if (abs(change) < 1.0e-14_dp) exit
      end do
   end function viscous_root

   !> Velocity as a share of its first value: cos(wt) exp(-b t).
   elemental real(dp) function amplitude(self, time)
      class(standing_wave_t), intent(in) :: self
      real(dp), intent(in) :: time

      amplitude = cos(self%frequency*time)*exp(-self%decay*time)
   end function amplitude

   !> Velocity at a place.
   pure function velocity(self, x, y, time) result(u)
      class(standing_wave_t), intent(in) :: self
      real(dp), intent(in) :: x, y   !! from a side wall, from the floor
      real(dp), intent(in) :: time
      real(dp) :: u(2)

      u = self%height*self%gravity*self%depth*self%k/(2*self%frequency)*self%amplitude(time) &
          *[cosh(self%k*y)*sin(self%k*x), -sinh(self%k*y)*cos(self%k*x)]/cosh(self%k*self%depth)
   end function velocity

   !> (p - rho g (H - y))/rho at a place.
   elemental real(dp) function dynamic_pressure(self, x, y, time) result(p)
      class(standing_wave_t), intent(in) :: self
      real(dp), intent(in) :: x, y   !! from a side wall, from the floor
      real(dp), intent(in) :: time

      p = -self%height*self%gravity*self%depth/2*cosh(self%k*y)/cosh(self%k*self%depth)*cos(self%k*x) &
          *sin(self%frequency*time)*exp(-self%decay*time)
   end function dynamic_pressure

   !> E_K/rho = eps**2 g L H**2/32 exp(-2 b t) (1 + cos 2wt) of a tank L wide.
   elemental real(dp) function kinetic_energy(self, width, time) result(energy)
      class(standing_wave_t), intent(in) :: self
      real(dp), intent(in) :: width   !! L, a multiple of half a wavelength
      real(dp), intent(in) :: time

      energy = self%height**2*self%gravity*width*self%depth**2/16*self%amplitude(time)**2
   end function kinetic_energy

end module standing_wave
