!> Takes namelist text apart without losing its line numbers.
!!
!! The compiler's own namelist read tells neither the line nor, often, the true cause, and lets repeated keys and empty
!! values pass; so the text is scanned here. The time is linear in its length.
module scanner
   use document, only: document_t, entry_t, group_t
   use findings, only: findings_t, place_t
   use growing_text, only: growing_text_t
   use name_table, only: name_table_t
   use text, only: behind, lower_case, parse_integer, quoted, to_text
   implicit none
   private

   public :: scan_namelist, scan_option

   character(*), parameter, public :: letters = 'abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ'

   character, parameter :: newline = achar(10)
   character, parameter :: nothing = achar(0)   ! what stands behind the end
   character(*), parameter :: quotes = '"'//"'"
   character(*), parameter :: name_letters = letters//'0123456789_'
   character(*), parameter :: blanks = ' '//achar(9)//achar(10)//achar(13)
   character(*), parameter :: byte_order_mark = char(239)//char(187)//char(191)
   integer, parameter :: most_repeats = 1000    ! of r*c; no key takes as many values
   integer, parameter :: shown_letters = 40     ! of a line that is quoted in a message; also the longest (index)

   !> A place in the text that moves on and knows its line.
   type :: cursor_t
      character(:), allocatable :: content
      integer :: at = 1
      integer :: line = 1
   contains
      procedure :: current
      procedure :: advance
      procedure :: skip_blanks
      procedure :: skip_line
      procedure :: read_name
      procedure :: read_word
      procedure :: rest_of_line
      procedure :: look_for_key
   end type cursor_t

