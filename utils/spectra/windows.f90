!> Window functions of spectral analysis, in their periodic form (Harris 1978).
module windows
   use kinds, only: dp
   implicit none
   private

   public :: window_values

   character(8), parameter, public :: window_names(*) = [character(8) :: 'hann', 'hamming', 'blackman', 'none']

   real(dp), parameter :: pi = acos(-1.0_dp)

contains

   !> The window at n points of one period, from 0; 1 everywhere for 'none'.
   pure function window_values(name, n) result(w)
      character(*), intent(in) :: name   !! one of window_names
      integer, intent(in) :: n
      real(dp) :: w(n)
      real(dp) :: angle(n)
      integer :: j

      angle = [(2*pi*j/n, j=0, n - 1)]
      select case (name)
      case ('hann')
         w = 0.5_dp - 0.5_dp*cos(angle)
      case ('hamming')
         w = 0.54_dp - 0.46_dp*cos(angle)
      case ('blackman')
         w = 0.42_dp - 0.5_dp*cos(angle) + 0.08_dp*cos(2*angle)
      case default
         w = 1
      end select
   end function window_values

end module windows
