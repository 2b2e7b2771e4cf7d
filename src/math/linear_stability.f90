!> Limits of the time step from the linear stability analysis of the scheme.
!!
!! Source: Runge-Kutta 4 with diffusion frozen over the step, on a square lattice with h = 2 dx and this kernel (ours;
!! docs/equations.md). The Courant number is dt c0/h; alpha and delta are the coefficients of eq. 5.
module linear_stability
   use kinds, only: dp
   implicit none
   private

   public :: largest_cfl

   real(dp), parameter, public :: cfl_acoustic = 2.49_dp       !! of sound waves without diffusion
   !> Of the density diffusion: dt = 0.2 h**2/(delta h c0). The lattice's own limit is 0.294; in disordered fluid the kernel sum is
   !! up to 1.3 times the lattice's, and the rate of diffusion with it (docs/equations.md).
   real(dp), parameter, public :: cfl_times_delta = 0.2_dp
   !> Of viscosity. With alpha = 8 nu/(c0 h) it is dt = 0.0625 h**2/nu: independent of the sound speed. The lattice's own limit is
   !! 0.932; in disordered fluid with a free surface single particles run away from about 0.7 on (docs/equations.md).
   real(dp), parameter, public :: cfl_times_alpha = 0.5_dp

contains

   !> Largest Courant number dt c0/h that is safe: min(2.49, 0.2/delta, 0.5/alpha).
   elemental real(dp) function largest_cfl(delta, alpha)
      real(dp), intent(in) :: delta   !! largest delta_i [-]
      real(dp), intent(in) :: alpha   !! largest alpha_i, that of the viscosity included [-]

      ! By products: a coefficient may be 0.
      largest_cfl = cfl_acoustic
      if (delta*largest_cfl > cfl_times_delta) largest_cfl = cfl_times_delta/delta
      if (alpha*largest_cfl > cfl_times_alpha) largest_cfl = cfl_times_alpha/alpha
   end function largest_cfl

end module linear_stability
