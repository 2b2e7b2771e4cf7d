!> A checkpoint in HDF5: groups with numbers as attributes and arrays as datasets, and the complete input as a text.
!!
!! The file is sealed: nothing in it is looked at unless its checksum is right.
module checkpoint_file
   use, intrinsic :: iso_c_binding, only: c_char, c_loc, c_ptr, c_size_t
   use archive, only: archive_t
   use build_info, only: git_id, version
   use communication, only: is_first
   use errors, only: failure, text_of_any
   use hdf5, only: h5aclose_f, h5aopen_by_name_f, h5aread_f, h5dclose_f, h5dget_space_f, h5dget_type_f, h5dopen_f, h5dread_f, &
      h5f_acc_rdonly_f, h5fclose_f, h5fopen_f, h5s_select_set_f, h5sclose_f, h5screate_simple_f, &
      h5sget_simple_extent_npoints_f, h5sselect_hyperslab_f, h5t_native_double, h5t_native_real, &
      h5t_std_i64le, h5tclose_f, h5tget_size_f, hid_t, hsize_t
   use hdf5_writer, only: hdf5_writer_t, open_library
   use kinds, only: dp, i8, sp
   use sealed_file, only: broken_seal
   use text, only: short, to_text
   implicit none
   private

   public :: checkpoint_file_t

   integer(i8), parameter :: format = 1   !! of the file; to be raised when an older one can no longer be read

   !> A checkpoint that is written or read.
   type, extends(archive_t) :: checkpoint_file_t
      character(:), allocatable :: version     !! of dynsph, that wrote it
      character(:), allocatable :: git_id      !! of its source
      character(:), allocatable :: input       !! the complete namelist
      character(:), allocatable :: origin      !! where the run was forked from; '' for one that began at its beginning
      integer(i8) :: particles = 0
      integer(i8) :: number = 0                !! of checkpoints that the run had written before
      integer(i8) :: step = 0
      real(dp) :: time = 0
      character(:), allocatable :: path
      type(hdf5_writer_t), private :: writer
      integer(hid_t), private :: file = -1
      character(:), allocatable, private :: group   !! that `keep` means
      character(:), allocatable, private :: lacks   !! the first thing that could not be read
   contains
      procedure :: write_head
      procedure :: finish
      procedure :: open => open_checkpoint
      procedure :: missing
      procedure :: close => close_checkpoint
      procedure :: part
      procedure :: keep_real
      procedure :: keep_long
      procedure :: keep_reals
      procedure :: keep_parts
      procedure :: keep_single_parts
   end type checkpoint_file_t

