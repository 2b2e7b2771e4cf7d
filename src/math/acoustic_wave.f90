!> A plane sound wave that travels along x.
!!
!! To first order in the amplitude eps, (rho - rho0)/rho0 = eps cos(k (x - c t)) exp(-sigma t), u = c0 eps (the same), with
!! p = c0**2 (rho - rho0). In the continuum c = c0, and the viscous term of eq. 5 damps by sigma = (3/8) alpha h c0 k**2/2: it acts
!! on compression three times as on shear, and only on the velocity. The density diffusion vanishes for long waves.
!! Speed and damping on a lattice come from module `square_lattice`.
module acoustic_wave
   use kinds, only: dp
   implicit none
   private

   public :: sound_wave_t, continuum_damping

   !> A wave of given speed and damping.
   type :: sound_wave_t
      real(dp) :: k = 1             !! wave number
      real(dp) :: compression = 0   !! eps
      real(dp) :: c0 = 1            !! speed that relates velocity and compression
      real(dp) :: speed = 1         !! c
      real(dp) :: damping = 0       !! sigma
   contains
      procedure :: density
      procedure :: velocity
   end type sound_wave_t

contains

   !> (rho - rho0)/rho0 at a place.
   elemental real(dp) function density(self, x, time)
      class(sound_wave_t), intent(in) :: self
      real(dp), intent(in) :: x, time

      density = self%compression*cos(self%k*(x - self%speed*time))*exp(-self%damping*time)
   end function density

   !> Velocity along x at a place.
   elemental real(dp) function velocity(self, x, time)
      class(sound_wave_t), intent(in) :: self
      real(dp), intent(in) :: x, time

      velocity = self%c0*self%density(x, time)
   end function velocity

   !> sigma of long waves.
   elemental real(dp) function continuum_damping(alpha, h, c0, k) result(damping)
      real(dp), intent(in) :: alpha, h, c0
      real(dp), intent(in) :: k   !! wave number
      real(dp), parameter :: compression = 3.0_dp/8

      damping = compression*alpha*h*c0*k**2/2
   end function continuum_damping

end module acoustic_wave