contains

   !> Takes a whole file apart; what is wrong with its form is noted, the rest goes on.
   subroutine scan_namelist(content, document, notes)
      character(*), intent(in) :: content
      type(document_t), intent(out) :: document
      type(findings_t), intent(inout) :: notes
      type(cursor_t) :: cursor

      cursor%content = content
      if (index(content, byte_order_mark) == 1) cursor%at = 1 + len(byte_order_mark)
      do
         call cursor%skip_blanks()
         select case (cursor%current())
         case (nothing)
            exit
         case ('&')
            call scan_group(cursor, document, notes)
         case ('/')
            call notes%mistake(place_t(cursor%line), '', "this '/' closes no group")
            call cursor%advance()
         case default
            call notes%mistake(place_t(cursor%line), '', quoted(cursor%rest_of_line()) &
                               //' stands outside the groups; a comment begins with !')
            do while (scan(cursor%current(), '&'//nothing) == 0)   ! once for all its lines
               call cursor%skip_line()
               call cursor%skip_blanks()
            end do
         end select
      end do
   end subroutine scan_namelist

   ! One group, from its & to its / or &end.
   subroutine scan_group(cursor, document, notes)
      type(cursor_t), intent(inout) :: cursor
      type(document_t), intent(inout) :: document
      type(findings_t), intent(inout) :: notes
      type(group_t) :: group
      type(name_table_t) :: before   ! keys of the group so far
      logical :: at_end

      group%place%line = cursor%line
      call cursor%advance()
      group%name = cursor%read_name()
      if (group%name == '' .or. group%name == 'end') then
         call notes%mistake(group%place, '', "'&"//group%name//"' opens no group; write &name")
         call cursor%skip_line()
         return
      end if
      do
         call cursor%skip_blanks()
         call look_for_end(cursor, group, notes, at_end)
         if (at_end) exit
         if (cursor%current() == ',') then
            call cursor%advance()
         else if (scan(cursor%current(), letters) > 0) then
            call scan_entry(cursor, group, before, notes)
         else
            call notes%mistake(place_t(cursor%line), group%name, &
                               '&'//group%name//": expected 'key = value', found "//quoted(cursor%rest_of_line()))
            call cursor%skip_line()
         end if
      end do
      call document%add_group(group)
   end subroutine scan_group

   ! Steps over the end of a group if it is here.
   subroutine look_for_end(cursor, group, notes, at_end)
      type(cursor_t), intent(inout) :: cursor
      type(group_t), intent(in) :: group
      type(findings_t), intent(inout) :: notes
      logical, intent(out) :: at_end
      character(:), allocatable :: name
      integer :: start

      at_end = .true.
      select case (cursor%current())
      case ('/')
         call cursor%advance()
      case ('&')
         start = cursor%at
         call cursor%advance()
         name = cursor%read_name()
         if (name == 'end') return
         cursor%at = start
         call notes%mistake(group%place, group%name, '&'//group%name//" is not closed: its '/' is missing before &"//name)
      case (nothing)
         call notes%mistake(group%place, group%name, '&'//group%name//" is not closed: its '/' is missing at the end of the file")
      case default
         at_end = .false.
      end select
   end subroutine look_for_end

   ! One `key = values`.
   subroutine scan_entry(cursor, group, before, notes)
      type(cursor_t), intent(inout) :: cursor
      type(group_t), intent(inout) :: group
      type(name_table_t), intent(inout) :: before
      type(findings_t), intent(inout) :: notes
      type(entry_t) :: item
      integer :: first

      item%place%line = cursor%line
      item%key = cursor%read_name()
      call scan_element(cursor, item, notes, group%name)
      call cursor%skip_blanks()
      if (cursor%current() /= '=') then
         call notes%mistake(item%place, group%name, '&'//group%name//": '"//item%key//"' is not followed by '='")
         call cursor%skip_line()
         return
      end if
      call cursor%advance()
      call scan_values(cursor, item, notes, group%name)
      first = mentioned(before, item)
      if (first > 0 .and. .not. item%broken) then
         call notes%mistake(item%place, group%name, '&'//group%name//' '//item%key//' is given twice, first at ' &
                            //notes%place_text(group%entries(first)%place))
         return
      end if
      call group%add_entry(item)
      if (before%find(item%key) == 0) call before%put(item%key, group%n)
      if (before%find(with_element(item)) == 0) call before%put(with_element(item), group%n)
   end subroutine scan_entry

   ! Position of the first entry of the group that sets the same value, 0 if there is none.
   pure integer function mentioned(before, item) result(first)
      type(name_table_t), intent(in) :: before
      type(entry_t), intent(in) :: item
      integer :: whole

      first = before%find(with_element(item))
      if (item%element == 0) then
         first = before%find(item%key)
      else
         whole = before%find(item%key//' 0')
         if (whole > 0 .and. (first == 0 .or. whole < first)) first = whole
      end if
   end function mentioned

   pure function with_element(item) result(words)
      type(entry_t), intent(in) :: item
      character(:), allocatable :: words

      words = item%key//' '//to_text(item%element)
   end function with_element

   ! The (2) of `key(2) = value` if there is one.
   subroutine scan_element(cursor, item, notes, group)
      type(cursor_t), intent(inout) :: cursor
      type(entry_t), intent(inout) :: item
      type(findings_t), intent(inout) :: notes
      character(*), intent(in) :: group
      character(:), allocatable :: inside, message
      integer :: length

      call cursor%skip_blanks()
      if (cursor%current() /= '(') return
      call cursor%advance()
      length = scan(cursor%content(cursor%at:), ')='//newline) - 1
      if (length < 0) length = len(cursor%content) - cursor%at + 1
      inside = trim(adjustl(cursor%content(cursor%at:cursor%at + length - 1)))
      cursor%at = cursor%at + length
      if (cursor%current() == ')') call cursor%advance()
      call parse_integer(inside, item%element, message)
      if (message /= '' .or. item%element < 1) then
         call notes%mistake(item%place, group, '&'//group//' '//item%key//'('//inside &
                            //'): only one element at a time, as in '//item%key//'(2), is understood')
         item%broken = .true.
         item%element = 0
      end if
   end subroutine scan_element

   ! Values up to the next key, the end of the group or the end of the text.
   subroutine scan_values(cursor, item, notes, group)
      type(cursor_t), intent(inout) :: cursor
      type(entry_t), intent(inout) :: item
      type(findings_t), intent(inout) :: notes
      character(*), intent(in) :: group
      logical :: key_here, value_due
      character(:), allocatable :: problem

      problem = ''
      value_due = .true.   ! two commas in a row, or one at the start, leave a value out
      do
         call cursor%skip_blanks()
         if (scan(cursor%current(), '/&'//nothing) > 0) exit
         if (cursor%current() == ',') then
            if (value_due) problem = 'a value is missing before a comma'
            value_due = .true.
            call cursor%advance()
         else if (cursor%current() == '=') then
            problem = "a second '=' without a key"
            call cursor%skip_line()
         else
            call cursor%look_for_key(key_here)
            if (key_here) exit
            call scan_value(cursor, item, problem)
            value_due = .false.
         end if
      end do
      if (item%n == 0 .and. problem == '') problem = 'it has no value'
      if (problem == '' .or. item%broken) return
      item%broken = .true.
      call notes%mistake(item%place, group, '&'//group//' '//item%key//': '//problem)
   end subroutine scan_values

   ! One value, or r*c as r values.
   subroutine scan_value(cursor, item, problem)
      type(cursor_t), intent(inout) :: cursor
      type(entry_t), intent(inout) :: item
      character(:), allocatable, intent(inout) :: problem   ! set when something is wrong
      character(:), allocatable :: message, word
      integer :: i, repeats, star
      logical :: in_quotes

      repeats = 1
      in_quotes = scan(cursor%current(), quotes) > 0
      word = ''
      if (.not. in_quotes) then
         word = cursor%read_word()
         star = index(word, '*')
         if (star > 1) then
            call parse_integer(word(:star - 1), repeats, message)
            if (message == '' .and. (repeats < 1 .or. repeats > most_repeats)) then
               problem = quoted(word)//' repeats a value not 1 to '//to_text(most_repeats)//' times'
               return
            else if (message == '') then
               word = behind(word, star)
               in_quotes = word == '' .and. scan(cursor%current(), quotes) > 0
               if (word == '' .and. .not. in_quotes) problem = 'a value is missing after '//to_text(repeats)//'*'
            else
               repeats = 1
            end if
         end if
      end if
      if (in_quotes) call scan_string(cursor, word, problem)
      do i = 1, repeats
         call item%add_value(word, in_quotes)
      end do
   end subroutine scan_value

   ! A text in quotes; a doubled quote stands for one.
   subroutine scan_string(cursor, word, problem)
      type(cursor_t), intent(inout) :: cursor
      character(:), allocatable, intent(out) :: word
      character(:), allocatable, intent(inout) :: problem
      type(growing_text_t) :: letters_so_far
      character :: letter, quote

      quote = cursor%current()
      do
         call cursor%advance()
         letter = cursor%current()
         if (scan(letter, newline//nothing) > 0) exit
         if (letter == quote) then
            ! Of a doubled quote one is part of the text.
            call cursor%advance()
            if (cursor%current() /= quote) exit
         end if
         call letters_so_far%add(letter)
      end do
      word = letters_so_far%text()
      if (letter /= quote) problem = 'the text '//quote//trim(word)//' is not closed by '//quote//' on its line'
   end subroutine scan_string

   !> Takes the values of a --set apart; the shell has taken the quotes, so they may lack.
   subroutine scan_option(item, free_text, notes, group)
      type(entry_t), intent(inout) :: item       !! with an option; values are appended
      logical, intent(in) :: free_text           !! without quotes it is one value as it stands
      type(findings_t), intent(inout) :: notes
      character(*), intent(in) :: group
      type(cursor_t) :: cursor

      if (free_text .and. scan(adjustl(item%option), quotes) /= 1) then
         call item%add_value(trim(adjustl(item%option)), .true.)
         return
      end if
      cursor%content = item%option
      call scan_values(cursor, item, notes, group)
      if (cursor%current() /= nothing .and. .not. item%broken) then
         call notes%mistake(item%place, group, quoted(cursor%rest_of_line())//' is not part of a value')
         item%broken = .true.
      end if
      if (allocated(item%values)) item%values%needs_quotes = .false.
   end subroutine scan_option

   ! The letter here.
   pure character function current(self)
      class(cursor_t), intent(in) :: self

      current = nothing
      if (self%at <= len(self%content)) current = self%content(self%at:self%at)
   end function current

   ! Moves on by one letter.
   pure subroutine advance(self)
      class(cursor_t), intent(inout) :: self

      if (self%current() == newline) self%line = self%line + 1
      self%at = self%at + 1
   end subroutine advance

   ! Moves on over blanks, line ends and comments.
   pure subroutine skip_blanks(self)
      class(cursor_t), intent(inout) :: self

      do while (self%at <= len(self%content))
         if (self%current() == '!') then
            call self%skip_line()
         else if (scan(self%current(), blanks) > 0) then
            call self%advance()
         else
            exit
         end if
      end do
   end subroutine skip_blanks

   ! Moves to the end of the line.
   pure subroutine skip_line(self)
      class(cursor_t), intent(inout) :: self

      do while (scan(self%current(), newline//nothing) == 0)
         call self%advance()
      end do
   end subroutine skip_line

   ! A name in lower case; '' if none stands here.
   function read_name(self) result(name)
      class(cursor_t), intent(inout) :: self
      character(:), allocatable :: name
      integer :: start

      start = self%at
      do while (scan(self%current(), name_letters) > 0)
         self%at = self%at + 1
      end do
      name = lower_case(self%content(start:self%at - 1))
   end function read_name

   ! A value without quotes. A '/' inside it, as in 161/30, does not end the group here: the reader refuses such a value with
   ! the right reason.
   function read_word(self) result(word)
      class(cursor_t), intent(inout) :: self
      character(:), allocatable :: word
      character :: next
      integer :: start

      start = self%at
      do
         call self%advance()
         if (scan(self%current(), blanks//',!=&'//quotes//nothing) > 0) exit
         if (self%current() == '/') then
            next = nothing
            if (self%at < len(self%content)) next = self%content(self%at + 1:self%at + 1)
            if (scan(next, name_letters//'.') == 0) exit
         end if
      end do
      word = self%content(start:self%at - 1)
   end function read_word

   ! What is left of the line, shortened for a message.
   pure function rest_of_line(self) result(rest)
      class(cursor_t), intent(in) :: self
      character(:), allocatable :: rest
      integer :: length

      rest = self%content(self%at:min(self%at + shown_letters, len(self%content)))
      length = scan(rest//newline, achar(13)//newline) - 1
      rest = trim(rest(:min(length, shown_letters)))
      if (length > shown_letters) rest = rest//'...'
   end function rest_of_line

   ! Whether `name =` or `name(...) =` stands here.
   subroutine look_for_key(self, key_here)
      class(cursor_t), intent(inout) :: self   ! as it was on return
      logical, intent(out) :: key_here
      character(:), allocatable :: name
      integer :: before_at, before_line, length

      key_here = .false.
      if (scan(self%current(), letters) == 0) return
      before_at = self%at
      before_line = self%line
      name = self%read_name()
      call self%skip_blanks()
      if (self%current() == '(') then
         associate (rest => self%content(self%at:min(self%at + shown_letters, len(self%content))))
            length = scan(rest, ')'//newline)
            if (length == 0) length = len(rest)
            if (rest(length:length) == newline) length = length - 1
         end associate
         self%at = self%at + length
         call self%skip_blanks()
      end if
      key_here = self%current() == '='
      self%at = before_at
      self%line = before_line
   end subroutine look_for_key

end module scanner
