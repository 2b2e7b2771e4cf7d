!> What can be done with a description of the input keys.
!!
!! Module `scene_keys` walks through all groups and keys once and tells each to a
!! visitor: the reader fetches values from a file, the writer prints them, or
!! the list of keys. So a key's name, range, unit and meaning stand in one place.
module key_visitor
   use kinds, only: dp
   use text, only: to_text
   implicit none
   private

   public :: key_visitor_t, range_t
   public :: above, at_least, between, any_number

   !> Numbers a key may have.
   type :: range_t
      real(dp) :: lower = -huge(1.0_dp)
      real(dp) :: upper = huge(1.0_dp)
      logical :: open_lower = .false.     !! the lower end itself is not allowed
   contains
      procedure :: holds
      procedure :: in_words
   end type range_t

   !> Visits groups and keys. A key's value on entry is its default.
   type, abstract :: key_visitor_t
      logical :: active = .true.                !! the key visited next has an effect in this scene
      character(:), allocatable :: condition    !! what it has an effect with, as in "shape = 'disc'"; '' for nothing
   contains
      procedure :: only_with
      procedure :: always
      procedure(announce_interface), deferred :: announce
      procedure(enter_interface), deferred :: enter
      procedure(leave_interface), deferred :: leave
      procedure(real_interface), deferred :: real_key
      procedure(real_or_word_interface), deferred :: real_or_word_key
      procedure(vector_interface), deferred :: vector_key
      procedure(integer_interface), deferred :: integer_key
      procedure(text_interface), deferred :: text_key
      procedure(choice_interface), deferred :: choice_key
      procedure(list_interface), deferred :: list_key
   end type key_visitor_t

   abstract interface
      !> Tells of a group, once, before its keys.
      subroutine announce_interface(self, name, meaning, required, repeatable)
         import :: key_visitor_t
         class(key_visitor_t), intent(inout) :: self
         character(*), intent(in) :: name, meaning
         logical, intent(in) :: required     !! the file must have one
         logical, intent(in) :: repeatable   !! it may have several
      end subroutine announce_interface

      !> Begins the keys of the number-th group of a name.
      subroutine enter_interface(self, name, number)
         import :: key_visitor_t
         class(key_visitor_t), intent(inout) :: self
         character(*), intent(in) :: name
         integer, intent(in) :: number
      end subroutine enter_interface

      !> Ends the keys of the group entered last.
      subroutine leave_interface(self)
         import :: key_visitor_t
         class(key_visitor_t), intent(inout) :: self
      end subroutine leave_interface

      !> A real number.
      subroutine real_interface(self, name, value, range, unit, meaning, required)
         import :: key_visitor_t, range_t, dp
         class(key_visitor_t), intent(inout) :: self
         character(*), intent(in) :: name, unit, meaning
         real(dp), intent(inout) :: value
         type(range_t), intent(in) :: range
         logical, intent(in), optional :: required
      end subroutine real_interface

      !> A real number, or a word in its place.
      subroutine real_or_word_interface(self, name, value, word, chosen, range, unit, meaning)
         import :: key_visitor_t, range_t, dp
         class(key_visitor_t), intent(inout) :: self
         character(*), intent(in) :: name, unit, meaning
         real(dp), intent(inout) :: value
         character(*), intent(in) :: word
         logical, intent(inout) :: chosen      !! the word stands there, value means nothing
         type(range_t), intent(in) :: range
      end subroutine real_or_word_interface

      !> A few real numbers, all of them wanted.
      subroutine vector_interface(self, name, value, range, unit, meaning, required)
         import :: key_visitor_t, range_t, dp
         class(key_visitor_t), intent(inout) :: self
         character(*), intent(in) :: name, unit, meaning
         real(dp), intent(inout) :: value(:)
         type(range_t), intent(in) :: range
         logical, intent(in), optional :: required
      end subroutine vector_interface

      !> A whole number.
      subroutine integer_interface(self, name, value, range, unit, meaning, required)
         import :: key_visitor_t, range_t
         class(key_visitor_t), intent(inout) :: self
         character(*), intent(in) :: name, unit, meaning
         integer, intent(inout) :: value
         type(range_t), intent(in) :: range
         logical, intent(in), optional :: required
      end subroutine integer_interface

      !> Free text, as long as the value can hold.
      subroutine text_interface(self, name, value, meaning, required)
         import :: key_visitor_t
         class(key_visitor_t), intent(inout) :: self
         character(*), intent(in) :: name, meaning
         character(*), intent(inout) :: value
         logical, intent(in), optional :: required
      end subroutine text_interface

      !> One word out of some.
      subroutine choice_interface(self, name, value, choices, meaning)
         import :: key_visitor_t
         class(key_visitor_t), intent(inout) :: self
         character(*), intent(in) :: name, meaning
         character(*), intent(inout) :: value
         character(*), intent(in) :: choices(:)
      end subroutine choice_interface

      !> One or more different words out of some.
      subroutine list_interface(self, name, values, used, choices, meaning)
         import :: key_visitor_t
         class(key_visitor_t), intent(inout) :: self
         character(*), intent(in) :: name, meaning
         character(*), intent(inout) :: values(:)
         integer, intent(inout) :: used           !! number of values in use
         character(*), intent(in) :: choices(:)
      end subroutine list_interface
   end interface

contains

   !> Says that the keys that follow have an effect only with something, and whether this scene has it.
   subroutine only_with(self, condition, holds)
      class(key_visitor_t), intent(inout) :: self
      character(*), intent(in) :: condition   !! in words
      logical, intent(in) :: holds

      self%condition = condition
      self%active = holds
   end subroutine only_with

   !> Says that the keys that follow have an effect in every scene.
   subroutine always(self)
      class(key_visitor_t), intent(inout) :: self

      call self%only_with('', .true.)
   end subroutine always

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

   !> A bound without the '.0' of a whole number.
   pure function bound_text(bound) result(words)
      real(dp), intent(in) :: bound
      character(:), allocatable :: words

      words = to_text(bound)
      if (len(words) > 2) then
         if (words(len(words) - 1:) == '.0') words = words(:len(words) - 2)
      end if
   end function bound_text

end module key_visitor
