!> A scene while it is read: its text taken apart, its values so far, and what was found about them.
module draft
   use document, only: document_t
   use findings, only: findings_t
   use known_solutions, only: known_solutions_t
   use settings, only: settings_t
   implicit none
   private

   public :: draft_t

   !> What the checks look at, and where they tell what they find.
   type :: draft_t
      type(document_t) :: document
      type(settings_t) :: scene
      type(findings_t) :: notes
      class(known_solutions_t), allocatable :: solutions
   contains
      procedure :: given
      procedure :: clean
      procedure :: mistake
      procedure :: warning
   end type draft_t

contains

   !> True when the input itself names a key.
   pure logical function given(self, group, key, number)
      class(draft_t), intent(in) :: self
      character(*), intent(in) :: group, key
      integer, intent(in), optional :: number   !! of the group

      given = self%document%given(group, one_unless(number), key)
   end function given

   !> True while nothing wrong was noted about groups: their values can be trusted.
   pure logical function clean(self, groups)
      class(draft_t), intent(in) :: self
      character(*), intent(in) :: groups   !! names, parted by blanks
      integer :: at, length

      clean = .true.
      at = 1
      do while (at <= len(groups))
         length = index(groups(at:)//' ', ' ') - 1
         clean = clean .and. self%notes%clean(groups(at:at + length - 1))
         at = at + length + 1
      end do
   end function clean

   !> Notes a mistake in a group, at a key.
   subroutine mistake(self, group, key, message, number)
      class(draft_t), intent(inout) :: self
      character(*), intent(in) :: group, key, message   !! key '': the group itself
      integer, intent(in), optional :: number           !! of the group

      call self%notes%mistake(self%document%place_of(group, one_unless(number), key), group, message)
   end subroutine mistake

   !> Notes something that is allowed but surely not meant, or has no effect.
   subroutine warning(self, group, key, message, number)
      class(draft_t), intent(inout) :: self
      character(*), intent(in) :: group, key, message
      integer, intent(in), optional :: number

      call self%notes%warning(self%document%place_of(group, one_unless(number), key), message)
   end subroutine warning

   pure integer function one_unless(number)
      integer, intent(in), optional :: number

      one_unless = 1
      if (present(number)) one_unless = number
   end function one_unless

end module draft
