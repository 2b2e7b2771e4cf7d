!> Prints the input keys: as a complete input, as the shortest one, as a template to fill in, or as tables.
module key_writer
   use key_visitor, only: key_visitor_t, range_t
   use kinds, only: dp
   use text, only: quoted, to_text
   implicit none
   private

   public :: key_writer_t

   integer, parameter, public :: as_echo = 1       !! values only
   integer, parameter, public :: as_template = 2   !! values with unit, range and meaning
   integer, parameter, public :: as_tables = 3     !! one Markdown table a group
   integer, parameter, public :: as_defaults = 4   !! nothing: the values are kept for `as_shortest`
   integer, parameter, public :: as_shortest = 5   !! what differs from these defaults, visited in the same order

   integer, parameter :: value_width = 28          ! columns kept for 'key = value'
   integer, parameter :: widest = 100              ! columns of the shortest input
   integer, parameter :: longest_value = 512       ! as text

   !> Writes what it visits to a unit.
   type, extends(key_visitor_t) :: key_writer_t
      integer :: unit = 0
      integer :: style = as_echo
      character(:), allocatable :: remark   !! what the template says above the next group
      character(longest_value), allocatable, private :: defaults(:)   ! of all keys, in the order of the visits
      integer, private :: visits = 0                                  ! of keys, with the scene's values
      character(:), allocatable, private :: line   ! of the shortest input, not written yet
   contains
      procedure :: announce
      procedure :: enter
      procedure :: leave
      procedure :: real_key
      procedure :: real_or_word_key
      procedure :: vector_key
      procedure :: integer_key
      procedure :: text_key
      procedure :: choice_key
      procedure :: list_key
      procedure, private :: write_key
      procedure, private :: add_if_other
   end type key_writer_t

