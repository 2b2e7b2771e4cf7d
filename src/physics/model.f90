!> The constants of the model in paper symbols, worked out once from the input.
module model
   use images, only: walls_t
   use kernel, only: kernel_t
   use kinds, only: dp
   implicit none
   private

   public :: model_t

   !> Everything the right-hand sides need besides the state.
   type :: model_t
      type(kernel_t) :: kernel        !! W and its gradient
      type(walls_t) :: walls          !! mirror planes
      real(dp) :: dx = 0              !! initial particle spacing
      real(dp) :: c0 = 0              !! sound speed
      real(dp) :: rho0 = 0            !! density at p = 0
      real(dp) :: gravity = 0         !! along -y
      real(dp) :: alpha = 0           !! viscous coefficient, real viscosity included
      real(dp) :: delta = 0           !! density-diffusion coefficient
      real(dp) :: cfl = 0             !! Courant number of eq. 8
   contains
      procedure :: step_limit
   end type model_t

contains

   !> dt = CFL h/(c0 + h max|pi_ij|), eq. 8.
   pure real(dp) function step_limit(self, largest_pi)
      class(model_t), intent(in) :: self
      real(dp), intent(in) :: largest_pi   !! over all pairs

      step_limit = self%cfl*self%kernel%h/(self%c0 + self%kernel%h*largest_pi)
   end function step_limit

end module model
