!> Takes the values of all keys from a namelist taken apart, and checks each.
module key_reader
   use document, only: entry_t, group_t, value_t
   use draft, only: draft_t
   use findings, only: findings_t, place_t
   use key_table, only: key_t, keys_t, listed
   use kinds, only: dp
   use scanner, only: letters, scan_option
   use scene_keys, only: count_groups, groups, list_keys
   use settings, only: group_names, most_numbers, name_length
   use text, only: has_control_characters, lower_case, nearest_word, parse_integer, parse_real, quoted, to_text
   implicit none
   private

   public :: read_values, check_keys

contains

   !> Sets the scene's values.
   subroutine read_values(draft)
      type(draft_t), intent(inout), target :: draft

      allocate (draft%scene%bodies(draft%document%count_of('body')))
      allocate (draft%scene%solids(draft%document%count_of('solid')))
      allocate (draft%scene%sponges(draft%document%count_of('sponge')))
      allocate (draft%scene%probes(draft%document%count_of('probe')))
      allocate (draft%scene%gauges(draft%document%count_of('gauge')))
      call visit_groups(draft, checking=.false.)
   end subroutine read_values

   !> Notes what depends on other keys: groups and keys that there are not, have no effect or are missing. All values must be read.
   subroutine check_keys(draft)
      type(draft_t), intent(inout), target :: draft

      call visit_groups(draft, checking=.true.)
      call check_groups(draft)
   end subroutine check_keys

   ! Reads or checks the keys of all groups, in the table's order.
   subroutine visit_groups(draft, checking)
      type(draft_t), intent(inout), target :: draft
      logical, intent(in) :: checking
      type(keys_t) :: keys
      integer :: at, g, i, number

      do g = 1, size(groups)
         number = 0
         do at = 1, draft%document%n
            associate (group => draft%document%groups(at))
               if (group%name /= groups(g)%name) cycle
               number = number + 1
               if (number > count_groups(draft%scene, groups(g)%name)) exit
               call list_keys(draft%scene, draft%solutions, groups(g)%name, number, keys)
               if (checking) call check_group(group, keys, draft%notes)
               if (checking) cycle
               do i = 1, keys%n
                  if (associated(keys%items(i)%numbers)) then
                     call read_numbers(group, keys%items(i), draft%notes)
                  else
                     call read_key(group, keys%items(i), draft%notes)
                  end if
               end do
            end associate
         end do
      end do
   end subroutine visit_groups

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
            call draft%mistake(name, number, '', '&'//name//' is given twice, first at ' &
                               //draft%notes%place_text(draft%document%place_of(name, 1, '')))
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
      character(:), allocatable :: meant
      logical :: there, missing(keys%n)
      integer :: first, i, idle, idle_entry, j

      idle = 0
      idle_entry = 0
      meant = ''
      do i = 1, keys%n
         names(i) = keys%items(i)%name
         first = 0   ! entry that gives its values
         there = .false.
         do j = group%n, 1, -1
            if (group%entries(j)%key /= keys%items(i)%name) cycle
            there = .true.
            if (group%entries(j)%taken) first = j
         end do
         missing(i) = keys%items(i)%required .and. keys%items(i)%active .and. .not. there
         if (first == 0 .or. keys%items(i)%active .or. group%unsure) cycle
         call notes%warning(group%entries(first)%place, no_effect(keys%items(i)))
         if (idle > 0) cycle
         idle = i
         idle_entry = first
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
            if (same_choice(key, keys%items(max(idle, 1)))) then
               ! One slip: the choice does not fit the keys.
               call notes%mistake(group%entries(idle_entry)%place, group%name, no_effect(keys%items(idle)) &
                                  //', and '//trim(key%name)//' is missing')
               exit
            end if
            call notes%mistake(group%place, group%name, '&'//group%name//' needs '//trim(key%name)//': '//trim(key%meaning))
         end associate
      end do

   contains

      pure function no_effect(key) result(words)
         type(key_t), intent(in) :: key
         character(:), allocatable :: words

         words = '&'//group%name//' '//trim(key%name)//' has no effect without '//trim(key%condition)
      end function no_effect

      ! Whether the conditions of two keys are about one choice, as "shape = 'disc'" and "shape = 'rectangle'" are.
      pure logical function same_choice(one, other)
         type(key_t), intent(in) :: one, other
         integer :: equals

         equals = index(one%condition, '=')
         same_choice = idle > 0 .and. equals > 0 .and. one%condition(:equals) == other%condition(:equals)
      end function same_choice

   end subroutine check_group

   ! The values that a group gives for a key.
   subroutine read_key(group, key, notes)
      type(group_t), intent(inout) :: group
      type(key_t), intent(inout) :: key
      type(findings_t), intent(inout) :: notes
      integer :: from(key%length())   ! the entry that gives a value; 0: none
      integer :: i

      from = 0
      do i = 1, group%n
         if (group%entries(i)%key == key%name) call take_entry(i)
      end do
      if (all(from == 0)) return
      if (associated(key%list)) key%list = ''
      if (associated(key%list)) key%used = 0
      do i = 1, size(from)
         if (from(i) > 0) call take_value(group%entries(from(i)), i)
      end do
      if (key%required .and. any(from == 0)) &
         call refuse(group%entries(from(findloc(from > 0, .true., 1))), ' needs '//to_text(size(from))//' values')

   contains

      ! Notes what is wrong with an entry, if anything is.
      subroutine refuse(item, problem)
         type(entry_t), intent(in) :: item
         character(*), intent(in) :: problem

         if (problem /= '') call notes%mistake(item%place, group%name, '&'//group%name//' '//trim(key%name)//problem)
      end subroutine refuse

      ! Finds which values an entry gives.
      subroutine take_entry(at)
         integer, intent(in) :: at
         character(:), allocatable :: problem

         associate (item => group%entries(at))
            item%known = .true.
            if (allocated(item%option)) &
               call scan_option(item, associated(key%words) .and. .not. allocated(key%choices), notes, group%name)
            if (item%broken) return
            problem = count_problem(item, size(from), associated(key%list))
            call refuse(item, problem)
            item%taken = problem == ''
            if (.not. item%taken) return
            if (item%element > 0) from(item%element) = at
            if (item%element == 0) from(:item%n) = at
         end associate
      end subroutine take_entry

      ! Takes one value that an entry gives.
      subroutine take_value(item, number)
         type(entry_t), intent(in) :: item
         integer, intent(in) :: number
         character(:), allocatable :: problem, meant
         logical :: is_word

         associate (word => item%values(merge(1, number, item%element > 0)))
            problem = ''
            meant = word%text
            is_word = associated(key%words) .or. associated(key%list)
            if (associated(key%chosen)) then
               meant = trim(key%choices(1))
               is_word = lower_case(word%text) == meant
               key%chosen = is_word
            end if
            if (associated(key%list)) key%used = key%used + 1
            if (.not. is_word) then
               call take_number(key, number, word, problem)
            else if (.not. (word%quoted .or. allocated(item%option))) then   ! the shell takes quotes
               problem = ': '//word%text//' is text and needs quotes: '//quoted(meant)
            else if (allocated(key%choices) .and. .not. associated(key%chosen)) then
               call take_choice(key, word%text, problem)
            else if (associated(key%words)) then
               call take_text(key, word%text, problem)
            end if
         end associate
         if (problem /= '' .and. associated(key%words) .and. allocated(key%choices)) group%unsure = .true.
         call refuse(item, problem)
      end subroutine take_value

   end subroutine read_key

   ! The numbers that a group lists for a key.
   subroutine read_numbers(group, key, notes)
      type(group_t), intent(inout) :: group
      type(key_t), intent(inout) :: key
      type(findings_t), intent(inout) :: notes
      character(:), allocatable :: problem
      integer :: i, k

      do i = 1, group%n
         if (group%entries(i)%key /= key%name) cycle
         associate (item => group%entries(i))
            item%known = .true.
            if (allocated(item%option)) call scan_option(item, .false., notes, group%name)
            if (item%broken) cycle
            problem = ''
            if (item%element > 0) problem = '('//to_text(item%element)//') is set; give all of its numbers at once'
            if (item%n > most_numbers) problem = ' has '//to_text(item%n)//' values; at most '//to_text(most_numbers) &
                                                 //' are possible'
            item%taken = problem == ''
            if (item%taken) then
               if (allocated(key%numbers%values)) deallocate (key%numbers%values)
               allocate (key%numbers%values(item%n), source=0.0_dp)
               do k = 1, item%n
                  if (problem == '') call take_number(key, k, item%values(k), problem)
               end do
            end if
            if (problem /= '') call notes%mistake(item%place, group%name, '&'//group%name//' '//trim(key%name)//problem)
         end associate
      end do
   end subroutine read_numbers

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
      else if (item%element == 0 .and. (item%n > length .or. item%n < length .and. .not. fewer_allowed)) then
         problem = to_text(length)//trim(merge(' value ', ' values', length == 1))
         if (fewer_allowed) problem = 'at most '//problem
         problem = ' takes '//problem//', not '//to_text(item%n)//' ('//shown_values(item)//')'
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

   ! A number within the key's range.
   subroutine take_number(key, at, word, problem)
      type(key_t), intent(inout) :: key
      integer, intent(in) :: at                             ! which of its values
      type(value_t), intent(in) :: word
      character(:), allocatable, intent(inout) :: problem   ! '' when taken
      real(dp) :: number
      integer :: whole

      if (associated(key%chosen) .and. (word%quoted .or. scan(word%text, letters) == 1)) then
         problem = ' = '//quoted(word%text)//' is unknown; write a number or '//quoted(key%choices(1))
         return
      else if (word%quoted) then
         problem = ': '//quoted(word%text)//' is text in quotes; a ' &
                   //trim(merge('whole number', 'number      ', associated(key%whole)))//' is wanted'
         return
      end if
      if (associated(key%whole)) then
         call parse_integer(word%text, whole, problem)
         number = whole
      else
         call parse_real(word%text, number, problem)
         if (problem /= '' .and. index(word%text, '/') > 0) problem = problem//'; it is not worked out: write its value'
      end if
      if (problem /= '') then
         problem = ': '//problem
      else if (.not. key%range%holds(number)) then
         problem = to_text(number)
         if (associated(key%whole)) problem = to_text(whole)
         problem = ' = '//problem//' is out of range: '//key%range%in_words()//' ['//trim(key%unit)//']'
      else
         if (associated(key%number)) key%number = number
         if (associated(key%vector)) key%vector(at) = number
         if (associated(key%numbers)) key%numbers%values(at) = number
         if (associated(key%whole)) key%whole = whole
      end if
   end subroutine take_number

   ! Free text on one line.
   subroutine take_text(key, text, problem)
      type(key_t), intent(inout) :: key
      character(*), intent(in) :: text
      character(:), allocatable, intent(inout) :: problem

      if (has_control_characters(text)) then
         problem = ' has a line end or another control character in it; write it on one line'
      else if (len_trim(text) > len(key%words)) then
         problem = ' has '//to_text(len_trim(text))//' letters; at most '//to_text(len(key%words))//' can be kept'
      else if (text == '' .and. key%required) then
         problem = ' is empty'
      else
         key%words = text
      end if
   end subroutine take_text

   ! A word if it is one of the key's choices; in a list, another one than those before it.
   subroutine take_choice(key, text, problem)
      type(key_t), intent(inout) :: key
      character(*), intent(in) :: text
      character(:), allocatable, intent(inout) :: problem
      character(len(text)) :: word

      word = lower_case(text)
      if (.not. any(key%choices == word)) then
         problem = nearest_word(text, key%choices)
         if (problem /= '') problem = "did you mean '"//problem//"'?"
         if (problem == '') problem = 'there are '//listed(key%choices)
         problem = ' = '//quoted(text)//' is unknown; '//problem
      else if (associated(key%words)) then
         key%words = word
      else
         if (any(key%list == word)) problem = ' names '//quoted(word)//' twice'
         key%list(key%used) = word
      end if
   end subroutine take_choice

end module key_reader
