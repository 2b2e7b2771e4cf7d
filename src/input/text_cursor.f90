!> A place in a text that moves on letter by letter and knows its line.
module text_cursor
   use text, only: lower_case
   implicit none
   private

   public :: cursor_t

   character, parameter, public :: newline = achar(10)
   character, parameter, public :: nothing = achar(0)   !! what stands behind the end
   character(*), parameter, public :: letters = 'abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ'
   character(*), parameter, public :: quotes = '"'//"'"

   character(*), parameter :: name_letters = letters//'0123456789_'
   character(*), parameter :: blanks = ' '//achar(9)//achar(10)//achar(13)

   integer, parameter :: shown_letters = 40     ! of a line that is quoted in a message

   !> A place in the text that moves on.
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

   !> The letter here.
   pure character function current(self)
      class(cursor_t), intent(in) :: self

      current = nothing
      if (self%at <= len(self%content)) current = self%content(self%at:self%at)
   end function current

   !> Moves on by one letter.
   pure subroutine advance(self)
      class(cursor_t), intent(inout) :: self

      if (self%current() == newline) self%line = self%line + 1
      self%at = self%at + 1
   end subroutine advance

   !> Moves on over blanks, line ends and comments.
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

   !> Moves to the end of the line.
   pure subroutine skip_line(self)
      class(cursor_t), intent(inout) :: self

      do while (self%at <= len(self%content))
         if (self%current() == newline) exit
         call self%advance()
      end do
   end subroutine skip_line

   !> Reads a name in lower case; '' if none stands here.
   function read_name(self) result(name)
      class(cursor_t), intent(inout) :: self
      character(:), allocatable :: name

      integer :: length

      if (self%at > len(self%content)) then
         name = ''
         return
      end if
      length = verify(self%content(self%at:)//nothing, name_letters) - 1
      name = lower_case(self%content(self%at:self%at + length - 1))
      self%at = self%at + length
   end function read_name

   !> Reads a value without quotes. A '/' inside it, as in 161/30, does not end the
   !! group here: the reader refuses such a value with the right reason.
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

   !> What is left of the line, shortened for a message.
   pure function rest_of_line(self) result(rest)
      class(cursor_t), intent(in) :: self
      character(:), allocatable :: rest

      integer :: length

      length = scan(self%content(self%at:)//newline, achar(13)//newline) - 1
      rest = trim(self%content(self%at:self%at + min(length, shown_letters) - 1))
      if (length > shown_letters) rest = rest//'...'
   end function rest_of_line

   !> Tells whether `name =` or `name(...) =` stands here, without moving on.
   subroutine look_for_key(self, key_here)
      class(cursor_t), intent(inout) :: self
      logical, intent(out) :: key_here

      character(:), allocatable :: name
      integer :: line, start

      key_here = .false.
      if (scan(self%current(), letters) == 0) return
      start = self%at
      line = self%line
      name = self%read_name()
      call self%skip_blanks()
      if (self%current() == '(') then
         do while (scan(self%current(), ')'//newline//nothing) == 0)
            call self%advance()
         end do
         if (self%current() == ')') call self%advance()
         call self%skip_blanks()
      end if
      key_here = name /= '' .and. self%current() == '='
      self%at = start
      self%line = line
   end subroutine look_for_key

end module text_cursor
