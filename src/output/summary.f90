!> The end of a run in `key = value` lines, written as one whole file.
module summary
   use communication, only: is_first
   use errors, only: failure
   use file_system, only: write_whole_file
   use kinds, only: dp, i8
   implicit none
   private

   public :: summary_t

   !> Lines `key = value` in the order in which they were added.
   type :: summary_t
      private
      character(:), allocatable :: text
   contains
      procedure :: add_text
      procedure, private :: add_real, add_integer, add_long
      generic :: add => add_text, add_real, add_integer, add_long
      procedure :: write => write_summary
   end type summary_t

contains

   subroutine add_text(self, key, value)
      class(summary_t), intent(inout) :: self
      character(*), intent(in) :: key     !! without blanks
      character(*), intent(in) :: value   !! one line

      if (.not. allocated(self%text)) self%text = ''
      self%text = self%text//trim(key)//' = '//trim(adjustl(value))//new_line('a')
   end subroutine add_text

   !> Adds a real number in full precision.
   subroutine add_real(self, key, value)
      class(summary_t), intent(inout) :: self
      character(*), intent(in) :: key
      real(dp), intent(in) :: value
      character(32) :: buffer

      write (buffer, '(es24.16e3)') value
      call self%add_text(key, buffer)
   end subroutine add_real

   subroutine add_integer(self, key, value)
      class(summary_t), intent(inout) :: self
      character(*), intent(in) :: key
      integer, intent(in) :: value

      call self%add_long(key, int(value, i8))
   end subroutine add_integer

   subroutine add_long(self, key, value)
      class(summary_t), intent(inout) :: self
      character(*), intent(in) :: key
      integer(i8), intent(in) :: value
      character(32) :: buffer

      write (buffer, '(i0)') value
      call self%add_text(key, buffer)
   end subroutine add_long

   !> Writes the file; under its name it is always complete.
   subroutine write_summary(self, path, problem)
      class(summary_t), intent(inout) :: self
      character(*), intent(in) :: path
      type(failure), intent(inout) :: problem   !! exit_files

      if (.not. allocated(self%text)) self%text = ''
      if (is_first()) call write_whole_file(path, self%text, problem)
      call problem%tell()
   end subroutine write_summary

end module summary
