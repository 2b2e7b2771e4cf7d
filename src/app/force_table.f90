!> What the tables of forces have in common: how often a row is due, the open file.
module force_table
   use cadence, only: cadence_t
   use columns, only: columns_t
   use errors, only: failure
   use table, only: table_t
   use time_scale, only: time_scale_t
   implicit none
   private

   public :: force_table_t

   !> An open table; those that extend it measure.
   type :: force_table_t
      type(cadence_t) :: when
      type(table_t) :: table
      type(time_scale_t) :: scale
   contains
      procedure :: prepare
      procedure :: open_file
      procedure :: is_open
      procedure :: begin_anew
      procedure :: secure
      procedure :: finish
   end type force_table_t

contains

   !> Takes the cadence, whose text was checked with the input, and the unit of time.
   subroutine prepare(self, cadence, scale)
      class(force_table_t), intent(inout) :: self
      character(*), intent(in) :: cadence
      type(time_scale_t), intent(in) :: scale
      character(:), allocatable :: message

      call self%when%parse(trim(cadence), message)
      self%scale = scale
   end subroutine prepare

   !> Opens the file of rows like this one, or looks whether one that was begun can go on.
   subroutine open_file(self, path, head, row, only_check, problem)
      class(force_table_t), intent(inout) :: self
      character(*), intent(in) :: path
      character(*), intent(in) :: head(:)       !! comment lines, without #
      type(columns_t), intent(in) :: row
      logical, intent(in) :: only_check
      type(failure), intent(inout) :: problem   !! exit_files

      if (self%table%was_begun()) then
         call self%table%go_on(path, size(row%names), only_check, problem)
      else if (.not. only_check) then
         call self%table%create(path, head, row%names, row%units, problem)
      end if
   end subroutine open_file

   pure logical function is_open(self)
      class(force_table_t), intent(in) :: self

      is_open = self%table%is_open()
   end function is_open

   !> Forgets which file there was; what is a mean since the last row goes on.
   subroutine begin_anew(self)
      class(force_table_t), intent(inout) :: self

      call self%table%begin_anew()
   end subroutine begin_anew

   !> All rows so far are on the disk.
   subroutine secure(self, problem)
      class(force_table_t), intent(inout) :: self
      type(failure), intent(inout) :: problem   !! exit_files

      call self%table%secure(problem)
   end subroutine secure

   !> Closes the table.
   subroutine finish(self, problem)
      class(force_table_t), intent(inout) :: self
      type(failure), intent(inout) :: problem

      call self%table%close(problem)
   end subroutine finish

end module force_table
