!> Directories and files: the few calls of the C library that Fortran lacks, and
!! files that appear under their name only when they are complete.
!!
!! Each call returns the system's reason, '' when it succeeded.
module file_system
   use, intrinsic :: iso_c_binding, only: c_associated, c_char, c_f_pointer, c_funptr, c_int, c_long, c_null_char, &
      c_null_funptr, c_ptr, c_size_t
   use errors, only: exit_files, failure
   use growing_text, only: growing_text_t
   use kinds, only: i8
   use system_words, only: c_words, forget_reason, last_number, last_reason, reason_of
   use text, only: to_text
   implicit none
   private

   public :: delete_file, file_bytes, find_files, flush_unit, is_deleted, is_directory, is_link, &
      is_writable, make_directory, partial_path, &
      path_exists, publish, read_whole_file, remove_directory, rename_file, same_place, secure_path, secure_unit, seek_end, &
      shorten_file, write_whole_file

   integer, parameter, public :: longest_path = 4096   !! characters, as Linux has it
   integer, parameter, public :: longest_text = 10**8  !! letters of a file that is read as a whole
   character(*), parameter :: cut_short = 'the system has not taken all of it'
   integer(c_int), parameter :: from_here = 1   !! SEEK_CUR

   integer(c_int), parameter :: mode_exists = 0, mode_write_search = 3   !! for access()
   integer(c_int), parameter :: all_may_read = int(o'777', c_int)        !! less the user's umask

   ! The head of the C library's glob_t (glibc and musl), with room for the rest.
   type, bind(c) :: glob_result
      integer(c_size_t) :: number = 0
      type(c_ptr) :: paths
      integer(c_size_t) :: rest(30) = 0
   end type glob_result

   interface
      integer(c_int) function c_mkdir(path, mode) bind(c, name='mkdir')
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: path(*)
         integer(c_int), value :: mode
      end function c_mkdir

      integer(c_int) function c_rmdir(path) bind(c, name='rmdir')
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: path(*)
      end function c_rmdir

      integer(c_int) function c_unlink(path) bind(c, name='unlink')
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: path(*)
      end function c_unlink

      integer(c_int) function c_rename(from, to) bind(c, name='rename')
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: from(*), to(*)
      end function c_rename

      integer(c_int) function c_access(path, mode) bind(c, name='access')
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: path(*)
         integer(c_int), value :: mode
      end function c_access

      integer(c_size_t) function c_readlink(path, target, length) bind(c, name='readlink')
         import :: c_char, c_size_t
         character(kind=c_char), intent(in) :: path(*)
         character(kind=c_char), intent(inout) :: target(*)
         integer(c_size_t), value :: length
      end function c_readlink

      ! The room must be that of the longest path.
      type(c_ptr) function c_realpath(path, resolved) bind(c, name='realpath')
         import :: c_char, c_ptr
         character(kind=c_char), intent(in) :: path(*)
         character(kind=c_char), intent(inout) :: resolved(*)
      end function c_realpath

      type(c_ptr) function c_opendir(path) bind(c, name='opendir')
         import :: c_char, c_ptr
         character(kind=c_char), intent(in) :: path(*)
      end function c_opendir

      integer(c_int) function c_closedir(handle) bind(c, name='closedir')
         import :: c_int, c_ptr
         type(c_ptr), value :: handle
      end function c_closedir

      integer(c_int) function c_glob(pattern, flags, on_error, found) bind(c, name='glob')
         import :: c_char, c_funptr, c_int, glob_result
         character(kind=c_char), intent(in) :: pattern(*)
         integer(c_int), value :: flags
         type(c_funptr), value :: on_error
         type(glob_result), intent(inout) :: found
      end function c_glob

      subroutine c_globfree(found) bind(c, name='globfree')
         import :: glob_result
         type(glob_result), intent(inout) :: found
      end subroutine c_globfree

      integer(c_int) function c_descriptor(unit) bind(c, name='_gfortran_fnum_i4')
         import :: c_int
         integer(c_int), intent(in) :: unit
      end function c_descriptor

      integer(c_long) function c_lseek(descriptor, offset, whence) bind(c, name='lseek')
         import :: c_int, c_long
         integer(c_int), value :: descriptor
         integer(c_long), value :: offset
         integer(c_int), value :: whence
      end function c_lseek

      integer(c_size_t) function c_write(descriptor, bytes, count) bind(c, name='write')
         import :: c_char, c_int, c_size_t
         integer(c_int), value :: descriptor
         character(kind=c_char), intent(in) :: bytes(*)
         integer(c_size_t), value :: count
      end function c_write

      integer(c_int) function c_fdatasync(descriptor) bind(c, name='fdatasync')
         import :: c_int
         integer(c_int), value :: descriptor
      end function c_fdatasync

      integer(c_int) function c_fsync(descriptor) bind(c, name='fsync')
         import :: c_int
         integer(c_int), value :: descriptor
      end function c_fsync

      integer(c_int) function c_truncate(path, length) bind(c, name='truncate')
         import :: c_char, c_int, c_long
         character(kind=c_char), intent(in) :: path(*)
         integer(c_long), value :: length
      end function c_truncate

      type(c_ptr) function c_fopen(path, mode) bind(c, name='fopen')
         import :: c_char, c_ptr
         character(kind=c_char), intent(in) :: path(*), mode(*)
      end function c_fopen

      integer(c_int) function c_fileno(stream) bind(c, name='fileno')
         import :: c_int, c_ptr
         type(c_ptr), value :: stream
      end function c_fileno

      integer(c_int) function c_fclose(stream) bind(c, name='fclose')
         import :: c_int, c_ptr
         type(c_ptr), value :: stream
      end function c_fclose

   end interface

