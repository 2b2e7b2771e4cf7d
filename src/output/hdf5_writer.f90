!> HDF5 files that appear under their name only when they are complete.
!!
!! A failing call of the library is remembered and makes the later ones do nothing;
!! `finish` turns it into a failure. So the callers read as what they write.
module hdf5_writer
   use, intrinsic :: iso_c_binding, only: c_char, c_loc, c_null_char, c_ptr
   use, intrinsic :: iso_fortran_env, only: int8
   use communication, only: is_first, n_processes
   use errors, only: exit_files, failure
   use file_system, only: delete_file, partial_path, publish, secure_path
   use hdf5, only: h5acreate_by_name_f, h5aclose_f, h5awrite_f, h5dclose_f, h5dcreate_f, h5dget_space_f, &
      h5dont_atexit_f, h5dwrite_f, h5s_select_set_f, h5sselect_hyperslab_f, &
      h5eset_auto_f, &
      h5f_acc_trunc_f, h5fclose_f, h5fcreate_f, h5gclose_f, h5gcreate_f, h5open_f, h5s_scalar_f, h5sclose_f, h5screate_f, &
      h5screate_simple_f, h5t_cset_utf8_f, h5t_native_double, h5t_native_integer, h5t_native_real, h5t_std_i64le, &
      h5t_std_u8le, h5t_str_nullpad_f, h5t_string, h5tclose_f, h5tcopy_f, h5tset_cset_f, h5tset_size_f, h5tset_strpad_f, &
      h5f_libver_v110_f, h5p_dataset_create_f, h5p_file_access_f, h5p_file_create_f, h5p_group_create_f, h5pset_userblock_f, &
      h5pclose_f, h5pcreate_f, h5pset_chunk_f, h5pset_fletcher32_f, &
      h5pset_libver_bounds_f, h5pset_obj_track_times_f, h5t_fortran_s1, hid_t, hsize_t
   use kinds, only: dp, i8, sp
   use row_parts, only: rows_before, send_rows, take_rows
   use sealed_file, only: seal_bytes, seal_file
   use system_words, only: forget_reason, last_reason
   implicit none
   private

   public :: hdf5_writer_t, open_library

   logical, save :: library_open = .false.   !! the library's own state; opening it twice leaks its types

   !> A file that is being written.
   type :: hdf5_writer_t
      private
      integer(hid_t) :: file = -1
      logical :: failed = .false.
      character(:), allocatable :: path
      character(:), allocatable :: failed_at, reason   !! where, and the system's words
      character(:), allocatable :: seal   !! words of the seal; not allocated for a file without one
   contains
      procedure :: create
      procedure :: make_group
      procedure :: put_reals
      procedure :: put_vectors
      procedure :: put_singles
      procedure :: put_integers
      procedure :: put_longs
      procedure :: put_bytes
      procedure :: put_text
      procedure :: put_label
      procedure, private :: attach_text, attach_real, attach_integers, attach_long
      generic :: attach => attach_text, attach_real, attach_integers, attach_long
      procedure :: finish
   end type hdf5_writer_t

