!> Reads a scene: its text, its keys, what follows from them, and whether they go together.
module scene_input
   use derived_settings, only: resolve_model, resolve_settings
   use draft, only: draft_t
   use errors, only: exit_files, exit_input, failure
   use file_system, only: is_link, path_exists, read_whole_file
   use key_reader, only: check_keys, read_values
   use known_solutions, only: known_solutions_t
   use overrides, only: apply_override
   use scanner, only: scan_namelist
   use settings, only: settings_t
   use settings_check, only: check_settings
   use solid_files, only: complete_lists
   implicit none
   private

   public :: load_scene, read_settings, read_settings_text

contains

   !> Reads a scene from a namelist file.
   !! Raises exit_files if the file cannot be read, exit_input with all mistakes in it.
   subroutine read_settings(path, overrides, solutions, scene, warnings, problem)
      character(*), intent(in) :: path
      character(*), intent(in) :: overrides(:)        !! 'group.key=value', later ones win
      class(known_solutions_t), intent(in) :: solutions
      type(settings_t), intent(out) :: scene
      character(:), allocatable, intent(out) :: warnings(:)
      type(failure), intent(inout) :: problem
      character(:), allocatable :: content

      call load_scene(path, content, problem)
      call read_settings_text(content, path, overrides, solutions, scene, warnings, problem)
   end subroutine read_settings

   !> The text of a scene's file. Raises exit_files with the reason and what to do.
   subroutine load_scene(path, content, problem)
      character(*), intent(in) :: path
      character(:), allocatable, intent(out) :: content
      type(failure), intent(inout) :: problem

      content = ''
      if (path_exists(path)) then
         call read_whole_file(path, content, problem)
      else if (is_link(path)) then
         call problem%raise(exit_files, path//': this link leads to a file that does not exist; give the path of a scene')
      else
         call problem%raise(exit_files, &
                            path//': there is no such file; give the path of a scene, for example input/dam_break.nml')
      end if
   end subroutine load_scene

   !> Reads a scene from namelist text.
   !! Raises exit_input with all mistakes in it. Without a text, where reading it has failed, there is no scene.
   subroutine read_settings_text(content, file, overrides, solutions, scene, warnings, problem)
      character(*), intent(in) :: content
      character(*), intent(in) :: file                !! name for messages
      character(*), intent(in) :: overrides(:)
      class(known_solutions_t), intent(in) :: solutions
      type(settings_t), intent(out) :: scene
      character(:), allocatable, intent(out) :: warnings(:)
      type(failure), intent(inout) :: problem
      type(draft_t) :: draft
      character(:), allocatable :: message
      integer :: i

      draft%notes%file = file
      allocate (draft%solutions, source=solutions)
      message = what_is_no_text(content)
      if (message /= '' .and. .not. problem%raised()) call problem%raise(exit_input, file//': '//message)
      if (problem%raised()) then
         allocate (scene%bodies(0), scene%solids(0), scene%sponges(0), scene%probes(0), scene%gauges(0))
      else
         call scan_namelist(content, draft%document, draft%notes)
         do i = 1, size(overrides)
            call apply_override(overrides(i), draft%document, draft%notes)
         end do
         call read_values(draft)
         call resolve_model(draft)
         call check_keys(draft)
         call complete_lists(draft)
         call resolve_settings(draft)
         call check_settings(draft)
         scene = draft%scene
      end if
      call draft%notes%warning_list(warnings)
      if (draft%notes%any_mistake()) call problem%raise(exit_input, draft%notes%mistake_text())
   end subroutine read_settings_text

   ! Why this is not a text with lines; '' if it is one.
   pure function what_is_no_text(content) result(message)
      character(*), intent(in) :: content
      character(:), allocatable :: message
      character(*), parameter :: utf_16(2) = [char(255)//char(254), char(254)//char(255)]

      message = ''
      if (any(content(:min(2, len(content))) == utf_16)) then
         message = 'this is text in UTF-16; save the file as UTF-8'
      else if (index(content, achar(0)) > 0) then
         message = 'this is not plain text; save the file as UTF-8'
      else if (index(content, achar(13)) > 0 .and. index(content, achar(10)) == 0) then
         message = 'lines end with a carriage return alone; save the file with line ends of Unix or Windows'
      end if
   end function what_is_no_text

end module scene_input
