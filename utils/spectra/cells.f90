!> Points in square cells as wide as a reach, so that what is near a place is found in nine cells.
module cells
   use kinds, only: dp
   implicit none
   private

   public :: cells_t, new_cells, find_near

   !> Points sorted by cell.
   type :: cells_t
      real(dp) :: lower(2) = 0            !! corner of cell (1, 1)
      real(dp) :: width = 1
      integer :: n(2) = 0                 !! cells in x and y
      integer, allocatable :: first(:)    !! (cells + 1) place of a cell's first point in `member`
      integer, allocatable :: member(:)   !! (points) their numbers, cell by cell
   end type cells_t

contains

   !> Sorts points into cells. More cells than four for each point are not made: the cells then are wider than the reach.
   pure type(cells_t) function new_cells(x, y, reach) result(cells)
      real(dp), intent(in) :: x(:), y(:)   !! (points) at least one
      real(dp), intent(in) :: reach
      integer :: cell(size(x)), next, k

      cells%lower = [minval(x), minval(y)]
      associate (extent => [maxval(x), maxval(y)] - cells%lower)
         cells%width = max(reach, sqrt(product(extent/(2*size(x)))), maxval(extent)/1.0e4_dp)
         cells%n = int(extent/cells%width) + 1
      end associate
      cell = cell_of(cells, x, y)
      allocate (cells%first(product(cells%n) + 1), cells%member(size(x)))
      cells%first = 0
      do k = 1, size(x)
         cells%first(cell(k) + 1) = cells%first(cell(k) + 1) + 1
      end do
      cells%first(1) = 1
      do k = 2, size(cells%first)
         cells%first(k) = cells%first(k) + cells%first(k - 1)
      end do
      ! first(c) moves to the end of its cell while members are placed, and is set back then.
      do k = 1, size(x)
         next = cells%first(cell(k))
         cells%member(next) = k
         cells%first(cell(k)) = next + 1
      end do
      cells%first(2:) = cells%first(:size(cells%first) - 1)
      cells%first(1) = 1
   end function new_cells

   elemental integer function cell_of(cells, x, y)
      type(cells_t), intent(in) :: cells
      real(dp), intent(in) :: x, y

      cell_of = int((y - cells%lower(2))/cells%width)*cells%n(1) + int((x - cells%lower(1))/cells%width) + 1
   end function cell_of

   !> Numbers of all points in the cells around a place.
   pure subroutine find_near(cells, x, y, list)
      type(cells_t), intent(in) :: cells
      real(dp), intent(in) :: x, y
      integer, allocatable, intent(out) :: list(:)
      integer :: centre(2), first(2), last(2), j, n, row(2)

      centre = floor(max(min(([x, y] - cells%lower)/cells%width, 1.0e6_dp), -1.0e6_dp))
      first = max(centre - 1, 0)
      last = min(centre + 1, cells%n - 1)
      if (first(1) > last(1)) last(2) = first(2) - 1   ! beside all cells
      n = 0
      do j = first(2), last(2)
         row = j*cells%n(1) + 1 + [first(1), last(1)]
         n = n + cells%first(row(2) + 1) - cells%first(row(1))
      end do
      allocate (list(n))
      n = 0
      do j = first(2), last(2)
         row = j*cells%n(1) + 1 + [first(1), last(1)]
         associate (a => cells%first(row(1)), b => cells%first(row(2) + 1) - 1)
            list(n + 1:n + b - a + 1) = cells%member(a:b)
            n = n + b - a + 1
         end associate
      end do
   end subroutine find_near

end module cells
