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
   integer, parameter :: most_repeats = 1000    ! of r*c
   integer, parameter :: shown_letters = 40     ! of a line that is quoted in a message; also the longest (index)

   !> A place in the text, and where to tell what is wrong with it.
   type :: cursor_t
      character(:), pointer :: content => null()
      integer :: at = 1
      integer :: line = 1
      character(:), allocatable :: group        ! that is being taken apart
      type(findings_t), pointer :: notes => null()
   end type cursor_t

contains

   !> Takes a whole file apart; what is wrong with its form is noted, the rest goes on.
   subroutine scan_namelist(content, document, notes)
      character(*), intent(in), target :: content
      type(document_t), intent(out) :: document
      type(findings_t), intent(inout), target :: notes
      type(cursor_t) :: cursor

      cursor%content => content
      cursor%notes => notes
      if (index(content, byte_order_mark) == 1) cursor%at = 1 + len(byte_order_mark)
      do
         call skip_blanks(cursor)
         select case (letter(cursor))
         case (nothing)
            exit
         case ('&')
            call scan_group(cursor, document)
         case ('/')
            call notes%mistake(place_t(cursor%line), '', "this '/' closes no group")
            call advance(cursor)
         case default
            call notes%mistake(place_t(cursor%line), '', quoted(rest_of_line(cursor)) &
                               //' stands outside the groups; a comment begins with !')
            do while (.not. here(cursor, '&'//nothing))   ! once for all its lines
               call skip_line(cursor)
               call skip_blanks(cursor)
            end do
         end select
      end do
   end subroutine scan_namelist

   ! One group, from its & to its / or &end.
   subroutine scan_group(cursor, document)
      type(cursor_t), intent(inout) :: cursor
      type(document_t), intent(inout) :: document
      type(group_t) :: group
      type(name_table_t) :: before   ! keys of the group so far
      character(:), allocatable :: name
      integer :: start

      group%place%line = cursor%line
      call advance(cursor)
      group%name = name_at(cursor)
      cursor%group = group%name
      if (group%name == '' .or. group%name == 'end') then
         call cursor%notes%mistake(group%place, '', "'&"//group%name//"' opens no group; write &name")
         call skip_line(cursor)
         return
      end if
      do
         call skip_blanks(cursor)
         select case (letter(cursor))
         case ('a':'z', 'A':'Z')
            call scan_entry(cursor, group, before)
         case (',')
            call advance(cursor)
         case ('/')
            call advance(cursor)
            exit
         case ('&')
            start = cursor%at
            call advance(cursor)
            name = name_at(cursor)
            if (name == 'end') exit
            cursor%at = start
            call refuse(cursor, group%place, " is not closed: its '/' is missing before &"//name)
            exit
         case (nothing)
            call refuse(cursor, group%place, " is not closed: its '/' is missing at the end of the file")
            exit
         case default
            call refuse(cursor, place_t(cursor%line), ": expected 'key = value', found "//quoted(rest_of_line(cursor)))
            call skip_line(cursor)
         end select
      end do
      call document%add_group(group)
   end subroutine scan_group

   ! Notes a mistake in a group.
   subroutine refuse(cursor, place, message)
      type(cursor_t), intent(in) :: cursor
      type(place_t), intent(in) :: place
      character(*), intent(in) :: message

      call cursor%notes%mistake(place, cursor%group, '&'//cursor%group//message)
   end subroutine refuse

   ! One `key = values`.
   subroutine scan_entry(cursor, group, before)
      type(cursor_t), intent(inout) :: cursor
      type(group_t), intent(inout) :: group
      type(name_table_t), intent(inout) :: before
      type(entry_t) :: item
      character(:), allocatable :: element
      integer, allocatable :: earlier(:)

      item%place%line = cursor%line
      item%key = name_at(cursor)
      call scan_element(cursor, item)
      call skip_blanks(cursor)
      if (.not. here(cursor, '=')) then
         call refuse(cursor, item%place, ": '"//item%key//"' is not followed by '='")
         call skip_line(cursor)
         return
      end if
      call advance(cursor)
      call scan_values(cursor, item)
      element = item%key//' '//to_text(item%element)
      ! The whole key sets what any of its elements does.
      earlier = [before%find(element), before%find(item%key//' 0')]
      if (item%element == 0) earlier = [before%find(item%key)]
      if (any(earlier > 0) .and. .not. item%broken) then
         call refuse(cursor, item%place, ' '//item%key//' is given twice, first at ' &
                     //cursor%notes%place_text(group%entries(minval(earlier, earlier > 0))%place))
         return
      end if
      call group%add_entry(item)
      if (before%find(item%key) == 0) call before%put(item%key, group%n)
      if (before%find(element) == 0) call before%put(element, group%n)
   end subroutine scan_entry

   ! The (2) of `key(2) = value` if there is one.
   subroutine scan_element(cursor, item)
      type(cursor_t), intent(inout) :: cursor
      type(entry_t), intent(inout) :: item
      character(:), allocatable :: inside, message
      integer :: start

      call skip_blanks(cursor)
      if (.not. here(cursor, '(')) return
      call advance(cursor)
      start = cursor%at
      do while (.not. here(cursor, ')='//newline//nothing))
         cursor%at = cursor%at + 1
      end do
      inside = trim(adjustl(cursor%content(start:cursor%at - 1)))
      if (here(cursor, ')')) call advance(cursor)
      call parse_integer(inside, item%element, message)
      if (message /= '' .or. item%element < 1) then
         call refuse(cursor, item%place, ' '//item%key//'('//inside//'): only one element at a time, as in ' &
                     //item%key//'(2), is understood')
         item%broken = .true.
         item%element = 0
      end if
   end subroutine scan_element

   ! Values up to the next key, the end of the group or the end of the text.
   subroutine scan_values(cursor, item)
      type(cursor_t), intent(inout) :: cursor
      type(entry_t), intent(inout) :: item
      logical :: value_due
      character(:), allocatable :: problem

      problem = ''
      value_due = .true.   ! two commas in a row, or one at the start, leave a value out
      do
         call skip_blanks(cursor)
         if (here(cursor, ',')) then
            if (value_due) problem = 'a value is missing before a comma'
            value_due = .true.
            call advance(cursor)
         else if (here(cursor, '=')) then
            problem = "a second '=' without a key"
            call skip_line(cursor)
         else
            if (here(cursor, '/&'//nothing)) exit
            if (key_at(cursor)) exit
            call scan_value(cursor, item, problem)
            value_due = .false.
         end if
      end do
      if (item%n == 0 .and. problem == '') problem = 'it has no value'
      if (problem == '' .or. item%broken) return
      item%broken = .true.
      call refuse(cursor, item%place, ' '//item%key//': '//problem)
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
      star = 0
      word = ''
      in_quotes = here(cursor, quotes)
      if (.not. in_quotes) then
         word = word_at(cursor)
         star = index(word, '*')
      end if
      if (star > 1) then
         call parse_integer(word(:star - 1), repeats, message)
         if (message /= '') then
            repeats = 1
         else if (repeats < 1 .or. repeats > most_repeats) then
            problem = quoted(word)//' repeats a value not 1 to '//to_text(most_repeats)//' times'
            return
         else
            word = behind(word, star)
            in_quotes = word == '' .and. here(cursor, quotes)
            if (word == '' .and. .not. in_quotes) problem = 'a value is missing after '//to_text(repeats)//'*'
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
      character :: quote
      logical :: closed

      quote = letter(cursor)
      closed = .false.
      do
         call advance(cursor)
         if (here(cursor, newline//nothing)) exit
         if (here(cursor, quote)) then
            ! Of a doubled quote one is part of the text.
            call advance(cursor)
            closed = .not. here(cursor, quote)
            if (closed) exit
         end if
         call letters_so_far%add(letter(cursor))
      end do
      word = letters_so_far%text()
      if (.not. closed) problem = 'the text '//quote//trim(word)//' is not closed by '//quote//' on its line'
   end subroutine scan_string

   !> Takes the values of a --set apart; the shell has taken the quotes, so they may lack.
   subroutine scan_option(item, free_text, notes, group)
      type(entry_t), intent(inout), target :: item   !! with an option; values are appended
      logical, intent(in) :: free_text               !! without quotes it is one value as it stands
      type(findings_t), intent(inout), target :: notes
      character(*), intent(in) :: group
      type(cursor_t) :: cursor

      if (free_text .and. scan(adjustl(item%option), quotes) /= 1) then
         call item%add_value(trim(adjustl(item%option)), .true.)
         return
      end if
      cursor%content => item%option
      cursor%notes => notes
      cursor%group = group
      call scan_values(cursor, item)
      if (here(cursor, nothing) .or. item%broken) return
      call notes%mistake(item%place, group, quoted(rest_of_line(cursor))//' is not part of a value')
      item%broken = .true.
   end subroutine scan_option

   ! The letter at the cursor.
   pure character function letter(cursor)
      type(cursor_t), intent(in) :: cursor

      letter = nothing
      if (cursor%at <= len(cursor%content)) letter = cursor%content(cursor%at:cursor%at)
   end function letter

   ! Whether that is one of some.
   pure logical function here(cursor, letters)
      type(cursor_t), intent(in) :: cursor
      character(*), intent(in) :: letters

      here = scan(letter(cursor), letters) > 0
   end function here

   ! Moves on by one letter.
   pure subroutine advance(cursor)
      type(cursor_t), intent(inout) :: cursor

      if (here(cursor, newline)) cursor%line = cursor%line + 1
      cursor%at = cursor%at + 1
   end subroutine advance

   ! Moves on over blanks, line ends and comments.
   pure subroutine skip_blanks(cursor)
      type(cursor_t), intent(inout) :: cursor

      do while (here(cursor, blanks//'!'))
         if (here(cursor, '!')) then
            call skip_line(cursor)
         else
            call advance(cursor)
         end if
      end do
   end subroutine skip_blanks

   ! Moves to the end of the line.
   pure subroutine skip_line(cursor)
      type(cursor_t), intent(inout) :: cursor

      do while (.not. here(cursor, newline//nothing))
         call advance(cursor)
      end do
   end subroutine skip_line

   ! Steps over a name, in lower case; '' if none stands here.
   function name_at(cursor) result(name)
      type(cursor_t), intent(inout) :: cursor
      character(:), allocatable :: name
      integer :: start

      start = cursor%at
      do while (here(cursor, name_letters))
         cursor%at = cursor%at + 1
      end do
      name = lower_case(cursor%content(start:cursor%at - 1))
   end function name_at

   ! Steps over a value without quotes. A '/' inside it, as in 161/30, does not end the group here: the reader refuses such a
   ! value with the right reason.
   function word_at(cursor) result(word)
      type(cursor_t), intent(inout) :: cursor
      character(:), allocatable :: word
      integer :: start

      start = cursor%at
      do
         call advance(cursor)
         if (here(cursor, blanks//',!=&'//quotes//nothing)) exit
         associate (next => cursor%content(cursor%at + 1:min(cursor%at + 1, len(cursor%content))))
            if (here(cursor, '/') .and. scan(next, name_letters//'.') == 0) exit
         end associate
      end do
      word = cursor%content(start:cursor%at - 1)
   end function word_at

   ! What is left of the line, shortened for a message.
   pure function rest_of_line(cursor) result(rest)
      type(cursor_t), intent(in) :: cursor
      character(:), allocatable :: rest
      integer :: length

      rest = cursor%content(cursor%at:min(cursor%at + shown_letters, len(cursor%content)))
      length = scan(rest//newline, achar(13)//newline) - 1
      rest = trim(rest(:min(length, shown_letters)))
      if (length > shown_letters) rest = rest//'...'
   end function rest_of_line

   ! Whether `name =` or `name(...) =` stands here.
   logical function key_at(cursor)
      type(cursor_t), intent(in) :: cursor
      type(cursor_t) :: ahead
      character(:), allocatable :: name
      integer :: last

      key_at = here(cursor, letters)
      if (.not. key_at) return
      ahead = cursor
      name = name_at(ahead)
      call skip_blanks(ahead)
      if (here(ahead, '(')) then
         last = ahead%at + shown_letters
         do while (ahead%at <= last .and. .not. here(ahead, ')'//newline//nothing))
            ahead%at = ahead%at + 1
         end do
         if (ahead%at <= last .and. here(ahead, ')')) ahead%at = ahead%at + 1
         call skip_blanks(ahead)
      end if
      key_at = here(ahead, '=')
   end function key_at

end module scanner
