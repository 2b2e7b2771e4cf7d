!> Explicit Runge-Kutta schemes whose stages each build on the rates of the stage before alone.
!!
!! Stage k+1 is at y + a_k dt f_k, the step ends at y + dt sum_k b_k f_k. On a linear problem dy/dt = T y a step multiplies y
!! by 1 + sum_m c_m (T dt)**m; with a part B of T frozen at the first stage by 1 + sum_m c_m dt**m A**(m-1) (A + B), A = T - B.
module integrators
   use kinds, only: dp
   implicit none
   private

   public :: integrator_t, new_integrator, step_polynomial

   integer, parameter, public :: most_stages = 4   !! of all schemes
   character(3), parameter, public :: integrator_names(3) = ['rk4', 'rk3', 'rk2']

   !> A scheme's coefficients, and the part of the axes in which |sum_m c_m z**m| <= 1.
   type :: integrator_t
      character(3) :: name = 'rk4'
      integer :: stages = 4
      real(dp) :: ahead(most_stages) = 0    !! a_k
      real(dp) :: weight(most_stages) = 0   !! b_k
      real(dp) :: imaginary = 0             !! z = i y is stable up to this y: sound
      real(dp) :: negative = 0              !! z = -x is stable up to this x: diffusion
   end type integrator_t

contains

   !> The scheme of a name in `integrator_names`: classical rk4, Heun's rk3, the midpoint rule rk2.
   pure type(integrator_t) function new_integrator(name) result(self)
      character(*), intent(in) :: name

      select case (name)
      case ('rk3')
         self = integrator_t('rk3', 3, [1.0_dp, 2.0_dp, 0.0_dp, 0.0_dp]/3, [1.0_dp, 0.0_dp, 3.0_dp, 0.0_dp]/4, &
                             sqrt(3.0_dp), 2.5127453266_dp)
      case ('rk2')
         self = integrator_t('rk2', 2, [1.0_dp, 0.0_dp, 0.0_dp, 0.0_dp]/2, [0.0_dp, 1.0_dp, 0.0_dp, 0.0_dp], 0.0_dp, 2.0_dp)
      case default
         self = integrator_t('rk4', 4, [1.0_dp, 1.0_dp, 2.0_dp, 0.0_dp]/2, [1.0_dp, 2.0_dp, 2.0_dp, 1.0_dp]/6, &
                             sqrt(8.0_dp), 2.7852935634_dp)
      end select
   end function new_integrator

   !> c_m, m = 1 to the number of stages.
   pure function step_polynomial(self) result(c)
      type(integrator_t), intent(in) :: self
      real(dp) :: c(self%stages)
      real(dp) :: stage(self%stages)   ! f_k = sum_m stage(m) T**m y
      integer :: k, m

      stage = 0
      stage(1) = 1
      c = 0
      do k = 1, self%stages
         c = c + self%weight(k)*stage
         do m = self%stages, 2, -1
            stage(m) = self%ahead(k)*stage(m - 1)
         end do
      end do
   end function step_polynomial

end module integrators
