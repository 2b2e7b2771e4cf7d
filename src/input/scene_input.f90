!> Reads a scene, and writes the complete input, the shortest one, a template or the list of keys.
module scene_input
   use derived_settings, only: resolve_settings
   use errors, only: exit_files, exit_input, failure
   use file_system, only: is_link, path_exists
   use key_reader, only: key_reader_t
   use key_writer, only: as_defaults, as_echo, as_shortest, as_tables, as_template, key_writer_t
   use known_solutions, only: known_solutions_t
   use namelist_text, only: scan_namelist
   use override_keys, only: apply_override
   use scene_keys, only: visit_keys
   use resting_fluid, only: resting_force, resting_force_t
   use settings, only: fluid_settings, settings_t
   use settings_check, only: check_settings
   use text, only: to_text
   implicit none
   private

   public :: load_scene, read_settings, read_settings_text
   public :: write_echo, echo_text, write_shortest, write_template, write_markdown

contains

   !> Reads a scene from a namelist file.
   !! Raises exit_files if the file cannot be read, exit_input with all mistakes in it.
   subroutine read_settings(path, overrides, solutions, setup, warnings, problem)
      character(*), intent(in) :: path
      character(*), intent(in) :: overrides(:)        !! 'group.key=value', later ones win
      class(known_solutions_t), intent(in) :: solutions
      type(settings_t), intent(out) :: setup
      character(:), allocatable, intent(out) :: warnings(:)
      type(failure), intent(inout) :: problem

      character(:), allocatable :: content

      call load_scene(path, content, problem)
      if (problem%raised()) then
         allocate (character(1) :: warnings(0))
         allocate (setup%bodies(0), setup%probes(0), setup%gauges(0))
         return
      end if
      call read_settings_text(content, path, overrides, solutions, setup, warnings, problem)
   end subroutine read_settings

   !> The text of a scene's file. Raises exit_files.
   subroutine load_scene(path, content, problem)
      character(*), intent(in) :: path
      character(:), allocatable, intent(out) :: content
      type(failure), intent(inout) :: problem

      character(:), allocatable :: message

      call load_file(path, content, message)
      if (message /= '') call problem%raise(exit_files, path//': '//message)
   end subroutine load_scene

   !> Reads a scene from namelist text.
   !! Raises exit_input with all mistakes in it.
   subroutine read_settings_text(content, file, overrides, solutions, setup, warnings, problem)
      character(*), intent(in) :: content
      character(*), intent(in) :: file                !! name for messages
      character(*), intent(in) :: overrides(:)
      class(known_solutions_t), intent(in) :: solutions
      type(settings_t), intent(out) :: setup
      character(:), allocatable, intent(out) :: warnings(:)
      type(failure), intent(inout) :: problem

      type(key_reader_t) :: reader
      character(:), allocatable :: message
      integer :: i

      message = what_is_no_text(content)
      if (message /= '') then
         call problem%raise(exit_input, file//': '//message)
         allocate (character(1) :: warnings(0))
         allocate (setup%bodies(0), setup%probes(0), setup%gauges(0))
         return
      end if
      call scan_namelist(content, file, reader%document, reader%notes)
      do i = 1, size(overrides)
         call apply_override(overrides(i), reader%document, reader%notes)
      end do
      allocate (setup%bodies(reader%document%count_of('body')))
      allocate (setup%probes(reader%document%count_of('probe')))
      allocate (setup%gauges(reader%document%count_of('gauge')))
      call visit_keys(reader, solutions, setup)
      call reader%finish()
      call resolve_settings(reader%document, solutions, setup, reader%notes)
      call check_settings(reader%document, solutions, setup, reader%notes)
      call reader%notes%warning_list(warnings)
      if (reader%notes%any_mistake()) call problem%raise(exit_input, reader%notes%mistake_text())
   end subroutine read_settings_text

   !> Writes the complete input of a run; reading it gives the same settings bit by bit.
   subroutine write_echo(unit, solutions, setup)
      integer, intent(in) :: unit
      class(known_solutions_t), intent(in) :: solutions
      type(settings_t), intent(in) :: setup

      type(key_writer_t) :: writer
      type(settings_t) :: copy

      copy = setup
      writer%unit = unit
      writer%style = as_echo
      write (unit, '(a)') '! The complete input of this run: all keys that have an effect, with the defaults it used.'
      call tell_derived(unit, setup%fluid)
      call leave_derived_out(copy%fluid)
      call visit_keys(writer, solutions, copy)
   end subroutine write_echo

   !> Says what is worked out from other keys.
   subroutine tell_derived(unit, fluid)
      integer, intent(in) :: unit
      type(fluid_settings), intent(in) :: fluid

      if (fluid%find_reference_speed) then
         write (unit, '(a)') '! sound_speed follows from mach once a coarse run has found reference_speed.'
      else if (fluid%mach > 0) then
         write (unit, '(a)') '! sound_speed = '//to_text(fluid%sound_speed)//' follows from mach and reference_speed.'
      end if
      if (fluid%reynolds > 0) write (unit, '(a)') '! viscosity = '//to_text(fluid%viscosity)//' follows from reynolds.'
   end subroutine tell_derived

   !> Takes back what is worked out from other keys: both at once would contradict each other when they are read.
   pure subroutine leave_derived_out(fluid)
      type(fluid_settings), intent(inout) :: fluid

      if (fluid%find_reference_speed .or. fluid%mach > 0) fluid%sound_speed = 0
      if (fluid%reynolds > 0) fluid%viscosity = 0
   end subroutine leave_derived_out

   !> Writes the scene in as few lines as it takes; reading it gives the same complete input.
   subroutine write_shortest(unit, solutions, setup)
      integer, intent(in) :: unit
      class(known_solutions_t), intent(in) :: solutions
      type(settings_t), intent(in) :: setup

      type(key_writer_t) :: writer
      type(settings_t) :: copy, defaults
      type(resting_force_t) :: force

      allocate (defaults%bodies(size(setup%bodies)), defaults%probes(size(setup%probes)), defaults%gauges(size(setup%gauges)))
      copy = setup
      call leave_derived_out(copy%fluid)
      force = resting_force(setup)
      if (.not. force%size > 0) then
         ! Hydrostatic pressure, the default, is none then.
         where (copy%bodies%pressure == 'zero') copy%bodies%pressure = defaults%bodies%pressure
      end if
      writer%unit = unit
      writer%style = as_defaults
      call visit_keys(writer, solutions, defaults)
      writer%style = as_shortest
      call visit_keys(writer, solutions, copy)
   end subroutine write_shortest

   !> The same as one text, lines ended by new_line.
   function echo_text(solutions, setup) result(content)
      class(known_solutions_t), intent(in) :: solutions
      type(settings_t), intent(in) :: setup
      character(:), allocatable :: content

      character(512) :: line
      integer :: unit, status

      content = ''
      open (newunit=unit, status='scratch', action='readwrite')
      call write_echo(unit, solutions, setup)
      rewind (unit)
      do
         read (unit, '(a)', iostat=status) line
         if (status /= 0) exit
         content = content//trim(line)//new_line('a')
      end do
      close (unit)
   end function echo_text

   !> Writes a namelist of all keys with default, unit, range and meaning.
   subroutine write_template(unit, solutions)
      integer, intent(in) :: unit
      class(known_solutions_t), intent(in) :: solutions

      type(key_writer_t) :: writer

      writer%unit = unit
      writer%style = as_template
      write (unit, '(a)') '! All keys of a scene with their defaults. Fill in what is required; the rest may be left out.', &
         '! Keys behind a ! have an effect only with another choice, which is named.', &
         '! Units are SI or any other consistent set, such as d = g = density = 1.'
      call visit_defaults(writer, solutions)
   end subroutine write_template

   !> Writes the list of all keys as Markdown, docs/input.md.
   subroutine write_markdown(unit, solutions)
      integer, intent(in) :: unit
      class(known_solutions_t), intent(in) :: solutions

      type(key_writer_t) :: writer

      writer%unit = unit
      writer%style = as_tables
      write (unit, '(a)') '# Input keys', '', &
         'This page is written by the program itself: `dynsph --keys > docs/input.md`.', '', &
         'A scene is a namelist file; `dynsph --template` prints one to fill in, `dynsph --shortest FILE.nml` what of a scene', &
         'differs from the defaults. Units are SI or any other consistent set, such as d = g = density = 1, in which times are', &
         't sqrt(g/d). `--set group.key=value` on the command line goes before the file; `body(2).key` means the second &body.'
      call visit_defaults(writer, solutions)
   end subroutine write_markdown

   !> Shows all keys with their defaults, one body, one probe and one gauge.
   subroutine visit_defaults(writer, solutions)
      type(key_writer_t), intent(inout) :: writer
      class(known_solutions_t), intent(in) :: solutions

      type(settings_t) :: defaults

      allocate (defaults%bodies(1), defaults%probes(1), defaults%gauges(1))
      call visit_keys(writer, solutions, defaults)
   end subroutine visit_defaults

   !> Reads a whole file.
   subroutine load_file(path, content, message)
      character(*), intent(in) :: path
      character(:), allocatable, intent(out) :: content
      character(:), allocatable, intent(out) :: message   !! '' when read, else why not and what to do

      character(:), allocatable :: longer
      character :: letter
      integer :: length, status, unit

      message = ''
      content = ''
      if (.not. path_exists(path)) then
         message = 'there is no such file; give the path of a scene, for example input/dam_break.nml'
         if (is_link(path)) message = 'this link leads to a file that does not exist; give the path of a scene'
         return
      end if
      open (newunit=unit, file=path, access='stream', form='unformatted', status='old', action='read', iostat=status)
      if (status == 0) then
         ! Letter by letter: a pipe does not know how long its text will be.
         allocate (character(4096) :: longer)
         length = 0
         do
            read (unit, iostat=status) letter
            if (status /= 0) exit
            if (length == len(longer)) longer = longer//repeat(' ', length)
            length = length + 1
            longer(length:length) = letter
         end do
         if (is_iostat_end(status)) status = 0
         content = longer(:length)
         close (unit)
      end if
      if (status /= 0) message = 'the file cannot be read; is it a text file that you may read?'
   end subroutine load_file

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
