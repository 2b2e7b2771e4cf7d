!> Values given to an assert, as lists and as text.
module funit_values
   use, intrinsic :: iso_fortran_env, only: int32, int64, real64
   implicit none
   private

   public :: flat, list_of, subscripts, text

   !> The elements of a scalar (repeated `n` times) or of an array of rank 1 or 2 (`n` unused) as a list.
   interface flat
      procedure flat_real64, flat_int32, flat_int64, flat_logical, flat_character
   end interface flat

contains

   pure function flat_real64(x, n) result(list)
      real(real64), intent(in) :: x(..)
      integer, intent(in) :: n
      real(real64), allocatable :: list(:)
      integer :: i

      select rank (x)
      rank (0)
         list = [(x, i=1, n)]
      rank (1)
         list = x
      rank (2)
         list = reshape(x, [size(x)])
      end select
   end function flat_real64

   pure function flat_int32(x, n) result(list)
      integer(int32), intent(in) :: x(..)
      integer, intent(in) :: n
      integer(int64), allocatable :: list(:)
      integer :: i

      select rank (x)
      rank (0)
         list = [(int(x, int64), i=1, n)]
      rank (1)
         list = int(x, int64)
      rank (2)
         list = int(reshape(x, [size(x)]), int64)
      end select
   end function flat_int32

   pure function flat_int64(x, n) result(list)
      integer(int64), intent(in) :: x(..)
      integer, intent(in) :: n
      integer(int64), allocatable :: list(:)
      integer :: i

      select rank (x)
      rank (0)
         list = [(x, i=1, n)]
      rank (1)
         list = x
      rank (2)
         list = reshape(x, [size(x)])
      end select
   end function flat_int64

   pure function flat_logical(x, n) result(list)
      logical, intent(in) :: x(..)
      integer, intent(in) :: n
      logical, allocatable :: list(:)
      integer :: i

      select rank (x)
      rank (0)
         list = [(x, i=1, n)]
      rank (1)
         list = x
      rank (2)
         list = reshape(x, [size(x)])
      end select
   end function flat_logical

   pure function flat_character(x, n) result(list)
      character(*), intent(in) :: x(..)
      integer, intent(in) :: n
      character(len(x)), allocatable :: list(:)
      integer :: i

      select rank (x)
      rank (0)
         list = [(x, i=1, n)]
      rank (1)
         list = x
      rank (2)
         list = reshape(x, [size(x)])
      end select
   end function flat_character

   !> A value as text: reals with all the digits that tell two of them apart, strings between quotation marks.
   pure function text(x) result(words)
      class(*), intent(in) :: x
      character(:), allocatable :: words
      character(40) :: number

      number = '(a type that is not supported)'
      select type (x)
      type is (real(real64))
         write (number, '(es24.16e3)') x
      type is (integer(int32))
         write (number, '(i0)') x
      type is (integer(int64))
         write (number, '(i0)') x
      type is (logical)
         number = merge('true ', 'false', x)
      type is (character(*))
         words = '"' // x // '"'
         return
      end select
      words = trim(adjustl(number))
   end function text

   !> Integers as text: [2,3].
   pure function list_of(numbers) result(words)
      integer, intent(in) :: numbers(:)
      character(:), allocatable :: words
      integer :: i

      words = '['
      do i = 1, size(numbers)
         if (i > 1) words = words // ','
         words = words // text(numbers(i))
      end do
      words = words // ']'
   end function list_of

   !> Where element `i` in storage order stands in an array of shape `extents`, counting from 1.
   pure function subscripts(i, extents)
      integer, intent(in) :: i, extents(:)
      integer :: subscripts(size(extents))
      integer :: k, before

      before = i - 1
      do k = 1, size(extents)
         subscripts(k) = 1 + mod(before, extents(k))
         before = before / extents(k)
      end do
   end function subscripts

end module funit_values
