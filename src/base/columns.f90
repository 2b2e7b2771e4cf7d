!> A row of a table whose columns are chosen at run time: each value comes with its name and unit.
module columns
   use kinds, only: dp
   implicit none
   private

   public :: columns_t

   integer, parameter, public :: column_name_length = 48, column_unit_length = 48

   !> Columns in the order in which they were added.
   type :: columns_t
      character(column_name_length), allocatable :: names(:)   !! (columns) without blanks
      character(column_unit_length), allocatable :: units(:)   !! (columns)
      real(dp), allocatable :: values(:)                       !! (columns)
   contains
      procedure :: add
   end type columns_t

contains

   !> Adds a column and its value in this row.
   pure subroutine add(self, name, unit, value)
      class(columns_t), intent(inout) :: self
      character(*), intent(in) :: name   !! without blanks
      character(*), intent(in) :: unit
      real(dp), intent(in) :: value

      if (.not. allocated(self%values)) allocate (self%names(0), self%units(0), self%values(0))
      self%names = [character(column_name_length) :: self%names, name]
      self%units = [character(column_unit_length) :: self%units, unit]
      self%values = [self%values, value]
   end subroutine add

end module columns
