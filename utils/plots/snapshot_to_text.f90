!> Turns a snapshot into a text table for gnuplot, which does not read HDF5.
!!
!! usage: dynsph-snapshot-to-text SNAPSHOT.vtkhdf [TABLE.txt]
!!
!! The head says `# key: value` for the attributes that pictures need, and
!! `# range of NAME: smallest largest mean deviation` for each column, and
!! `# outline of NAME: x y` for each corner of a solid, the first one again at the end; a
!! line of column names follows, then one row for each particle. A vector gives three columns:
!! NAME_x, NAME_y and its magnitude NAME. Without a second file name the table goes to
!! standard output. Exit codes as dynsph's.
program snapshot_to_text
   use, intrinsic :: iso_fortran_env, only: output_unit
   use errors, only: end_program, exit_files, exit_input, failure
   use file_system, only: secure_unit
   use hdf5_reader, only: hdf5_reader_t, name_length, numbers
   use kinds, only: dp, i8
   use standard_output, only: errors_for_signals
   implicit none

   type :: column_t
      character(name_length) :: name = ''
      real(dp), allocatable :: values(:)   !! (n)
   end type column_t

   !> A solid.
   type :: outline_t
      character(name_length) :: name = ''
      real(dp), allocatable :: points(:, :)   !! (3, n) closed
   end type outline_t

   type(failure) :: problem
   type(hdf5_reader_t) :: file
   type(column_t), allocatable :: columns(:)
   type(outline_t), allocatable :: outlines(:)

   if (command_argument_count() < 1 .or. command_argument_count() > 2) then
      call problem%raise(exit_input, 'usage: dynsph-snapshot-to-text SNAPSHOT.vtkhdf [TABLE.txt]')
      call end_program(problem)
   end if
   call errors_for_signals(pipes=.false.)
   call file%open(argument(1), problem)
   if (.not. problem%raised()) call read_columns(file, columns, problem)
   if (.not. problem%raised()) call read_outlines(file, outlines, problem)
   if (.not. problem%raised()) call write_table(file, columns, outlines, problem)
   call file%close()
   call end_program(problem)

