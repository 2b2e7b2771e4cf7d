!> The dynamic model: alpha_i and delta_i from the rate of strain, and the diffusive terms with them.
!!
!! Source: eqs. 22 and 23, D_i = 1/2 sum_j [u_ji (x) L_i grad W + L_i grad W (x) u_ji] V_j, ||D|| = sqrt(2 D:D); eqs. 21, 25, 26,
!! nu_T = (C_S l)**2 ||D||, nu_delta = (C_delta l)**2 ||D|| with l = 2h; alpha_i = K nu_T/(c0 h),
!! delta_i = nu_delta/(c0 h), both limited; between two particles their harmonic means act, eqs. 20 and 24.
module eddy
   use candidates, only: block_slots
   use diffusion, only: freeze_viscosity
   use eddy_sums, only: eddy_sums_t
   use first_sums, only: first_sums_t
   use kinds, only: dp
   use model, only: model_t
   use particles, only: particles_t
   use renormalisation, only: matrices_t
   implicit none
   private

   public :: velocity_gradient_t, velocity_gradient, strain_rate, eddy_coefficients, freeze_coefficients, freeze_eddy_terms

   !> Renormalised velocity gradient of a particle; 0 where L is singular.
   type :: velocity_gradient_t
      real(dp) :: u_x, u_y, v_x, v_y
   end type velocity_gradient_t

contains

   !> grad u = [ sum_j u_ji (x) grad W V_j ] L of one of a block's particles.
   pure type(velocity_gradient_t) function velocity_gradient(factor, sums, k, l_xx, l_xy, l_yy) result(gradient)
      real(dp), intent(in) :: factor             !! [1/m4] of the kernel's gradient
      type(first_sums_t), intent(in) :: sums     !! of the dynamic pass
      integer, intent(in) :: k                   !! place in the block
      real(dp), intent(in) :: l_xx, l_xy, l_yy   !! [1]

      gradient%u_x = factor*(sums%u_x(k)*l_xx + sums%u_y(k)*l_xy)
      gradient%u_y = factor*(sums%u_x(k)*l_xy + sums%u_y(k)*l_yy)
      gradient%v_x = factor*(sums%v_x(k)*l_xx + sums%v_y(k)*l_xy)
      gradient%v_y = factor*(sums%v_x(k)*l_xy + sums%v_y(k)*l_yy)
   end function velocity_gradient

   !> ||D|| = sqrt(2 D:D), eq. 22.
   elemental real(dp) function strain_rate(gradient)
      type(velocity_gradient_t), intent(in) :: gradient

      strain_rate = sqrt(2*(gradient%u_x**2 + gradient%v_y**2) + (gradient%u_y + gradient%v_x)**2)
   end function strain_rate

   !> alpha_i and delta_i of a strain rate, eqs. 21 and 25 with their limiters.
   elemental subroutine eddy_coefficients(model, strain, alpha, delta)
      type(model_t), intent(in) :: model
      real(dp), intent(in) :: strain            !! [1/s] ||D||
      real(dp), intent(out) :: alpha, delta     !! [1]
      real(dp) :: clipped

      clipped = min(strain, model%largest_strain)
      alpha = min(model%alpha_per_strain*clipped, model%limit)
      delta = min(model%delta_per_strain*clipped, model%limit)
   end subroutine eddy_coefficients

   !> alpha_i and delta_i of a block.
   pure subroutine freeze_coefficients(model, sums, l, p, i0, n)
      type(model_t), intent(in) :: model
      type(first_sums_t), intent(in) :: sums
      type(matrices_t), intent(in) :: l
      type(particles_t), intent(inout) :: p   !! alpha, delta of the block are set [1]
      integer, intent(in) :: i0, n            !! slot before the block's first; slots
      real(dp) :: strain(block_slots)
      integer :: k

      !$omp simd
      do k = 1, n
         strain(k) = strain_rate(velocity_gradient(model%kernel%gradient_factor, sums, k, l%xx(k), l%xy(k), l%yy(k)))
      end do
      call eddy_coefficients(model, strain(:n), p%alpha(i0 + 1:i0 + n), p%delta(i0 + 1:i0 + n))
   end subroutine freeze_coefficients

   !> The viscous acceleration and the density-diffusion rate, eq. 5 with eqs. 20 and 24.
   pure subroutine freeze_eddy_terms(model, sums, p, i0, n)
      type(model_t), intent(in) :: model
      type(eddy_sums_t), intent(in) :: sums
      type(particles_t), intent(inout) :: p   !! visc_x, visc_y, diff_s of the block are set
      integer, intent(in) :: i0, n            !! slot before the block's first; slots
      real(dp) :: factor
      integer :: k

      call freeze_viscosity(model, 1.0_dp, sums%viscous_x, sums%viscous_y, p, i0, n)
      factor = model%kernel%h*model%c0*model%kernel%gradient_factor
      !$omp simd
      do k = 1, n
         p%diff_s(i0 + k) = factor*sums%diffusion(k)
      end do
   end subroutine freeze_eddy_terms

end module eddy
