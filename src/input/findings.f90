!> What was found wrong or useless in the input, gathered to be told all at once.
module findings
   use growing_text, only: growing_text_t
   use kinds, only: dp
   use settings, only: group_names
   use sorting, only: ascending
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
      logical :: forbids = .false.           ! the run
   end type finding_t

   !> Mistakes forbid the run, warnings do not.
   type :: findings_t
      character(:), allocatable :: file      !! its name, for messages
      type(finding_t), allocatable, private :: items(:)   ! (n) and room for more
      integer, private :: n = 0
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
   pure subroutine mistake(self, place, group, message)
      class(findings_t), intent(inout) :: self
      type(place_t), intent(in) :: place
      character(*), intent(in) :: group     !! namelist group whose values cannot be trusted then, or ''
      character(*), intent(in) :: message

      where (group_names == group) self%spoiled = .true.
      call append(self, place, message, forbids=.true.)
   end subroutine mistake

   !> Notes something that is allowed but surely not meant, or has no effect.
   pure subroutine warning(self, place, message)
      class(findings_t), intent(inout) :: self
      type(place_t), intent(in) :: place
      character(*), intent(in) :: message

      call append(self, place, message, forbids=.false.)
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

   pure subroutine append(self, place, message, forbids)
      class(findings_t), intent(inout) :: self
      type(place_t), intent(in) :: place
      character(*), intent(in) :: message
      logical, intent(in) :: forbids
      type(finding_t), allocatable :: longer(:)

      if (.not. allocated(self%items)) allocate (self%items(8))
      if (self%n == size(self%items)) then
         allocate (longer(2*self%n))
         longer(:self%n) = self%items
         call move_alloc(longer, self%items)
      end if
      self%n = self%n + 1
      associate (item => self%items(self%n))
         item%text = self%place_text(place)//': '//message
         item%line = place%line
         item%forbids = forbids
      end associate
   end subroutine append

   ! The mistakes, or the warnings, in the order of the file; what has no line comes last. Those of one line stay in the order
   ! in which they were found.
   pure subroutine sort_by_line(self, forbids, order)
      type(findings_t), intent(in) :: self
      logical, intent(in) :: forbids
      integer, allocatable, intent(out) :: order(:)
      integer :: i

      order = pack([(i, i=1, self%n)], [(self%items(i)%forbids .eqv. forbids, i=1, self%n)])
      order = order(ascending([(real(merge(self%items(order(i))%line, huge(1), self%items(order(i))%line > 0), dp), &
                                i=1, size(order))]))
   end subroutine sort_by_line

   !> True once a mistake was noted.
   pure logical function any_mistake(self)
      class(findings_t), intent(in) :: self
      integer :: i

      any_mistake = any([(self%items(i)%forbids, i=1, self%n)])
   end function any_mistake

   !> True while nothing wrong was noted about groups: their values can be trusted.
   pure logical function clean(self, groups)
      class(findings_t), intent(in) :: self
      character(*), intent(in) :: groups   !! names, parted by blanks
      integer :: g

      clean = .true.
      do g = 1, size(group_names)
         if (self%spoiled(g)) clean = clean .and. index(groups, trim(group_names(g))) == 0
      end do
   end function clean

   !> All mistakes, one a line, in the order of the file.
   pure function mistake_text(self) result(lines)
      class(findings_t), intent(in) :: self
      character(:), allocatable :: lines
      type(growing_text_t) :: all_of_them
      integer, allocatable :: order(:)
      integer :: i

      call sort_by_line(self, .true., order)
      do i = 1, size(order)
         if (i > 1) call all_of_them%add(new_line('a'))
         call all_of_them%add(self%items(order(i))%text)
      end do
      lines = all_of_them%text()
   end function mistake_text

   !> All warnings, in the order of the file, blank-padded to the longest.
   pure subroutine warning_list(self, list)
      class(findings_t), intent(in) :: self
      character(:), allocatable, intent(out) :: list(:)
      integer, allocatable :: order(:)
      integer :: i, longest

      call sort_by_line(self, .false., order)
      longest = max(1, maxval([(len(self%items(order(i))%text), i=1, size(order))]))
      allocate (character(longest) :: list(size(order)))
      do i = 1, size(order)
         list(i) = self%items(order(i))%text
      end do
   end subroutine warning_list

end module findings
