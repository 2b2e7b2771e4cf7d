!> Copies of particles that other processes compute: the same slots in the same order as there, filled whenever they change.
module halo
   use communication, only: exchange, n_processes, this_process
   use division, only: division_t, needed_by, owner
   use kinds, only: dp
   use particles, only: state_t
   use strips, only: strips_t
   implicit none
   private

   public :: halo_t, find_halo, fill_copies

   !> Slots in a row.
   type :: segment_t
      integer :: first = 1, last = 0
   end type segment_t

   !> What goes to and comes from each process, the slots of one behind those of the other.
   type :: halo_t
      logical :: exists = .false.
      integer, allocatable :: out_end(:), in_end(:)   !! (-1:processes-1) slots until that of a process
      type(segment_t), allocatable :: outgoing(:), incoming(:)
   end type halo_t

   interface fill_copies
      procedure fill_state, fill_field
   end interface fill_copies

contains

   !> The copies that a sort has made room for.
   subroutine find_halo(self, division, strips)
      type(halo_t), intent(inout) :: self
      type(division_t), intent(in) :: division
      type(strips_t), intent(in) :: strips   !! of all slots held
      integer :: process, k, n

      n = n_processes()
      self%exists = n > 1
      if (.not. self%exists) return
      self%out_end = [(0, k=-1, n - 1)]
      self%in_end = self%out_end
      deallocate (self%out_end, self%in_end)
      allocate (self%out_end(-1:n - 1), self%in_end(-1:n - 1), source=0)
      self%outgoing = [segment_t ::]
      self%incoming = [segment_t ::]
      do process = 0, n - 1
         self%out_end(process) = self%out_end(process - 1)
         self%in_end(process) = self%in_end(process - 1)
         if (process == this_process()) cycle
         do k = 1, strips%n
            associate (place => strips%first_place + strips%place(k) - 1, mine => k >= strips%own(1) .and. k <= strips%own(2))
               if (mine .and. needed_by(division, process, place)) then
                  call append(self%outgoing, strips%first(k), strips%last(k), self%out_end(process))
               else if (.not. mine .and. owner(division, place) == process) then
                  call append(self%incoming, strips%first(k), strips%last(k), self%in_end(process))
               end if
            end associate
         end do
      end do
   end subroutine find_halo

   subroutine append(segments, first, last, slots)
      type(segment_t), allocatable, intent(inout) :: segments(:)
      integer, intent(in) :: first, last
      integer, intent(inout) :: slots

      segments = [segments, segment_t(first, last)]
      slots = slots + last - first + 1
   end subroutine append

   ! All that a state has.
   subroutine fill_state(self, state)
      type(halo_t), intent(in) :: self
      type(state_t), intent(inout) :: state
      real(dp), allocatable :: outgoing(:), incoming(:)
      integer :: n

      if (.not. self%exists) return
      n = ubound(self%out_end, 1)
      allocate (outgoing(6*self%out_end(n)), incoming(6*self%in_end(n)))
      call pack_slots(self%outgoing, state, outgoing)
      call exchange(outgoing, 6*self%out_end, incoming, 6*self%in_end)
      call unpack_slots(self%incoming, incoming, state)
   end subroutine fill_state

   subroutine pack_slots(segments, state, buffer)
      type(segment_t), intent(in) :: segments(:)
      type(state_t), intent(in) :: state
      real(dp), intent(inout) :: buffer(:)
      integer :: i, k, n

      n = 0
      do k = 1, size(segments)
         do i = segments(k)%first, segments(k)%last
            buffer(n + 1:n + 6) = [state%x(i), state%y(i), state%u(i), state%v(i), state%s(i), state%volume(i)]
            n = n + 6
         end do
      end do
   end subroutine pack_slots

   subroutine unpack_slots(segments, buffer, state)
      type(segment_t), intent(in) :: segments(:)
      real(dp), intent(in) :: buffer(:)
      type(state_t), intent(inout) :: state
      integer :: i, k, n

      n = 0
      do k = 1, size(segments)
         do i = segments(k)%first, segments(k)%last
            state%x(i) = buffer(n + 1)
            state%y(i) = buffer(n + 2)
            state%u(i) = buffer(n + 3)
            state%v(i) = buffer(n + 4)
            state%s(i) = buffer(n + 5)
            state%volume(i) = buffer(n + 6)
            n = n + 6
         end do
      end do
   end subroutine unpack_slots

   ! One field.
   subroutine fill_field(self, field)
      type(halo_t), intent(in) :: self
      real(dp), intent(inout) :: field(:)   !! (slots)
      real(dp), allocatable :: outgoing(:), incoming(:)
      integer :: k, n

      if (.not. self%exists) return
      n = ubound(self%out_end, 1)
      allocate (outgoing(self%out_end(n)), incoming(self%in_end(n)))
      n = 0
      do k = 1, size(self%outgoing)
         associate (first => self%outgoing(k)%first, last => self%outgoing(k)%last)
            outgoing(n + 1:n + last - first + 1) = field(first:last)
            n = n + last - first + 1
         end associate
      end do
      call exchange(outgoing, self%out_end, incoming, self%in_end)
      n = 0
      do k = 1, size(self%incoming)
         associate (first => self%incoming(k)%first, last => self%incoming(k)%last)
            field(first:last) = incoming(n + 1:n + last - first + 1)
            n = n + last - first + 1
         end associate
      end do
   end subroutine fill_field

end module halo