contains

   !> Heads a group's table, or keeps its meaning for the template.
   subroutine announce(self, name, meaning, required, repeatable)
      class(key_writer_t), intent(inout) :: self
      character(*), intent(in) :: name, meaning
      logical, intent(in) :: required, repeatable

      character(:), allocatable :: how_many

      if (required .and. repeatable) then
         how_many = 'Required; may be repeated.'
      else if (required) then
         how_many = 'Required.'
      else if (repeatable) then
         how_many = 'Optional; may be repeated.'
      else
         how_many = 'Optional.'
      end if
      self%remark = meaning//' '//how_many
      if (self%style /= as_tables) return
      write (self%unit, '(a)') '', '## &'//name, '', self%remark, '', &
         '| key | default | unit | range or choices | meaning |', '| --- | --- | --- | --- | --- |'
   end subroutine announce

   !> Opens a group.
   subroutine enter(self, name, number)
      class(key_writer_t), intent(inout) :: self
      character(*), intent(in) :: name
      integer, intent(in) :: number

      call self%always()
      self%line = '&'//name
      if (self%style >= as_tables) return
      write (self%unit, '(a)') ''
      if (self%style == as_template .and. number == 1) write (self%unit, '(a)') '! '//self%remark
      write (self%unit, '(a)') '&'//name
   end subroutine enter

   !> Closes a group.
   subroutine leave(self)
      class(key_writer_t), intent(inout) :: self

      if (self%style < as_tables) write (self%unit, '(a)') '/'
      if (self%style == as_shortest .and. index(self%line, ' = ') > 0) write (self%unit, '(a)') self%line//' /'
   end subroutine leave

   !> Writes a real number.
   subroutine real_key(self, name, value, range, unit, meaning, required)
      class(key_writer_t), intent(inout) :: self
      character(*), intent(in) :: name, unit, meaning
      real(dp), intent(inout) :: value
      type(range_t), intent(in) :: range
      logical, intent(in), optional :: required

      call self%write_key(name, to_text(value), unit, range%in_words(), meaning, required)
   end subroutine real_key

   !> Writes a real number, or the word in its place.
   subroutine real_or_word_key(self, name, value, word, chosen, range, unit, meaning)
      class(key_writer_t), intent(inout) :: self
      character(*), intent(in) :: name, unit, meaning
      real(dp), intent(inout) :: value
      character(*), intent(in) :: word
      logical, intent(inout) :: chosen
      type(range_t), intent(in) :: range

      character(:), allocatable :: shown

      shown = to_text(value)
      if (chosen) shown = quoted(word)
      call self%write_key(name, shown, unit, range%in_words()//', or '//quoted(word), meaning)
   end subroutine real_or_word_key

   !> Writes a few real numbers.
   subroutine vector_key(self, name, value, range, unit, meaning, required)
      class(key_writer_t), intent(inout) :: self
      character(*), intent(in) :: name, unit, meaning
      real(dp), intent(inout) :: value(:)
      type(range_t), intent(in) :: range
      logical, intent(in), optional :: required

      call self%write_key(name, to_text(value), unit, range%in_words(), meaning, required)
   end subroutine vector_key

   !> Writes a whole number.
   subroutine integer_key(self, name, value, range, unit, meaning, required)
      class(key_writer_t), intent(inout) :: self
      character(*), intent(in) :: name, unit, meaning
      integer, intent(inout) :: value
      type(range_t), intent(in) :: range
      logical, intent(in), optional :: required

      call self%write_key(name, to_text(value), unit, range%in_words(), meaning, required)
   end subroutine integer_key

   !> Writes free text.
   subroutine text_key(self, name, value, meaning, required)
      class(key_writer_t), intent(inout) :: self
      character(*), intent(in) :: name, meaning
      character(*), intent(inout) :: value
      logical, intent(in), optional :: required

      call self%write_key(name, quoted(value), '', 'text, up to '//to_text(len(value))//' letters', meaning, required)
   end subroutine text_key

   !> Writes one word out of some.
   subroutine choice_key(self, name, value, choices, meaning)
      class(key_writer_t), intent(inout) :: self
      character(*), intent(in) :: name, meaning
      character(*), intent(inout) :: value
      character(*), intent(in) :: choices(:)

      call self%write_key(name, quoted(value), '', words_text(choices), meaning)
   end subroutine choice_key

   !> Writes some words out of some.
   subroutine list_key(self, name, values, used, choices, meaning)
      class(key_writer_t), intent(inout) :: self
      character(*), intent(in) :: name, meaning
      character(*), intent(inout) :: values(:)
      integer, intent(inout) :: used
      character(*), intent(in) :: choices(:)

      call self%write_key(name, words_text(values(:used)), '', 'some of '//words_text(choices), meaning)
   end subroutine list_key

   !> Words in quotes, parted by commas.
   pure function words_text(words) result(line)
      character(*), intent(in) :: words(:)
      character(:), allocatable :: line

      integer :: i

      line = ''
      do i = 1, size(words)
         if (i > 1) line = line//', '
         line = line//quoted(words(i))
      end do
   end function words_text

   !> Writes one key in the wanted style.
   subroutine write_key(self, name, value, unit, range, meaning, required)
      class(key_writer_t), intent(inout) :: self
      character(*), intent(in) :: name, value
      character(*), intent(in) :: unit, range, meaning   !! unit '': the key is no number
      logical, intent(in), optional :: required

      character(:), allocatable :: shown, column
      logical :: must

      must = .false.
      if (present(required)) must = required
      select case (self%style)
      case (as_echo)
         if (self%active) write (self%unit, '(3x, 3a)') name, ' = ', value
      case (as_template)
         shown = name//' = '//value
         if (must) shown = name//' ='   ! left empty: what is not filled in is refused
         if (.not. self%active) shown = '! '//shown
         if (len(shown) < value_width) shown = shown//repeat(' ', value_width - len(shown))
         column = range
         if (must) column = 'required; '//column
         if (unit /= '') column = '['//unit//'] '//column
         if (self%condition /= '') column = column//'; only with '//self%condition
         write (self%unit, '(3x, a)') '! '//meaning, shown//'   ! '//column
      case (as_defaults)
         if (.not. allocated(self%defaults)) allocate (self%defaults(0))
         self%defaults = [character(longest_value) :: self%defaults, value]
      case (as_shortest)
         call self%add_if_other(name, value, must)
      case default
         column = '`'//value//'`'
         if (must) column = '**required**'
         shown = escaped(meaning)
         if (self%condition /= '') shown = shown//' Only with '//self%condition//'.'
         write (self%unit, '(13a)') '| `', name, '` | ', column, ' | ', unit, ' | ', range, ' | ', shown, ' |'
      end select
   end subroutine write_key

   !> Adds a key to the group's line if it must be given or its value is not the default.
   subroutine add_if_other(self, name, value, must)
      class(key_writer_t), intent(inout) :: self
      character(*), intent(in) :: name, value
      logical, intent(in) :: must

      self%visits = self%visits + 1
      if (.not. self%active .or. (value == self%defaults(self%visits) .and. .not. must)) return
      if (index(self%line, ' = ') > 0) self%line = self%line//','
      if (len(self%line//name//value) + 6 > widest) then
         write (self%unit, '(a)') self%line
         self%line = '  '
      end if
      self%line = self%line//' '//name//' = '//value
   end subroutine add_if_other

   !> Text for a cell of a Markdown table, where a bar would end the cell.
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
