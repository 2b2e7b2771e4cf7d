!> Scenes as text for tests of the input: the least one, changed line by line, and what is said about it.
module scene_texts
   use errors, only: exit_input, failure
   use key_writer, only: complete_input
   use scene_input, only: read_settings_text
   use settings, only: settings_t
   use solution_register, only: solutions_t
   implicit none
   private

   public :: scene_with, exchanged, settings_of, refusal, refusal_of, override_refusal, warned, first_warning, echo_of

   character, parameter, public :: newline = achar(10)
   character(1), parameter, public :: no_overrides(0) = [character(1) ::]

   !> The least scene; tests put other lines in the place of one of these.
   character(*), parameter, public :: least(17) = [character(24) :: &
      '&scene', 'resolution = 20', '/', &                             !  1 -  3
      '&domain', 'upper = 4.0, 3.0', '/', &                           !  4 -  6
      '&fluid', 'mach = 0.1', 'reference_speed = 1.0', '/', &         !  7 - 10
      '&body', 'lower = 0.0, 0.0', 'upper = 2.0, 1.0', '/', &         ! 11 - 14
      '&time', 'end_time = 1.0', '/']                                 ! 15 - 17

contains

   !> The least scene with one line changed.
   function scene_with(number, line) result(content)
      integer, intent(in) :: number
      character(*), intent(in) :: line
      character(:), allocatable :: content

      integer :: i

      content = ''
      do i = 1, size(least)
         if (i == number) then
            content = content//line//newline
         else
            content = content//trim(least(i))//newline
         end if
      end do
   end function scene_with

   !> What is said about a text, '' if nothing is wrong.
   function refusal_of(content) result(message)
      character(*), intent(in) :: content
      character(:), allocatable :: message

      type(settings_t) :: scene
      type(failure) :: problem
      character(:), allocatable :: warnings(:)

      message = ''
      call read_settings_text(content, 'f', no_overrides, solutions_t(), scene, warnings, problem)
      if (.not. problem%raised()) return
      message = problem%message
      if (problem%code /= exit_input) message = 'wrong exit code'
   end function refusal_of

   !> What is said about the least scene with one line changed.
   function refusal(number, line) result(message)
      integer, intent(in) :: number
      character(*), intent(in) :: line
      character(:), allocatable :: message

      message = refusal_of(scene_with(number, line))
   end function refusal

   !> The warnings about the least scene with one line changed, after 'refused' if it is.
   function warned(number, line) result(lines)
      integer, intent(in) :: number
      character(*), intent(in) :: line
      character(:), allocatable :: lines

      type(settings_t) :: scene
      type(failure) :: problem
      character(:), allocatable :: warnings(:)
      integer :: i

      call read_settings_text(scene_with(number, line), 'f', no_overrides, solutions_t(), scene, warnings, problem)
      lines = ''
      if (problem%raised()) lines = 'refused '
      do i = 1, size(warnings)
         lines = lines//trim(warnings(i))
      end do
   end function warned

   !> What is said about the least scene with one override.
   function override_refusal(phrase) result(message)
      character(*), intent(in) :: phrase
      character(:), allocatable :: message

      type(settings_t) :: scene
      type(failure) :: problem
      character(:), allocatable :: warnings(:)

      message = ''
      call read_settings_text(scene_with(0, ''), 'f', [phrase], solutions_t(), scene, warnings, problem)
      if (problem%raised()) message = problem%message
   end function override_refusal

   !> The complete input of given settings, as text.
   function echo_of(scene) result(content)
      type(settings_t), intent(in) :: scene
      character(:), allocatable :: content

      content = complete_input(solutions_t(), scene)
   end function echo_of

   !> Settings of a text that is right.
   function settings_of(content) result(scene)
      character(*), intent(in) :: content
      type(settings_t) :: scene

      type(failure) :: problem
      character(:), allocatable :: warnings(:)

      call read_settings_text(content, 'f', no_overrides, solutions_t(), scene, warnings, problem)
      if (problem%raised()) error stop 'a scene that should be right is refused; refusal_of(content) says why'
   end function settings_of

   !> A text with a part exchanged wherever it stands.
   function exchanged(content, old, new) result(changed)
      character(*), intent(in) :: content, old, new
      character(:), allocatable :: changed

      integer :: at, next

      changed = ''
      next = 1
      do
         at = index(content(next:), old)
         if (at == 0) exit
         changed = changed//content(next:next + at - 2)//new
         next = next + at - 1 + len(old)
      end do
      changed = changed//content(next:)
   end function exchanged

   !> The first warning about a text, '' if there is none.
   function first_warning(content) result(line)
      character(*), intent(in) :: content
      character(:), allocatable :: line

      type(settings_t) :: scene
      type(failure) :: problem
      character(:), allocatable :: warnings(:)

      call read_settings_text(content, 'f', no_overrides, solutions_t(), scene, warnings, problem)
      line = ''
      if (size(warnings) > 0) line = trim(warnings(1))
   end function first_warning

end module scene_texts
