!> Fetches the values of the keys it visits from a namelist document and checks each.
module key_reader
   use findings, only: findings_t, place_t
   use key_visitor, only: key_visitor_t, range_t
   use kinds, only: dp
   use known_keys, only: described, idle_text, known_t, name_length, same_choice, suggest
   use key_words, only: all_values, count_problem, free_text, shown_values, some_values, take_option
   use namelist_document, only: document_t, entry_t, value_t
   use text, only: has_control_characters, lower_case, nearest_word, parse_integer, parse_real, quoted, to_text
   use text_cursor, only: letters
   implicit none
   private

   public :: key_reader_t

   integer, parameter :: most_names = 64    ! keys of one group, or groups

   !> Reads from `document`; what is wrong goes to `notes`.
   type, extends(key_visitor_t) :: key_reader_t
      type(document_t) :: document
      type(findings_t) :: notes
      character(name_length), private :: group_name = ''
      integer, private :: group = 0         ! position of the group entered; 0: not in the document
      integer, private :: key_count = 0     ! keys of this group that were visited
      integer, private :: group_count = 0   ! groups that were announced
      logical, private :: unsure = .false.  ! a choice of this group was refused: what goes with it is not known
      type(known_t), private :: idle        ! the first key of this group that is given and has no effect
      type(place_t), private :: idle_place
      type(known_t), private :: keys(most_names)
      type(known_t), private :: groups(most_names)
   contains
      procedure :: announce
      procedure :: enter
      procedure :: leave
      procedure :: finish
      procedure :: real_key
      procedure :: real_or_word_key
      procedure :: vector_key
      procedure :: integer_key
      procedure :: text_key
      procedure :: choice_key
      procedure :: list_key
      procedure, private :: note_key
      procedure, private :: collect
      procedure, private :: refuse
      procedure, private :: take_real
      procedure, private :: take_choice
   end type key_reader_t

