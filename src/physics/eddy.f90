!> The dynamic model: alpha_i and delta_i from the rate of strain, and the diffusive terms with them.
!!
!! Source: eqs. 19-26. D_i = 1/2 sum_j [u_ji (x) L_i grad W + L_i grad W (x) u_ji] V_j, ||D|| = sqrt(2 D:D),
!! nu_T = (C_S l)**2 ||D||, nu_delta = (C_delta l)**2 ||D|| with l = 2h; alpha_i = K nu_T/(c0 h),
!! delta_i = nu_delta/(c0 h), both limited; between two particles their harmonic means act.
module eddy
   use eddy_sums, only: eddy_sums_t
   use kinds, only: dp
   use lanes, only: nl
   use model, only: model_t
   use particles, only: particles_t
   use renormalisation, only: renormalisation_t, renormalise
   use strain_sums, only: strain_sums_t
   implicit none
   private

   public :: velocity_gradient_t, velocity_gradient, strain_rate, eddy_coefficients, freeze_coefficients, freeze_eddy_terms

   !> Renormalised velocity gradient of a cluster; 0 where L is singular.
   type :: velocity_gradient_t
      real(dp) :: u_x(nl), u_y(nl), v_x(nl), v_y(nl)
   end type velocity_gradient_t

contains

   !> grad u = [ sum_j u_ji (x) grad W V_j ] L.
   pure type(velocity_gradient_t) function velocity_gradient(factor, sums, l) result(gradient)
      real(dp), intent(in) :: factor             !! of the kernel's gradient
      type(strain_sums_t), intent(in) :: sums
      type(renormalisation_t), intent(in) :: l

      gradient%u_x = factor*(sums%u_x*l%xx + sums%u_y*l%xy)
      gradient%u_y = factor*(sums%u_x*l%xy + sums%u_y*l%yy)
      gradient%v_x = factor*(sums%v_x*l%xx + sums%v_y*l%xy)
      gradient%v_y = factor*(sums%v_x*l%xy + sums%v_y*l%yy)
   end function velocity_gradient

   !> ||D|| = sqrt(2 D:D), eq. 20.
   pure function strain_rate(gradient) result(norm)
      type(velocity_gradient_t), intent(in) :: gradient
      real(dp) :: norm(nl)

      norm = sqrt(2*(gradient%u_x**2 + gradient%v_y**2) + (gradient%u_y + gradient%v_x)**2)
   end function strain_rate

   !> alpha_i and delta_i of a strain rate, eqs. 21-24 with their limiters.
   elemental subroutine eddy_coefficients(model, strain, alpha, delta)
      type(model_t), intent(in) :: model
      real(dp), intent(in) :: strain            !! ||D||
      real(dp), intent(out) :: alpha, delta
      real(dp) :: clipped

      clipped = min(strain, model%largest_strain)
      alpha = min(model%alpha_per_strain*clipped, model%limit)
      delta = min(model%delta_per_strain*clipped, model%limit)
   end subroutine eddy_coefficients

   !> G of eq. 6, alpha_i and delta_i of a cluster.
   pure subroutine freeze_coefficients(model, sums, p, i0, singular)
      type(model_t), intent(in) :: model
      type(strain_sums_t), intent(in) :: sums
      type(particles_t), intent(inout) :: p   !! grad_x, grad_y, alpha, delta of the cluster are set
      integer, intent(in) :: i0               !! slot before the cluster's first
      integer, intent(out) :: singular        !! particles whose L**-1 could not be inverted
      type(renormalisation_t) :: l

      associate (f => model%kernel%gradient_factor)
         l = renormalise(f, sums%matrix_xx, sums%matrix_xy, sums%matrix_yy)
         p%grad_x(i0 + 1:i0 + nl) = f*(l%xx*sums%density_x + l%xy*sums%density_y)
         p%grad_y(i0 + 1:i0 + nl) = f*(l%xy*sums%density_x + l%yy*sums%density_y)
         call eddy_coefficients(model, strain_rate(velocity_gradient(f, sums, l)), &
                                p%alpha(i0 + 1:i0 + nl), p%delta(i0 + 1:i0 + nl))
      end associate
      singular = count(p%id(i0 + 1:i0 + nl) > 0 .and. .not. l%regular)
   end subroutine freeze_coefficients

   !> The viscous acceleration and the density-diffusion rate, eq. 5 with eqs. 25 and 26.
   pure subroutine freeze_eddy_terms(model, sums, p, i0)
      type(model_t), intent(in) :: model
      type(eddy_sums_t), intent(in) :: sums
      type(particles_t), intent(inout) :: p   !! visc_x, visc_y, diff_s of the cluster are set
      integer, intent(in) :: i0               !! slot before the cluster's first
      real(dp) :: factor, by_density(nl)

      factor = model%kernel%h*model%c0*model%kernel%gradient_factor
      by_density = factor*model%rho0/(model%rho0 + p%base%s(i0 + 1:i0 + nl))
      p%visc_x(i0 + 1:i0 + nl) = by_density*sums%viscous_x
      p%visc_y(i0 + 1:i0 + nl) = by_density*sums%viscous_y
      p%diff_s(i0 + 1:i0 + nl) = factor*sums%diffusion
   end subroutine freeze_eddy_terms

end module eddy