contains

   function argument(number)
      integer, intent(in) :: number
      character(:), allocatable :: argument
      integer :: length

      call get_command_argument(number, length=length)
      allocate (character(length) :: argument)
      call get_command_argument(number, argument)
   end function argument

   !> Reads positions and all particle arrays, in the order in which the file lists them.
   subroutine read_columns(file, columns, problem)
      type(hdf5_reader_t), intent(in) :: file
      type(column_t), allocatable, intent(out) :: columns(:)
      type(failure), intent(inout) :: problem   !! exit_files
      type(column_t), allocatable :: wide(:)
      real(dp), allocatable :: values(:, :)
      character(name_length), allocatable :: names(:)
      integer :: i, n

      call file%field_names(names, problem)
      if (problem%raised()) return
      call file%read_points(values, problem)
      if (problem%raised()) return
      allocate (wide(2 + 3*size(names)))
      n = 0
      call add_column(wide, n, 'x', values(1, :))
      call add_column(wide, n, 'y', values(2, :))
      do i = 1, size(names)
         call file%read_field(names(i), size(wide(1)%values), values, problem)
         if (problem%raised()) return
         if (size(values, 1) > 1) then
            call add_column(wide, n, trim(names(i))//'_x', values(1, :))
            call add_column(wide, n, trim(names(i))//'_y', values(2, :))
            call add_column(wide, n, names(i), norm2(values, 1))
         else
            call add_column(wide, n, names(i), values(1, :))
         end if
      end do
      columns = wide(:n)
   end subroutine read_columns

   subroutine read_outlines(file, outlines, problem)
      type(hdf5_reader_t), intent(in) :: file
      type(outline_t), allocatable, intent(out) :: outlines(:)
      type(failure), intent(inout) :: problem   !! exit_files
      character(name_length), allocatable :: names(:)
      integer :: i

      call file%solid_names(names, problem)
      allocate (outlines(size(names)))
      do i = 1, size(names)
         if (problem%raised()) return
         outlines(i)%name = names(i)
         call file%read_outline(names(i), outlines(i)%points, problem)
      end do
   end subroutine read_outlines

   subroutine add_column(columns, n, name, values)
      type(column_t), intent(inout) :: columns(:)
      integer, intent(inout) :: n   !! columns so far
      character(*), intent(in) :: name
      real(dp), intent(in) :: values(:)

      n = n + 1
      columns(n)%name = name
      columns(n)%values = values
   end subroutine add_column

   subroutine write_table(file, columns, outlines, problem)
      type(hdf5_reader_t), intent(in) :: file
      type(column_t), intent(in) :: columns(:)
      type(outline_t), intent(in) :: outlines(:)
      type(failure), intent(inout) :: problem   !! exit_files: cannot be written
      character(256) :: message
      character(:), allocatable :: reason, where
      character((2 + name_length)*size(columns) + 100) :: line
      integer(i8) :: bytes
      integer :: i, k, status, unit

      unit = output_unit
      status = 0
      if (command_argument_count() == 2) &
         open (newunit=unit, file=argument(2), status='replace', action='write', iostat=status, iomsg=message)
      if (status /= 0) then
         call problem%raise(exit_files, "cannot write '"//argument(2)//"': "//trim(message))
         return
      end if
      bytes = 0
      call put(unit, '# title: '//file%title(), bytes, status, message)
      do i = 1, size(numbers)
         write (line, '(3a, es23.15e3)') '# ', trim(numbers(i)), ':', file%number(trim(numbers(i)))
         call put(unit, trim(line), bytes, status, message)
      end do
      do i = 1, size(columns)
         write (line, '(3a, 4es16.7e3)') '# range of ', trim(columns(i)%name), ':', range_of(columns(i)%values)
         call put(unit, trim(line), bytes, status, message)
      end do
      do i = 1, size(outlines)
         do k = 1, size(outlines(i)%points, 2)
            write (line, '(3a, 2es16.7e3)') '# outline of ', trim(outlines(i)%name), ':', outlines(i)%points(:2, k)
            call put(unit, trim(line), bytes, status, message)
         end do
      end do
      line = ''
      do i = 1, size(columns)
         line = trim(line)//' '//columns(i)%name
      end do
      call put(unit, trim(line), bytes, status, message)
      do k = 1, size(columns(1)%values)
         write (line, '(*(es16.7e3))') (columns(i)%values(k), i=1, size(columns))
         call put(unit, trim(line), bytes, status, message)
      end do
      if (status == 0) then
         call secure_unit(unit, bytes, reason)
         status = len(reason)
         message = reason
      end if
      where = 'to standard output'
      if (command_argument_count() == 2) where = "'"//argument(2)//"'"
      if (status /= 0) call problem%raise(exit_files, 'cannot write '//where//': '//trim(message))
   end subroutine write_table

   ! A line, and its bytes.
   subroutine put(unit, text, bytes, status, message)
      integer, intent(in) :: unit
      character(*), intent(in) :: text
      integer(i8), intent(inout) :: bytes      !! of all lines
      integer, intent(inout) :: status         !! of the first line that failed
      character(*), intent(inout) :: message

      if (status == 0) write (unit, '(a)', iostat=status, iomsg=message) text
      bytes = bytes + len(text) + 1
   end subroutine put

   !> Smallest, largest, mean and standard deviation; zeros for no values.
   pure function range_of(values) result(range)
      real(dp), intent(in) :: values(:)
      real(dp) :: range(4)
      real(dp) :: squares
      integer :: i

      range = 0.0_dp
      if (size(values) == 0) return
      range(1:3) = [minval(values), maxval(values), sum(values)/size(values)]
      squares = 0.0_dp
      do i = 1, size(values)
         squares = squares + (values(i) - range(3))**2
      end do
      range(4) = sqrt(squares/size(values))
   end function range_of

end program snapshot_to_text
