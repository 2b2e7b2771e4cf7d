!> What of a complete input is another than it was, and what of that a run that goes on bears.
module changed_keys
   use cadence, only: cadence_t
   use text, only: to_text
   implicit none
   private

   public :: change_t, list_changes

   integer, parameter :: longest_name = 64
   integer, parameter :: longest_value = 400, shown_letters = 60   ! in a message: of a value, of a longer one
   character(*), parameter :: number_letters = '+-.0123456789'

   !> Neither the flow nor what is in the files depends on these.
   character(*), parameter :: harmless(*) = [character(longest_name) :: 'time.end_time', 'time.max_steps', 'time.max_wall_time', &
      'time.balance_limit', 'output.energy', 'output.probes', 'output.errors', 'output.solids', 'output.walls', &
      'output.snapshots', 'output.precision', 'output.checkpoint']

   !> Tables that are there or not.
   character(*), parameter :: tables(*) = [character(longest_name) :: 'output.energy', 'output.probes', 'output.errors', &
      'output.solids', 'output.walls']

   !> What the particles of a checkpoint are made of, and the solution that their history is compared with.
   character(*), parameter :: of_the_particles(*) = [character(longest_name) :: 'scene.reference_length', 'scene.resolution', &
      'fluid.density', 'exact.']

   !> A key whose value is another.
   type :: change_t
      character(longest_name) :: key = ''      !! group.key, body(2).key
      character(:), allocatable :: before, now   !! values; '' where the key has no effect
   contains
      procedure :: words
      procedure :: may_go_on
      procedure :: may_fork
   end type change_t

contains

   !> All changes between two complete inputs. A key that has an effect in one of them only is a consequence of another, and
   !! listed only if there is no other.
   subroutine list_changes(before, now, changes)
      character(*), intent(in) :: before, now
      type(change_t), allocatable, intent(out) :: changes(:)
      type(change_t), allocatable :: old(:), new(:), consequences(:)
      integer :: i, k

      call list_values(before, old)
      call list_values(now, new)
      allocate (changes(0), consequences(0))
      do i = 1, size(new)
         k = place(old, new(i)%key)
         if (k == 0) then
            call add(consequences, new(i)%key, '', new(i)%now)
         else if (old(k)%now /= new(i)%now) then
            call add(changes, new(i)%key, old(k)%now, new(i)%now)
         end if
      end do
      do i = 1, size(old)
         if (place(new, old(i)%key) == 0) call add(consequences, old(i)%key, old(i)%now, '')
      end do
      if (size(changes) == 0) call move_alloc(consequences, changes)
   end subroutine list_changes

   ! The values of an input, under their whole names.
   subroutine list_values(input, values)
      character(*), intent(in) :: input
      type(change_t), allocatable, intent(out) :: values(:)
      character(:), allocatable :: line, group
      integer :: at, equals, number, past

      allocate (values(0))
      group = ''
      number = 0
      at = 1
      do while (at <= len(input))
         past = index(input(at:), new_line('a'))
         if (past == 0) past = len(input) - at + 2
         line = trim(adjustl(input(at:at + past - 2)))
         at = at + past
         equals = index(line, ' = ')
         if (index(line, '&') == 1) then
            number = merge(number + 1, 1, line(2:) == group)
            group = line(2:)
         else if (equals > 0 .and. index(line, '!') /= 1) then
            call add(values, whole_name(group, number, line(:equals - 1)), '', line(equals + 3:))
         else if (size(values) > 0 .and. line /= '' .and. verify(line(:min(1, len(line))), number_letters) == 0) then
            ! A long list of numbers goes on.
            values(size(values))%now = values(size(values))%now//' '//line
         end if
      end do
   end subroutine list_values

   ! group.key, or body(2).key where there may be several.
   pure function whole_name(group, number, key) result(name)
      character(*), intent(in) :: group, key
      integer, intent(in) :: number
      character(:), allocatable :: name

      if (any(group == [character(8) :: 'body', 'solid', 'sponge', 'probe', 'gauge'])) then
         name = group//'('//to_text(number)//').'//key
      else
         name = group//'.'//key
      end if
   end function whole_name

   pure integer function place(values, key)
      type(change_t), intent(in) :: values(:)
      character(*), intent(in) :: key

      do place = size(values), 1, -1
         if (values(place)%key == key) return
      end do
   end function place

   subroutine add(list, key, before, now)
      type(change_t), allocatable, intent(inout) :: list(:)
      character(*), intent(in) :: key, before, now
      type(change_t), allocatable :: longer(:)

      allocate (longer(size(list) + 1))   ! gfortran 12 miscompiles array constructors of such types
      longer(:size(list)) = list
      longer(size(longer))%key = key
      longer(size(longer))%before = before
      longer(size(longer))%now = now
      call move_alloc(longer, list)
   end subroutine add

   !> The change, for a message.
   pure function words(self)
      class(change_t), intent(in) :: self
      character(:), allocatable :: words

      words = trim(self%key)//' = '//shown(self%now)//' (was '//shown(self%before)//')'
      if (self%now == '') words = trim(self%key)//' without effect (was '//shown(self%before)//')'
      if (self%before == '') words = trim(self%key)//' = '//shown(self%now)//' (was without effect)'
   end function words

   ! A value, shortened to what a message has room for. Texts are never as long as lists of numbers are.
   pure function shown(value) result(start)
      character(*), intent(in) :: value
      character(:), allocatable :: start

      start = value
      if (len(value) > longest_value) start = value(:shown_letters)//' ...'
   end function shown

   !> Whether the results can go on in their files.
   logical function may_go_on(self)
      class(change_t), intent(in) :: self

      may_go_on = any(harmless == self%key)
      if (may_go_on .and. any(tables == self%key)) may_go_on = never(self%before) .eqv. never(self%now)
   end function may_go_on

   !> Whether the particles can go on in another directory.
   pure logical function may_fork(self)
      class(change_t), intent(in) :: self
      integer :: k

      may_fork = all([index(self%key, 'body('), index(self%key, 'solid('), index(self%key, 'sponge(')] /= 1)
      do k = 1, size(of_the_particles)
         if (index(self%key, trim(of_the_particles(k))) == 1) may_fork = .false.
      end do
   end function may_fork

   ! Of a cadence in quotes.
   logical function never(value)
      character(*), intent(in) :: value
      type(cadence_t) :: when
      character(:), allocatable :: ignored

      call when%parse(value(2:max(1, len(value) - 1)), ignored)
      never = when%is_never()
   end function never

end module changed_keys
