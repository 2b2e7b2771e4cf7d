!> Window functions: they let a piece cut out of a signal end at zero, so that its ends make no wavenumbers of their own.
!!
!! Periodic form: w_j = sum_k c_k cos(2 pi k j/n), j = 0, ..., n - 1; the value at n would be the one at 0 again.
module windows
   use kinds, only: dp
   implicit none
   private

   public :: window_values

   !> The names that window_values knows; 'none' and 'rectangular' are the same.
   character(11), parameter, public :: window_names(*) = [character(11) :: 'hann', 'hamming', 'blackman', 'none', 'rectangular']

   real(dp), parameter :: pi = acos(-1.0_dp)

contains

   !> The n values of a window.
   pure function window_values(name, n) result(values)
      character(*), intent(in) :: name   !! one of window_names
      integer, intent(in) :: n
      real(dp) :: values(n)
      real(dp) :: c(0:2)
      integer :: j

      select case (name)
      case ('hann')
         c = [0.5_dp, -0.5_dp, 0.0_dp]
      case ('hamming')
         c = [0.54_dp, -0.46_dp, 0.0_dp]
      case ('blackman')
         c = [0.42_dp, -0.5_dp, 0.08_dp]
      case default
         c = [1.0_dp, 0.0_dp, 0.0_dp]
      end select
      do j = 1, n
         associate (phase => 2*pi*(j - 1)/n)
            values(j) = c(0) + c(1)*cos(phase) + c(2)*cos(2*phase)
         end associate
      end do
   end function window_values

end module windows
