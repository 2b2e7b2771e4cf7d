!> Takes the values of all keys from a namelist taken apart, and checks each.
module key_reader
   use document, only: entry_t, group_t, value_t
   use draft, only: draft_t
   use findings, only: findings_t, place_t
   use key_table, only: is_choice, is_list, is_real, is_text, is_vector, is_whole, key_t, keys_t
   use kinds, only: dp
   use scanner, only: letters, scan_option
   use scene_keys, only: count_groups, groups, list_keys
   use settings, only: group_names, name_length
   use text, only: has_control_characters, lower_case, nearest_word, parse_integer, parse_real, quoted, to_text
   implicit none
   private

   public :: read_values

contains

   !> Sets the scene's values. What depends on other keys is looked at when all have been read.
   subroutine read_values(draft)
      type(draft_t), intent(inout), target :: draft
      type(keys_t) :: keys
      integer :: at, g, i, number, pass

      allocate (draft%scene%bodies(draft%document%count_of('body')))
      allocate (draft%scene%probes(draft%document%count_of('probe')))
      allocate (draft%scene%gauges(draft%document%count_of('gauge')))
      do pass = 1, 2
         do g = 1, size(groups)
            do number = 1, count_groups(draft%scene, groups(g)%name)
               at = draft%document%index_of(trim(groups(g)%name), number)
               if (at == 0) cycle
               call list_keys(draft%scene, draft%solutions, groups(g)%name, number, keys)
               if (pass == 1) then
                  do i = 1, keys%n
                     call read_key(draft%document%groups(at), keys%items(i), draft%notes)
                  end do
               else
                  call check_group(draft%document%groups(at), keys, draft%notes)
               end if
            end do
         end do
      end do
      call check_groups(draft)
   end subroutine read_values

   ! Unknown groups, groups that are missing or there too often.
   subroutine check_groups(draft)
      type(draft_t), intent(inout) :: draft
      logical :: missing(size(groups))
      character(:), allocatable :: meant, name
      integer :: g, number

      meant = ''
      name = ''
      do g = 1, size(groups)
         name = trim(groups(g)%name)
         missing(g) = groups(g)%required .and. draft%document%count_of(name) == 0
         if (groups(g)%repeatable) cycle
         do number = 2, draft%document%count_of(name)
            call draft%mistake(name, '', '&'//name//' is given twice, first at ' &
                               //draft%notes%place_text(draft%document%place_of(name, 1, '')), number)
         end do
      end do
      do g = 1, draft%document%n
         associate (group => draft%document%groups(g))
            if (any(group_names == group%name)) cycle
            meant = nearest_word(group%name, group_names)
            where (group_names == meant) missing = .false.
            call draft%notes%mistake(group%place, meant, 'there is no group &'//group%name//'; '//hint('&', meant))
         end associate
      end do
      do g = 1, size(groups)
         if (missing(g)) call draft%notes%mistake(place_t(), trim(groups(g)%name), 'the input needs &' &
            //trim(groups(g)%name)//': '//trim(groups(g)%meaning)//' dynsph --template shows one.')
      end do
   end subroutine check_groups

   pure function hint(mark, meant) result(words)
      character(*), intent(in) :: mark    ! '&' for groups
      character(*), intent(in) :: meant   ! '' if no name is like it
      character(:), allocatable :: words

      words = "did you mean '"//mark//meant//"'?"
      if (meant == '') words = 'dynsph --keys lists what there is'
   end function hint

   ! Keys of a group that do not exist, have no effect or are missing.
   subroutine check_group(group, keys, notes)
      type(group_t), intent(in) :: group
      type(keys_t), intent(in) :: keys
      type(findings_t), intent(inout) :: notes
      character(name_length) :: names(keys%n)
      character(:), allocatable :: idle, idle_condition, idle_text, meant
      logical :: there(keys%n), missing(keys%n)
      type(place_t) :: idle_place
      integer :: first, i

      meant = ''
      idle = ''
      idle_text = ''
      idle_condition = ''
      do i = 1, keys%n
         associate (key => keys%items(i))
            names(i) = key%name
            call look_up(group, key%name, first, there(i))
            missing(i) = key%required .and. key%active .and. .not. there(i)
            if (first == 0 .or. key%active) cycle
            idle = '&'//group%name//' '//key%name//' has no effect without '//key%condition
            call notes%warning(group%entries(first)%place, idle)
            if (idle_condition /= '') cycle
            idle_condition = key%condition
            idle_text = idle
            idle_place = group%entries(first)%place
         end associate
      end do
      do i = 1, group%n
         if (group%entries(i)%known) cycle
         meant = nearest_word(group%entries(i)%key, names)
         where (names == meant) missing = .false.
         call notes%mistake(group%entries(i)%place, group%name, &
                            '&'//group%name//" has no key '"//group%entries(i)%key//"'; "//hint('', meant))
      end do
      do i = 1, keys%n
         associate (key => keys%items(i))
            if (.not. missing(i) .or. (key%condition /= '' .and. group%unsure)) cycle
            if (same_choice(key%condition, idle_condition)) then
               ! One slip: the choice does not fit the keys.
               call notes%mistake(idle_place, group%name, idle_text//', and '//key%name//' is missing')
               exit
            end if
            call notes%mistake(group%place, group%name, '&'//group%name//' needs '//key%name//': '//key%meaning)
         end associate
      end do
   end subroutine check_group

   ! The first entry of a group that gives a key's values, and whether the key is mentioned at all.
   pure subroutine look_up(group, name, first, there)
      type(group_t), intent(in) :: group
      character(*), intent(in) :: name
      integer, intent(out) :: first      ! 0: none, or a mistake in it is noted
      logical, intent(out) :: there
      integer :: i

      first = 0
      there = .false.
      do i = group%n, 1, -1
         if (group%entries(i)%key /= name) cycle
         there = .true.
         if (group%entries(i)%taken) first = i
      end do
   end subroutine look_up

   ! Whether two conditions are about one key, as "shape = 'disc'" and "shape = 'rectangle'" are.
   pure logical function same_choice(one, other)
      character(*), intent(in) :: one, other

      same_choice = index(one, '=') > 0
      if (same_choice) same_choice = index(other, one(:index(one, '='))) == 1
   end function same_choice

   ! The values that a group gives for a key.
   subroutine read_key(group, key, notes)
      type(group_t), intent(inout) :: group
      type(key_t), intent(inout) :: key
      type(findings_t), intent(inout) :: notes
      type(value_t) :: words(key%length())
      type(place_t) :: places(key%length())
      logical :: given(key%length())
      character(:), allocatable :: problem
      integer :: first, i

      call collect(group, key, words, places, given, notes)
      if (.not. any(given)) return
      first = findloc(given, .true., 1)
      problem = ''
      select case (key%kind)
      case (is_real)
         call take_real_or_word(key, words(1), problem)
      case (is_vector)
         do i = 1, size(words)
            if (given(i)) call take_real(key, words(i), key%vector(i), problem)
            if (problem /= '') call refuse(places(i))
            problem = ''
         end do
         if (.not. all(given) .and. key%required) problem = ' needs '//to_text(size(given))//' values'
      case (is_whole)
         call take_whole(key, words(1), problem)
      case (is_text)
         call take_text(key, words(1), problem)
      case (is_choice)
         call take_choice(key, words(1), key%words, problem)
         if (problem /= '') group%unsure = .true.
      case (is_list)
         key%list = ''
         key%used = 0
         do i = 1, size(words)
            if (.not. given(i)) cycle
            key%used = key%used + 1
            call take_choice(key, words(i), key%list(key%used), problem)
            if (any(key%list(:key%used - 1) == key%list(key%used)) .and. key%list(key%used) /= '') &
               problem = ' names '//quoted(key%list(key%used))//' twice'
            if (problem /= '') call refuse(places(i))
            problem = ''
         end do
      end select
      if (problem /= '') call refuse(places(first))

   contains

      subroutine refuse(place)
         type(place_t), intent(in) :: place

         call notes%mistake(place, group%name, '&'//group%name//' '//key%name//problem)
      end subroutine refuse

   end subroutine read_key

   ! Gathers the words given for a key.
   subroutine collect(group, key, words, places, given, notes)
      type(group_t), intent(inout) :: group
      type(key_t), intent(in) :: key
      type(value_t), intent(out) :: words(:)         ! as many as the key can hold
      type(place_t), intent(out) :: places(:)
      logical, intent(out) :: given(:)
      type(findings_t), intent(inout) :: notes
      character(:), allocatable :: problem
      integer :: at, i, j

      problem = ''
      given = .false.
      do i = 1, group%n
         associate (item => group%entries(i))
            if (item%key /= key%name) cycle
            item%known = .true.
            if (allocated(item%option)) call scan_option(item, key%kind == is_text, notes, group%name)
            if (item%broken) cycle
            problem = count_problem(item, size(words), key%kind == is_list)
            if (problem /= '') then
               call notes%mistake(item%place, group%name, '&'//group%name//' '//key%name//problem)
               cycle
            end if
            item%taken = .true.
            do j = 1, item%n
               at = max(item%element, j)
               words(at) = item%values(j)
               places(at) = item%place
               given(at) = .true.
            end do
         end associate
      end do
   end subroutine collect

   ! What is wrong with the number of values, '' when nothing is.
   pure function count_problem(item, length, fewer_allowed) result(problem)
      type(entry_t), intent(in) :: item
      integer, intent(in) :: length         ! values that the key can hold
      logical, intent(in) :: fewer_allowed
      character(:), allocatable :: problem

      problem = ''
      if (item%element > 0 .and. length == 1) then
         problem = '('//to_text(item%element)//') is set, but it is not an array'
      else if (item%element > length) then
         problem = '('//to_text(item%element)//') is set, but it has only '//to_text(length)//' values'
      else if (item%element > 0 .and. item%n /= 1) then
         problem = '('//to_text(item%element)//') takes 1 value, not '//to_text(item%n)
      else if (item%element == 0 .and. fewer_allowed .and. item%n > length) then
         problem = ' takes at most '//to_text(length)//' values, not '//to_text(item%n)//' ('//shown_values(item)//')'
      else if (item%element == 0 .and. .not. fewer_allowed .and. item%n /= length) then
         problem = ' takes '//to_text(length)//trim(merge(' value ', ' values', length == 1))//', not '//to_text(item%n) &
                   //' ('//shown_values(item)//')'
      end if
   end function count_problem

   ! The first few values, for a message.
   pure function shown_values(item) result(line)
      type(entry_t), intent(in) :: item
      character(:), allocatable :: line
      integer, parameter :: shown = 4
      integer :: i

      line = item%values(1)%text
      do i = 2, min(shown, item%n)
         line = line//' | '//item%values(i)%text
      end do
      if (item%n > shown) line = line//' ...'
   end function shown_values

   ! Whether text lacks the quotes that it needs in a file; on the command line the shell takes them.
   pure logical function lacks_quotes(word)
      type(value_t), intent(in) :: word

      lacks_quotes = word%needs_quotes .and. .not. word%quoted
   end function lacks_quotes

   subroutine take_real_or_word(key, word, problem)
      type(key_t), intent(inout) :: key
      type(value_t), intent(in) :: word
      character(:), allocatable, intent(inout) :: problem
      character(:), allocatable :: instead

      if (.not. associated(key%chosen)) then
         call take_real(key, word, key%number, problem)
         return
      end if
      instead = trim(key%choices(1))
      key%chosen = lower_case(word%text) == instead
      if (key%chosen .and. lacks_quotes(word)) then
         problem = ': '//word%text//' is text and needs quotes: '//quoted(instead)
      else if (.not. key%chosen .and. (word%quoted .or. scan(word%text, letters) == 1)) then
         problem = ' = '//quoted(word%text)//' is unknown; write a number or '//quoted(instead)
      else if (.not. key%chosen) then
         call take_real(key, word, key%number, problem)
      end if
   end subroutine take_real_or_word

   ! A real number within the key's range.
   subroutine take_real(key, word, value, problem)
      type(key_t), intent(in) :: key
      type(value_t), intent(in) :: word
      real(dp), intent(inout) :: value
      character(:), allocatable, intent(inout) :: problem
      character(:), allocatable :: message
      real(dp) :: number

      if (word%quoted) then
         problem = ': '//quoted(word%text)//' is text in quotes; a number is wanted'
         return
      end if
      call parse_real(word%text, number, message)
      if (message /= '') then
         if (index(word%text, '/') > 0) message = message//'; it is not worked out: write its value'
         problem = ': '//message
      else if (.not. key%range%holds(number)) then
         problem = ' = '//to_text(number)//' is out of range: '//key%range%in_words()//' ['//key%unit//']'
      else
         value = number
      end if
   end subroutine take_real

   ! A whole number within the key's range.
   subroutine take_whole(key, word, problem)
      type(key_t), intent(inout) :: key
      type(value_t), intent(in) :: word
      character(:), allocatable, intent(inout) :: problem
      character(:), allocatable :: message
      integer :: number

      if (word%quoted) then
         problem = ': '//quoted(word%text)//' is text in quotes; a whole number is wanted'
         return
      end if
      call parse_integer(word%text, number, message)
      if (message /= '') then
         problem = ': '//message
      else if (.not. key%range%holds(real(number, dp))) then
         problem = ' = '//to_text(number)//' is out of range: '//key%range%in_words()//' ['//key%unit//']'
      else
         key%whole = number
      end if
   end subroutine take_whole

   ! Free text on one line.
   subroutine take_text(key, word, problem)
      type(key_t), intent(inout) :: key
      type(value_t), intent(in) :: word
      character(:), allocatable, intent(inout) :: problem

      if (lacks_quotes(word)) then
         problem = ': '//word%text//' is text and needs quotes: '//quoted(word%text)
      else if (has_control_characters(word%text)) then
         problem = ' has a line end or another control character in it; write it on one line'
      else if (len_trim(word%text) > len(key%words)) then
         problem = ' has '//to_text(len_trim(word%text))//' letters; at most '//to_text(len(key%words))//' can be kept'
      else if (word%text == '' .and. key%required) then
         problem = ' is empty'
      else
         key%words = word%text
      end if
   end subroutine take_text

   ! A word if it is one of the key's choices.
   subroutine take_choice(key, word, value, problem)
      type(key_t), intent(in) :: key
      type(value_t), intent(in) :: word
      character(*), intent(inout) :: value
      character(:), allocatable, intent(inout) :: problem
      character(:), allocatable :: meant

      if (any(key%choices == lower_case(word%text)) .and. .not. lacks_quotes(word)) then
         value = lower_case(word%text)
         return
      end if
      meant = nearest_word(word%text, key%choices)
      if (lacks_quotes(word)) then
         problem = ': '//word%text//' is text and needs quotes: '//quoted(word%text)
      else if (meant /= '') then
         problem = ' = '//quoted(word%text)//" is unknown; did you mean '"//meant//"'?"
      else
         problem = ' = '//quoted(word%text)//' is unknown; there are '//key%choice_text()
      end if
   end subroutine take_choice

end module key_reader
