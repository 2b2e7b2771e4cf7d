!> ParaView's file series: which snapshot file belongs to which time.
module series
   use errors, only: failure
   use file_system, only: write_whole_file
   use kinds, only: dp
   implicit none
   private

   public :: series_t

   integer, parameter :: longest_name = 64

   !> The snapshots of a run so far.
   type :: series_t
      private
      character(longest_name), allocatable :: names(:)
      real(dp), allocatable :: times(:)
   contains
      procedure :: add
      procedure :: count => count_files
   end type series_t

contains

   !> Adds a snapshot and writes the series anew as a whole file.
   subroutine add(self, path, name, time, problem)
      class(series_t), intent(inout) :: self
      character(*), intent(in) :: path          !! of the series file
      character(*), intent(in) :: name          !! of the snapshot, relative to the series file
      real(dp), intent(in) :: time
      type(failure), intent(inout) :: problem   !! exit_files
      character(longest_name) :: padded

      if (.not. allocated(self%names)) allocate (self%names(0), self%times(0))
      padded = name
      self%names = [self%names, padded]
      self%times = [self%times, time]
      call write_whole_file(path, as_json(self), problem)
   end subroutine add

   !> Snapshots so far.
   pure integer function count_files(self)
      class(series_t), intent(in) :: self

      count_files = 0
      if (allocated(self%names)) count_files = size(self%names)
   end function count_files

   function as_json(self) result(text)
      class(series_t), intent(in) :: self
      character(:), allocatable :: text
      character(*), parameter :: eol = new_line('a')
      character(32) :: number
      integer :: i

      text = '{'//eol//'  "file-series-version": "1.0",'//eol//'  "files": ['//eol
      do i = 1, size(self%names)
         write (number, '(es24.16e3)') self%times(i)
         text = text//'    {"name": "'//trim(self%names(i))//'", "time": '//trim(adjustl(number))//'}'
         if (i < size(self%names)) text = text//','
         text = text//eol
      end do
      text = text//'  ]'//eol//'}'//eol
   end function as_json

end module series
