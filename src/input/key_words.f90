!> The words given for a key: how many it takes, and those behind --set.
module key_words
   use findings, only: findings_t
   use namelist_document, only: entry_t, value_t
   use namelist_text, only: scan_words
   use text, only: to_text
   implicit none
   private

   public :: take_option, count_problem, shown_values

   integer, parameter, public :: all_values = 1    !! the key wants all its values
   integer, parameter, public :: some_values = 2   !! it takes fewer
   integer, parameter, public :: free_text = 3     !! it takes any text

contains

   !> Takes the text behind --set group.key= apart; free text without quotes is kept as it is.
   subroutine take_option(item, style, notes, group)
      type(entry_t), intent(inout) :: item
      integer, intent(in) :: style
      type(findings_t), intent(inout) :: notes
      character(*), intent(in) :: group

      if (style == free_text .and. scan(adjustl(item%raw), '"'//"'") /= 1) then
         call item%add_value(trim(adjustl(item%raw)), .true.)
      else
         call scan_words(item%raw, item, notes, group)
         if (allocated(item%values)) item%values%needs_quotes = .false.
      end if
   end subroutine take_option

   !> Says what is wrong with the number of values, '' when nothing is.
   pure function count_problem(element, length, n, fewer_allowed) result(problem)
      integer, intent(in) :: element, length, n   !! element set or 0, values kept, values given
      logical, intent(in) :: fewer_allowed
      character(:), allocatable :: problem

      problem = ''
      if (element > 0 .and. length == 1) then
         problem = '('//to_text(element)//') is set, but it is not an array'
      else if (element > length) then
         problem = '('//to_text(element)//') is set, but it has only '//to_text(length)//' values'
      else if (element > 0 .and. n /= 1) then
         problem = '('//to_text(element)//') takes 1 value, not '//to_text(n)
      else if (element == 0 .and. fewer_allowed .and. n > length) then
         problem = ' takes at most '//to_text(length)//' values, not '//to_text(n)
      else if (element == 0 .and. .not. fewer_allowed .and. n /= length) then
         problem = ' takes '//to_text(length)//trim(merge(' value ', ' values', length == 1))//', not '//to_text(n)
      end if
   end function count_problem

   !> The first few values, for a message.
   pure function shown_values(values) result(line)
      type(value_t), intent(in) :: values(:)
      character(:), allocatable :: line

      integer, parameter :: shown = 4
      integer :: i

      line = values(1)%text
      do i = 2, min(shown, size(values))
         line = line//' | '//values(i)%text
      end do
      if (size(values) > shown) line = line//' ...'
   end function shown_values

end module key_words
