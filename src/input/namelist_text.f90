!> Takes namelist text apart without losing its line numbers.
!!
!! The compiler's own namelist read tells neither the line nor, often, the true
!! cause, and lets repeated keys and empty values pass; so the text is scanned here.
module namelist_text
   use findings, only: findings_t
   use namelist_document, only: document_t, entry_t, group_t
   use text, only: behind, parse_integer, quoted, to_text
   use text_cursor, only: cursor_t, letters, newline, nothing, quotes
   implicit none
   private

   public :: scan_namelist, scan_words

   character(*), parameter :: byte_order_mark = char(239)//char(187)//char(191)
   integer, parameter :: most_repeats = 1000    ! of r*c; no key takes as many values

contains

   !> Takes a whole file apart; what is wrong with its form is noted, the rest goes on.
   subroutine scan_namelist(content, file, document, notes)
      character(*), intent(in) :: content
      character(*), intent(in) :: file            !! name for messages
      type(document_t), intent(out) :: document
      type(findings_t), intent(inout) :: notes

      type(cursor_t) :: cursor

      document%file = file
      cursor%content = content
      if (index(content, byte_order_mark) == 1) cursor%at = 1 + len(byte_order_mark)
      do
         call cursor%skip_blanks()
         select case (cursor%current())
         case (nothing)
            exit
         case ('&')
            call scan_group(cursor, document, notes)
         case default
            call refuse_outside(cursor, document, notes)
         end select
      end do
   end subroutine scan_namelist

   !> Takes the values given on the command line apart; quotes may lack there.
   subroutine scan_words(content, item, notes, group)
      character(*), intent(in) :: content
      type(entry_t), intent(inout) :: item       !! its place is set; values are appended
      type(findings_t), intent(inout) :: notes
      character(*), intent(in) :: group

      type(cursor_t) :: cursor

      cursor%content = content
      call scan_values(cursor, item, notes, group)
      if (cursor%current() /= nothing .and. .not. item%broken) then
         call notes%mistake(item%place, group, quoted(cursor%rest_of_line())//' is not part of a value')
         item%broken = .true.
      end if
   end subroutine scan_words

   !> Notes text that stands outside all groups, once for all its lines.
   subroutine refuse_outside(cursor, document, notes)
      type(cursor_t), intent(inout) :: cursor
      type(document_t), intent(in) :: document
      type(findings_t), intent(inout) :: notes

      if (cursor%current() == '/') then
         call notes%mistake(document%line_place(cursor%line), '', "this '/' closes no group")
         call cursor%advance()
         return
      end if
      call notes%mistake(document%line_place(cursor%line), '', quoted(cursor%rest_of_line()) &
                         //' stands outside the groups; a comment begins with !')
      do
         call cursor%skip_line()
         call cursor%skip_blanks()
         if (scan(cursor%current(), '&'//nothing) > 0) exit
      end do
   end subroutine refuse_outside

   !> Takes one group apart, from its & to its / or &end.
   subroutine scan_group(cursor, document, notes)
      type(cursor_t), intent(inout) :: cursor
      type(document_t), intent(inout) :: document
      type(findings_t), intent(inout) :: notes

      type(group_t) :: group
      logical :: at_end

      group%place = document%line_place(cursor%line)
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
            call scan_entry(cursor, group, document, notes)
         else
            call notes%mistake(document%line_place(cursor%line), group%name, &
                               '&'//group%name//": expected 'key = value', found "//quoted(cursor%rest_of_line()))
            call cursor%skip_line()
         end if
      end do
      call document%add_group(group)
   end subroutine scan_group

   !> Steps over the end of a group if it is here.
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
         if (name /= 'end') then
            call notes%mistake(group%place, group%name, &
                               '&'//group%name//" is not closed: its '/' is missing before &"//name)
            cursor%at = start
         end if
      case (nothing)
         call notes%mistake(group%place, group%name, &
                            '&'//group%name//" is not closed: its '/' is missing at the end of the file")
      case default
         at_end = .false.
      end select
   end subroutine look_for_end

   !> Takes `key = values` apart and adds it to its group.
   subroutine scan_entry(cursor, group, document, notes)
      type(cursor_t), intent(inout) :: cursor
      type(group_t), intent(inout) :: group
      type(document_t), intent(in) :: document
      type(findings_t), intent(inout) :: notes

      type(entry_t) :: item
      integer :: i

      item%place = document%line_place(cursor%line)
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
      do i = 1, group%entry_count()
         associate (before => group%entries(i))
            if (before%key /= item%key .or. item%broken) cycle
            if (before%element /= item%element .and. before%element*item%element > 0) cycle
            call notes%mistake(item%place, group%name, '&'//group%name//' '//item%key &
                               //' is given twice, first at '//before%place%text)
            return
         end associate
      end do
      call group%add_entry(item)
   end subroutine scan_entry

   !> Reads the (2) of `key(2) = value` if there is one.
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

   !> Reads values up to the next key, the end of the group or the end of the text.
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
      if (.not. allocated(item%values) .and. problem == '') problem = 'it has no value'
      if (problem == '' .or. item%broken) return
      item%broken = .true.
      call notes%mistake(item%place, group, '&'//group//' '//item%key//': '//problem)
   end subroutine scan_values

   !> Reads one value, or r*c as r values.
   subroutine scan_value(cursor, item, problem)
      type(cursor_t), intent(inout) :: cursor
      type(entry_t), intent(inout) :: item
      character(:), allocatable, intent(inout) :: problem   !! set when something is wrong

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

   !> Reads a text in quotes; a doubled quote stands for one.
   subroutine scan_string(cursor, word, problem)
      type(cursor_t), intent(inout) :: cursor
      character(:), allocatable, intent(out) :: word
      character(:), allocatable, intent(inout) :: problem

      character :: quote
      integer :: start

      quote = cursor%current()
      call cursor%advance()
      word = ''
      start = cursor%at
      do
         if (scan(cursor%current(), newline//nothing) > 0) then
            word = word//cursor%content(start:cursor%at - 1)
            problem = 'the text '//quote//trim(word)//' is not closed by '//quote//' on its line'
            return
         end if
         if (cursor%current() == quote) then
            ! Of a doubled quote one is part of the text.
            word = word//cursor%content(start:cursor%at - 1)
            call cursor%advance()
            if (cursor%current() /= quote) return
            start = cursor%at
         end if
         call cursor%advance()
      end do
   end subroutine scan_string

end module namelist_text
