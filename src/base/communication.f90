!> What the processes of a run tell each other. This source is for a run of one process: nobody is asked.
module communication
   use kinds, only: dp, i8
   implicit none
   private

   public :: any_process, largest_of_all, sums_of_all

contains

   !> Whether a statement holds in some process.
   pure logical function any_process(statement)
      logical, intent(in) :: statement

      any_process = statement
   end function any_process

   !> Each value becomes its largest over all processes.
   pure subroutine largest_of_all(n, values)
      integer, intent(in) :: n
      real(dp), intent(inout) :: values(n)

      values = values
   end subroutine largest_of_all

   !> Each number becomes its sum over all processes.
   pure subroutine sums_of_all(n, numbers)
      integer, intent(in) :: n
      integer(i8), intent(inout) :: numbers(n)

      numbers = numbers
   end subroutine sums_of_all

end module communication