contains

   !> Begins a file with what is said of the run: input, origin, particles, step and time are set.
   subroutine write_head(self, path)
      class(checkpoint_file_t), intent(inout) :: self
      character(*), intent(in) :: path

      self%reading = .false.
      self%path = path
      call self%writer%create(path, seal='checkpoint of dynsph '//version//' ('//git_id//'), step '//to_text(self%step)//', t = ' &
                              //short(self%time)//new_line('a')//'HDF5 from byte 512 on')
      call self%writer%attach('/', 'format', format)
      call self%writer%put_text('/version', version)
      call self%writer%put_text('/git_id', git_id)
      call self%writer%put_text('/input', self%input)
      call self%writer%put_text('/origin', self%origin//' ')
      self%group = '/'
      call keep_facts(self)
   end subroutine write_head

   subroutine keep_facts(self)
      class(checkpoint_file_t), intent(inout) :: self

      call self%keep('particles', self%particles)
      call self%keep('number', self%number)
      call self%keep('step', self%step)
      call self%keep('time', self%time)
   end subroutine keep_facts

   !> Completes the file that was begun.
   subroutine finish(self, problem)
      class(checkpoint_file_t), intent(inout) :: self
      type(failure), intent(inout) :: problem   !! exit_files

      call self%writer%finish(problem)
   end subroutine finish

   !> Opens a file and reads its head. `reason` says why it cannot be used; '' if it can.
   subroutine open_checkpoint(self, path, reason)
      class(checkpoint_file_t), intent(inout) :: self
      character(*), intent(in) :: path
      character(:), allocatable, intent(out) :: reason
      integer(i8) :: number
      integer :: status

      self%reading = .true.
      self%path = path
      self%lacks = ''
      self%group = '/'
      reason = ''
      if (is_first()) reason = broken_seal(path)
      call text_of_any(reason)
      if (reason /= '') return
      call open_library(status)
      if (status >= 0) call h5fopen_f(path, h5f_acc_rdonly_f, self%file, status)
      if (status < 0) then
         self%file = -1
         reason = 'HDF5 cannot open it'
      end if
      call text_of_any(reason)
      if (reason /= '') then
         call self%close()
         return
      end if
      number = 0
      call self%keep('format', number)
      if (number /= format) reason = &
         'its format is '//to_text(number)//', and this version knows '//to_text(format)
      call text_of_any(reason)
      if (reason /= '') then
         call self%close()
         return
      end if
      call read_text(self, '/version', self%version)
      call read_text(self, '/git_id', self%git_id)
      call read_text(self, '/input', self%input)
      call read_text(self, '/origin', self%origin)
      call keep_facts(self)
      reason = self%missing()
      if (reason /= '') call self%close()
   end subroutine open_checkpoint

   !> What could not be read so far, as a reason; '' if nothing.
   function missing(self) result(reason)
      class(checkpoint_file_t), intent(in) :: self
      character(:), allocatable :: reason

      reason = ''
      if (self%lacks /= '') reason = "it has no '"//self%lacks//"' of the kind that is needed"
      call text_of_any(reason)
   end function missing

   subroutine close_checkpoint(self)
      class(checkpoint_file_t), intent(inout) :: self
      integer :: ignored

      if (self%file >= 0) call h5fclose_f(self%file, ignored)
      self%file = -1
   end subroutine close_checkpoint

   subroutine part(self, name)
      class(checkpoint_file_t), intent(inout) :: self
      character(*), intent(in) :: name

      self%group = '/'//name//'/'
      if (.not. self%reading) call self%writer%make_group('/'//name)
   end subroutine part

   subroutine keep_real(self, name, value)
      class(checkpoint_file_t), intent(inout) :: self
      character(*), intent(in) :: name
      real(dp), intent(inout) :: value
      real(dp), target :: found

      if (self%reading) then
         found = value
         call read_attribute(self, name, h5t_native_double, c_loc(found))
         value = found
      else
         call self%writer%attach(self%group, name, value)
      end if
   end subroutine keep_real

   subroutine keep_long(self, name, value)
      class(checkpoint_file_t), intent(inout) :: self
      character(*), intent(in) :: name
      integer(i8), intent(inout) :: value
      integer(i8), target :: found

      if (self%reading) then
         found = value
         call read_attribute(self, name, h5t_std_i64le, c_loc(found))
         value = found
      else
         call self%writer%attach(self%group, name, value)
      end if
   end subroutine keep_long

   subroutine keep_reals(self, name, values)
      class(checkpoint_file_t), intent(inout) :: self
      character(*), intent(in) :: name
      real(dp), intent(inout), contiguous, target :: values(:)

      if (self%reading) then
         call read_array(self, name, h5t_native_double, 1, size(values), size(values), c_loc(values))
      else
         call self%writer%put_reals(self%group//name, values, single=.false., in_parts=.false.)
      end if
   end subroutine keep_reals

   subroutine keep_parts(self, name, first, total, values)
      class(checkpoint_file_t), intent(inout) :: self
      character(*), intent(in) :: name
      integer, intent(in) :: first, total
      real(dp), intent(inout), contiguous, target :: values(:)

      if (self%reading) then
         call read_array(self, name, h5t_native_double, first, size(values), total, c_loc(values))
      else
         call self%writer%put_reals(self%group//name, values, single=.false., in_parts=.true.)
      end if
   end subroutine keep_parts

   subroutine keep_single_parts(self, name, first, total, values)
      class(checkpoint_file_t), intent(inout) :: self
      character(*), intent(in) :: name
      integer, intent(in) :: first, total
      real(sp), intent(inout), contiguous, target :: values(:)

      if (self%reading) then
         call read_array(self, name, h5t_native_real, first, size(values), total, c_loc(values))
      else
         call self%writer%put_singles(self%group//name, values)
      end if
   end subroutine keep_single_parts

   subroutine read_attribute(self, name, kind, start)
      class(checkpoint_file_t), intent(inout) :: self
      character(*), intent(in) :: name
      integer(hid_t), intent(in) :: kind
      type(c_ptr), intent(in) :: start
      type(c_ptr) :: place
      integer(hid_t) :: attribute
      integer :: ignored, status

      if (self%lacks /= '') return
      place = start
      call h5aopen_by_name_f(self%file, self%group, name, attribute, status)
      if (status >= 0) then
         call h5aread_f(attribute, kind, place, status)
         call h5aclose_f(attribute, ignored)
      end if
      if (status < 0) self%lacks = self%group//name
   end subroutine read_attribute

   subroutine read_array(self, name, kind, first, n, total, start)
      class(checkpoint_file_t), intent(inout) :: self
      character(*), intent(in) :: name
      integer(hid_t), intent(in) :: kind
      integer, intent(in) :: first, n, total   !! value that is wanted first, how many, and how many there must be
      type(c_ptr), intent(in) :: start
      type(c_ptr) :: place
      integer(hid_t) :: dataset, memory, space
      integer(hsize_t) :: there
      integer :: ignored, status

      if (self%lacks /= '') return
      place = start
      call h5dopen_f(self%file, self%group//name, dataset, status)
      if (status >= 0) then
         call h5dget_space_f(dataset, space, status)
         call h5sget_simple_extent_npoints_f(space, there, status)
         call h5sclose_f(space, ignored)
         if (there /= total) status = -1
         if (status >= 0 .and. n > 0) then
            call h5dget_space_f(dataset, space, status)
            call h5sselect_hyperslab_f(space, h5s_select_set_f, [first - 1_hsize_t], [int(n, hsize_t)], status)
            call h5screate_simple_f(1, [int(n, hsize_t)], memory, status)
            call h5dread_f(dataset, kind, place, status, memory, space)
            call h5sclose_f(memory, ignored)
            call h5sclose_f(space, ignored)
         end if
         call h5dclose_f(dataset, ignored)
      end if
      if (status < 0) self%lacks = self%group//name
   end subroutine read_array

   subroutine read_text(self, name, value)
      class(checkpoint_file_t), intent(inout) :: self
      character(*), intent(in) :: name
      character(:), allocatable, intent(out) :: value
      character(kind=c_char), allocatable, target :: bytes(:)
      type(c_ptr) :: start
      integer(hid_t) :: dataset, kind
      integer(c_size_t) :: length
      integer :: i, ignored, status

      value = ''
      if (self%lacks /= '') return
      call h5dopen_f(self%file, name, dataset, status)
      if (status >= 0) then
         call h5dget_type_f(dataset, kind, status)
         call h5tget_size_f(kind, length, status)
         allocate (bytes(length))
         start = c_loc(bytes)
         call h5dread_f(dataset, kind, start, status)
         value = repeat(' ', size(bytes))
         do i = 1, size(bytes)
            value(i:i) = bytes(i)
         end do
         value = trim(value)
         call h5tclose_f(kind, ignored)
         call h5dclose_f(dataset, ignored)
      end if
      if (status < 0) self%lacks = name
   end subroutine read_text

end module checkpoint_file
