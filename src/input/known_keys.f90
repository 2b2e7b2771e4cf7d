!> Keys and groups that exist, and what is said when one is missing, misspelt or has no effect.
module known_keys
   use text, only: nearest_word
   implicit none
   private

   public :: known_t, suggest, described, idle_text, same_choice

   integer, parameter, public :: name_length = 40   !! of names and conditions
   integer, parameter :: meaning_length = 160

   !> A key or group that exists.
   type :: known_t
      character(name_length) :: name = ''
      character(meaning_length) :: meaning = ''
      logical :: missing = .false.          ! required, but not given
      character(name_length) :: condition = ''   ! what it has an effect with; '' for nothing
   end type known_t

contains

   !> Says what an unknown name may have meant; that one is then not called missing as well.
   subroutine suggest(name, mark, known, hint, meant)
      character(*), intent(in) :: name
      character(*), intent(in) :: mark                   !! '&' for groups
      type(known_t), intent(inout) :: known(:)
      character(:), allocatable, intent(out) :: hint
      character(:), allocatable, intent(out) :: meant    !! '' if nothing is like it

      character(name_length) :: names(size(known))

      names = known%name
      meant = nearest_word(name, names)
      if (meant == '') then
         hint = 'dynsph --keys lists what there is'
      else
         hint = "did you mean '"//mark//meant//"'?"
         where (known%name == meant) known%missing = .false.
      end if
   end subroutine suggest

   !> Name and meaning of a key or group.
   pure function described(known) result(line)
      type(known_t), intent(in) :: known
      character(:), allocatable :: line

      line = trim(known%name)//': '//trim(known%meaning)
   end function described

   !> That a key has no effect, and why.
   pure function idle_text(group, key) result(line)
      character(*), intent(in) :: group
      type(known_t), intent(in) :: key
      character(:), allocatable :: line

      line = '&'//group//' '//trim(key%name)//' has no effect without '//trim(key%condition)
   end function idle_text

   !> Whether two conditions are about one key, as "shape = 'disc'" and "shape = 'rectangle'" are.
   pure logical function same_choice(one, other)
      character(*), intent(in) :: one, other

      same_choice = index(one, '=') > 0
      if (same_choice) same_choice = index(other, one(:index(one, '='))) == 1
   end function same_choice

end module known_keys
