!> Numbers kept under names, found in a time that does not grow with how many there are.
module name_table
   use kinds, only: i8
   implicit none
   private

   public :: name_table_t

   type :: slot_t
      character(:), allocatable :: name
      integer :: number = 0
   end type slot_t

   !> A hash table with open addresses.
   type :: name_table_t
      private
      type(slot_t), allocatable :: slots(:)
      integer :: used = 0
   contains
      procedure :: find
      procedure :: put
      procedure, private :: slot_of
      procedure, private :: grow
   end type name_table_t

contains

   !> The number kept under a name, 0 if there is none.
   pure integer function find(self, name)
      class(name_table_t), intent(in) :: self
      character(*), intent(in) :: name

      find = 0
      if (self%used > 0) find = self%slots(self%slot_of(name))%number
   end function find

   !> Keeps a number, which is not 0, under a name, in the place of one that is there.
   pure subroutine put(self, name, number)
      class(name_table_t), intent(inout) :: self
      character(*), intent(in) :: name
      integer, intent(in) :: number
      integer :: at

      call self%grow()
      at = self%slot_of(name)
      if (.not. allocated(self%slots(at)%name)) self%used = self%used + 1
      self%slots(at)%name = name
      self%slots(at)%number = number
   end subroutine put

   ! Where a name is, or belongs; there is a free slot.
   pure integer function slot_of(self, name) result(at)
      class(name_table_t), intent(in) :: self
      character(*), intent(in) :: name
      integer(i8), parameter :: factor = 16777619_i8, mask = 2_i8**31 - 1
      integer(i8) :: hash
      integer :: i

      hash = 0
      do i = 1, len(name)
         hash = iand((ieor(hash, int(iachar(name(i:i)), i8)) + 1)*factor, mask)
      end do
      at = int(modulo(hash, size(self%slots, kind=i8))) + 1
      do
         if (.not. allocated(self%slots(at)%name)) return
         if (len(self%slots(at)%name) == len(name)) then
            if (self%slots(at)%name == name) return
         end if
         at = modulo(at, size(self%slots)) + 1
      end do
   end function slot_of

   ! Keeps half of the slots free.
   pure subroutine grow(self)
      class(name_table_t), intent(inout) :: self
      type(slot_t), allocatable :: before(:)
      integer :: at, i

      if (.not. allocated(self%slots)) allocate (self%slots(5))
      if (2*self%used < size(self%slots)) return
      call move_alloc(self%slots, before)
      allocate (self%slots(4*size(before) + 1))
      do i = 1, size(before)
         if (.not. allocated(before(i)%name)) cycle
         at = self%slot_of(before(i)%name)
         call move_alloc(before(i)%name, self%slots(at)%name)
         self%slots(at)%number = before(i)%number
      end do
   end subroutine grow

end module name_table
