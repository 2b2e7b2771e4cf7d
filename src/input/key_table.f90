!> What is known of an input key, and where its value is: a row of the table that module `scene_keys` holds.
module key_table
   use kinds, only: dp
   use settings, only: name_length
   use text, only: quoted, to_text
   implicit none
   private

   public :: key_t, keys_t, range_t
   public :: above, at_least, between, any_number

   integer, parameter, public :: is_real = 1      !! a real number
   integer, parameter, public :: is_vector = 2    !! a few real numbers, all of them wanted
   integer, parameter, public :: is_whole = 3     !! a whole number
   integer, parameter, public :: is_text = 4      !! free text, as long as the value can hold
   integer, parameter, public :: is_choice = 5    !! one word out of some
   integer, parameter, public :: is_list = 6      !! some different words out of some

   integer, parameter :: most_keys = 16           ! of a group

   !> Numbers a key may have.
   type :: range_t
      real(dp) :: lower = -huge(1.0_dp)
      real(dp) :: upper = huge(1.0_dp)
      logical :: open_lower = .false.     !! the lower end itself is not allowed
   contains
      procedure :: holds
      procedure :: in_words
   end type range_t

   !> A key; its value is the component of the scene that it points to.
   type :: key_t
      character(:), allocatable :: name
      character(:), allocatable :: meaning
      character(:), allocatable :: unit        !! of numbers, else ''
      integer :: kind = 0
      type(range_t) :: range                   !! of numbers
      logical :: required = .false.
      character(:), allocatable :: condition   !! what it has an effect with, as in "shape = 'disc'"; '' for nothing
      logical :: active = .true.               !! the scene has that
      character(name_length), allocatable :: choices(:)
      real(dp), pointer :: number => null()
      logical, pointer :: chosen => null()     !! choices(1) stands in the place of the number
      real(dp), pointer :: vector(:) => null()
      integer, pointer :: whole => null()
      character(:), pointer :: words => null()         !! of text and choices
      character(name_length), pointer :: list(:) => null()
      integer, pointer :: used => null()       !! words of the list
   contains
      procedure :: length
      procedure :: value_text
      procedure :: range_text
      procedure :: choice_text
   end type key_t

   !> The keys of a group. What is said by `only_with` holds for those that are added behind it.
   type :: keys_t
      integer :: n = 0
      type(key_t) :: items(most_keys)
      character(:), allocatable, private :: condition
      logical, private :: active = .true.
   contains
      procedure :: only_with
      procedure :: always
      procedure :: real_key
      procedure :: vector_key
      procedure :: whole_key
      procedure :: text_key
      procedure :: choice_key
      procedure :: list_key
      procedure, private :: add
   end type keys_t

