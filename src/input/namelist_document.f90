!> A namelist file taken apart: its groups, their keys, the values as written and where.
module namelist_document
   use findings, only: place_t
   use text, only: to_text
   implicit none
   private

   public :: document_t, group_t, entry_t, value_t

   !> One value as written; quotes are taken off.
   type :: value_t
      character(:), allocatable :: text
      logical :: quoted = .false.
      logical :: needs_quotes = .true.       !! not on the command line, where the shell takes them
   end type value_t

   !> `key = values` or `key(element) = value`.
   type :: entry_t
      character(:), allocatable :: key       !! in lower case
      integer :: element = 0                 !! 0: the whole key
      type(place_t) :: place
      type(value_t), allocatable :: values(:)
      logical :: broken = .false.            !! a mistake in it is noted already
      character(:), allocatable :: raw       !! text behind the '=' of --set, not taken apart yet
      logical :: known = .false.             !! asked for by the reader
   contains
      procedure :: add_value
   end type entry_t

   !> One group from its & to its /.
   type :: group_t
      character(:), allocatable :: name      !! in lower case
      type(place_t) :: place
      type(entry_t), allocatable :: entries(:)
   contains
      procedure :: add_entry
      procedure :: drop_entry
      procedure :: entry_count
   end type group_t

   !> All groups of a file in their order.
   type :: document_t
      character(:), allocatable :: file
      type(group_t), allocatable :: groups(:)
   contains
      procedure :: add_group
      procedure :: group_count
      procedure :: count_of
      procedure :: index_of
      procedure :: entry_of
      procedure :: given
      procedure :: place_of
      procedure :: line_place
   end type document_t

contains

   !> Appends a value.
   subroutine add_value(self, word, in_quotes)
      class(entry_t), intent(inout) :: self
      character(*), intent(in) :: word
      logical, intent(in) :: in_quotes

      type(value_t), allocatable :: longer(:)
      integer :: i, n

      n = 0
      if (allocated(self%values)) n = size(self%values)
      allocate (longer(n + 1))
      do i = 1, n
         longer(i) = self%values(i)
      end do
      longer(n + 1)%text = word
      longer(n + 1)%quoted = in_quotes
      call move_alloc(longer, self%values)
   end subroutine add_value

   !> Appends a key.
   subroutine add_entry(self, item)
      class(group_t), intent(inout) :: self
      type(entry_t), intent(in) :: item

      type(entry_t), allocatable :: longer(:)
      integer :: i

      allocate (longer(self%entry_count() + 1))
      do i = 1, self%entry_count()
         longer(i) = self%entries(i)
      end do
      longer(size(longer)) = item
      call move_alloc(longer, self%entries)
   end subroutine add_entry

   !> Takes a key out, because a later one stands for it.
   subroutine drop_entry(self, at)
      class(group_t), intent(inout) :: self
      integer, intent(in) :: at

      type(entry_t), allocatable :: shorter(:)
      integer :: i, kept

      allocate (shorter(size(self%entries) - 1))
      kept = 0
      do i = 1, size(self%entries)
         if (i == at) cycle
         kept = kept + 1
         shorter(kept) = self%entries(i)
      end do
      call move_alloc(shorter, self%entries)
   end subroutine drop_entry

   !> Number of keys.
   pure integer function entry_count(self)
      class(group_t), intent(in) :: self

      entry_count = 0
      if (allocated(self%entries)) entry_count = size(self%entries)
   end function entry_count

   !> Appends a group.
   subroutine add_group(self, item)
      class(document_t), intent(inout) :: self
      type(group_t), intent(in) :: item

      type(group_t), allocatable :: longer(:)
      integer :: i

      allocate (longer(self%group_count() + 1))
      do i = 1, self%group_count()
         longer(i) = self%groups(i)
      end do
      longer(size(longer)) = item
      call move_alloc(longer, self%groups)
   end subroutine add_group

   !> Number of groups.
   pure integer function group_count(self)
      class(document_t), intent(in) :: self

      group_count = 0
      if (allocated(self%groups)) group_count = size(self%groups)
   end function group_count

   !> Number of groups of one name.
   pure integer function count_of(self, name)
      class(document_t), intent(in) :: self
      character(*), intent(in) :: name

      integer :: i

      count_of = 0
      do i = 1, self%group_count()
         if (self%groups(i)%name == name) count_of = count_of + 1
      end do
   end function count_of

   !> Position of the number-th group of a name, 0 if there is none.
   pure integer function index_of(self, name, number)
      class(document_t), intent(in) :: self
      character(*), intent(in) :: name
      integer, intent(in) :: number

      integer :: i, seen

      index_of = 0
      seen = 0
      do i = 1, self%group_count()
         if (self%groups(i)%name /= name) cycle
         seen = seen + 1
         if (seen == number) index_of = i
      end do
   end function index_of

   !> Position of a key's last mention in a group, 0 if it is not there.
   pure integer function entry_of(self, group, key)
      class(document_t), intent(in) :: self
      integer, intent(in) :: group           !! position of the group, 0 for none
      character(*), intent(in) :: key

      integer :: i

      entry_of = 0
      if (group == 0) return
      do i = 1, self%groups(group)%entry_count()
         if (self%groups(group)%entries(i)%key == key) entry_of = i
      end do
   end function entry_of

   !> True when the input itself names a key.
   pure logical function given(self, name, number, key)
      class(document_t), intent(in) :: self
      character(*), intent(in) :: name
      integer, intent(in) :: number
      character(*), intent(in) :: key

      given = self%entry_of(self%index_of(name, number), key) > 0
   end function given

   !> Where a key stands; where its group starts if it is not given; the file if that is not there either.
   pure type(place_t) function place_of(self, name, number, key)
      class(document_t), intent(in) :: self
      character(*), intent(in) :: name
      integer, intent(in) :: number
      character(*), intent(in) :: key        !! '' for the group itself

      integer :: group, item

      group = self%index_of(name, number)
      item = self%entry_of(group, key)
      if (item > 0) then
         place_of = self%groups(group)%entries(item)%place
      else if (group > 0) then
         place_of = self%groups(group)%place
      else
         ! By component: gfortran 12's constructor loses the length of a deferred-length text.
         place_of%text = self%file
         place_of%line = 0
      end if
   end function place_of

   !> A line of the file as a place.
   pure type(place_t) function line_place(self, line)
      class(document_t), intent(in) :: self
      integer, intent(in) :: line

      line_place%text = self%file//':'//to_text(line)
      line_place%line = line
   end function line_place

end module namelist_document
