!> Inviscid rates of a cluster from its pair sums.
!!
!! Source: eq. 5 without the diffusive sums, with p = c0**2 s (eq. 3):
!! drho_i/dt = -rho_i sum_j u_ji.grad W V_j and
!! du_i/dt = g - 1/rho_i sum_j (p_i + p_j) grad W V_j.
module flow
   use flow_sums, only: flow_sums_t
   use gradient_sums, only: gradient_sums_t
   use kinds, only: dp
   use lanes, only: nl
   use model, only: model_t
   use particles, only: state_t
   use strain_sums, only: strain_sums_t
   implicit none
   private

   public :: rates_t, flow_rates, as_flow_sums

   !> The flow sums contained in a first stage's sums.
   interface as_flow_sums
      procedure :: from_gradient_sums, from_strain_sums
   end interface as_flow_sums

   !> Rates of a cluster; gravity is kept apart because its work is the potential energy's.
   type :: rates_t
      real(dp) :: u(nl), v(nl)   !! acceleration by pressure
      real(dp) :: s(nl)          !! rate of density
   end type rates_t

contains

   !> Turns the pair sums into rates.
   pure subroutine flow_rates(model, state, i0, sums, rates)
      type(model_t), intent(in) :: model
      type(state_t), intent(in) :: state     !! the state that the sums were taken of
      integer, intent(in) :: i0              !! slot before the cluster's first
      type(flow_sums_t), intent(in) :: sums
      type(rates_t), intent(out) :: rates
      real(dp) :: rho(nl), factor(nl)

      rho = model%rho0 + state%s(i0 + 1:i0 + nl)
      factor = -model%c0**2*model%kernel%gradient_factor/rho
      rates%u = factor*sums%force_x
      rates%v = factor*sums%force_y
      rates%s = -rho*model%kernel%gradient_factor*sums%divergence
   end subroutine flow_rates

   !> The flow sums contained in a first stage's sums of the constant model.
   pure type(flow_sums_t) function from_gradient_sums(sums, state, i0) result(flow)
      type(gradient_sums_t), intent(in) :: sums
      type(state_t), intent(in) :: state
      integer, intent(in) :: i0

      flow%divergence = sums%divergence
      call both_pressures(state%s(i0 + 1:i0 + nl), sums%density_x, sums%kernel_x, flow%force_x)
      call both_pressures(state%s(i0 + 1:i0 + nl), sums%density_y, sums%kernel_y, flow%force_y)
   end function from_gradient_sums

   !> The same of the dynamic model.
   pure type(flow_sums_t) function from_strain_sums(sums, state, i0) result(flow)
      type(strain_sums_t), intent(in) :: sums
      type(state_t), intent(in) :: state
      integer, intent(in) :: i0

      flow%divergence = sums%u_x + sums%v_y
      call both_pressures(state%s(i0 + 1:i0 + nl), sums%density_x, sums%kernel_x, flow%force_x)
      call both_pressures(state%s(i0 + 1:i0 + nl), sums%density_y, sums%kernel_y, flow%force_y)
   end function from_strain_sums

   ! sum_j (s_i + s_j) grad W V = sum_j (s_j - s_i) grad W V + 2 s_i sum_j grad W V.
   elemental subroutine both_pressures(s, difference, kernel, total)
      real(dp), intent(in) :: s, difference, kernel
      real(dp), intent(out) :: total

      total = difference + 2*s*kernel
   end subroutine both_pressures

end module flow
