!> The words of the command line.
module program_arguments
   implicit none
   private

   public :: take_arguments

contains

   !> All words from one on, as long as the longest.
   subroutine take_arguments(arguments, from)
      character(:), allocatable, intent(out) :: arguments(:)
      integer, intent(in), optional :: from   !! number of the first, 1 if left out
      integer :: before, i, length, longest

      before = 0
      if (present(from)) before = from - 1
      longest = 1
      do i = before + 1, command_argument_count()
         call get_command_argument(i, length=length)
         longest = max(longest, length)
      end do
      allocate (character(longest) :: arguments(max(0, command_argument_count() - before)))
      do i = 1, size(arguments)
         call get_command_argument(before + i, arguments(i))
      end do
   end subroutine take_arguments

end module program_arguments
