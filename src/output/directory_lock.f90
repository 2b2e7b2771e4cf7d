!> One run at a time in a directory: a file that says whose it is, and a lock of the system's on it.
!!
!! The system's lock ends with the process, however that ends; but it may not reach from one machine to another. So the file also
!! has the machine and when the run was seen last, and what another machine wrote counts until it has been silent for a while.
module directory_lock
   use, intrinsic :: iso_c_binding, only: c_char, c_int, c_long, c_null_char, c_size_t
   use errors, only: exit_files, exit_input, failure
   use file_system, only: delete_file, file_bytes, is_deleted, is_link
   use kinds, only: i8
   implicit none
   private

   public :: directory_lock_t

   integer, parameter :: no_unit = -1
   integer(i8), parameter :: silence = 120        !! [s] after which another machine's run is taken for ended
   integer(i8), parameter :: beat_interval = 10   !! [s]
   integer(c_int), parameter :: exclusive_or_fail = 6   ! LOCK_EX + LOCK_NB
   integer, parameter :: word_length = 64

   !> Who holds a directory.
   type :: owner_t
      character(word_length) :: host = '', started = ''
      integer(i8) :: process = 0
      integer(i8) :: seen = 0   !! [s] since 1970
   end type owner_t

   !> A lock that this process holds, or not.
   type :: directory_lock_t
      private
      integer :: unit = no_unit
      character(:), allocatable :: path
      type(owner_t) :: owner
   contains
      procedure :: acquire
      procedure :: beat
      procedure :: release
   end type directory_lock_t

   interface
      integer(c_int) function c_flock(descriptor, operation) bind(c, name='flock')
         import :: c_int
         integer(c_int), value :: descriptor, operation
      end function c_flock

      integer(c_int) function c_descriptor(unit) bind(c, name='_gfortran_fnum_i4')
         import :: c_int
         integer(c_int), intent(in) :: unit
      end function c_descriptor

      integer(c_int) function c_gethostname(name, length) bind(c, name='gethostname')
         import :: c_char, c_int, c_size_t
         character(kind=c_char), intent(inout) :: name(*)
         integer(c_size_t), value :: length
      end function c_gethostname

      integer(c_int) function c_getpid() bind(c, name='getpid')
         import :: c_int
      end function c_getpid

      integer(c_long) function c_time(result) bind(c, name='time')
         import :: c_long
         integer(c_long), intent(out) :: result
      end function c_time
   end interface

contains

   !> Takes the directory for this process.
   subroutine acquire(self, directory, name, problem)
      class(directory_lock_t), intent(inout) :: self
      character(*), intent(in) :: directory
      character(*), intent(in) :: name            !! of the file in it
      type(failure), intent(inout) :: problem     !! exit_input: another run holds it; exit_files
      type(owner_t) :: other
      character(256) :: message
      integer(i8) :: length
      integer :: status

      self%path = directory//'/'//name
      self%owner = this_process()
      if (is_link(self%path)) call problem%raise(exit_input, "'"//self%path//"' is a link, and dynsph has that name for a " &
                                                 //'file of its own: move it away')
      if (problem%raised()) return
      open (newunit=self%unit, file=self%path, status='unknown', action='readwrite', iostat=status, iomsg=message)
      if (status /= 0) then
         self%unit = no_unit
         call problem%raise(exit_files, "cannot write '"//self%path//"': "//trim(message))
         return
      end if
      call read_owner(self%unit, other)
      length = file_bytes(self%path)
      if (c_flock(c_descriptor(int(self%unit, c_int)), exclusive_or_fail) /= 0) then
         call refuse('')
      else if (other%host == '' .and. length > 0) then
         call problem%raise(exit_input, "'"//self%path//"' was not written by a run of dynsph, which has that name for one of " &
                            //'its own: move it away')
         close (self%unit, iostat=status)
         self%unit = no_unit
      else if (other%host /= '' .and. other%host /= self%owner%host .and. self%owner%seen - other%seen < silence) then
         call refuse("; if that machine is no more, delete '"//self%path//"'")
      else
         call write_owner(self)
         ! Whoever held it may have deleted the file between our opening and locking it.
         if (is_deleted(c_descriptor(int(self%unit, c_int)))) call refuse('')
      end if

   contains

      subroutine refuse(hint)
         character(*), intent(in) :: hint
         character(20) :: number
         integer :: ignored

         write (number, '(i0)') other%process
         call problem%raise(exit_input, "a run is writing to '"//directory//"' (process "//trim(number)//' on '//trim(other%host) &
                            //', since '//trim(other%started)//'): choose another directory, or stop that run'//hint)
         close (self%unit, iostat=ignored)
         self%unit = no_unit
      end subroutine refuse

   end subroutine acquire

   !> Tells other machines that this run is alive; to be called now and then.
   subroutine beat(self)
      class(directory_lock_t), intent(inout) :: self

      if (self%unit == no_unit) return
      if (seconds() - self%owner%seen >= beat_interval) call write_owner(self)
   end subroutine beat

   subroutine write_owner(self)
      type(directory_lock_t), intent(inout) :: self
      integer :: ignored

      self%owner%seen = seconds()
      rewind (self%unit, iostat=ignored)
      write (self%unit, '(a)', iostat=ignored) 'host = '//trim(self%owner%host)
      write (self%unit, '(a, i0)', iostat=ignored) 'process = ', self%owner%process
      write (self%unit, '(a)', iostat=ignored) 'started = '//trim(self%owner%started)
      write (self%unit, '(a, i0)', iostat=ignored) 'seen = ', self%owner%seen
      flush (self%unit, iostat=ignored)
   end subroutine write_owner

   !> Gives the directory free.
   subroutine release(self)
      class(directory_lock_t), intent(inout) :: self
      character(:), allocatable :: reason
      integer :: ignored

      if (self%unit == no_unit) return
      call delete_file(self%path, reason)
      close (self%unit, iostat=ignored)
      self%unit = no_unit
   end subroutine release

   function this_process() result(owner)
      type(owner_t) :: owner
      character(kind=c_char) :: name(word_length)
      integer :: values(8), i

      name = c_null_char
      if (c_gethostname(name, size(name, kind=c_size_t) - 1) == 0) then
         do i = 1, word_length
            if (name(i) == c_null_char) exit
            owner%host(i:i) = name(i)
         end do
      end if
      if (owner%host == '') owner%host = 'unknown'
      owner%process = c_getpid()
      call date_and_time(values=values)
      write (owner%started, '(i4.4, 2("-", i2.2), " ", i2.2, 2(":", i2.2))') values(1:3), values(5:7)
      owner%seen = seconds()
   end function this_process

   integer(i8) function seconds()
      integer(c_long) :: now

      seconds = c_time(now)
   end function seconds

   ! What the file says; a file that is new, or that somebody is just writing, says nothing.
   subroutine read_owner(unit, owner)
      integer, intent(in) :: unit
      type(owner_t), intent(out) :: owner
      character(2*word_length) :: line
      integer :: equals, ignored, status

      do
         read (unit, '(a)', iostat=status) line
         if (status /= 0) exit
         equals = index(line, ' = ')
         if (equals == 0) cycle
         associate (value => line(equals + 3:))
            select case (line(:equals))
            case ('host')
               owner%host = value(:word_length)
            case ('process')
               read (value, *, iostat=ignored) owner%process
            case ('started')
               owner%started = value(:word_length)
            case ('seen')
               read (value, *, iostat=ignored) owner%seen
            end select
         end associate
      end do
   end subroutine read_owner

end module directory_lock
