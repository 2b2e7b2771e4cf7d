!> The terms that a step freezes, as the step itself makes them, in the order of the particles' numbers.
module frozen
   use kinds, only: dp
   use march, only: new_timers
   use model, only: model_t
   use neighbours, only: neighbours_t
   use particles, only: particles_t
   use patches, only: deal, points_of, points_t, scatter
   use step_state, only: step_t
   use time_step, only: advance, refresh
   use timers, only: timers_t
   implicit none
   private

   public :: frozen_t, freeze

   real(dp), parameter :: moment = 1.0e-9_dp   ! of a step

   !> (n) or (2, n)
   type :: frozen_t
      type(points_t) :: at                        !! the state that all this belongs to
      type(step_t) :: run
      real(dp), allocatable :: viscosity(:, :)    !! acceleration
      real(dp), allocatable :: diffusion(:)       !! rate of rho
      real(dp), allocatable :: gradient(:, :)     !! G
      real(dp), allocatable :: alpha(:), delta(:) !! alpha_i, delta_i; 0 without the dynamic model
      real(dp), allocatable :: dissipating(:)     !! power; 0 if it is not asked for
   contains
      procedure :: viscous_power
      procedure :: diffusive_power
   end type frozen_t

contains

   !> Takes one very short step from the state in `next` and looks at what it froze.
   subroutine freeze(model, start, found)
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: start
      type(frozen_t), intent(out) :: found
      type(particles_t) :: p
      type(neighbours_t) :: near
      type(timers_t) :: timers

      p = start
      call deal(p)
      timers = new_timers()
      call refresh(model, p, near, found%run, timers)
      call advance(model, p, near, found%run, moment, timers)
      found%at = points_of(p)
      allocate (found%viscosity(2, p%n), found%gradient(2, p%n))
      allocate (found%diffusion(p%n), found%alpha(p%n), found%delta(p%n), found%dissipating(p%n), source=0.0_dp)
      call scatter(p, p%visc_x, found%viscosity(1, :))
      call scatter(p, p%visc_y, found%viscosity(2, :))
      call scatter(p, p%grad_x, found%gradient(1, :))
      call scatter(p, p%grad_y, found%gradient(2, :))
      call scatter(p, p%diff_s, found%diffusion)
      if (allocated(p%alpha)) call scatter(p, p%alpha, found%alpha)
      if (allocated(p%delta)) call scatter(p, p%delta, found%delta)
      if (allocated(p%dissipating)) call scatter(p, p%dissipating, found%dissipating)
   end subroutine freeze

   !> P_alpha = sum m u.a_visc.
   pure real(dp) function viscous_power(self)
      class(frozen_t), intent(in) :: self

      viscous_power = sum(self%at%m*(self%at%u*self%viscosity(1, :) + self%at%v*self%viscosity(2, :)))
   end function viscous_power

   !> P_delta = sum (m p/rho**2) (drho/dt)_diffusive.
   pure real(dp) function diffusive_power(self, model)
      class(frozen_t), intent(in) :: self
      type(model_t), intent(in) :: model

      diffusive_power = sum(self%at%m*model%c0**2*self%at%s/(model%rho0 + self%at%s)**2*self%diffusion)
   end function diffusive_power

end module frozen
