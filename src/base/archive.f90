!> What is kept of a run so that it can go on, said once for both ways: the same procedure of a type writes it and reads it.
!!
!! A type that has hidden state binds a procedure `archive`, which calls `keep` for each component. A component that need not be
!! kept says why in its comment, 'not kept: ...'; utils/lint looks for both, so that a new one cannot be forgotten.
module archive
   use kinds, only: dp, i8, sp
   implicit none
   private

   public :: archive_t

   !> Something that takes values, or gives them back.
   type, abstract :: archive_t
      logical :: reading = .false.   !! `keep` sets what it is given; else it leaves it as it is
   contains
      procedure(begin_part), deferred :: part
      procedure(one_real), deferred :: keep_real
      procedure(one_long), deferred :: keep_long
      procedure(many_reals), deferred :: keep_reals
      procedure(parts_of_reals), deferred :: keep_parts
      procedure(parts_of_singles), deferred :: keep_single_parts
      procedure :: keep_integer
      procedure :: keep_logical
      generic :: keep => keep_real, keep_long, keep_reals, keep_integer, keep_logical
   end type archive_t

   abstract interface
      !> Begins a part with names of its own.
      subroutine begin_part(self, name)
         import :: archive_t
         class(archive_t), intent(inout) :: self
         character(*), intent(in) :: name
      end subroutine begin_part

      subroutine one_real(self, name, value)
         import :: archive_t, dp
         class(archive_t), intent(inout) :: self
         character(*), intent(in) :: name
         real(dp), intent(inout) :: value
      end subroutine one_real

      subroutine one_long(self, name, value)
         import :: archive_t, i8
         class(archive_t), intent(inout) :: self
         character(*), intent(in) :: name
         integer(i8), intent(inout) :: value
      end subroutine one_long

      !> As many as were written; the number is looked at.
      subroutine many_reals(self, name, values)
         import :: archive_t, dp
         class(archive_t), intent(inout) :: self
         character(*), intent(in) :: name
         real(dp), intent(inout), contiguous, target :: values(:)
      end subroutine many_reals

      !> Of an array that each process has a part of, one behind the other.
      subroutine parts_of_reals(self, name, first, total, values)
         import :: archive_t, dp
         class(archive_t), intent(inout) :: self
         character(*), intent(in) :: name
         integer, intent(in) :: first   !! of this part
         integer, intent(in) :: total   !! of all parts
         real(dp), intent(inout), contiguous, target :: values(:)
      end subroutine parts_of_reals

      subroutine parts_of_singles(self, name, first, total, values)
         import :: archive_t, sp
         class(archive_t), intent(inout) :: self
         character(*), intent(in) :: name
         integer, intent(in) :: first, total
         real(sp), intent(inout), contiguous, target :: values(:)
      end subroutine parts_of_singles
   end interface

contains

   subroutine keep_integer(self, name, value)
      class(archive_t), intent(inout) :: self
      character(*), intent(in) :: name
      integer, intent(inout) :: value
      integer(i8) :: long

      long = value
      call self%keep_long(name, long)
      if (self%reading) value = int(long)
   end subroutine keep_integer

   subroutine keep_logical(self, name, value)
      class(archive_t), intent(inout) :: self
      character(*), intent(in) :: name
      logical, intent(inout) :: value
      integer(i8) :: long

      long = merge(1_i8, 0_i8, value)
      call self%keep_long(name, long)
      if (self%reading) value = long /= 0
   end subroutine keep_logical

end module archive
