!> Text tables that grow while a run goes on: a head of comments, then rows of numbers.
!!
!! The last line of the head holds the column names and is no comment, so that
!! gnuplot (`set datafile columnheaders`, `column("E_K")`) and pandas find them.
module table
   use archive, only: archive_t
   use communication, only: is_first
   use errors, only: exit_files, failure
   use file_system, only: file_bytes, flush_unit, path_exists, secure_unit, seek_end, shorten_file
   use kinds, only: dp, i8
   use timers, only: wall_seconds
   implicit none
   private

   public :: table_t

   integer, parameter :: no_unit = -1
   integer, parameter :: elsewhere = huge(1)                !! the first process writes
   real(dp), parameter :: no_row = -huge(1.0_dp)
   integer, parameter :: column_width = 25                  !! full precision, three digits of exponent
   real(dp), parameter :: flush_interval = 1.0_dp           !! [s], so that a run can be watched
   character(*), parameter :: row_format = '(*(es25.16e3))'

   !> A table that is being written under its final name.
   type :: table_t
      private
      integer :: unit = no_unit         !! (not kept: of the open file)
      integer(i8) :: row_bytes = 0
      integer(i8) :: bytes = 0          !! that the file must have by now
      real(dp) :: last = no_row         !! first number of the last row
      real(dp) :: last_flush = 0.0_dp   !! (not kept: of the clock)
      logical :: failed = .false.       !! and that was told (not kept: the run ends)
      character(:), allocatable :: path !! (not kept: a directory may be renamed)
   contains
      procedure :: create
      procedure :: go_on
      procedure :: was_begun
      procedure :: begin_anew
      procedure :: row
      procedure :: secure
      procedure :: close => close_table
      procedure :: is_open
      procedure :: archive => archive_table
   end type table_t

