!> What reading a scene asks of the exact solutions, which are known on a floor above (module solution_register).
module known_solutions
   use document, only: document_t
   use findings, only: findings_t
   use kinds, only: dp
   use settings, only: body_settings, choice_length, settings_t
   implicit none
   private

   public :: known_solutions_t

   type, abstract :: known_solutions_t
   contains
      procedure(list_of), deferred :: list
      procedure(largest_speed), deferred :: start_speed
      procedure(check_of), deferred :: check
   end type known_solutions_t

   abstract interface
      !> What &exact solution accepts, 'none' first, and which other keys belong to that.
      subroutine list_of(self, names, has_amplitude, has_waves)
         import :: known_solutions_t, choice_length
         class(known_solutions_t), intent(in) :: self
         character(choice_length), allocatable, intent(out) :: names(:)
         logical, allocatable, intent(out) :: has_amplitude(:), has_waves(:)   !! (names)
      end subroutine list_of

      !> Largest speed of a body that starts with the scene's solution [m/s].
      real(dp) function largest_speed(self, scene, body) result(speed)
         import :: known_solutions_t, settings_t, body_settings, dp
         class(known_solutions_t), intent(in) :: self
         type(settings_t), intent(in) :: scene
         type(body_settings), intent(in) :: body   !! its box is known
      end function largest_speed

      !> Notes what the scene lacks for its solution.
      subroutine check_of(self, document, scene, notes)
         import :: known_solutions_t, document_t, settings_t, findings_t
         class(known_solutions_t), intent(in) :: self
         type(document_t), intent(in) :: document
         type(settings_t), intent(in) :: scene
         type(findings_t), intent(inout) :: notes
      end subroutine check_of
   end interface

end module known_solutions
