!> Writes the input keys: as a complete input, as the shortest one, as a template to fill in, or as tables.
module key_writer
   use growing_text, only: growing_text_t
   use key_table, only: key_t, keys_t
   use known_solutions, only: known_solutions_t
   use resting_fluid, only: resting_force, resting_force_t
   use scene_keys, only: count_groups, groups, known_group_t, list_keys
   use settings, only: settings_t
   use text, only: to_text
   implicit none
   private

   public :: complete_input, shortest_input, template, tables

   integer, parameter :: value_width = 28          ! columns kept for 'key = value'
   integer, parameter :: widest = 100              ! columns of the shortest input

contains

   !> The complete input of a run; reading it gives the same settings bit by bit.
   function complete_input(solutions, scene) result(content)
      class(known_solutions_t), intent(in) :: solutions
      type(settings_t), intent(in) :: scene
      character(:), allocatable :: content
      type(settings_t), target :: copy
      type(growing_text_t) :: lines
      type(keys_t) :: keys
      integer :: g, i, number

      call lines%add_line('! The complete input of this run: all keys that have an effect, with the defaults it used.')
      associate (fluid => scene%fluid)
         if (fluid%find_reference_speed) then
            call lines%add_line('! sound_speed follows from mach once a coarse run has found reference_speed.')
         else if (fluid%mach > 0) then
            call lines%add_line('! sound_speed = '//to_text(fluid%sound_speed)//' follows from mach and reference_speed.')
         end if
         if (fluid%reynolds > 0) call lines%add_line('! viscosity = '//to_text(fluid%viscosity)//' follows from reynolds.')
      end associate
      copy = as_given(scene)
      do g = 1, size(groups)
         ! A tank that stands is none: inputs of before there were such are the same as now.
         if (groups(g)%name == 'tank' .and. copy%tank%motion == 'none') cycle
         do number = 1, count_groups(copy, groups(g)%name)
            call list_keys(copy, solutions, groups(g)%name, number, keys)
            call lines%add_line('')
            call lines%add_line('&'//trim(groups(g)%name))
            do i = 1, keys%n
               associate (key => keys%items(i))
                  if (key%active) call lines%add_line('   '//trim(key%name)//' = '//key%value_text())
               end associate
            end do
            call lines%add_line('/')
         end do
      end do
      content = lines%text()
   end function complete_input

   !> The scene in as few lines as it takes; reading it gives the same complete input.
   function shortest_input(solutions, scene) result(content)
      class(known_solutions_t), intent(in) :: solutions
      type(settings_t), intent(in) :: scene
      character(:), allocatable :: content
      type(settings_t), target :: copy, defaults
      type(growing_text_t) :: lines
      type(keys_t) :: keys, default_keys
      type(resting_force_t) :: force
      integer :: g, number

      allocate (defaults%bodies(1), defaults%solids(1), defaults%sponges(1), defaults%probes(1), defaults%gauges(1))
      copy = as_given(scene)
      ! Hydrostatic pressure, the default, is none where nothing presses.
      force = resting_force(scene)
      do number = 1, size(copy%bodies)
         associate (pressure => copy%bodies(number)%pressure)
            if (pressure == 'zero' .and. .not. force%size > 0) pressure = defaults%bodies(1)%pressure
         end associate
      end do
      do g = 1, size(groups)
         call list_keys(defaults, solutions, groups(g)%name, 1, default_keys)
         do number = 1, count_groups(copy, groups(g)%name)
            call list_keys(copy, solutions, groups(g)%name, number, keys)
            call add_short_group(trim(groups(g)%name), keys, default_keys, lines)
         end do
      end do
      content = lines%text()
   end function shortest_input

   !> A namelist of all keys with default, unit, range and meaning.
   function template(solutions) result(content)
      class(known_solutions_t), intent(in) :: solutions
      character(:), allocatable :: content
      type(growing_text_t) :: lines

      call lines%add_line('! All keys of a scene with their defaults. Fill in what is required; the rest may be left out.')
      call lines%add_line('! Keys behind a ! have an effect only with another choice, which is named.')
      call lines%add_line('! Units are SI or any other consistent set, such as d = g = density = 1.')
      call describe_groups(solutions, .false., lines)
      content = lines%text()
   end function template

   !> The list of all keys as Markdown, docs/input.md.
   function tables(solutions) result(content)
      class(known_solutions_t), intent(in) :: solutions
      character(:), allocatable :: content
      type(growing_text_t) :: lines

      call lines%add_line('# Input keys')
      call lines%add_line('')
      call lines%add_line('This page is written by the program itself: `dynsph --keys > docs/input.md`.')
      call lines%add_line('')
      call lines%add_line('A scene is a namelist file; `dynsph --template` prints one to fill in, `dynsph --shortest FILE.nml` ' &
                          //'what of a scene')
      call lines%add_line('differs from the defaults. Units are SI or any other consistent set, such as d = g = density = 1, in ' &
                          //'which times are')
      call lines%add_line('t sqrt(g/d). `--set group.key=value` on the command line goes before the file; `body(2).key` means ' &
                          //'the second &body.')
      call describe_groups(solutions, .true., lines)
      content = lines%text()
   end function tables

   ! Without what is worked out from other keys: both at once would contradict each other when they are read.
   pure type(settings_t) function as_given(scene)
      type(settings_t), intent(in) :: scene

      as_given = scene
      associate (fluid => as_given%fluid)
         if (fluid%find_reference_speed .or. fluid%mach > 0) fluid%sound_speed = 0
         if (fluid%reynolds > 0) fluid%viscosity = 0
      end associate
   end function as_given

   ! A group, if any of its keys must be given or is not the default.
   subroutine add_short_group(name, keys, default_keys, lines)
      character(*), intent(in) :: name
      type(keys_t), intent(in) :: keys, default_keys
      type(growing_text_t), intent(inout) :: lines
      character(:), allocatable :: line, phrase
      integer :: i

      phrase = ''
      line = '&'//name
      do i = 1, keys%n
         associate (key => keys%items(i))
            if (.not. key%active) cycle
            phrase = key%value_text()
            if (.not. (key%required .or. key%follows) .and. phrase == default_keys%items(i)%value_text()) cycle
            phrase = trim(key%name)//' = '//phrase
         end associate
         if (index(line, ' = ') > 0) line = line//','
         if (len(line//phrase) + 3 > widest) then
            call lines%add_line(line)
            line = '  '
         end if
         line = line//' '//phrase
      end do
      if (index(line, ' = ') > 0) call lines%add_line(line//' /')
   end subroutine add_short_group

   ! What it means, and `key = default   ! [unit] range`; a key that must be given is left empty: what is not filled in is refused.
   ! One that follows from others is not set.
   function template_lines(key) result(line)
      type(key_t), intent(in) :: key
      character(:), allocatable :: line

      line = trim(key%name)//' ='
      if (.not. (key%required .or. key%follows)) line = line//' '//key%value_text()
      if (key%follows .or. .not. key%active) line = '! '//line
      line = '   ! '//trim(key%meaning)//new_line('a')//'   '//line//repeat(' ', max(0, value_width - len(line)))//'   ! '
      if (key%unit /= '') line = line//'['//trim(key%unit)//'] '
      if (key%required) line = line//'required; '
      line = line//key%range_text()
      if (key%condition /= '') line = line//'; only with '//trim(key%condition)
   end function template_lines

   ! All groups with the defaults of their keys.
   subroutine describe_groups(solutions, as_tables, lines)
      class(known_solutions_t), intent(in) :: solutions
      logical, intent(in) :: as_tables
      type(growing_text_t), intent(inout) :: lines
      type(settings_t), target :: defaults
      type(keys_t) :: keys
      integer :: g, i

      allocate (defaults%bodies(1), defaults%solids(1), defaults%sponges(1), defaults%probes(1), defaults%gauges(1))
      do g = 1, size(groups)
         call list_keys(defaults, solutions, groups(g)%name, 1, keys)
         call lines%add_line('')
         if (as_tables) then
            call lines%add_line('## &'//trim(groups(g)%name))
            call lines%add_line('')
            call lines%add_line(described(groups(g)))
            call lines%add_line('')
            call lines%add_line('|key|default|unit|range or choices|meaning|')
            call lines%add_line('|---|---|---|---|---|')
         else
            call lines%add_line('! '//described(groups(g)))
            call lines%add_line('&'//trim(groups(g)%name))
         end if
         do i = 1, keys%n
            if (as_tables) call lines%add_line(table_row(keys%items(i)))
            if (.not. as_tables) call lines%add_line(template_lines(keys%items(i)))
         end do
         if (.not. as_tables) call lines%add_line('/')
      end do
   end subroutine describe_groups

   function table_row(key) result(row)
      type(key_t), intent(in) :: key
      character(:), allocatable :: row

      row = '`'//key%value_text()//'`'
      if (associated(key%numbers)) row = 'none'
      if (key%follows) row = 'follows'
      if (key%required) row = '**required**'
      row = '|`'//trim(key%name)//'`|'//row//'|'//trim(key%unit)//'|'//key%range_text()//'|'//escaped(trim(key%meaning))
      if (key%condition /= '') row = row//' For '//trim(key%condition)//'.'
      row = row//'|'
   end function table_row

   ! What a group is, and how many there may be.
   pure function described(group) result(words)
      type(known_group_t), intent(in) :: group
      character(:), allocatable :: words

      words = trim(group%meaning)//trim(merge(' Required', ' Optional', group%required))
      if (group%repeatable) words = words//'; may be repeated'
      words = words//'.'
   end function described

   ! Text for a cell of a Markdown table, where a bar would end the cell.
   pure function escaped(line) result(cell)
      character(*), intent(in) :: line
      character(:), allocatable :: cell
      integer :: i

      cell = ''
      do i = 1, len(line)
         if (line(i:i) == '|') cell = cell//'\'
         cell = cell//line(i:i)
      end do
   end function escaped

end module key_writer
