!> Inviscid rates of a block from its pair sums.
!!
!! Source: eq. 5 without the diffusive sums, with p = c0**2 s (eq. 3):
!! drho_i/dt = -rho_i sum_j u_ji.grad W V_j and
!! du_i/dt = g - 1/rho_i sum_j (p_i + p_j) grad W V_j.
module flow
   use candidates, only: block_slots
   use flow_sums, only: flow_sums_t
   use kinds, only: dp
   use model, only: model_t
   use particles, only: state_t
   implicit none
   private

   public :: rates_t, flow_rates

   !> Rates of a block; gravity is kept apart because its work is the potential energy's.
   type :: rates_t
      real(dp) :: u(block_slots), v(block_slots)   !! [m/s2] acceleration by pressure
      real(dp) :: s(block_slots)                   !! [kg/m3/s] rate of density
   end type rates_t

contains

   !> Turns the pair sums into rates.
   pure subroutine flow_rates(model, state, i0, n, sums, rates)
      type(model_t), intent(in) :: model
      type(state_t), intent(in) :: state     !! the state that the sums were taken of
      integer, intent(in) :: i0, n           !! slot before the block's first; slots
      class(flow_sums_t), intent(in) :: sums
      type(rates_t), intent(inout) :: rates
      real(dp) :: rho, factor
      integer :: k

      !$omp simd private(rho, factor)
      do k = 1, n
         rho = model%rho0 + state%s(i0 + k)
         factor = -model%c0**2*model%kernel%gradient_factor/rho
         rates%u(k) = factor*sums%force_x(k)
         rates%v(k) = factor*sums%force_y(k)
         rates%s(k) = -rho*model%kernel%gradient_factor*sums%divergence(k)
      end do
   end subroutine flow_rates

end module flow
