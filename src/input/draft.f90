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
      procedure :: mistake
      procedure :: warning
   end type draft_t

contains

   !> Notes a mistake in a group, at a key.
   subroutine mistake(self, group, number, key, message)
      class(draft_t), intent(inout) :: self
      character(*), intent(in) :: group, key, message   !! key '': the group itself
      integer, intent(in) :: number                     !! of the group

      call self%notes%mistake(self%document%place_of(group, number, key), group, message)
   end subroutine mistake

   !> Notes something that is allowed but surely not meant, or has no effect.
   subroutine warning(self, group, number, key, message)
      class(draft_t), intent(inout) :: self
      character(*), intent(in) :: group, key, message
      integer, intent(in) :: number

      call self%notes%warning(self%document%place_of(group, number, key), message)
   end subroutine warning

end module draft
