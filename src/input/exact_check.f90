!> Checks that a scene is the one its exact solution holds for.
module exact_check
   use findings, only: findings_t
   use kinds, only: dp
   use namelist_document, only: document_t
   use settings, only: settings_t
   implicit none
   private

   public :: check_exact

contains

   !> Runs all checks of &exact.
   subroutine check_exact(document, setup, notes)
      type(document_t), intent(in) :: document
      type(settings_t), intent(in) :: setup
      type(findings_t), intent(inout) :: notes

   end subroutine check_exact

end module exact_check
