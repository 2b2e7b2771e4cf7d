!> What was found wrong or useless in the input, gathered to be told all at once.
module findings
   implicit none
   private

   public :: findings_t, place_t

   !> Where something stands: 'scene.nml:12', or the option of the command line that says it.
   type :: place_t
      character(:), allocatable :: text
      integer :: line = 0     !! in the file; 0 for the command line or the file as a whole
   end type place_t

   type :: finding_t
      character(:), allocatable :: text    ! the whole message, place included
      character(:), allocatable :: group   ! the namelist group it is about, or ''
      integer :: line = 0
   end type finding_t

   !> Mistakes forbid the run, warnings do not.
   type :: findings_t
      private
      type(finding_t), allocatable :: mistakes(:)
      type(finding_t), allocatable :: warnings(:)
   contains
      procedure :: mistake
      procedure :: warning
      procedure :: any_mistake
      procedure :: clean
      procedure :: mistake_text
      procedure :: warning_list
   end type findings_t

contains

   !> Notes a mistake.
   subroutine mistake(self, place, group, message)
      class(findings_t), intent(inout) :: self
      type(place_t), intent(in) :: place
      character(*), intent(in) :: group     !! namelist group it is about, or ''
      character(*), intent(in) :: message

      type(finding_t) :: item

      item%text = place%text//': '//message
      item%group = group
      item%line = place%line
      call append(self%mistakes, item)
   end subroutine mistake

   !> Notes something that is allowed but surely not meant, or has no effect.
   subroutine warning(self, place, message)
      class(findings_t), intent(inout) :: self
      type(place_t), intent(in) :: place
      character(*), intent(in) :: message

      type(finding_t) :: item

      item%text = place%text//': '//message
      item%group = ''
      item%line = place%line
      call append(self%warnings, item)
   end subroutine warning

   !> Puts a finding behind all those that stand no later in the file; what has no line comes last.
   subroutine append(list, item)
      type(finding_t), allocatable, intent(inout) :: list(:)
      type(finding_t), intent(in) :: item

      type(finding_t), allocatable :: longer(:)
      integer :: at, count_before, i

      count_before = 0
      if (allocated(list)) count_before = size(list)
      at = count_before + 1
      do while (at > 1)
         if (rank_of(list(at - 1)) <= rank_of(item)) exit
         at = at - 1
      end do
      allocate (longer(count_before + 1))
      do i = 1, at - 1
         longer(i) = list(i)
      end do
      longer(at) = item
      do i = at, count_before
         longer(i + 1) = list(i)
      end do
      call move_alloc(longer, list)
   end subroutine append

   !> Order of a finding in the report.
   pure integer function rank_of(item)
      type(finding_t), intent(in) :: item

      rank_of = merge(item%line, huge(1), item%line > 0)
   end function rank_of

   !> True once a mistake was noted.
   pure logical function any_mistake(self)
      class(findings_t), intent(in) :: self

      any_mistake = allocated(self%mistakes)
   end function any_mistake

   !> True while nothing wrong was noted about a group: its values can be trusted.
   pure logical function clean(self, group)
      class(findings_t), intent(in) :: self
      character(*), intent(in) :: group

      integer :: i

      clean = .true.
      if (.not. allocated(self%mistakes)) return
      do i = 1, size(self%mistakes)
         if (self%mistakes(i)%group == group) clean = .false.
      end do
   end function clean

   !> All mistakes, one a line, in the order of the file.
   pure function mistake_text(self) result(lines)
      class(findings_t), intent(in) :: self
      character(:), allocatable :: lines

      integer :: i

      lines = ''
      if (.not. allocated(self%mistakes)) return
      do i = 1, size(self%mistakes)
         if (i > 1) lines = lines//new_line('a')
         lines = lines//self%mistakes(i)%text
      end do
   end function mistake_text

   !> All warnings, in the order of the file, blank-padded to the longest.
   pure subroutine warning_list(self, list)
      class(findings_t), intent(in) :: self
      character(:), allocatable, intent(out) :: list(:)

      integer :: i, longest

      if (.not. allocated(self%warnings)) then
         allocate (character(1) :: list(0))
         return
      end if
      longest = 1
      do i = 1, size(self%warnings)
         longest = max(longest, len(self%warnings(i)%text))
      end do
      allocate (character(longest) :: list(size(self%warnings)))
      do i = 1, size(self%warnings)
         list(i) = self%warnings(i)%text
      end do
   end subroutine warning_list

end module findings
