!> What the machine has to offer: memory, and room on a disk.
!!
!! Both are what is left now; other programs may take it. What is not known counts as endless.
module machine
   use, intrinsic :: iso_c_binding, only: c_char, c_int, c_long, c_null_char
   use kinds, only: dp
   implicit none
   private

   public :: available_memory, free_space

   real(dp), parameter, public :: endless = huge(1.0_dp)

   integer(c_int), parameter :: address_space = 9   ! RLIMIT_AS of Linux

   interface
      integer(c_int) function c_getrlimit(resource, limits) bind(c, name='getrlimit')
         import :: c_int, c_long
         integer(c_int), value :: resource
         integer(c_long), intent(out) :: limits(2)
      end function c_getrlimit

      ! The head of Linux's struct statvfs where long has 64 bits: f_bsize, f_frsize, f_blocks, f_bfree, f_bavail.
      integer(c_int) function c_statvfs(path, figures) bind(c, name='statvfs')
         import :: c_char, c_int, c_long
         character(kind=c_char), intent(in) :: path(*)
         integer(c_long), intent(inout) :: figures(64)
      end function c_statvfs
   end interface

contains

   !> Bytes that a program can still get: of the machine, of its control group, of its own limit.
   real(dp) function available_memory() result(bytes)
      integer(c_long) :: limits(2)
      real(dp) :: group, used

      bytes = 1024*number_after('/proc/meminfo', 'MemAvailable:')
      group = number_after('/sys/fs/cgroup/memory.max', '')
      ! Not memory.current: that counts cached files, which give way.
      used = number_after('/sys/fs/cgroup/memory.stat', 'anon ')
      if (group < endless .and. used < endless) bytes = min(bytes, group - used)
      ! Without a limit it is all ones, -1 here.
      if (c_getrlimit(address_space, limits) == 0 .and. limits(1) >= 0) bytes = min(bytes, real(limits(1), dp))
   end function available_memory

   !> Bytes that this user can still write to the disk that a path is on; the path need not exist yet.
   real(dp) function free_space(path) result(bytes)
      character(*), intent(in) :: path
      integer(c_long) :: figures(64)
      integer :: last

      bytes = endless
      if (storage_size(0_c_long) /= 64) return
      last = len_trim(path)
      do
         if (last == 0) exit
         if (c_statvfs(path(:last)//c_null_char, figures) == 0) then
            bytes = real(figures(2), dp)*real(figures(5), dp)
            return
         end if
         last = index(path(:last), '/', back=.true.) - 1
         if (last < 0) exit
      end do
      if (c_statvfs(merge('/', '.', index(path, '/') == 1)//c_null_char, figures) == 0) &
         bytes = real(figures(2), dp)*real(figures(5), dp)
   end function free_space

   ! The number behind a word in a small file, or its first one; endless if there is none.
   real(dp) function number_after(file, word) result(number)
      character(*), intent(in) :: file, word
      character(256) :: line
      integer :: status, unit

      number = endless
      open (newunit=unit, file=file, status='old', action='read', iostat=status)
      if (status /= 0) return
      do
         read (unit, '(a)', iostat=status) line
         if (status /= 0) exit
         if (index(line, word) /= 1) cycle
         read (line(len(word) + 1:), *, iostat=status) number
         if (status /= 0) number = endless
         exit
      end do
      close (unit)
   end function number_after

end module machine
