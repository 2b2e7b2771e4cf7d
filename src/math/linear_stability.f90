!> Limits of the time step from the linear stability analysis of the scheme.
!!
!! Source: the analysis of module `von_neumann` (ours; docs/equations.md). Rates of sound, density diffusion and viscosity on a
!! lattice, times the step, must stay inside the part of the axes where the integrator is stable; terms that are frozen over the
!! step are Euler's, stable to -2. The Courant number is dt c0/h; alpha and delta are the coefficients of eq. 5.
module linear_stability
   use integrators, only: integrator_t
   use kinds, only: dp
   use von_neumann, only: fastest_rates, lattice_waves, stable_cfl, wave_t
   implicit none
   private

   public :: stability_t, new_stability, margins_t

   integer, parameter :: waves_along = 24        ! wave numbers looked at, along an axis
   real(dp), parameter :: frozen_negative = 2    ! Euler's limit
   !> Below this cfl the growth of undamped sound in rk2 is lost in what `stable_cfl` counts as none.
   real(dp), parameter :: least_damped_cfl = 0.2_dp

   !> Shares of the lattice's limits that are used: disordered fluid is less stable. Found in flows by utils/studies/margins
   !! (docs/equations.md).
   type :: margins_t
      !> On a lattice the diffusive terms take up to 3 % of the limit of sound. In disordered fluid an oscillating drop and a
      !! dam break lose their energy balance at 0.95 of it; at 0.90 the dam break does from every other start.
      real(dp) :: sound = 0.84_dp
      !> The rate at each particle follows its kernel sum (`frozen_terms.crowding`). Dam breaks then run away at 1, not at 0.9.
      real(dp) :: diffusion = 0.9_dp
      !> In disordered fluid with a free surface single particles run away at 0.85 of the lattice's viscous limit,
      !! not at 0.75.
      real(dp) :: viscous = 0.5365_dp
   end type margins_t

   !> Largest stable Courant numbers.
   type :: stability_t
      real(dp) :: sound = 0         !! of sound waves; 0: they grow whatever the step
      real(dp) :: times_delta = 0   !! times the largest delta_i, each times its crowding
      real(dp) :: times_alpha = 0   !! times the largest alpha_i, that of the viscosity included
   contains
      procedure :: largest_cfl
   end type stability_t

contains

   !> The limits of an integrator; with rk4, frozen diffusion and h = 2 dx they are 2.09, 0.264 and 0.5.
   pure type(stability_t) function new_stability(integrator, frozen, ratio, delta, alpha, margins) result(self)
      type(integrator_t), intent(in) :: integrator
      logical, intent(in) :: frozen   !! diffusive terms are held over the step
      real(dp), intent(in) :: ratio   !! h/dx
      real(dp), intent(in) :: delta   !! that acts at least everywhere: rk2 lives by it
      real(dp), intent(in) :: alpha   !! the same
      type(margins_t), intent(in), optional :: margins   !! other than the safe ones
      type(margins_t) :: share
      type(wave_t) :: waves(waves_along*(waves_along + 3)/2)
      real(dp) :: rates(3), negative, damped

      if (present(margins)) share = margins
      waves = lattice_waves(ratio, waves_along)
      rates = fastest_rates(waves)
      negative = integrator%negative
      if (frozen) negative = frozen_negative
      if (integrator%imaginary > 0) then
         self%sound = share%sound*integrator%imaginary/rates(1)
      else
         damped = stable_cfl(waves, integrator, frozen, delta, alpha)
         if (damped > least_damped_cfl) self%sound = share%sound*damped
      end if
      self%times_delta = share%diffusion*negative/rates(2)
      self%times_alpha = share%viscous*negative/rates(3)
   end function new_stability

   !> Largest Courant number dt c0/h that is safe: min(sound, times_delta/delta, times_alpha/alpha).
   elemental real(dp) function largest_cfl(self, delta, alpha)
      class(stability_t), intent(in) :: self
      real(dp), intent(in) :: delta   !! largest delta_i, each times its crowding [-]
      real(dp), intent(in) :: alpha   !! largest alpha_i, that of the viscosity included [-]

      ! By products: a coefficient may be 0.
      largest_cfl = self%sound
      if (delta*largest_cfl > self%times_delta) largest_cfl = self%times_delta/delta
      if (alpha*largest_cfl > self%times_alpha) largest_cfl = self%times_alpha/alpha
   end function largest_cfl

end module linear_stability
