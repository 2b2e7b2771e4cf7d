!> What was found wrong or useless in the input, gathered to be told all at once.
module findings
   use growing_text, only: growing_text_t
   use settings, only: group_names
   use text, only: to_text
   implicit none
   private

   public :: findings_t, place_t

   !> Where something stands.
   type :: place_t
      integer :: line = 0                    !! in the file; 0: the file as a whole, or the command line
      character(:), allocatable :: option    !! of the command line that says it
   end type place_t

   type :: finding_t
      character(:), allocatable :: text      ! the whole message, place included
      integer :: line = 0
   end type finding_t

   type :: list_t
      type(finding_t), allocatable :: items(:)   ! (n) and room for more
      integer :: n = 0
   end type list_t

   !> Mistakes forbid the run, warnings do not.
   type :: findings_t
      character(:), allocatable :: file      !! its name, for messages
      type(list_t), private :: mistakes, warnings
      logical, private :: spoiled(size(group_names)) = .false.
   contains
      procedure :: mistake
      procedure :: warning
      procedure :: any_mistake
      procedure :: clean
      procedure :: mistake_text
      procedure :: warning_list
      procedure :: place_text
   end type findings_t

contains

   !> Notes a mistake.
   subroutine mistake(self, place, group, message)
      class(findings_t), intent(inout) :: self
      type(place_t), intent(in) :: place
      character(*), intent(in) :: group     !! namelist group whose values cannot be trusted then, or ''
      character(*), intent(in) :: message

      where (group_names == group) self%spoiled = .true.
      call append(self%mistakes, self%place_text(place)//': '//message, place%line)
   end subroutine mistake

   !> Notes something that is allowed but surely not meant, or has no effect.
   subroutine warning(self, place, message)
      class(findings_t), intent(inout) :: self
      type(place_t), intent(in) :: place
      character(*), intent(in) :: message

      call append(self%warnings, self%place_text(place)//': '//message, place%line)
   end subroutine warning

   !> 'scene.nml:12', or the option of the command line.
   pure function place_text(self, place) result(words)
      class(findings_t), intent(in) :: self
      type(place_t), intent(in) :: place
      character(:), allocatable :: words

      words = self%file
      if (allocated(place%option)) words = place%option
      if (place%line > 0) words = words//':'//to_text(place%line)
   end function place_text

   subroutine append(list, text, line)
      type(list_t), intent(inout) :: list
      character(*), intent(in) :: text
      integer, intent(in) :: line
      type(finding_t), allocatable :: longer(:)
      integer :: i

      if (.not. allocated(list%items)) allocate (list%items(8))
      if (list%n == size(list%items)) then
         allocate (longer(2*list%n))
         do i = 1, list%n
            call move_alloc(list%items(i)%text, longer(i)%text)
            longer(i)%line = list%items(i)%line
         end do
         call move_alloc(longer, list%items)
      end if
      list%n = list%n + 1
      list%items(list%n)%text = text
      list%items(list%n)%line = line
   end subroutine append

   ! In the order of the file; what has no line comes last. Those of one line stay in the order in which they were found.
   pure function file_order(list) result(order)
      type(list_t), intent(in) :: list
      integer :: order(list%n)
      integer, allocatable :: first(:)
      integer :: i, last, line

      order = [(i, i=1, list%n)]
      if (list%n == 0) return
      last = maxval(list%items(:list%n)%line) + 1
      allocate (first(0:last + 1), source=0)
      do i = 1, list%n
         line = line_of(list%items(i))
         first(line + 1) = first(line + 1) + 1
      end do
      do line = 1, last
         first(line) = first(line) + first(line - 1)
      end do
      do i = 1, list%n
         line = line_of(list%items(i))
         first(line) = first(line) + 1
         order(first(line)) = i
      end do

   contains

      pure integer function line_of(item)
         type(finding_t), intent(in) :: item

         line_of = merge(item%line, last, item%line > 0)
      end function line_of

   end function file_order

   !> True once a mistake was noted.
   pure logical function any_mistake(self)
      class(findings_t), intent(in) :: self

      any_mistake = self%mistakes%n > 0
   end function any_mistake

   !> True while nothing wrong was noted about a group: its values can be trusted.
   pure logical function clean(self, group)
      class(findings_t), intent(in) :: self
      character(*), intent(in) :: group

      clean = .not. any(self%spoiled .and. group_names == group)
   end function clean

   !> All mistakes, one a line, in the order of the file.
   pure function mistake_text(self) result(lines)
      class(findings_t), intent(in) :: self
      character(:), allocatable :: lines
      type(growing_text_t) :: all_of_them
      integer :: order(self%mistakes%n), i

      order = file_order(self%mistakes)
      do i = 1, size(order)
         if (i > 1) call all_of_them%add(new_line('a'))
         call all_of_them%add(self%mistakes%items(order(i))%text)
      end do
      lines = all_of_them%text()
   end function mistake_text

   !> All warnings, in the order of the file, blank-padded to the longest.
   pure subroutine warning_list(self, list)
      class(findings_t), intent(in) :: self
      character(:), allocatable, intent(out) :: list(:)
      integer :: order(self%warnings%n), i, longest

      order = file_order(self%warnings)
      longest = 1
      do i = 1, size(order)
         longest = max(longest, len(self%warnings%items(i)%text))
      end do
      allocate (character(longest) :: list(size(order)))
      do i = 1, size(order)
         list(i) = self%warnings%items(order(i))%text
      end do
   end subroutine warning_list

end module findings
