!> Reading what snapshots hold: arrays as columns of reals, outlines of solids, numbers of the root group, the title.
!!
!! Texts of variable length, as the root group has them, are not touched: they are in a heap without a checksum, and version 1.10
!! of the HDF5 library crashes on damaged ones. The title is there once more, of fixed length; earlier versions had it only there.
module hdf5_reader
   use, intrinsic :: iso_c_binding, only: c_char, c_loc, c_null_char, c_ptr, c_size_t
   use errors, only: exit_files, failure
   use hdf5, only: h5aclose_f, h5aexists_f, h5aget_space_f, h5aget_type_f, h5aopen_by_name_f, h5aopen_f, h5aread_f, h5dclose_f, &
      h5dget_space_f, h5dopen_f, h5dread_f, h5eset_auto_f, h5f_acc_rdonly_f, h5fclose_f, h5fopen_f, h5gget_obj_info_idx_f, &
      h5gn_members_f, h5lexists_f, h5open_f, h5sclose_f, h5sget_simple_extent_dims_f, h5sget_simple_extent_ndims_f, &
      h5sget_simple_extent_npoints_f, h5t_float_f, h5t_integer_f, h5t_native_double, h5t_string_f, h5tclose_f, h5tget_class_f, &
      h5tget_size_f, h5tis_variable_str_f, hid_t, hsize_t
   use kinds, only: dp
   use snapshot, only: outlines_group
   use text, only: to_text
   implicit none
   private

   public :: hdf5_reader_t, name_length, numbers

   integer, parameter :: name_length = 64   !! of an array
   integer(c_size_t), parameter :: most_bytes = 65536   !! of a title
   character(*), parameter :: grid = '/VTKHDF', fields = grid//'/PointData'
   character(*), parameter :: numbers(*) = [character(16) :: 'time', 'reference_length', 'spacing', 'sound_speed', 'density', &
      'gravity']   !! attributes that are asked for

   character(*), parameter :: damaged = 'the file is damaged, or was not written by dynsph'
   integer, parameter :: most_particles = 2*10**8   !! that dynsph writes

   !> A snapshot that is open for reading.
   type :: hdf5_reader_t
      private
      character(:), allocatable :: path
      integer(hid_t) :: file = -1
   contains
      procedure :: open => open_snapshot
      procedure :: close => close_snapshot
      procedure :: field_names
      procedure :: read_points
      procedure :: read_field
      procedure :: solid_names
      procedure :: read_outline
      procedure :: number
      procedure :: title
   end type hdf5_reader_t

