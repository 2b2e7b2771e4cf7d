!> ParaView's file series: which snapshot file belongs to which time, and where solids are then.
module series
   use archive, only: archive_t
   use communication, only: is_first
   use errors, only: failure
   use file_system, only: write_whole_file
   use growing_text, only: growing_text_t
   use kinds, only: dp
   use outline_series, only: outlines_as_xdmf
   use result_directory, only: outlines_name, snapshot_name
   use timers, only: wall_seconds
   implicit none
   private

   public :: series_t

   real(dp), parameter :: write_interval = 1   !! [s] at least; the file is made anew each time

   !> The snapshots of a run so far, numbered from 0.
   type :: series_t
      private
      integer :: n = 0
      real(dp), allocatable :: times(:)   !! (n, with room for more)
      real(dp) :: last_written = -huge(1.0_dp)   !! (not kept: of the clock)
      logical :: behind = .false.   !! the file lacks the latest (not kept: seen when it is written)
      character(:), allocatable :: solids(:)   !! names; not allocated where there are none (not kept: of the scene)
      integer, allocatable :: corners(:)       !! of each (not kept: of the scene)
   contains
      procedure :: name_solids
      procedure :: add
      procedure :: write => write_series
      procedure :: finish
      procedure :: begin_anew
      procedure :: count => count_files
      procedure :: archive => archive_series
   end type series_t

contains

   subroutine archive_series(self, file)
      class(series_t), intent(inout) :: self
      class(archive_t), intent(inout) :: file

      call file%part('snapshots')
      call file%keep('number', self%n)
      if (file%reading) self%times = spread(0.0_dp, 1, self%n)
      if (self%n > 0) call file%keep('times', self%times(:self%n))
   end subroutine archive_series

   !> Says that there are solids: then `outlines_name` is written beside the series.
   subroutine name_solids(self, names, corners)
      class(series_t), intent(inout) :: self
      character(*), intent(in) :: names(:)
      integer, intent(in) :: corners(:)   !! that each has

      self%solids = names
      self%corners = corners
   end subroutine name_solids

   !> Forgets the snapshots: the run goes on in another directory.
   subroutine begin_anew(self)
      class(series_t), intent(inout) :: self

      self%n = 0
   end subroutine begin_anew

   !> Adds the next snapshot, and writes the file unless that was done just now.
   subroutine add(self, path, time, problem)
      class(series_t), intent(inout) :: self
      character(*), intent(in) :: path          !! of the series file
      real(dp), intent(in) :: time
      type(failure), intent(inout) :: problem   !! exit_files
      real(dp), allocatable :: longer(:)

      if (.not. allocated(self%times)) allocate (self%times(64))
      if (self%n >= size(self%times)) then
         allocate (longer(2*self%n + 64))
         longer(:self%n) = self%times(:self%n)
         call move_alloc(longer, self%times)
      end if
      self%n = self%n + 1
      self%times(self%n) = time
      self%behind = .true.
      if (wall_seconds() - self%last_written >= write_interval .and. is_first()) call self%write(path, problem)
      call problem%tell()
   end subroutine add

   !> Writes the series as a whole file: of the first process alone.
   subroutine write_series(self, path, problem)
      class(series_t), intent(inout) :: self
      character(*), intent(in) :: path
      type(failure), intent(inout) :: problem   !! exit_files

      call write_whole_file(path, as_json(self), problem)
      if (allocated(self%solids)) call write_whole_file(path(:index(path, '/', back=.true.))//outlines_name, &
         outlines_as_xdmf(self%times(:self%n), self%solids, self%corners), problem)
      self%behind = .false.
      self%last_written = wall_seconds()
   end subroutine write_series

   !> Writes what the file still lacks.
   subroutine finish(self, path, problem)
      class(series_t), intent(inout) :: self
      character(*), intent(in) :: path
      type(failure), intent(inout) :: problem   !! exit_files

      if (is_first() .and. self%behind) call self%write(path, problem)
      call problem%tell()
   end subroutine finish

   !> Snapshots so far.
   pure integer function count_files(self)
      class(series_t), intent(in) :: self

      count_files = self%n
   end function count_files

   function as_json(self) result(text)
      class(series_t), intent(in) :: self
      character(:), allocatable :: text
      type(growing_text_t) :: lines
      character(32) :: number
      integer :: i

      call lines%add_line('{')
      call lines%add_line('  "file-series-version": "1.0",')
      call lines%add_line('  "files": [')
      do i = 1, self%n
         write (number, '(es24.16e3)') self%times(i)
         call lines%add_line('    {"name": "'//snapshot_name(i - 1)//'", "time": '//trim(adjustl(number))//'}' &
                             //trim(merge(',', ' ', i < self%n)))
      end do
      call lines%add_line('  ]')
      call lines%add_line('}')
      text = lines%text()
   end function as_json

end module series
