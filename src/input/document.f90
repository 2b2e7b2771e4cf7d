!> A namelist file taken apart: its groups, their keys, the values as written and where.
module document
   use findings, only: place_t
   use name_table, only: name_table_t
   use settings, only: most_numbers
   use text, only: to_text
   implicit none
   private

   public :: document_t, group_t, entry_t, value_t

   character, parameter :: parted = achar(0)    ! no name has this letter
   integer, parameter :: most_kept = most_numbers   ! values of a key; more are only counted

   !> One value as written; quotes are taken off.
   type :: value_t
      character(:), allocatable :: text
      logical :: quoted = .false.
   end type value_t

   !> `key = values` or `key(element) = value`.
   type :: entry_t
      character(:), allocatable :: key       !! in lower case
      integer :: element = 0                 !! 0: the whole key
      type(place_t) :: place
      type(value_t), allocatable :: values(:)   !! (n) and room for more; those that are kept
      integer :: n = 0                          !! values given
      character(:), allocatable :: option    !! text behind the '=' of --set, not taken apart yet
      logical :: broken = .false.            !! a mistake in it is noted already
      logical :: known = .false.             !! there is such a key
      logical :: taken = .false.             !! its values are those of the scene
   contains
      procedure :: add_value
   end type entry_t

   !> One group from its & to its /.
   type :: group_t
      character(:), allocatable :: name      !! in lower case
      type(place_t) :: place
      type(entry_t), allocatable :: entries(:)  !! (n) and room for more
      integer :: n = 0
      logical :: unsure = .false.            !! a choice was refused: what goes with it is not known
   contains
      procedure :: add_entry
   end type group_t

   !> All groups of a file in their order.
   type :: document_t
      type(group_t), allocatable :: groups(:)   !! (n) and room for more
      integer :: n = 0
      type(name_table_t), private :: numbers    ! name: how many; name, parted, 2: position of the second
   contains
      procedure :: add_group
      procedure :: count_of
      procedure :: index_of
      procedure :: given
      procedure :: place_of
   end type document_t

contains

   !> Appends a value.
   pure subroutine add_value(self, word, in_quotes)
      class(entry_t), intent(inout) :: self
      character(*), intent(in) :: word
      logical, intent(in) :: in_quotes
      type(value_t), allocatable :: longer(:)

      self%n = self%n + 1
      if (self%n > most_kept) return
      if (.not. allocated(self%values)) allocate (self%values(1))
      if (self%n > size(self%values)) then
         allocate (longer(2*size(self%values)))
         longer(:size(self%values)) = self%values
         call move_alloc(longer, self%values)
      end if
      self%values(self%n)%text = word
      self%values(self%n)%quoted = in_quotes
   end subroutine add_value

   !> Appends a key.
   pure subroutine add_entry(self, item)
      class(group_t), intent(inout) :: self
      type(entry_t), intent(in) :: item
      type(entry_t), allocatable :: longer(:)

      if (.not. allocated(self%entries)) allocate (self%entries(4))
      if (self%n == size(self%entries)) then
         allocate (longer(2*self%n))
         longer(:self%n) = self%entries
         call move_alloc(longer, self%entries)
      end if
      self%n = self%n + 1
      self%entries(self%n) = item
   end subroutine add_entry

   !> Appends a group, and takes its keys.
   pure subroutine add_group(self, item)
      class(document_t), intent(inout) :: self
      type(group_t), intent(inout) :: item
      type(group_t), allocatable :: longer(:)
      integer :: i, number

      if (.not. allocated(self%groups)) allocate (self%groups(16))
      if (self%n == size(self%groups)) then
         allocate (longer(2*self%n))
         do i = 1, self%n
            call move_group(self%groups(i), longer(i))
         end do
         call move_alloc(longer, self%groups)
      end if
      self%n = self%n + 1
      number = self%count_of(item%name) + 1
      call self%numbers%put(item%name, number)
      call self%numbers%put(item%name//parted//to_text(number), self%n)
      call move_group(item, self%groups(self%n))
   end subroutine add_group

   ! A copy would take time for each of its keys.
   pure subroutine move_group(from, to)
      type(group_t), intent(inout) :: from, to

      to%place = from%place
      to%n = from%n
      call move_alloc(from%name, to%name)
      call move_alloc(from%entries, to%entries)
   end subroutine move_group

   !> Number of groups of one name.
   pure integer function count_of(self, name)
      class(document_t), intent(in) :: self
      character(*), intent(in) :: name

      count_of = self%numbers%find(name)
   end function count_of

   !> Position of the number-th group of a name, 0 if there is none.
   pure integer function index_of(self, name, number)
      class(document_t), intent(in) :: self
      character(*), intent(in) :: name
      integer, intent(in) :: number

      index_of = self%numbers%find(name//parted//to_text(number))
   end function index_of

   ! Position of a key's last mention in a group, 0 if it is not there.
   pure integer function entry_of(self, group, key)
      class(document_t), intent(in) :: self
      integer, intent(in) :: group           ! position of the group, 0 for none
      character(*), intent(in) :: key

      entry_of = 0
      if (group == 0) return
      do entry_of = self%groups(group)%n, 1, -1
         if (self%groups(group)%entries(entry_of)%key == key) return
      end do
   end function entry_of

   !> True when the input itself names a key.
   pure logical function given(self, name, number, key)
      class(document_t), intent(in) :: self
      character(*), intent(in) :: name
      integer, intent(in) :: number
      character(*), intent(in) :: key

      given = entry_of(self, self%index_of(name, number), key) > 0
   end function given

   !> Where a key stands; where its group starts if it is not given; the file if that is not there either.
   pure type(place_t) function place_of(self, name, number, key) result(place)
      class(document_t), intent(in) :: self
      character(*), intent(in) :: name
      integer, intent(in) :: number
      character(*), intent(in) :: key        !! '' for the group itself
      integer :: group, item

      group = self%index_of(name, number)
      item = entry_of(self, group, key)
      if (group > 0) place = self%groups(group)%place
      if (item > 0) place = self%groups(group)%entries(item)%place
   end function place_of

end module document
