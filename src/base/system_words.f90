!> Why the system refused something, in its own words: 'No space left on device'.
module system_words
   use, intrinsic :: iso_c_binding, only: c_char, c_f_pointer, c_int, c_ptr, c_size_t
   implicit none
   private

   public :: c_words, forget_reason, last_number, last_reason, reason_of

   interface
      type(c_ptr) function c_errno_address() bind(c, name='__errno_location')
         import :: c_ptr
      end function c_errno_address

      type(c_ptr) function c_strerror(number) bind(c, name='strerror')
         import :: c_int, c_ptr
         integer(c_int), value :: number
      end function c_strerror

      integer(c_size_t) function c_strlen(text) bind(c, name='strlen')
         import :: c_ptr, c_size_t
         type(c_ptr), value :: text
      end function c_strlen
   end interface

contains

   !> From here on `last_reason` tells of what comes.
   subroutine forget_reason()
      integer(c_int), pointer :: number

      call c_f_pointer(c_errno_address(), number)
      number = 0
   end subroutine forget_reason

   !> The system's words for the last of its calls that failed since `forget_reason`, also of a call that a library made.
   function last_reason(otherwise) result(reason)
      character(*), intent(in) :: otherwise   !! if none failed
      character(:), allocatable :: reason

      reason = otherwise
      if (last_number() /= 0) reason = c_words(c_strerror(last_number()))
   end function last_reason

   !> The system's number for it; 0 if none failed.
   integer(c_int) function last_number()
      integer(c_int), pointer :: number

      call c_f_pointer(c_errno_address(), number)
      last_number = number
   end function last_number

   !> The system's words for the call that returned this status; '' for success.
   function reason_of(status) result(reason)
      integer(c_int), intent(in) :: status
      character(:), allocatable :: reason

      reason = ''
      if (status /= 0) reason = c_words(c_strerror(last_number()))
   end function reason_of

   !> A text of the C library.
   function c_words(address) result(text)
      type(c_ptr), intent(in) :: address
      character(:), allocatable :: text
      character(kind=c_char), pointer :: bytes(:)
      integer :: i

      call c_f_pointer(address, bytes, [c_strlen(address)])
      allocate (character(size(bytes)) :: text)
      do i = 1, size(bytes)
         text(i:i) = bytes(i)
      end do
   end function c_words

end module system_words
