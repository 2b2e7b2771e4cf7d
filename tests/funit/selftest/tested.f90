!> Code under test for the tests of the stand-in.
module tested
   use, intrinsic :: iso_fortran_env, only: real64
   use funit, only: throw
   implicit none
   private

   public :: root

contains

   !> The square root; raises an exception where there is none.
   real(real64) function root(x)
      real(real64), intent(in) :: x

      root = 0
      if (x < 0) then
         call throw('negative number')
         return
      end if
      root = sqrt(x)
   end function root

end module tested