contains

   !> Learns that a group exists; notes whether it is missing or there too often.
   subroutine announce(self, name, meaning, required, repeatable)
      class(key_reader_t), intent(inout) :: self
      character(*), intent(in) :: name, meaning
      logical, intent(in) :: required, repeatable

      type(place_t) :: first, place
      integer :: number

      self%group_count = self%group_count + 1
      self%groups(self%group_count) = known_t(name, meaning, missing=required .and. self%document%count_of(name) == 0)
      if (repeatable) return
      first = self%document%place_of(name, 1, '')
      do number = 2, self%document%count_of(name)
         place = self%document%place_of(name, number, '')
         call self%notes%mistake(place, name, '&'//name//' is given twice, first at '//first%text)
      end do
   end subroutine announce

   !> Turns to the number-th group of a name.
   subroutine enter(self, name, number)
      class(key_reader_t), intent(inout) :: self
      character(*), intent(in) :: name
      integer, intent(in) :: number

      self%group_name = name
      self%group = self%document%index_of(name, number)
      self%key_count = 0
      self%unsure = .false.
      self%idle = known_t()
      call self%always()
   end subroutine enter

   !> Notes keys of the group that nobody asked for, and required ones that are not there.
   subroutine leave(self)
      class(key_reader_t), intent(inout) :: self

      character(:), allocatable :: hint, meant
      integer :: i

      if (self%group == 0) return
      hint = ''
      meant = ''
      associate (group => self%document%groups(self%group))
         do i = 1, group%entry_count()
            if (group%entries(i)%known) cycle
            call suggest(group%entries(i)%key, '', self%keys(:self%key_count), hint, meant)
            call self%notes%mistake(group%entries(i)%place, group%name, &
                                    '&'//group%name//" has no key '"//group%entries(i)%key//"'; "//hint)
         end do
         do i = 1, self%key_count
            associate (key => self%keys(i))
               if (.not. key%missing .or. (key%condition /= '' .and. self%unsure)) cycle
               if (same_choice(key%condition, self%idle%condition)) then
                  ! One slip: the choice does not fit the keys.
                  call self%notes%mistake(self%idle_place, group%name, idle_text(group%name, self%idle)//', and ' &
                                          //trim(key%name)//' is missing')
                  exit
               end if
               call self%notes%mistake(group%place, group%name, '&'//group%name//' needs '//described(key))
            end associate
         end do
      end associate
      self%group = 0
   end subroutine leave

   !> Notes groups that do not exist and required ones that are not there.
   subroutine finish(self)
      class(key_reader_t), intent(inout) :: self

      character(:), allocatable :: hint, meant
      integer :: i

      hint = ''
      meant = ''
      do i = 1, self%document%group_count()
         associate (group => self%document%groups(i))
            if (any(self%groups%name == group%name)) cycle
            call suggest(group%name, '&', self%groups(:self%group_count), hint, meant)
            call self%notes%mistake(group%place, meant, 'there is no group &'//group%name//'; '//hint)
         end associate
      end do
      do i = 1, self%group_count
         if (self%groups(i)%missing) then
            call self%notes%mistake(self%document%place_of('', 1, ''), trim(self%groups(i)%name), &
                                    'the input needs &'//described(self%groups(i))//' dynsph --template shows one.')
         end if
      end do
   end subroutine finish

   !> Reads a real number.
   subroutine real_key(self, name, value, range, unit, meaning, required)
      class(key_reader_t), intent(inout) :: self
      character(*), intent(in) :: name, unit, meaning
      real(dp), intent(inout) :: value
      type(range_t), intent(in) :: range
      logical, intent(in), optional :: required

      real(dp) :: values(1)

      values(1) = value
      call self%vector_key(name, values, range, unit, meaning, required)
      value = values(1)
   end subroutine real_key

   !> Reads a real number, or a word in its place.
   subroutine real_or_word_key(self, name, value, word, chosen, range, unit, meaning)
      class(key_reader_t), intent(inout) :: self
      character(*), intent(in) :: name, unit, meaning
      real(dp), intent(inout) :: value
      character(*), intent(in) :: word
      logical, intent(inout) :: chosen
      type(range_t), intent(in) :: range

      type(value_t) :: words(1)
      type(place_t) :: places(1)
      logical :: given(1)

      call self%note_key(name, meaning)
      call self%collect(name, words, places, given, all_values)
      if (.not. given(1)) return
      chosen = lower_case(words(1)%text) == word
      if (chosen .and. words(1)%needs_quotes .and. .not. words(1)%quoted) then
         call self%refuse(places(1), name, ': '//words(1)%text//' is text and needs quotes: '//quoted(word))
      else if (.not. chosen .and. (words(1)%quoted .or. scan(words(1)%text, letters) == 1)) then
         call self%refuse(places(1), name, ' = '//quoted(words(1)%text)//' is unknown; write a number or '//quoted(word))
      else if (.not. chosen) then
         call self%take_real(name, words(1), places(1), range, unit, value)
      end if
   end subroutine real_or_word_key

   !> Reads a few real numbers, all together or one by one.
   subroutine vector_key(self, name, value, range, unit, meaning, required)
      class(key_reader_t), intent(inout) :: self
      character(*), intent(in) :: name, unit, meaning
      real(dp), intent(inout) :: value(:)
      type(range_t), intent(in) :: range
      logical, intent(in), optional :: required

      type(value_t) :: words(size(value))
      type(place_t) :: places(size(value))
      logical :: given(size(value))
      integer :: i

      call self%note_key(name, meaning, required)
      call self%collect(name, words, places, given, all_values)
      do i = 1, size(value)
         if (given(i)) call self%take_real(name, words(i), places(i), range, unit, value(i))
      end do
      if (any(given) .and. .not. all(given) .and. present(required)) then
         call self%refuse(places(findloc(given, .true., 1)), name, ' needs '//to_text(size(value))//' values')
      end if
   end subroutine vector_key

   !> Turns a word into a real number within its range.
   subroutine take_real(self, name, word, place, range, unit, value)
      class(key_reader_t), intent(inout) :: self
      character(*), intent(in) :: name, unit
      type(value_t), intent(in) :: word
      type(place_t), intent(in) :: place
      type(range_t), intent(in) :: range
      real(dp), intent(inout) :: value

      character(:), allocatable :: message
      real(dp) :: number

      if (word%quoted) then
         call self%refuse(place, name, ': '//quoted(word%text)//' is text in quotes; a number is wanted')
         return
      end if
      call parse_real(word%text, number, message)
      if (message /= '') then
         if (index(word%text, '/') > 0) message = message//'; it is not worked out: write its value'
         call self%refuse(place, name, ': '//message)
      else if (.not. range%holds(number)) then
         call self%refuse(place, name, ' = '//to_text(number)//' is out of range: '//range%in_words()//' ['//unit//']')
      else
         value = number
      end if
   end subroutine take_real

   !> Reads a whole number.
   subroutine integer_key(self, name, value, range, unit, meaning, required)
      class(key_reader_t), intent(inout) :: self
      character(*), intent(in) :: name, unit, meaning
      integer, intent(inout) :: value
      type(range_t), intent(in) :: range
      logical, intent(in), optional :: required

      type(value_t) :: words(1)
      type(place_t) :: places(1)
      logical :: given(1)
      character(:), allocatable :: message
      integer :: number

      call self%note_key(name, meaning, required)
      call self%collect(name, words, places, given, all_values)
      if (.not. given(1)) return
      if (words(1)%quoted) then
         call self%refuse(places(1), name, ': '//quoted(words(1)%text)//' is text in quotes; a whole number is wanted')
         return
      end if
      call parse_integer(words(1)%text, number, message)
      if (message /= '') then
         call self%refuse(places(1), name, ': '//message)
      else if (.not. range%holds(real(number, dp))) then
         call self%refuse(places(1), name, ' = '//to_text(number)//' is out of range: '//range%in_words()//' ['//unit//']')
      else
         value = number
      end if
   end subroutine integer_key

   !> Reads free text.
   subroutine text_key(self, name, value, meaning, required)
      class(key_reader_t), intent(inout) :: self
      character(*), intent(in) :: name, meaning
      character(*), intent(inout) :: value
      logical, intent(in), optional :: required

      type(value_t) :: words(1)
      type(place_t) :: places(1)
      logical :: given(1)

      call self%note_key(name, meaning, required)
      call self%collect(name, words, places, given, free_text)
      if (.not. given(1)) return
      if (words(1)%needs_quotes .and. .not. words(1)%quoted) then
         call self%refuse(places(1), name, ': '//words(1)%text//' is text and needs quotes: '//quoted(words(1)%text))
      else if (has_control_characters(words(1)%text)) then
         call self%refuse(places(1), name, ' has a line end or another control character in it; write it on one line')
      else if (len_trim(words(1)%text) > len(value)) then
         call self%refuse(places(1), name, ' has '//to_text(len_trim(words(1)%text))//' letters; at most ' &
                          //to_text(len(value))//' can be kept')
      else if (words(1)%text == '' .and. present(required)) then
         call self%refuse(places(1), name, ' is empty')
      else
         value = words(1)%text
      end if
   end subroutine text_key

   !> Reads one word out of some.
   subroutine choice_key(self, name, value, choices, meaning)
      class(key_reader_t), intent(inout) :: self
      character(*), intent(in) :: name, meaning
      character(*), intent(inout) :: value
      character(*), intent(in) :: choices(:)

      type(value_t) :: words(1)
      type(place_t) :: places(1)
      logical :: given(1)

      call self%note_key(name, meaning)
      call self%collect(name, words, places, given, all_values)
      if (given(1)) call self%take_choice(name, words(1), places(1), choices, value)
   end subroutine choice_key

   !> Reads one or more different words out of some.
   subroutine list_key(self, name, values, used, choices, meaning)
      class(key_reader_t), intent(inout) :: self
      character(*), intent(in) :: name, meaning
      character(*), intent(inout) :: values(:)
      integer, intent(inout) :: used
      character(*), intent(in) :: choices(:)

      type(value_t) :: words(size(values))
      type(place_t) :: places(size(values))
      logical :: given(size(values))
      integer :: i

      call self%note_key(name, meaning)
      call self%collect(name, words, places, given, some_values)
      if (.not. any(given)) return
      used = 0
      values = ''
      do i = 1, size(values)
         if (.not. given(i)) cycle
         used = used + 1
         call self%take_choice(name, words(i), places(i), choices, values(used))
         if (any(values(:used - 1) == values(used)) .and. values(used) /= '') then
            call self%refuse(places(i), name, ' names '//quoted(values(used))//' twice')
         end if
      end do
   end subroutine list_key

   !> Takes a word if it is one of the choices.
   subroutine take_choice(self, name, word, place, choices, value)
      class(key_reader_t), intent(inout) :: self
      character(*), intent(in) :: name
      type(value_t), intent(in) :: word
      type(place_t), intent(in) :: place
      character(*), intent(in) :: choices(:)
      character(*), intent(inout) :: value

      character(:), allocatable :: listed, meant
      integer :: i

      do i = 1, size(choices)
         if (lower_case(word%text) == choices(i) .and. (word%quoted .or. .not. word%needs_quotes)) then
            value = choices(i)
            return
         end if
      end do
      self%unsure = .true.
      meant = nearest_word(word%text, choices)
      if (word%needs_quotes .and. .not. word%quoted) then
         call self%refuse(place, name, ': '//word%text//' is text and needs quotes: '//quoted(word%text))
      else if (meant /= '') then
         call self%refuse(place, name, ' = '//quoted(word%text)//" is unknown; did you mean '"//meant//"'?")
      else
         listed = quoted(choices(1))
         do i = 2, size(choices)
            listed = listed//', '//quoted(choices(i))
         end do
         call self%refuse(place, name, ' = '//quoted(word%text)//' is unknown; there are '//listed)
      end if
   end subroutine take_choice

   !> Keeps the name of a key that exists, and whether it is missing.
   subroutine note_key(self, name, meaning, required)
      class(key_reader_t), intent(inout) :: self
      character(*), intent(in) :: name, meaning
      logical, intent(in), optional :: required

      self%key_count = self%key_count + 1
      self%keys(self%key_count) = known_t(name, meaning, condition=self%condition)
      if (.not. present(required)) return
      self%keys(self%key_count)%missing = required .and. self%active .and. self%document%entry_of(self%group, name) == 0
   end subroutine note_key

   !> Gathers the values given for a key in the group entered.
   subroutine collect(self, name, words, places, given, style)
      class(key_reader_t), intent(inout) :: self
      character(*), intent(in) :: name
      type(value_t), intent(out) :: words(:)         !! as many as the key can hold; 1: no array
      type(place_t), intent(out) :: places(:)
      logical, intent(out) :: given(:)
      integer, intent(in) :: style                   !! all_values, some_values or free_text

      type(entry_t) :: item
      character(:), allocatable :: problem
      integer :: at, i, j

      given = .false.
      problem = ''
      if (self%group == 0) return
      do i = 1, self%document%groups(self%group)%entry_count()
         if (self%document%groups(self%group)%entries(i)%key /= name) cycle
         self%document%groups(self%group)%entries(i)%known = .true.
         item = self%document%groups(self%group)%entries(i)
         if (allocated(item%raw)) call take_option(item, style, self%notes, trim(self%group_name))
         if (item%broken) cycle
         problem = count_problem(item%element, size(words), size(item%values), style == some_values)
         if (problem /= '') then
            if (item%element == 0) problem = problem//' ('//shown_values(item%values)//')'
            call self%refuse(item%place, name, problem)
            cycle
         end if
         do j = 1, size(item%values)
            at = max(item%element, j)
            words(at) = item%values(j)
            places(at) = item%place
            given(at) = .true.
         end do
      end do
      if (any(given) .and. .not. self%active) then
         at = findloc(given, .true., 1)
         if (self%idle%name == '') then
            self%idle = known_t(name, '', condition=self%condition)
            self%idle_place = places(at)
         end if
         call self%notes%warning(places(at), idle_text(trim(self%group_name), known_t(name, '', condition=self%condition)))
      end if
   end subroutine collect

   !> Notes a mistake in a key of the group entered.
   subroutine refuse(self, place, name, message)
      class(key_reader_t), intent(inout) :: self
      type(place_t), intent(in) :: place
      character(*), intent(in) :: name, message

      call self%notes%mistake(place, trim(self%group_name), '&'//trim(self%group_name)//' '//name//message)
   end subroutine refuse

end module key_reader
