!> The order of many numbers.
module sorting
   use kinds, only: dp
   implicit none
   private

   public :: ascending

contains

   !> Positions of the values from the least to the largest; equal ones stay in their order. Time is n log n.
   pure function ascending(values) result(order)
      real(dp), intent(in) :: values(:)   !! (n)
      integer :: order(size(values))
      integer :: other(size(values)), half, left, middle, right, i, j, k
      logical :: from_first

      order = [(i, i=1, size(values))]
      half = 1
      do while (half < size(values))
         do left = 1, size(values), 2*half
            middle = min(left + half, size(values) + 1)      ! where the second run begins
            right = min(left + 2*half, size(values) + 1)     ! where it has ended
            i = left
            j = middle
            do k = left, right - 1
               from_first = j >= right
               if (i < middle .and. j < right) from_first = values(order(i)) <= values(order(j))
               if (from_first) then
                  other(k) = order(i)
                  i = i + 1
               else
                  other(k) = order(j)
                  j = j + 1
               end if
            end do
         end do
         order = other
         half = 2*half
      end do
   end function ascending

end module sorting