contains

   subroutine archive_table(self, file)
      class(table_t), intent(inout) :: self
      class(archive_t), intent(inout) :: file

      call file%keep('row_bytes', self%row_bytes)
      call file%keep('bytes', self%bytes)
      call file%keep('last', self%last)
   end subroutine archive_table

   !> Whether a part of it was there when it was kept.
   pure logical function was_begun(self)
      class(table_t), intent(in) :: self

      was_begun = self%bytes > 0
   end function was_begun

   !> Forgets what was kept: the table begins in another file.
   subroutine begin_anew(self)
      class(table_t), intent(inout) :: self

      self%bytes = 0
      self%last = no_row
   end subroutine begin_anew

   !> Starts a table; an earlier file of that name is replaced.
   subroutine create(self, path, head, names, units, problem)
      class(table_t), intent(inout) :: self
      character(*), intent(in) :: path
      character(*), intent(in) :: head(:)       !! comment lines, without #
      character(*), intent(in) :: names(:)      !! (columns) without blanks
      character(*), intent(in) :: units(:)      !! (columns)
      type(failure), intent(inout) :: problem   !! exit_files: cannot be written
      character(256) :: message
      character(:), allocatable :: last
      character(3) :: number
      integer :: i, status

      self%path = trim(path)
      self%row_bytes = size(names)*column_width + 1
      if (.not. is_first()) then
         self%unit = elsewhere
         call problem%tell()
         if (problem%raised()) self%unit = no_unit
         return
      end if
      open (newunit=self%unit, file=path, status='replace', action='write', iostat=status, iomsg=message)
      if (status /= 0) then
         self%unit = no_unit
         call problem%raise(exit_files, "cannot write '"//self%path//"': "//trim(message))
         call problem%tell()
         return
      end if
      self%bytes = 0
      do i = 1, size(head)
         call put(trim('# '//head(i)))
      end do
      call put('# columns, name [unit]:')
      do i = 1, size(names)
         write (number, '(i3)') i
         call put('# '//number//'  '//trim(names(i))//' ['//trim(units(i))//']')
      end do
      last = ''
      do i = 1, size(names)
         last = last//right_aligned(names(i))
      end do
      call put(last)
      call flush_now(self, wall_seconds(), problem)
      call problem%tell()
      if (problem%raised()) call give_up(self)

   contains

      ! A line; whether there was room for it is seen at the end.
      subroutine put(line)
         character(*), intent(in) :: line
         integer :: ignored

         write (self%unit, '(a)', iostat=ignored) line
         self%bytes = self%bytes + len(line) + 1
      end subroutine put

   end subroutine create

   !> Opens a table that was begun; rows that were written after it was kept are cut off. Changes nothing where that cannot be.
   subroutine go_on(self, path, columns, only_check, problem)
      class(table_t), intent(inout) :: self
      character(*), intent(in) :: path
      integer, intent(in) :: columns
      logical, intent(in) :: only_check         !! whether it can be: nothing is opened
      type(failure), intent(inout) :: problem   !! exit_files: it is not what was kept, or cannot be written

      self%unit = merge(no_unit, elsewhere, only_check)
      if (is_first()) call open_begun(self, path, columns, only_check, problem)
      call problem%tell()
      if (problem%raised()) call give_up(self)
   end subroutine go_on

   ! A table that cannot be written is open nowhere.
   subroutine give_up(self)
      class(table_t), intent(inout) :: self
      integer :: ignored

      if (is_first() .and. self%unit /= no_unit) close (self%unit, iostat=ignored)
      self%unit = no_unit
   end subroutine give_up

   subroutine open_begun(self, path, columns, only_check, problem)
      class(table_t), intent(inout) :: self
      character(*), intent(in) :: path
      integer, intent(in) :: columns
      logical, intent(in) :: only_check
      type(failure), intent(inout) :: problem
      character(256) :: message
      character(:), allocatable :: reason
      integer(i8) :: there
      integer :: status

      self%path = trim(path)
      there = file_bytes(path)
      if (self%row_bytes /= columns*column_width + 1) then
         call problem%raise(exit_files, "cannot go on with '"//self%path//"': it has other columns than this version writes")
      else if (there < self%bytes) then
         call problem%raise(exit_files, "cannot go on with '"//self%path//"': rows are missing that the checkpoint knows of")
      else if (.not. ends_as_kept(self, path)) then
         call problem%raise(exit_files, "cannot go on with '"//self%path//"': its rows are not those that the checkpoint knows of")
      end if
      if (problem%raised() .or. only_check) return
      call shorten_file(path, self%bytes, reason)
      if (reason /= '') then
         call problem%raise(exit_files, "cannot write '"//self%path//"': "//reason)
         return
      end if
      open (newunit=self%unit, file=path, status='old', position='append', action='write', iostat=status, iomsg=message)
      if (status == 0) then
         call seek_end(self%unit)
         return
      end if
      self%unit = no_unit
      call problem%raise(exit_files, "cannot write '"//self%path//"': "//trim(message))
   end subroutine open_begun

   ! Whether a line ends where the kept part does, and is that of the last row.
   logical function ends_as_kept(self, path)
      class(table_t), intent(in) :: self
      character(*), intent(in) :: path
      character :: letter
      character(column_width) :: number
      real(dp) :: value
      integer :: status, unit

      ends_as_kept = .false.
      open (newunit=unit, file=path, access='stream', form='unformatted', status='old', action='read', iostat=status)
      if (status /= 0) return
      read (unit, pos=self%bytes, iostat=status) letter
      ends_as_kept = status == 0 .and. letter == new_line('a')
      if (ends_as_kept .and. self%last > no_row) then
         read (unit, pos=self%bytes - self%row_bytes + 1, iostat=status) number
         if (status == 0) read (number, *, iostat=status) value
         ends_as_kept = status == 0
         if (ends_as_kept) ends_as_kept = .not. abs(value - self%last) > 0
      end if
      close (unit)
   end function ends_as_kept

   !> Adds a row. NaN and infinities are written as such. A failure is the first process's: the caller tells the others.
   subroutine row(self, values, problem)
      class(table_t), intent(inout) :: self
      real(dp), intent(in) :: values(:)         !! (columns)
      type(failure), intent(inout) :: problem   !! exit_files: the disk is full

      if (self%unit == no_unit) return
      if (is_first()) call write_row(self, values, problem)
   end subroutine row

   subroutine write_row(self, values, problem)
      class(table_t), intent(inout) :: self
      real(dp), intent(in) :: values(:)
      type(failure), intent(inout) :: problem
      character(256) :: message
      real(dp) :: now
      integer :: status

      write (self%unit, row_format, iostat=status, iomsg=message) values
      if (status /= 0) then
         call problem%raise(exit_files, "cannot write '"//self%path//"': "//trim(message))
         return
      end if
      self%bytes = self%bytes + self%row_bytes
      self%last = values(1)
      now = wall_seconds()
      if (now - self%last_flush >= flush_interval) call flush_now(self, now, problem)
   end subroutine write_row

   !> All rows so far are on the disk.
   subroutine secure(self, problem)
      class(table_t), intent(inout) :: self
      type(failure), intent(inout) :: problem   !! exit_files: the disk is full

      character(:), allocatable :: reason

      if (self%unit == no_unit) return
      if (is_first()) then
         call secure_unit(self%unit, self%bytes, reason)
         call complain(self, reason, problem)
      end if
      call problem%tell()
   end subroutine secure

   !> Ends a table, which is on the disk then; one that is not open is left alone.
   subroutine close_table(self, problem)
      class(table_t), intent(inout) :: self
      type(failure), intent(inout) :: problem   !! exit_files: the disk is full
      integer :: ignored

      if (self%unit == no_unit) return
      call self%secure(problem)
      if (is_first()) close (self%unit, iostat=ignored)
      self%unit = no_unit
   end subroutine close_table

   pure logical function is_open(self)
      class(table_t), intent(in) :: self

      is_open = self%unit /= no_unit
   end function is_open

   !> Hands the rows so far to the system; a full disk shows only here.
   subroutine flush_now(self, now, problem)
      class(table_t), intent(inout) :: self
      real(dp), intent(in) :: now   !! [s]
      type(failure), intent(inout) :: problem
      character(:), allocatable :: reason

      call flush_unit(self%unit, self%bytes, reason)
      call complain(self, reason, problem)
      self%last_flush = now
   end subroutine flush_now

   ! What is wrong, once, if anything is. Rows of a file without a name would be lost at the end of the run.
   subroutine complain(self, reason, problem)
      class(table_t), intent(inout) :: self
      character(*), intent(in) :: reason   !! of the system; '' if it took all
      type(failure), intent(inout) :: problem
      character(:), allocatable :: words

      words = reason
      if (words == '') then
         if (.not. path_exists(self%path)) words = 'it was removed or renamed meanwhile'
      end if
      if (words == '' .or. self%failed) return
      self%failed = .true.
      call problem%raise(exit_files, "cannot write '"//self%path//"': "//words)
   end subroutine complain

   !> A column name above the last digit of its numbers; the first column begins with blanks too. A long one takes more room.
   pure function right_aligned(name) result(cell)
      character(*), intent(in) :: name
      character(:), allocatable :: cell

      cell = repeat(' ', max(1, column_width - len_trim(name)))//trim(name)
   end function right_aligned

end module table