contains

   !> Opens the HDF5 library, once. It is quiet: its own words on standard error would come before ours.
   subroutine open_library(status)
      integer, intent(out) :: status   !! < 0: it cannot be opened

      status = 0
      if (.not. library_open) then
         ! Files are closed here; at exit the library would crash on one that a full disk has kept open.
         call h5dont_atexit_f(status)
         call h5open_f(status)
         library_open = status >= 0
      end if
      if (library_open) call h5eset_auto_f(0, status)
   end subroutine open_library

   !> Starts a file under its temporary name.
   subroutine create(self, path, seal)
      class(hdf5_writer_t), intent(inout) :: self
      character(*), intent(in) :: path
      character(*), intent(in), optional :: seal   !! words: the file gets a checksum, and is on the disk before it has its name
      integer(hid_t) :: access, creation
      integer :: status

      self%path = trim(path)
      self%failed = .not. is_first()   ! which alone writes
      if (self%failed) return
      call forget_reason()
      call open_library(status)
      call note(self, status, 'the HDF5 library')
      ! Headers of this form have checksums; HDF5 1.10 (2016) and newer read them.
      call h5pcreate_f(h5p_file_access_f, access, status)
      call note(self, status, 'the file')
      call h5pset_libver_bounds_f(access, h5f_libver_v110_f, h5f_libver_v110_f, status)
      call note(self, status, 'the file')
      call timeless(self, h5p_file_create_f, creation, 'the file')
      if (allocated(self%seal)) deallocate (self%seal)
      if (present(seal)) then
         self%seal = seal
         call h5pset_userblock_f(creation, int(seal_bytes, hsize_t), status)
         call note(self, status, 'the file')
      end if
      call h5fcreate_f(partial_path(self%path), h5f_acc_trunc_f, self%file, status, creation, access)
      call note(self, status, 'the file')
      call h5pclose_f(creation, status)
      call h5pclose_f(access, status)
   end subroutine create

   !> Makes a group; its parent must exist.
   subroutine make_group(self, name)
      class(hdf5_writer_t), intent(inout) :: self
      character(*), intent(in) :: name   !! with all its parents
      integer(hid_t) :: creation, group
      integer :: ignored, status

      if (self%failed) return
      call timeless(self, h5p_group_create_f, creation, name)
      call h5gcreate_f(self%file, name, group, status, gcpl_id=creation)
      call note(self, status, name)
      if (status >= 0) call h5gclose_f(group, status)
      call h5pclose_f(creation, ignored)
   end subroutine make_group

   ! Properties of what is created without the time of day: the same run gives the same file.
   subroutine timeless(self, class, properties, name)
      type(hdf5_writer_t), intent(inout) :: self
      integer(hid_t), intent(in) :: class
      integer(hid_t), intent(out) :: properties
      character(*), intent(in) :: name   !! of what is created
      integer :: status

      call h5pcreate_f(class, properties, status)
      call note(self, status, name)
      call h5pset_obj_track_times_f(properties, .false., status)
      call note(self, status, name)
   end subroutine timeless

   !> Writes a real array in single or double precision.
   subroutine put_reals(self, name, values, single, in_parts)
      class(hdf5_writer_t), intent(inout) :: self
      character(*), intent(in) :: name
      real(dp), intent(in), contiguous, target :: values(:)   !! (n)
      logical, intent(in) :: single
      logical, intent(in) :: in_parts   !! each process has a part; else all have the same
      real(sp), allocatable, target :: rounded(:)

      if (single) then
         rounded = real(values, sp)
         call put(self, name, h5t_native_real, shape(values, hsize_t), c_loc(rounded), 4, in_parts)
      else
         call put(self, name, h5t_native_double, shape(values, hsize_t), c_loc(values), 8, in_parts)
      end if
   end subroutine put_reals

   !> Writes plane vectors as an array of n rows with three components, the third zero.
   subroutine put_vectors(self, name, x, y, single)
      class(hdf5_writer_t), intent(inout) :: self
      character(*), intent(in) :: name
      real(dp), intent(in) :: x(:), y(:)   !! (n) each
      logical, intent(in) :: single
      real(sp), allocatable, target :: rounded(:, :)
      real(dp), allocatable, target :: rows(:, :)
      integer(hsize_t) :: extent(2)
      integer :: i

      extent = [3_hsize_t, size(x, kind=hsize_t)]   ! Fortran's order; n by 3 for everyone else
      if (single) then
         allocate (rounded(3, size(x)))
         do i = 1, size(x)
            rounded(:, i) = [real(x(i), sp), real(y(i), sp), 0.0_sp]
         end do
         call put(self, name, h5t_native_real, extent, c_loc(rounded), 3*4, .true.)
      else
         allocate (rows(3, size(x)))
         do i = 1, size(x)
            rows(:, i) = [x(i), y(i), 0.0_dp]
         end do
         call put(self, name, h5t_native_double, extent, c_loc(rows), 3*8, .true.)
      end if
   end subroutine put_vectors

   subroutine put_singles(self, name, values)
      class(hdf5_writer_t), intent(inout) :: self
      character(*), intent(in) :: name
      real(sp), intent(in), contiguous, target :: values(:)   !! (n)

      call put(self, name, h5t_native_real, shape(values, hsize_t), c_loc(values), 4, .true.)
   end subroutine put_singles

   subroutine put_integers(self, name, values)
      class(hdf5_writer_t), intent(inout) :: self
      character(*), intent(in) :: name
      integer, intent(in), contiguous, target :: values(:)   !! (n)

      call put(self, name, h5t_native_integer, shape(values, hsize_t), c_loc(values), 4, .true.)
   end subroutine put_integers

   subroutine put_longs(self, name, values, in_parts)
      class(hdf5_writer_t), intent(inout) :: self
      character(*), intent(in) :: name
      integer(i8), intent(in), contiguous, target :: values(:)   !! (n)
      logical, intent(in) :: in_parts   !! as above

      call put(self, name, h5t_std_i64le, shape(values, hsize_t), c_loc(values), 8, in_parts)
   end subroutine put_longs

   !> Writes small numbers as unsigned bytes.
   subroutine put_bytes(self, name, values)
      class(hdf5_writer_t), intent(inout) :: self
      character(*), intent(in) :: name
      integer(int8), intent(in), contiguous, target :: values(:)   !! (n) 0 to 127

      call put(self, name, h5t_std_u8le, shape(values, hsize_t), c_loc(values), 1, .true.)
   end subroutine put_bytes

   !> Writes a text of any length but 0, as an array of one string.
   subroutine put_text(self, name, value)
      class(hdf5_writer_t), intent(inout) :: self
      character(*), intent(in) :: name, value
      character(kind=c_char), allocatable, target :: bytes(:)
      integer(hid_t) :: string
      integer :: i, status

      if (self%failed) return
      allocate (bytes(len(value)))
      do i = 1, len(value)
         bytes(i) = value(i:i)
      end do
      call h5tcopy_f(h5t_fortran_s1, string, status)
      call h5tset_cset_f(string, h5t_cset_utf8_f, status)
      call h5tset_size_f(string, len(value, kind(0_hsize_t)), status)
      call put(self, name, string, [1_hsize_t], c_loc(bytes), len(value), .false.)
      call h5tclose_f(string, status)
   end subroutine put_text

   !> Attaches a text of fixed length, as VTK's reader wants it; h5py shows it as bytes. Nothing for an empty text.
   subroutine put_label(self, owner, name, value)
      class(hdf5_writer_t), intent(inout) :: self
      character(*), intent(in) :: owner, name, value
      character(kind=c_char), target :: bytes(len(value))
      integer(hid_t) :: string
      integer :: i, status

      if (self%failed .or. len(value) == 0) return
      bytes = [(value(i:i), i=1, len(value))]
      call h5tcopy_f(h5t_fortran_s1, string, status)
      if (any(iachar(bytes) > 127)) call h5tset_cset_f(string, h5t_cset_utf8_f, status)
      call h5tset_size_f(string, len(value, kind(0_hsize_t)), status)
      call h5tset_strpad_f(string, h5t_str_nullpad_f, status)
      call put_attribute(self, owner, name, string, [integer(hsize_t) ::], c_loc(bytes))
      call h5tclose_f(string, status)
   end subroutine put_label

   !> Attaches a UTF-8 text of any length, which h5py shows as a text. HDF5 keeps it in a heap without a checksum.
   subroutine attach_text(self, owner, name, value)
      class(hdf5_writer_t), intent(inout) :: self
      character(*), intent(in) :: owner   !! a group or dataset
      character(*), intent(in) :: name, value
      character(kind=c_char), allocatable, target :: bytes(:)
      type(c_ptr), target :: address(1)
      integer(hid_t) :: string
      integer :: i, status

      if (self%failed) return
      allocate (bytes(len(value) + 1))
      do i = 1, len(value)
         bytes(i) = value(i:i)
      end do
      bytes(len(value) + 1) = c_null_char
      address(1) = c_loc(bytes)
      call h5tcopy_f(h5t_string, string, status)
      call h5tset_cset_f(string, h5t_cset_utf8_f, status)
      call put_attribute(self, owner, name, string, [integer(hsize_t) ::], c_loc(address))
      call h5tclose_f(string, status)
   end subroutine attach_text

   subroutine attach_real(self, owner, name, value)
      class(hdf5_writer_t), intent(inout) :: self
      character(*), intent(in) :: owner, name
      real(dp), intent(in) :: value
      real(dp), target :: copy

      copy = value
      call put_attribute(self, owner, name, h5t_native_double, [integer(hsize_t) ::], c_loc(copy))
   end subroutine attach_real

   subroutine attach_long(self, owner, name, value)
      class(hdf5_writer_t), intent(inout) :: self
      character(*), intent(in) :: owner, name
      integer(i8), intent(in) :: value
      integer(i8), target :: copy

      copy = value
      call put_attribute(self, owner, name, h5t_std_i64le, [integer(hsize_t) ::], c_loc(copy))
   end subroutine attach_long

   subroutine attach_integers(self, owner, name, values)
      class(hdf5_writer_t), intent(inout) :: self
      character(*), intent(in) :: owner, name
      integer, intent(in) :: values(:)   !! one is written as a scalar
      integer, target :: copy(size(values))

      copy = values
      if (size(values) == 1) then
         call put_attribute(self, owner, name, h5t_native_integer, [integer(hsize_t) ::], c_loc(copy))
      else
         call put_attribute(self, owner, name, h5t_native_integer, shape(values, hsize_t), c_loc(copy))
      end if
   end subroutine attach_integers

   !> Closes the file and gives it its name, or leaves nothing behind.
   subroutine finish(self, problem)
      class(hdf5_writer_t), intent(inout) :: self
      type(failure), intent(inout) :: problem   !! exit_files
      character(:), allocatable :: ignored
      integer :: status

      if (.not. is_first()) then
         call problem%tell()
         return
      end if
      if (self%file >= 0) then
         call h5fclose_f(self%file, status)
         call note(self, status, 'the end of the file')
      end if
      self%file = -1
      if (allocated(self%seal) .and. .not. self%failed) call close_seal(self)
      if (.not. self%failed) then
         call publish(self%path, problem)
      else
         call problem%raise(exit_files, "cannot write '"//self%path//"' (at "//self%failed_at// &
            '): '//self%reason)
      end if
      if (problem%raised()) call delete_file(partial_path(self%path), ignored)
      call problem%tell()
   end subroutine finish

   ! The checksum, and all of the file on the disk.
   subroutine close_seal(self)
      type(hdf5_writer_t), intent(inout) :: self
      character(:), allocatable :: reason
      character(256) :: message
      integer :: status

      call seal_file(partial_path(self%path), self%seal, status, message)
      call note(self, -abs(status), 'its checksum')
      if (self%failed) return
      call secure_path(partial_path(self%path), reason)
      call note(self, merge(0, -1, reason == ''), 'its checksum')
      if (reason /= '') self%reason = reason
   end subroutine close_seal

   !> Writes one dataset without compression, which would take longer than the step.
   !!
   !! Where each process has a part of its rows they follow each other; the first process asks for them chunk by chunk.
   subroutine put(self, name, kind, extent, address, row_bytes, in_parts)
      class(hdf5_writer_t), intent(inout) :: self
      character(*), intent(in) :: name
      integer(hid_t), intent(in) :: kind         !! type in memory and in the file
      integer(hsize_t), intent(in) :: extent(:)  !! of what this process has
      type(c_ptr), intent(in) :: address
      integer, intent(in) :: row_bytes           !! bytes of a row
      logical, intent(in) :: in_parts            !! each process has a part of the rows
      integer(i8), allocatable :: before(:)      ! (0:processes) rows before those of a process
      integer(hsize_t) :: whole(size(extent)), rows(size(extent))
      integer(hid_t) :: space, dataset, properties
      integer :: ignored, status

      whole = extent
      if (in_parts) then
         before = rows_before(int(extent(size(extent)), i8))
         whole(size(extent)) = before(ubound(before, 1))
      end if
      rows = chunk_of(whole)
      if (.not. is_first()) then
         if (in_parts) call send_rows(before, rows(size(extent)), row_bytes, address)
         return
      end if
      dataset = -1
      if (.not. self%failed) then
         call h5screate_simple_f(size(extent), whole, space, status)
         call note(self, status, name)
         call timeless(self, h5p_dataset_create_f, properties, name)
         if (all(whole > 0)) call part(self, properties, rows)
         call h5dcreate_f(self%file, name, kind, space, dataset, status, properties)
         call note(self, status, name)
         call h5pclose_f(properties, ignored)
         call h5sclose_f(space, ignored)
      end if
      if (in_parts .and. n_processes() > 1) then
         call write_rows(self, name, dataset, kind, whole, rows, before, row_bytes, address)
      else if (all(whole > 0) .and. .not. self%failed) then
         call h5dwrite_f(dataset, kind, address, status)
         call note(self, status, name)
      end if
      if (dataset >= 0) then
         call h5dclose_f(dataset, status)
         call note(self, status, name)
      end if
   end subroutine put

   ! Of the first process: all rows, chunk by chunk. What was sent is taken even if nothing can be written any more.
   subroutine write_rows(self, name, dataset, kind, whole, rows, before, row_bytes, address)
      class(hdf5_writer_t), intent(inout) :: self
      character(*), intent(in) :: name
      integer(hid_t), intent(in) :: dataset, kind
      integer(hsize_t), intent(in) :: whole(:), rows(:)   !! extents of the dataset and of a chunk
      integer(i8), intent(in) :: before(0:)
      integer, intent(in) :: row_bytes
      type(c_ptr), intent(in) :: address
      integer(int8), allocatable, target :: chunk(:)
      integer(hsize_t) :: offset(size(whole)), here(size(whole))
      integer(hid_t) :: memory, space
      type(c_ptr) :: start_of_chunk
      integer(i8) :: start
      integer :: ignored, status

      allocate (chunk(rows(size(rows))*row_bytes))
      do start = 0, whole(size(whole)) - 1, rows(size(rows))
         here = whole
         here(size(here)) = min(rows(size(rows)), whole(size(whole)) - start)
         call take_rows(before, start, here(size(here)), row_bytes, address, chunk)
         if (self%failed) cycle
         offset = 0
         offset(size(offset)) = start
         call h5screate_simple_f(size(here), here, memory, status)
         call h5dget_space_f(dataset, space, status)
         call h5sselect_hyperslab_f(space, h5s_select_set_f, offset, here, status)
         start_of_chunk = c_loc(chunk)
         call h5dwrite_f(dataset, kind, start_of_chunk, status, memory, space)
         call note(self, status, name)
         call h5sclose_f(memory, ignored)
         call h5sclose_f(space, ignored)
      end do
   end subroutine write_rows

   ! Rows of a dataset that are kept together: a million at most.
   pure function chunk_of(extent) result(rows)
      integer(hsize_t), intent(in) :: extent(:)
      integer(hsize_t) :: rows(size(extent))
      integer(hsize_t), parameter :: most_rows = 1000000
      integer(hsize_t) :: parts

      rows = extent
      associate (n => extent(size(extent)))
         parts = max(1_hsize_t, (n + most_rows - 1)/most_rows)
         rows(size(extent)) = max(1_hsize_t, (n + parts - 1)/parts)
      end associate
   end function chunk_of

   ! Parts of a dataset with a checksum each: a bit that flips on the disk is not taken for a number.
   subroutine part(self, properties, rows)
      class(hdf5_writer_t), intent(inout) :: self
      integer(hid_t), intent(in) :: properties
      integer(hsize_t), intent(in) :: rows(:)   !! of a part
      integer :: status

      call h5pset_chunk_f(properties, size(rows), rows, status)
      call note(self, status, 'the parts of a dataset')
      call h5pset_fletcher32_f(properties, status)
      call note(self, status, 'the parts of a dataset')
   end subroutine part

   subroutine put_attribute(self, owner, name, kind, extent, address)
      class(hdf5_writer_t), intent(inout) :: self
      character(*), intent(in) :: owner, name
      integer(hid_t), intent(in) :: kind
      integer(hsize_t), intent(in) :: extent(:)   !! of size 0 for a scalar
      type(c_ptr), intent(in) :: address
      integer(hid_t) :: space, attribute
      integer :: ignored, status

      if (self%failed) return
      if (size(extent) == 0) then
         call h5screate_f(h5s_scalar_f, space, status)
      else
         call h5screate_simple_f(size(extent), extent, space, status)
      end if
      call note(self, status, name)
      call h5acreate_by_name_f(self%file, owner, name, kind, space, attribute, status)
      call note(self, status, owner//' '//name)
      if (status >= 0) then
         call h5awrite_f(attribute, kind, address, status)
         call note(self, status, owner//' '//name)
         call h5aclose_f(attribute, ignored)
      end if
      call h5sclose_f(space, ignored)
   end subroutine put_attribute

   !> Remembers the first call that failed, and what the system had to say.
   subroutine note(self, status, place)
      class(hdf5_writer_t), intent(inout) :: self
      integer, intent(in) :: status
      character(*), intent(in) :: place

      if (self%failed) return
      if (status >= 0) then
         call forget_reason()   ! what HDF5 tried in vain and did without
         return
      end if
      self%failed = .true.
      self%failed_at = place
      self%reason = last_reason('HDF5 could not')
   end subroutine note

end module hdf5_writer
