!> Windows for spectra: periodic ones, so that their transforms have few values that are not zero.
module windows
   use kinds, only: dp
   implicit none
   private

   public :: window_values

   character(8), parameter, public :: window_names(*) = ['hann    ', 'hamming ', 'blackman', 'none    ']

contains

   !> A window's values; 1 at most.
   pure function window_values(name, n) result(values)
      character(*), intent(in) :: name   !! one of window_names
      integer, intent(in) :: n
      real(dp) :: values(n), angle(n)
      integer :: j

      angle = [(2*acos(-1.0_dp)*j/n, j=0, n - 1)]
      select case (name)
      case ('hamming')
         values = 0.54_dp - 0.46_dp*cos(angle)
      case ('blackman')
         values = 0.42_dp - 0.5_dp*cos(angle) + 0.08_dp*cos(2*angle)
      case ('none')
         values = 1
      case default
         values = 0.5_dp - 0.5_dp*cos(angle)
      end select
   end function window_values

end module windows