contains

   !> True when something of that name exists, whatever it is.
   logical function path_exists(path)
      character(*), intent(in) :: path

      path_exists = c_access(c_text(path), mode_exists) == 0
   end function path_exists

   !> True for a symbolic link, wherever it leads.
   logical function is_link(path)
      character(*), intent(in) :: path
      character(kind=c_char) :: target(1)

      is_link = c_readlink(c_text(path), target, 1_c_size_t) >= 0
   end function is_link

   !> Whether two paths lead to one directory or file that is there.
   logical function same_place(one, other)
      character(*), intent(in) :: one, other
      character(kind=c_char) :: first(longest_path), second(longest_path)

      first = c_null_char
      second = c_null_char
      same_place = c_associated(c_realpath(c_text(one), first))
      if (same_place) same_place = c_associated(c_realpath(c_text(other), second))
      if (same_place) same_place = all(first == second)
   end function same_place

   !> Whether an open file has lost its name; where the system cannot tell it has not.
   logical function is_deleted(descriptor)
      integer(c_int), intent(in) :: descriptor
      character(*), parameter :: mark = ' (deleted)'
      character(kind=c_char) :: target(longest_path)
      character(20) :: number
      integer(c_size_t) :: length
      integer :: i

      write (number, '(i0)') descriptor
      length = c_readlink(c_text('/proc/self/fd/'//number), target, size(target, kind=c_size_t))
      is_deleted = length >= len(mark)
      if (is_deleted) is_deleted = all(target(length - len(mark) + 1:length) == [(mark(i:i), i=1, len(mark))])
   end function is_deleted

   !> True for a directory that may be listed.
   logical function is_directory(path)
      character(*), intent(in) :: path
      type(c_ptr) :: handle
      integer(c_int) :: ignored

      handle = c_opendir(c_text(path))
      is_directory = c_associated(handle)
      if (is_directory) ignored = c_closedir(handle)
   end function is_directory

   !> True for a directory in which this user may make files.
   logical function is_writable(path, reason)
      character(*), intent(in) :: path
      character(:), allocatable, intent(out) :: reason

      reason = reason_of(c_access(c_text(path), mode_write_search))
      is_writable = len(reason) == 0
   end function is_writable

   !> Makes one directory; its parent must exist.
   subroutine make_directory(path, reason)
      character(*), intent(in) :: path
      character(:), allocatable, intent(out) :: reason

      reason = reason_of(c_mkdir(c_text(path), all_may_read))
      if (len(reason) > 0) then
         if (is_link(path)) reason = 'it is a symbolic link that leads nowhere'
      end if
   end subroutine make_directory

   !> Removes a directory if it is empty; fails, and changes nothing, otherwise.
   subroutine remove_directory(path, reason)
      character(*), intent(in) :: path
      character(:), allocatable, intent(out) :: reason

      reason = reason_of(c_rmdir(c_text(path)))
   end subroutine remove_directory

   !> Deletes one file; fails on a directory.
   subroutine delete_file(path, reason)
      character(*), intent(in) :: path
      character(:), allocatable, intent(out) :: reason

      reason = reason_of(c_unlink(c_text(path)))
   end subroutine delete_file

   !> Renames a file; one that had the new name is replaced in the same instant.
   subroutine rename_file(from, to, reason)
      character(*), intent(in) :: from, to
      character(:), allocatable, intent(out) :: reason

      reason = reason_of(c_rename(c_text(from), c_text(to)))
   end subroutine rename_file

   !> Cuts a file behind its first bytes.
   subroutine shorten_file(path, bytes, reason)
      character(*), intent(in) :: path
      integer(i8), intent(in) :: bytes
      character(:), allocatable, intent(out) :: reason

      reason = reason_of(c_truncate(c_text(path), int(bytes, c_long)))
   end subroutine shorten_file

   !> Length of a file; -1 where there is none.
   integer(i8) function file_bytes(path)
      character(*), intent(in) :: path

      inquire (file=path, size=file_bytes)
   end function file_bytes

   !> Returns once a file, or the names in a directory, are on the disk: a machine that loses its power does not lose them.
   subroutine secure_path(path, reason)
      character(*), intent(in) :: path
      character(:), allocatable, intent(out) :: reason
      type(c_ptr) :: stream
      integer(c_int) :: ignored

      stream = c_fopen(c_text(path), 'r'//c_null_char)
      if (.not. c_associated(stream)) then
         reason = reason_of(1_c_int)
         return
      end if
      reason = reason_of(c_fsync(c_fileno(stream)))
      ignored = c_fclose(stream)
   end subroutine secure_path

   !> The paths in a directory whose name matches a shell pattern, sorted.
   subroutine find_files(directory, pattern, paths)
      character(*), intent(in) :: directory
      character(*), intent(in) :: pattern                            !! with * ? and [...]
      character(longest_path), allocatable, intent(out) :: paths(:)  !! (number found)
      type(glob_result) :: found
      type(c_ptr), pointer :: list(:)
      integer :: i

      if (c_glob(c_text(literal(directory)//'/'//pattern), 0_c_int, c_null_funptr, found) /= 0) then
         allocate (paths(0))
         return
      end if
      call c_f_pointer(found%paths, list, [found%number])
      allocate (paths(size(list)))
      do i = 1, size(list)
         paths(i) = c_words(list(i))
      end do
      call c_globfree(found)
   end subroutine find_files

   !> The name a file has while it is being written.
   pure function partial_path(path) result(partial)
      character(*), intent(in) :: path
      character(:), allocatable :: partial

      partial = path//'.partial'
   end function partial_path

   !> Gives a file written as `partial_path(path)` its name, replacing an earlier one.
   subroutine publish(path, problem)
      character(*), intent(in) :: path
      type(failure), intent(inout) :: problem   !! exit_files
      character(:), allocatable :: reason

      call rename_file(partial_path(path), path, reason)
      if (len(reason) > 0) call problem%raise(exit_files, "cannot rename '"//partial_path(path)//"' to '"//path//"': "//reason)
   end subroutine publish

   !> Writes a text as a whole file: complete under its name, or not there.
   subroutine write_whole_file(path, text, problem)
      character(*), intent(in) :: path
      character(*), intent(in) :: text          !! with its own line ends
      type(failure), intent(inout) :: problem   !! exit_files
      character(:), allocatable :: ignored, reason
      character(256) :: message
      integer :: unit, status

      open (newunit=unit, file=partial_path(path), access='stream', form='unformatted', status='replace', action='write', &
         iostat=status, iomsg=message)
      if (status == 0) then
         write (unit, iostat=status, iomsg=message) text
         if (status == 0) then
            call secure_unit(unit, len(text, i8), reason)
            status = len(reason)
            message = reason
         end if
         close (unit)
      end if
      if (status == 0) then
         call publish(path, problem)
      else
         call problem%raise(exit_files, "cannot write '"//path//"': "//trim(message))
      end if
      if (problem%raised()) call delete_file(partial_path(path), ignored)
   end subroutine write_whole_file

   !> Reads the text of a whole file, or all that a pipe gives.
   subroutine read_whole_file(path, content, problem)
      character(*), intent(in) :: path
      character(:), allocatable, intent(out) :: content   !! until the first letter 0 of what has no end, such as /dev/zero
      type(failure), intent(inout) :: problem   !! exit_files
      type(growing_text_t) :: read_so_far
      character :: letter
      integer(i8) :: length
      integer :: unit, status

      content = ''
      length = 0
      open (newunit=unit, file=path, access='stream', form='unformatted', status='old', action='read', iostat=status)
      if (status == 0) then
         inquire (unit=unit, size=length)
         if (length <= longest_text) then
            content = repeat(' ', max(0, int(length)))
            read (unit, iostat=status) content
            if (status == 0) call read_so_far%add(content)
            ! A pipe does not know how long its text will be.
            letter = ' '
            do while (status == 0 .and. length <= longest_text .and. letter /= c_null_char)
               read (unit, iostat=status) letter
               if (status /= 0) exit
               call read_so_far%add(letter)
               length = length + 1
            end do
            content = read_so_far%text()
         end if
         close (unit)
      end if
      if (length > longest_text) then
         call problem%raise(exit_files, path//': the file has more than '//to_text(longest_text/10**6) &
                            //' million letters; is it the text that you meant?')
      else if (status > 0) then
         call problem%raise(exit_files, path//': the file cannot be read; is it a text file that you may read?')
      end if
   end subroutine read_whole_file

   !> Hands what was written to a unit to the system. gfortran's WRITE, FLUSH and CLOSE keep a full disk to themselves, and INQUIRE
   !! counts what the disk did not take; the place that the open file has reached is the system's own.
   subroutine flush_unit(unit, bytes, reason)
      integer, intent(in) :: unit
      integer(i8), intent(in) :: bytes   !! written so far
      character(:), allocatable, intent(out) :: reason
      integer(c_int) :: descriptor
      integer(i8) :: taken
      integer :: ignored
      logical :: has_disk

      call forget_reason()
      flush (unit, iostat=ignored)
      reason = last_reason('')
      if (reason /= '') return
      descriptor = c_descriptor(int(unit, c_int))
      taken = c_lseek(descriptor, 0_c_long, from_here)
      if (taken >= bytes) return
      call bring_to_disk(descriptor, has_disk, reason)
      if (has_disk .and. reason == '') reason = cut_short
   end subroutine flush_unit

   !> As `flush_unit`, and what was written is on the disk.
   subroutine secure_unit(unit, bytes, reason)
      integer, intent(in) :: unit
      integer(i8), intent(in) :: bytes   !! written so far
      character(:), allocatable, intent(out) :: reason
      logical :: has_disk

      call flush_unit(unit, bytes, reason)
      if (reason == '') call bring_to_disk(c_descriptor(int(unit, c_int)), has_disk, reason)
   end subroutine secure_unit

   ! What an open file has taken is on the disk then. Pipes and devices have none; they are asked whether they take anything:
   ! /dev/full takes not even nothing.
   subroutine bring_to_disk(descriptor, has_disk, reason)
      integer(c_int), intent(in) :: descriptor
      logical, intent(out) :: has_disk
      character(:), allocatable, intent(out) :: reason
      integer(c_int), parameter :: no_disk = 22   ! EINVAL of Linux

      call forget_reason()
      reason = reason_of(c_fdatasync(descriptor))
      has_disk = last_number() /= no_disk
      if (.not. has_disk) reason = reason_of(int(c_write(descriptor, c_null_char, 0_c_size_t), c_int))
   end subroutine bring_to_disk

   !> The place of a file that was opened to be appended to: gfortran goes there with the first row only, and until then the file
   !! would seem to have lost what is in it.
   subroutine seek_end(unit)
      integer, intent(in) :: unit
      integer(c_int), parameter :: from_end = 2   ! SEEK_END
      integer(i8) :: ignored

      ignored = c_lseek(c_descriptor(int(unit, c_int)), 0_c_long, from_end)
   end subroutine seek_end

   !> A path in which no character is special to glob().
   pure function literal(path)
      character(*), intent(in) :: path
      character(:), allocatable :: literal
      integer :: i

      literal = ''
      do i = 1, len_trim(path)
         if (scan(path(i:i), '*?[]\') > 0) literal = literal//'\'
         literal = literal//path(i:i)
      end do
   end function literal

   pure function c_text(text)
      character(*), intent(in) :: text
      character(len_trim(text) + 1, kind=c_char) :: c_text

      c_text = trim(text)//c_null_char
   end function c_text

end module file_system
