!> A checksum over a whole file, in a block at its start: one bit that has changed anywhere, or a cut, is seen before the file is
!! read.
!!
!! The block is 512 letters: what HDF5 calls a user block, so that its tools open sealed files as they are. The checksum is the
!! CRC-32 of zlib, of all bytes that follow it.
module sealed_file
   use, intrinsic :: iso_fortran_env, only: int8
   use kinds, only: i8
   use system_words, only: forget_reason, last_reason
   implicit none
   private

   public :: seal_file, broken_seal

   integer, parameter, public :: seal_bytes = 512   !! that a file leaves free at its start

   character(*), parameter :: sign = 'dynsph sealed file, crc32 '
   integer, parameter :: digits = 8
   integer, parameter :: chunk = 1048576   !! bytes read at once

contains

   !> Writes the block of a complete file. `status` is 0 if that went well, and `message` says why not otherwise.
   subroutine seal_file(path, words, status, message)
      character(*), intent(in) :: path
      character(*), intent(in) :: words      !! about the file, for who looks at its start; what does not fit is left out
      integer, intent(out) :: status
      character(*), intent(inout) :: message
      character(seal_bytes) :: block
      character(digits) :: found
      integer :: unit

      block = sign//repeat('0', digits)//new_line('a')//words
      block(seal_bytes:) = new_line('a')
      open (newunit=unit, file=path, access='stream', form='unformatted', status='old', action='readwrite', iostat=status, &
         iomsg=message)
      if (status /= 0) return
      write (unit, pos=1, iostat=status, iomsg=message) block
      if (status == 0) then
         found = checksum(unit)   ! not within the statement: it reads the same unit
         write (unit, pos=1, iostat=status, iomsg=message) sign//found
      end if
      if (status == 0) then
         call forget_reason()
         flush (unit)
         message = last_reason('')
         status = len_trim(message)
      end if
      close (unit)
   end subroutine seal_file

   !> Why a file is not what was sealed; '' if it is.
   function broken_seal(path) result(reason)
      character(*), intent(in) :: path
      character(:), allocatable :: reason
      character(len(sign) + digits) :: start
      integer :: unit, status

      reason = 'it cannot be read'
      open (newunit=unit, file=path, access='stream', form='unformatted', status='old', action='read', iostat=status)
      if (status /= 0) return
      reason = 'it is not one of dynsph'
      read (unit, pos=1, iostat=status) start
      if (status == 0 .and. start(:len(sign)) == sign) then
         reason = 'it is damaged: its checksum is another'
         if (checksum(unit) == start(len(sign) + 1:)) reason = ''
      end if
      close (unit)
   end function broken_seal

   ! Of all bytes behind the checksum itself, as digits.
   function checksum(unit) result(text)
      integer, intent(in) :: unit
      character(digits) :: text
      integer(int8), allocatable :: bytes(:)
      integer(i8) :: crc, length, first, last
      integer(i8) :: table(0:255)
      integer :: status

      table = crc_table()
      allocate (bytes(chunk))
      inquire (unit=unit, size=length)
      crc = int(z'FFFFFFFF', i8)
      first = len(sign) + digits + 1
      do while (first <= length)
         last = min(length, first + chunk - 1)
         read (unit, pos=first, iostat=status) bytes(:last - first + 1)
         if (status /= 0) exit   ! a cut: the checksum is another
         call add_bytes(table, bytes(:last - first + 1), crc)
         first = last + 1
      end do
      write (text, '(z8.8)') ieor(crc, int(z'FFFFFFFF', i8))
   end function checksum

   pure subroutine add_bytes(table, bytes, crc)
      integer(i8), intent(in) :: table(0:255)
      integer(int8), intent(in) :: bytes(:)
      integer(i8), intent(inout) :: crc
      integer :: i

      do i = 1, size(bytes)
         crc = ieor(ishft(crc, -8), table(iand(ieor(crc, int(bytes(i), i8)), 255_i8)))
      end do
   end subroutine add_bytes

   ! Remainders of all bytes by the polynomial of CRC-32, lowest bit first.
   pure function crc_table() result(table)
      integer(i8) :: table(0:255)
      integer(i8), parameter :: polynomial = int(z'EDB88320', i8)
      integer :: k, bit

      do k = 0, 255
         table(k) = k
         do bit = 1, 8
            if (btest(table(k), 0)) then
               table(k) = ieor(ishft(table(k), -1), polynomial)
            else
               table(k) = ishft(table(k), -1)
            end if
         end do
      end do
   end function crc_table

end module sealed_file