contains

   !> Says that the keys that follow have an effect only with something, and whether this scene has it.
   subroutine only_with(self, condition, holds)
      class(keys_t), intent(inout) :: self
      character(*), intent(in) :: condition   !! in words
      logical, intent(in) :: holds

      self%condition = condition
      self%active = holds
   end subroutine only_with

   !> Says that the keys that follow have an effect in every scene.
   subroutine always(self)
      class(keys_t), intent(inout) :: self

      call self%only_with('', .true.)
   end subroutine always

   !> Adds a real number, which may have a word in its place.
   subroutine real_key(self, name, value, range, unit, meaning, required, word, chosen)
      class(keys_t), intent(inout), target :: self
      character(*), intent(in) :: name, unit, meaning
      real(dp), intent(inout), target :: value
      type(range_t), intent(in) :: range
      logical, intent(in), optional :: required
      character(*), intent(in), optional :: word
      logical, intent(inout), optional, target :: chosen   !! the word stands there, value means nothing
      type(key_t), pointer :: key

      call self%add(is_real, name, meaning, required, key)
      key%unit = unit
      key%range = range
      key%number => value
      if (.not. present(word)) return
      key%choices = [character(name_length) :: word]
      key%chosen => chosen
   end subroutine real_key

   !> Adds a few real numbers.
   subroutine vector_key(self, name, value, range, unit, meaning, required)
      class(keys_t), intent(inout), target :: self
      character(*), intent(in) :: name, unit, meaning
      real(dp), intent(inout), target :: value(:)
      type(range_t), intent(in) :: range
      logical, intent(in), optional :: required
      type(key_t), pointer :: key

      call self%add(is_vector, name, meaning, required, key)
      key%unit = unit
      key%range = range
      key%vector => value
   end subroutine vector_key

   !> Adds a whole number.
   subroutine whole_key(self, name, value, range, unit, meaning)
      class(keys_t), intent(inout), target :: self
      character(*), intent(in) :: name, unit, meaning
      integer, intent(inout), target :: value
      type(range_t), intent(in) :: range
      type(key_t), pointer :: key

      call self%add(is_whole, name, meaning, .false., key)
      key%unit = unit
      key%range = range
      key%whole => value
   end subroutine whole_key

   !> Adds free text.
   subroutine text_key(self, name, value, meaning, required)
      class(keys_t), intent(inout), target :: self
      character(*), intent(in) :: name, meaning
      character(*), intent(inout), target :: value
      logical, intent(in), optional :: required
      type(key_t), pointer :: key

      call self%add(is_text, name, meaning, required, key)
      key%words => value
   end subroutine text_key

   !> Adds one word out of some.
   subroutine choice_key(self, name, value, choices, meaning)
      class(keys_t), intent(inout), target :: self
      character(*), intent(in) :: name, meaning
      character(*), intent(inout), target :: value
      character(*), intent(in) :: choices(:)
      type(key_t), pointer :: key

      call self%add(is_choice, name, meaning, .false., key)
      key%words => value
      key%choices = [character(name_length) :: choices]
   end subroutine choice_key

   !> Adds some words out of some.
   subroutine list_key(self, name, values, used, choices, meaning)
      class(keys_t), intent(inout), target :: self
      character(*), intent(in) :: name, meaning
      character(name_length), intent(inout), target :: values(:)
      integer, intent(inout), target :: used
      character(*), intent(in) :: choices(:)
      type(key_t), pointer :: key

      call self%add(is_list, name, meaning, .false., key)
      key%list => values
      key%used => used
      key%choices = [character(name_length) :: choices]
   end subroutine list_key

   subroutine add(self, kind, name, meaning, required, key)
      class(keys_t), intent(inout), target :: self
      integer, intent(in) :: kind
      character(*), intent(in) :: name, meaning
      logical, intent(in), optional :: required
      type(key_t), pointer, intent(out) :: key

      if (.not. allocated(self%condition)) self%condition = ''
      self%n = self%n + 1
      key => self%items(self%n)
      key%kind = kind
      key%name = name
      key%meaning = meaning
      key%unit = ''
      key%condition = self%condition
      key%active = self%active
      if (present(required)) key%required = required
   end subroutine add

   !> Number of values that the key can hold; 1: no array.
   pure integer function length(self)
      class(key_t), intent(in) :: self

      length = 1
      if (self%kind == is_vector) length = size(self%vector)
      if (self%kind == is_list) length = size(self%list)
   end function length

   !> The value as a namelist has it.
   pure function value_text(self) result(words)
      class(key_t), intent(in) :: self
      character(:), allocatable :: words

      select case (self%kind)
      case (is_real)
         words = to_text(self%number)
         if (associated(self%chosen)) then
            if (self%chosen) words = quoted(self%choices(1))
         end if
      case (is_vector)
         words = to_text(self%vector)
      case (is_whole)
         words = to_text(self%whole)
      case (is_list)
         words = listed(self%list(:self%used))
      case default
         words = quoted(self%words)
      end select
   end function value_text

   !> What the value may be.
   pure function range_text(self) result(words)
      class(key_t), intent(in) :: self
      character(:), allocatable :: words

      select case (self%kind)
      case (is_text)
         words = 'text, up to '//to_text(len(self%words))//' letters'
      case (is_choice)
         words = self%choice_text()
      case (is_list)
         words = 'some of '//self%choice_text()
      case default
         words = self%range%in_words()
         if (associated(self%chosen)) words = words//', or '//quoted(self%choices(1))
      end select
   end function range_text

   !> The words that there are.
   pure function choice_text(self) result(words)
      class(key_t), intent(in) :: self
      character(:), allocatable :: words

      words = listed(self%choices)
   end function choice_text

   ! Words in quotes, parted by commas.
   pure function listed(words) result(line)
      character(*), intent(in) :: words(:)
      character(:), allocatable :: line
      integer :: i

      line = ''
      do i = 1, size(words)
         if (i > 1) line = line//', '
         line = line//quoted(words(i))
      end do
   end function listed

   !> Numbers above a bound.
   pure type(range_t) function above(lower)
      real(dp), intent(in) :: lower

      above = range_t(lower=lower, open_lower=.true.)
   end function above

   !> Numbers from a bound upwards.
   pure type(range_t) function at_least(lower)
      real(dp), intent(in) :: lower

      at_least = range_t(lower=lower)
   end function at_least

   !> Numbers from a bound to another, both included.
   pure type(range_t) function between(lower, upper)
      real(dp), intent(in) :: lower, upper

      between = range_t(lower=lower, upper=upper)
   end function between

   !> Any number.
   pure type(range_t) function any_number()

      any_number = range_t()
   end function any_number

   !> True for a number in the range.
   pure logical function holds(self, number)
      class(range_t), intent(in) :: self
      real(dp), intent(in) :: number

      holds = number >= self%lower .and. number <= self%upper
      if (self%open_lower) holds = holds .and. number > self%lower
   end function holds

   !> The range in words: 'above 0', 'at least 0', '4 to 20000' or 'any'.
   pure function in_words(self) result(words)
      class(range_t), intent(in) :: self
      character(:), allocatable :: words

      if (self%upper < huge(self%upper)) then
         words = bound_text(self%lower)//' to '//bound_text(self%upper)
      else if (self%open_lower) then
         words = 'above '//bound_text(self%lower)
      else if (self%lower > -huge(self%lower)) then
         words = 'at least '//bound_text(self%lower)
      else
         words = 'any'
      end if
   end function in_words

   ! A bound without the '.0' of a whole number.
   pure function bound_text(bound) result(words)
      real(dp), intent(in) :: bound
      character(:), allocatable :: words

      words = to_text(bound)
      if (index(words, '.0', back=.true.) == len(words) - 1 .and. len(words) > 2) words = words(:len(words) - 2)
   end function bound_text

end module key_table
