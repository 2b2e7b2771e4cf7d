!> Puts `--set group.key=value` of the command line in the place of what a file says.
module overrides
   use document, only: document_t, entry_t, group_t
   use findings, only: findings_t
   use text, only: lower_case, parse_integer, quoted, to_text
   implicit none
   private

   public :: apply_override

   character, parameter :: dropped = '-'   ! no name of a key
   character(*), parameter :: wanted = '; write --set group.key=value or --set body(2).key=value'

contains

   !> Puts one override into a document.
   subroutine apply_override(phrase, document, notes)
      character(*), intent(in) :: phrase             !! 'group.key=value'
      type(document_t), intent(inout) :: document
      type(findings_t), intent(inout) :: notes
      type(entry_t) :: item
      type(group_t) :: new_group
      character(:), allocatable :: name, problem
      integer :: at, dot, equals, i, number

      item%place%option = 'command line: --set '//trim(phrase)
      problem = ''
      at = 0
      equals = index(phrase, '=')
      dot = index(phrase(:max(equals - 1, 0)), '.')
      if (equals == 0) then
         problem = "there is no '='"//wanted
      else if (dot == 0) then
         problem = "there is no '.' between group and key"//wanted
      else if (phrase(equals + 1:) == '') then
         problem = "there is no value behind the '='"//wanted
      else
         item%option = trim(phrase(equals + 1:))
         call split_index(phrase(dot + 1:equals - 1), item%key, item%element, problem)
         if (problem == '') call split_index(phrase(:dot - 1), name, number, problem)
         if (problem == '') call find_group(document, notes%file, name, number, at, problem)
      end if
      if (problem /= '') then
         call notes%mistake(item%place, '', problem)
         return
      end if
      if (at == 0) then
         new_group%name = name
         new_group%place = item%place
         call document%add_group(new_group)
         at = document%n
      end if
      associate (there => document%groups(at))
         do i = 1, there%n
            if (there%entries(i)%key /= item%key) cycle
            if (item%element > 0 .and. there%entries(i)%element /= item%element) cycle
            there%entries(i)%key = dropped
            there%entries(i)%known = .true.
         end do
         call there%add_entry(item)
      end associate
   end subroutine apply_override

   ! Parts 'Name(2)' into 'name' and 2, 'Name' into 'name' and 0.
   pure subroutine split_index(words, name, number, problem)
      character(*), intent(in) :: words
      character(:), allocatable, intent(out) :: name
      integer, intent(out) :: number
      character(:), allocatable, intent(out) :: problem      ! '' if it has this form
      character(:), allocatable :: phrase
      integer :: open_at

      problem = ''
      number = 0
      phrase = trim(adjustl(lower_case(words)))
      open_at = index(phrase, '(')
      name = phrase
      if (open_at > 0) then
         name = trim(phrase(:open_at - 1))
         if (phrase(len(phrase):) /= ')') then
            problem = quoted(phrase)//' has no closing bracket'
            return
         end if
         call parse_integer(trim(adjustl(phrase(open_at + 1:len(phrase) - 1))), number, problem)
         if (problem == '' .and. number < 1) problem = quoted(phrase)//' is not counted from 1'
      end if
      if (problem == '' .and. name == '') problem = 'a name is missing'//wanted
   end subroutine split_index

   ! The group that is meant; 0 if the file has none of that name yet.
   pure subroutine find_group(document, file, name, number, at, problem)
      type(document_t), intent(in) :: document
      character(*), intent(in) :: file, name
      integer, intent(in) :: number              ! 0: not said
      integer, intent(out) :: at
      character(:), allocatable, intent(out) :: problem
      integer :: there

      problem = ''
      there = document%count_of(name)
      at = document%index_of(name, max(number, 1))
      if (number == 0 .and. there > 1) then
         problem = 'there are '//to_text(there)//' groups &'//name//'; say '//name//'(1) to '//name//'('//to_text(there)//')'
      else if (number > max(there, 1)) then
         problem = 'there is no group &'//name//' number '//to_text(number)//' in '//file//', only '//to_text(there)
      end if
   end subroutine find_group

end module overrides
