!> Harmonic means of two particles' coefficients.
!!
!! Source: eqs. 20 and 24, 2 a b/(a + b).
module harmonic_means
   use kinds, only: dp
   implicit none
   private

   public :: mean_coefficients

   real(dp), parameter :: nothing = 1.0e-60_dp   !! makes the mean of 0 and 0 vanish; its square can be divided by

contains

   !> alpha_ij and delta_ij, 0 where one of the two is 0, and 1/r**2. One division serves all three.
   elemental subroutine mean_coefficients(alpha_i, alpha_j, delta_i, delta_j, z, alpha_ij, delta_ij, inverse_2)
      real(dp), intent(in) :: alpha_i, alpha_j, delta_i, delta_j   !! >= 0
      real(dp), intent(in) :: z                                    !! r**2 > 0
      real(dp), intent(out) :: alpha_ij, delta_ij
      real(dp), intent(out) :: inverse_2                           !! 1/z
      real(dp) :: alpha_sum, delta_sum, sums, common, both

      alpha_sum = alpha_i + alpha_j + nothing
      delta_sum = delta_i + delta_j + nothing
      sums = alpha_sum*delta_sum
      common = 1/(sums*z)
      inverse_2 = common*sums
      both = 2*(common*z)
      alpha_ij = (alpha_i*alpha_j)*(delta_sum*both)
      delta_ij = (delta_i*delta_j)*(alpha_sum*both)
   end subroutine mean_coefficients

end module harmonic_means
