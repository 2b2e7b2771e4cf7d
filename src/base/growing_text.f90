!> A text that grows piece by piece, in time that is linear in its length.
module growing_text
   implicit none
   private

   public :: growing_text_t

   !> The text so far.
   type :: growing_text_t
      private
      character(:), allocatable :: buffer
      integer :: length = 0
   contains
      procedure :: add
      procedure :: add_line
      procedure :: text => whole_text
   end type growing_text_t

contains

   !> Appends letters.
   pure subroutine add(self, letters)
      class(growing_text_t), intent(inout) :: self
      character(*), intent(in) :: letters
      character(:), allocatable :: longer

      if (.not. allocated(self%buffer)) allocate (character(1024) :: self%buffer)
      if (self%length + len(letters) > len(self%buffer)) then
         allocate (character(2*(self%length + len(letters))) :: longer)
         longer(:self%length) = self%buffer(:self%length)
         call move_alloc(longer, self%buffer)
      end if
      self%buffer(self%length + 1:self%length + len(letters)) = letters
      self%length = self%length + len(letters)
   end subroutine add

   !> Appends a line and its end.
   pure subroutine add_line(self, line)
      class(growing_text_t), intent(inout) :: self
      character(*), intent(in) :: line

      call self%add(line)
      call self%add(new_line('a'))
   end subroutine add_line

   !> All of it.
   pure function whole_text(self) result(text)
      class(growing_text_t), intent(in) :: self
      character(:), allocatable :: text

      text = ''
      if (self%length > 0) text = self%buffer(:self%length)
   end function whole_text

end module growing_text
