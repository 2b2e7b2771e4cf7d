!> Explicit Runge-Kutta schemes whose stages each build on the rates of the stage before alone.
!!
!! Stage k+1 is at y_k+1 = y + a_k dt f_k, the step ends at y + dt sum_k b_k f_k. With a_k dt f_k = y_k+1 - y this is
!! y + sum_k<n (b_k/a_k) (y_k+1 - y) + dt b_n f_n: no rate has to be kept but those of the last stage n.
module integrators
   use kinds, only: dp
   implicit none
   private

   public :: integrator_t, new_integrator

   integer, parameter, public :: most_stages = 4   !! of all schemes
   character(3), parameter, public :: integrator_names(3) = ['rk4', 'rk3', 'rk2']

   !> A scheme's coefficients, and how far along the axes it is stable.
   type :: integrator_t
      character(3) :: name = 'rk4'
      integer :: stages = 4
      real(dp) :: ahead(most_stages) = 0    !! a_k
      real(dp) :: weight(most_stages) = 0   !! b_k
      real(dp) :: share(most_stages) = 0    !! b_k/a_k of all stages but the last
      real(dp) :: imaginary = 0             !! sound of rate w: w dt at most
      real(dp) :: negative = 0              !! diffusion of rate w: w dt at most
   contains
      procedure :: time_of
   end type integrator_t

contains

   !> The scheme of a name in `integrator_names`: classical rk4, Heun's rk3, the midpoint rule rk2.
   pure type(integrator_t) function new_integrator(name) result(self)
      character(*), intent(in) :: name

      self%name = name
      select case (name)
      case ('rk2')
         self%stages = 2
         self%ahead = [1.0_dp, 0.0_dp, 0.0_dp, 0.0_dp]/2
         self%weight = [0.0_dp, 1.0_dp, 0.0_dp, 0.0_dp]
         self%imaginary = 0
         self%negative = 2
      case ('rk3')
         self%stages = 3
         self%ahead = [1.0_dp, 2.0_dp, 0.0_dp, 0.0_dp]/3
         self%weight = [1.0_dp, 0.0_dp, 3.0_dp, 0.0_dp]/4
         self%imaginary = sqrt(3.0_dp)
         self%negative = 2.5127453266_dp
      case default
         self%name = 'rk4'
         self%stages = 4
         self%ahead = [1.0_dp, 1.0_dp, 2.0_dp, 0.0_dp]/2
         self%weight = [1.0_dp, 2.0_dp, 2.0_dp, 1.0_dp]/6
         self%imaginary = sqrt(8.0_dp)
         self%negative = 2.7852935634_dp
      end select
      self%share(:self%stages - 1) = self%weight(:self%stages - 1)/self%ahead(:self%stages - 1)
   end function new_integrator

   !> When a stage is, from the start of the step and in its length.
   pure real(dp) function time_of(self, stage)
      class(integrator_t), intent(in) :: self
      integer, intent(in) :: stage

      time_of = 0
      if (stage > 1) time_of = self%ahead(stage - 1)
   end function time_of

end module integrators
