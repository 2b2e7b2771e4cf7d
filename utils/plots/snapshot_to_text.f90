!> Turns a snapshot into a text table for gnuplot, which does not read HDF5.
!!
!! usage: dynsph-snapshot-to-text SNAPSHOT.vtkhdf [TABLE.txt]
!!
!! The head says `# key: value` for the attributes that pictures need, and
!! `# range of NAME: smallest largest mean deviation` for each column; a line of
!! column names follows, then one row for each particle. A vector gives three columns:
!! NAME_x, NAME_y and its magnitude NAME. Without a second file name the table goes to
!! standard output. Exit codes as dynsph's.
program snapshot_to_text
   use, intrinsic :: iso_c_binding, only: c_associated, c_char, c_f_pointer, c_loc, c_ptr, c_size_t
   use, intrinsic :: iso_fortran_env, only: output_unit
   use errors, only: end_program, exit_files, exit_input, failure
   use hdf5, only: h5aclose_f, h5aopen_f, h5aread_f, h5dclose_f, h5dget_space_f, h5dopen_f, h5dread_f, h5eset_auto_f, &
      h5f_acc_rdonly_f, h5fclose_f, h5fopen_f, h5gget_obj_info_idx_f, h5gn_members_f, h5open_f, h5sclose_f, &
      h5sget_simple_extent_dims_f, h5sget_simple_extent_ndims_f, h5t_cset_utf8_f, h5t_native_double, h5t_string, h5tclose_f, &
      h5tcopy_f, h5tset_cset_f, hid_t, hsize_t
   use kinds, only: dp
   implicit none

   integer, parameter :: longest_name = 64
   character(*), parameter :: numbers(*) = [character(16) :: 'time', 'reference_length', 'spacing', 'sound_speed', 'density', &
      'gravity']

   type :: column_t
      character(longest_name) :: name = ''
      real(dp), allocatable :: values(:)   !! (n)
   end type column_t

   interface
      integer(c_size_t) function c_strlen(text) bind(c, name='strlen')
         import :: c_ptr, c_size_t
         type(c_ptr), value :: text
      end function c_strlen
   end interface

   type(failure) :: problem
   type(column_t), allocatable :: columns(:)
   integer(hid_t) :: file
   integer :: status

   call h5open_f(status)
   call h5eset_auto_f(0, status)
   if (command_argument_count() < 1 .or. command_argument_count() > 2) then
      call problem%raise(exit_input, 'usage: dynsph-snapshot-to-text SNAPSHOT.vtkhdf [TABLE.txt]')
      call end_program(problem)
   end if
   call h5fopen_f(argument(1), h5f_acc_rdonly_f, file, status)
   if (status < 0) call problem%raise(exit_files, "cannot read '"//argument(1)//"' as an HDF5 file")
   if (.not. problem%raised()) call read_columns(file, columns, problem)
   if (.not. problem%raised()) call write_table(file, columns, problem)
   if (file >= 0) call h5fclose_f(file, status)
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
      integer(hid_t), intent(in) :: file
      type(column_t), allocatable, intent(out) :: columns(:)
      type(failure), intent(inout) :: problem   !! exit_files: not a snapshot
      type(column_t), allocatable :: wide(:)
      real(dp), allocatable :: values(:, :)
      character(longest_name) :: name
      integer :: i, kind, members, n, status

      call h5gn_members_f(file, '/VTKHDF/PointData', members, status)
      if (status < 0) then
         call problem%raise(exit_files, "'"//argument(1)//"' is not a snapshot of dynsph")
         return
      end if
      call read_array(file, '/VTKHDF/Points', values, problem)
      if (problem%raised()) return
      allocate (wide(2 + 3*members))
      n = 0
      call add_column(wide, n, 'x', values(1, :))
      call add_column(wide, n, 'y', values(2, :))
      do i = 1, members
         call h5gget_obj_info_idx_f(file, '/VTKHDF/PointData', i - 1, name, kind, status)
         call read_array(file, '/VTKHDF/PointData/'//trim(name), values, problem)
         if (problem%raised()) return
         if (size(values, 1) > 1) then
            call add_column(wide, n, trim(name)//'_x', values(1, :))
            call add_column(wide, n, trim(name)//'_y', values(2, :))
            call add_column(wide, n, name, norm2(values, 1))
         else
            call add_column(wide, n, name, values(1, :))
         end if
      end do
      columns = wide(:n)
   end subroutine read_columns

   subroutine add_column(columns, n, name, values)
      type(column_t), intent(inout) :: columns(:)
      integer, intent(inout) :: n   !! columns so far
      character(*), intent(in) :: name
      real(dp), intent(in) :: values(:)

      n = n + 1
      columns(n)%name = name
      columns(n)%values = values
   end subroutine add_column

   subroutine read_array(file, name, values, problem)
      integer(hid_t), intent(in) :: file
      character(*), intent(in) :: name
      real(dp), allocatable, target, intent(out) :: values(:, :)   !! (components, n)
      type(failure), intent(inout) :: problem
      type(c_ptr) :: start
      integer(hid_t) :: dataset, space
      integer(hsize_t) :: extent(2), largest(2)
      integer :: rank, status

      extent = 0
      call h5dopen_f(file, name, dataset, status)
      if (status >= 0) then
         call h5dget_space_f(dataset, space, status)
         call h5sget_simple_extent_ndims_f(space, rank, status)
         if (rank <= 2) call h5sget_simple_extent_dims_f(space, extent(:rank), largest(:rank), status)
         if (rank == 1) extent = [1_hsize_t, extent(1)]
         allocate (values(extent(1), extent(2)))
         status = 0
         start = c_loc(values)
         if (size(values) > 0) call h5dread_f(dataset, h5t_native_double, start, status)
         if (rank > 2) status = -1
         call h5sclose_f(space, rank)
         call h5dclose_f(dataset, rank)
      end if
      if (status < 0) call problem%raise(exit_files, "cannot read '"//name//"' of '"//argument(1)//"'")
   end subroutine read_array

   !> A real attribute of the root group; 0 when it is missing.
   real(dp) function number_of(file, name)
      integer(hid_t), intent(in) :: file
      character(*), intent(in) :: name
      real(dp), target :: value
      type(c_ptr) :: start
      integer(hid_t) :: attribute
      integer :: status

      value = 0.0_dp
      start = c_loc(value)
      call h5aopen_f(file, name, attribute, status)
      if (status >= 0) then
         call h5aread_f(attribute, h5t_native_double, start, status)
         call h5aclose_f(attribute, status)
      end if
      number_of = value
   end function number_of

   !> A text attribute of the root group; '' when it is missing.
   function text_of(file, name) result(text)
      integer(hid_t), intent(in) :: file
      character(*), intent(in) :: name
      character(:), allocatable :: text
      character(kind=c_char), pointer :: bytes(:)
      type(c_ptr), target :: address(1)
      type(c_ptr) :: start
      integer(hid_t) :: attribute, string
      integer :: i, status

      text = ''
      call h5aopen_f(file, name, attribute, status)
      if (status < 0) return
      call h5tcopy_f(h5t_string, string, status)
      call h5tset_cset_f(string, h5t_cset_utf8_f, status)
      start = c_loc(address)
      call h5aread_f(attribute, string, start, status)
      if (status >= 0 .and. c_associated(address(1))) then
         call c_f_pointer(address(1), bytes, [c_strlen(address(1))])
         do i = 1, size(bytes)
            text = text//bytes(i)
         end do
      end if
      call h5tclose_f(string, status)
      call h5aclose_f(attribute, status)
   end function text_of

   subroutine write_table(file, columns, problem)
      integer(hid_t), intent(in) :: file
      type(column_t), intent(in) :: columns(:)
      type(failure), intent(inout) :: problem   !! exit_files: cannot be written
      character(256) :: message
      integer :: i, k, status, unit

      unit = output_unit
      status = 0
      if (command_argument_count() == 2) &
         open (newunit=unit, file=argument(2), status='replace', action='write', iostat=status, iomsg=message)
      if (status /= 0) then
         call problem%raise(exit_files, "cannot write '"//argument(2)//"': "//trim(message))
         return
      end if
      write (unit, '(a)') '# title: '//text_of(file, 'title')
      do i = 1, size(numbers)
         write (unit, '(3a, es23.15e3)') '# ', trim(numbers(i)), ':', number_of(file, trim(numbers(i)))
      end do
      do i = 1, size(columns)
         write (unit, '(3a, 4es16.7e3)') '# range of ', trim(columns(i)%name), ':', range_of(columns(i)%values)
      end do
      write (unit, '(*(1x, a))') (trim(columns(i)%name), i=1, size(columns))
      do k = 1, size(columns(1)%values)
         write (unit, '(*(es16.7e3))', iostat=status, iomsg=message) (columns(i)%values(k), i=1, size(columns))
         if (status /= 0) exit
      end do
      if (status /= 0) call problem%raise(exit_files, 'cannot write the table: '//trim(message))
   end subroutine write_table

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