contains

   !> Raises exit_files if it is no HDF5 file or not a snapshot of dynsph.
   subroutine open_snapshot(self, path, problem)
      class(hdf5_reader_t), intent(inout) :: self
      character(*), intent(in) :: path
      type(failure), intent(inout) :: problem
      integer :: members, status

      self%path = trim(path)
      call h5open_f(status)
      call h5eset_auto_f(0, status)
      call h5fopen_f(self%path, h5f_acc_rdonly_f, self%file, status)
      if (status < 0) then
         self%file = -1
         call problem%raise(exit_files, "cannot read '"//self%path//"' as an HDF5 file")
         return
      end if
      call h5gn_members_f(self%file, fields, members, status)
      if (status < 0) call problem%raise(exit_files, "'"//self%path//"' is not a snapshot of dynsph")
      if (.not. problem%raised()) call check_attributes(self, problem)
   end subroutine open_snapshot

   ! An attribute of a foreign or damaged file may have any extent and type; what is read here has room for one value.
   subroutine check_attributes(self, problem)
      class(hdf5_reader_t), intent(in) :: self
      type(failure), intent(inout) :: problem
      integer :: i

      do i = 1, size(numbers)
         if (problem%raised()) return
         if (.not. is_number_or_missing(self, trim(numbers(i)))) call problem%raise(exit_files, "attribute '"//trim(numbers(i)) &
            //"' of '"//self%path//"' is not one number; "//damaged)
      end do
   end subroutine check_attributes

   logical function is_number_or_missing(self, name) result(fine)
      class(hdf5_reader_t), intent(in) :: self
      character(*), intent(in) :: name   !! of an attribute of the root group
      integer(hid_t) :: attribute, kind
      integer :: class, status
      logical :: there

      call h5aexists_f(self%file, name, there, status)
      fine = status >= 0 .and. .not. there
      if (fine) return
      call h5aopen_f(self%file, name, attribute, status)
      if (status < 0) return
      class = -1
      call h5aget_type_f(attribute, kind, status)
      if (status >= 0) then
         call h5tget_class_f(kind, class, status)
         call h5tclose_f(kind, status)
      end if
      fine = is_scalar(attribute)
      fine = fine .and. any(class == [h5t_float_f, h5t_integer_f])
      call h5aclose_f(attribute, status)
   end function is_number_or_missing

   subroutine close_snapshot(self)
      class(hdf5_reader_t), intent(inout) :: self
      integer :: ignored

      if (self%file >= 0) call h5fclose_f(self%file, ignored)
      self%file = -1
   end subroutine close_snapshot

   !> Names of all particle arrays, in the order in which the file lists them. Raises exit_files if one is damaged.
   subroutine field_names(self, names, problem)
      class(hdf5_reader_t), intent(in) :: self
      character(name_length), allocatable, intent(out) :: names(:)
      type(failure), intent(inout) :: problem

      call list_members(self, fields, names, problem)
   end subroutine field_names

   !> Names of the solids that it has outlines of, none in files of before there were any.
   subroutine solid_names(self, names, problem)
      class(hdf5_reader_t), intent(in) :: self
      character(name_length), allocatable, intent(out) :: names(:)
      type(failure), intent(inout) :: problem   !! exit_files: one is damaged
      logical :: there
      integer :: status

      allocate (names(0))
      call h5lexists_f(self%file, outlines_group, there, status)
      if (status < 0 .or. there) call list_members(self, outlines_group, names, problem)
   end subroutine solid_names

   ! What a group has.
   subroutine list_members(self, group, names, problem)
      class(hdf5_reader_t), intent(in) :: self
      character(*), intent(in) :: group
      character(name_length), allocatable, intent(out) :: names(:)
      type(failure), intent(inout) :: problem
      integer :: i, kind, members, status

      call h5gn_members_f(self%file, group, members, status)
      if (status < 0) members = 0
      allocate (names(members))
      names = ''
      do i = 1, members
         if (status >= 0) call h5gget_obj_info_idx_f(self%file, group, i - 1, names(i), kind, status)
      end do
      if (status < 0) call problem%raise(exit_files, "cannot read which arrays '"//self%path//"' has; "//damaged)
   end subroutine list_members

   !> Positions, (3, n).
   subroutine read_points(self, values, problem)
      class(hdf5_reader_t), intent(in) :: self
      real(dp), allocatable, intent(out) :: values(:, :)
      type(failure), intent(inout) :: problem

      call read_array(self, '/VTKHDF/Points', values, problem)
      if (problem%raised()) return
      if (size(values, 1) /= 3) &
         call problem%raise(exit_files, "the points of '"//self%path//"' have no three coordinates; "//damaged)
   end subroutine read_points

   !> The outline of a solid, (3, n), its first corner again at the end.
   subroutine read_outline(self, name, values, problem)
      class(hdf5_reader_t), intent(in) :: self
      character(*), intent(in) :: name
      real(dp), allocatable, intent(out) :: values(:, :)
      type(failure), intent(inout) :: problem   !! exit_files: cannot be read

      call read_array(self, outlines_group//'/'//trim(name)//'/points', values, problem)
      if (problem%raised()) return
      if (size(values, 1) /= 3) &
         call problem%raise(exit_files, "the outline '"//trim(name)//"' of '"//self%path//"' has no three coordinates; "//damaged)
   end subroutine read_outline

   !> A particle array, (1 or 3, n). Raises exit_files if it is not there, or has other extents.
   subroutine read_field(self, name, n, values, problem)
      class(hdf5_reader_t), intent(in) :: self
      character(*), intent(in) :: name
      integer, intent(in) :: n   !! particles
      real(dp), allocatable, intent(out) :: values(:, :)
      type(failure), intent(inout) :: problem

      call read_array(self, fields//'/'//trim(name), values, problem)
      if (problem%raised()) return
      if (size(values, 2) /= n .or. all(size(values, 1) /= [1, 3])) call problem%raise(exit_files, "'"//trim(name)//"' of '" &
         //self%path//"' is no array of one or three numbers for each of "//to_text(n)//' particles; '//damaged)
   end subroutine read_field

   subroutine read_array(self, name, values, problem)
      type(hdf5_reader_t), intent(in) :: self
      character(*), intent(in) :: name
      real(dp), allocatable, target, intent(out) :: values(:, :)   !! (components, n)
      type(failure), intent(inout) :: problem
      type(c_ptr) :: start
      integer(hid_t) :: dataset, space
      integer(hsize_t) :: extent(2), largest(2)
      integer :: rank, status

      extent = 0
      call h5dopen_f(self%file, name, dataset, status)
      if (status >= 0) then
         call h5dget_space_f(dataset, space, status)
         call h5sget_simple_extent_ndims_f(space, rank, status)
         status = -1
         if (rank == 1 .or. rank == 2) call h5sget_simple_extent_dims_f(space, extent(:rank), largest(:rank), status)
         if (rank == 1) extent = [1_hsize_t, extent(1)]
         ! More than a file can hold is damage, and no memory is asked for it.
         if (extent(1) > 3 .or. extent(2) > most_particles) status = -1
         if (status >= 0) then
            allocate (values(extent(1), extent(2)))
            start = c_loc(values)
            if (size(values) > 0) call h5dread_f(dataset, h5t_native_double, start, status)
         end if
         call h5sclose_f(space, rank)
         call h5dclose_f(dataset, rank)
      end if
      if (status < 0) call problem%raise(exit_files, "cannot read '"//name//"' of '"//self%path//"'; "//damaged)
   end subroutine read_array

   !> A real attribute of the root group; 0 when it is missing.
   real(dp) function number(self, name)
      class(hdf5_reader_t), intent(in) :: self
      character(*), intent(in) :: name
      real(dp), target :: value
      type(c_ptr) :: start
      integer(hid_t) :: attribute
      integer :: status

      value = 0.0_dp
      start = c_loc(value)
      call h5aopen_f(self%file, name, attribute, status)
      if (status >= 0) then
         call h5aread_f(attribute, h5t_native_double, start, status)
         call h5aclose_f(attribute, status)
      end if
      number = value
   end function number

   !> The title; '' where it is not kept with a fixed length.
   function title(self)
      class(hdf5_reader_t), intent(in) :: self
      character(:), allocatable :: title
      character(kind=c_char), allocatable, target :: bytes(:)
      type(c_ptr) :: start
      integer(hid_t) :: attribute, kind
      integer(c_size_t) :: length
      integer :: i, status

      title = ''
      call h5aopen_by_name_f(self%file, grid, 'title', attribute, status)
      if (status < 0) return
      call h5aget_type_f(attribute, kind, status)
      if (status >= 0) then
         length = fixed_length(kind)
         if (.not. is_scalar(attribute)) length = 0
         if (length > 0) then
            allocate (bytes(length))
            start = c_loc(bytes)
            call h5aread_f(attribute, kind, start, status)
            do i = 1, size(bytes)
               if (status < 0 .or. bytes(i) == c_null_char) exit
               title = title//bytes(i)
            end do
         end if
         call h5tclose_f(kind, status)
      end if
      call h5aclose_f(attribute, status)
   end function title

   ! Bytes of a text type of fixed length; 0 for any other type.
   integer(c_size_t) function fixed_length(kind) result(length)
      integer(hid_t), intent(in) :: kind
      integer :: class, status
      logical :: varies

      length = 0
      call h5tget_class_f(kind, class, status)
      if (status < 0 .or. class /= h5t_string_f) return
      call h5tis_variable_str_f(kind, varies, status)
      if (status < 0 .or. varies) return
      call h5tget_size_f(kind, length, status)
      if (status < 0 .or. length > most_bytes) length = 0
   end function fixed_length

   ! Whether an attribute is one value.
   logical function is_scalar(attribute)
      integer(hid_t), intent(in) :: attribute
      integer(hid_t) :: space
      integer(hsize_t) :: points
      integer :: status

      points = 0
      call h5aget_space_f(attribute, space, status)
      if (status >= 0) then
         call h5sget_simple_extent_npoints_f(space, points, status)
         call h5sclose_f(space, status)
      end if
      is_scalar = points == 1
   end function is_scalar

end module hdf5_reader
