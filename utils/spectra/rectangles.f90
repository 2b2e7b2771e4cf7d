!> The largest rectangle of a grid in which a condition holds everywhere.
module rectangles
   implicit none
   private

   public :: largest_rectangle

contains

   !> Corners [i1, j1, i2, j2] of the rectangle with the most points among those at least so many points wide and high; zeros if
   !! there is none.
   !!
   !! Row by row, each column is a bar as high as the points that hold above one another; the largest rectangle under the
   !! bars is found with a stack of rising bars.
   pure function largest_rectangle(holds, least) result(corners)
      logical, intent(in) :: holds(:, :)   !! (nx, ny)
      integer, intent(in) :: least
      integer :: corners(4)
      integer :: height(size(holds, 1) + 1), stack(size(holds, 1) + 1)
      integer :: area, i, j, left, n, top

      n = size(holds, 1)
      corners = 0
      area = 0
      height = 0
      do j = 1, size(holds, 2)
         height(:n) = merge(height(:n) + 1, 0, holds(:, j))   ! height(n + 1) = 0 closes all bars
         top = 0
         do i = 1, n + 1
            do while (top > 0)
               if (height(stack(top)) < height(i)) exit
               left = 1
               if (top > 1) left = stack(top - 1) + 1
               if (min(height(stack(top)), i - left) >= least .and. height(stack(top))*(i - left) > area) then
                  area = height(stack(top))*(i - left)
                  corners = [left, j - height(stack(top)) + 1, i - 1, j]
               end if
               top = top - 1
            end do
            top = top + 1
            stack(top) = i
         end do
      end do
   end function largest_rectangle

end module rectangles
