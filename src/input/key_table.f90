!> What is known of an input key, and where its value is: a row of the table that module `scene_keys` holds.
module key_table
   use growing_text, only: growing_text_t
   use kinds, only: dp
   use settings, only: choice_length, name_length, number_list_t
   use text, only: quoted, short, to_text
   implicit none
   private

   public :: key_t, keys_t, range_t, listed

   integer, parameter :: most_keys = 32           ! of a group
   integer, parameter :: per_line = 4             ! numbers of a long list

   !> Numbers a key may have.
   type :: range_t
      real(dp) :: lower = -huge(1.0_dp)
      real(dp) :: upper = huge(1.0_dp)
      logical :: open_lower = .false.     !! the lower end itself is not allowed
   contains
      procedure :: holds
      procedure :: in_words
   end type range_t

   type(range_t), parameter, public :: positive = range_t(lower=0.0_dp, open_lower=.true.)
   type(range_t), parameter, public :: not_negative = range_t(lower=0.0_dp)

   !> A key; its value is that component of the scene to which one of these points:
   !! `number`, `vector` (all its numbers are wanted), `numbers` (as many as there are), `whole`, `words` (free text, or one word
   !! out of `choices`), `list` (some different words out of `choices`).
   type :: key_t
      character(name_length) :: name = ''
      character(200) :: meaning = ''
      character(16) :: unit = ''               !! of numbers
      type(range_t) :: range = range_t()       !! of numbers
      logical :: required = .false.
      real(dp), pointer :: number => null()
      real(dp), pointer :: vector(:) => null()
      type(number_list_t), pointer :: numbers => null()
      integer, pointer :: whole => null()
      character(choice_length), allocatable :: choices(:)
      logical, pointer :: chosen => null()     !! choices(1) stands in the place of the number
      character(name_length), pointer :: list(:) => null()
      integer, pointer :: used => null()       !! words of the list
      character(:), pointer :: words => null()
      logical :: follows = .false.             !! from other keys, where it is not given
      character(64) :: condition = ''          !! what it has an effect with, as in "shape = 'disc'"; '' for nothing
      logical :: active = .true.               !! the scene has that
   contains
      procedure :: length
      procedure :: value_text
      procedure :: range_text
   end type key_t

   !> The keys of a group. What is said by `only_with` holds for those that are added behind it.
   type :: keys_t
      integer :: n = 0
      type(key_t) :: items(most_keys)
      character(64), private :: condition = ''
      logical, private :: active = .true.
   contains
      procedure :: only_with
      procedure :: add
   end type keys_t

contains

   !> Says that the keys that follow have an effect only with something, and whether this scene has it.
   subroutine only_with(self, condition, holds)
      class(keys_t), intent(inout) :: self
      character(*), intent(in) :: condition   !! in words; '' if they always have
      logical, intent(in) :: holds

      self%condition = condition
      self%active = holds
   end subroutine only_with

   !> Adds a key.
   subroutine add(self, key, words)
      class(keys_t), intent(inout) :: self
      type(key_t), intent(in) :: key
      character(*), intent(inout), target, optional :: words   !! gfortran 12 loses their length in the constructor of a key

      self%n = self%n + 1
      self%items(self%n) = key
      self%items(self%n)%condition = self%condition
      self%items(self%n)%active = self%active
      if (present(words)) self%items(self%n)%words => words
   end subroutine add

   !> Number of values that the key can hold; 1: no array.
   pure integer function length(self)
      class(key_t), intent(in) :: self

      length = 1
      if (associated(self%vector)) length = size(self%vector)
      if (associated(self%list)) length = size(self%list)
   end function length

   !> The value as a namelist has it; a long list of numbers takes several lines.
   pure function value_text(self) result(words)
      class(key_t), intent(in) :: self
      character(:), allocatable :: words

      if (associated(self%number)) words = to_text(self%number)
      if (associated(self%vector)) words = to_text(self%vector)
      if (associated(self%numbers)) words = in_lines(self%numbers)
      if (associated(self%whole)) words = to_text(self%whole)
      if (associated(self%words)) words = quoted(self%words)
      if (associated(self%list)) words = listed(self%list(:self%used))
      if (associated(self%chosen)) then
         if (self%chosen) words = quoted(self%choices(1))
      end if
   end function value_text

   ! Numbers parted by commas, on as many lines as it takes.
   pure function in_lines(numbers) result(words)
      type(number_list_t), intent(in) :: numbers
      character(:), allocatable :: words
      type(growing_text_t) :: lines
      integer :: i

      do i = 1, numbers%n()
         if (i > 1) call lines%add(',')
         if (i > 1 .and. mod(i, per_line) == 1) call lines%add(new_line('a')//'     ')
         if (i > 1) call lines%add(' ')
         call lines%add(to_text(numbers%values(i)))
      end do
      words = lines%text()
   end function in_lines

   !> What the value may be.
   pure function range_text(self) result(words)
      class(key_t), intent(in) :: self
      character(:), allocatable :: words

      if (associated(self%list)) then
         words = 'some of '//listed(self%choices)
      else if (associated(self%numbers)) then
         words = 'list of numbers'
      else if (.not. associated(self%words)) then
         words = self%range%in_words()
         if (associated(self%chosen)) words = words//', or '//quoted(self%choices(1))
      else if (allocated(self%choices)) then
         words = listed(self%choices)
      else
         words = 'text, up to '//to_text(len(self%words))//' letters'
      end if
   end function range_text

   !> Words in quotes, parted by commas.
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
         words = short(self%lower)//' to '//short(self%upper)
      else if (self%open_lower) then
         words = 'above '//short(self%lower)
      else if (self%lower > -huge(self%lower)) then
         words = 'at least '//short(self%lower)
      else
         words = 'any'
      end if
   end function in_words

end module key_table
