!> Copies of particles that other processes compute: the same slots in the same order as there, filled whenever they change.
!!
!! Between `start` and `finish` messages travel, and what needs no copy can be computed.
module halo
   use communication, only: exchange_t, n_processes, this_process
   use division, only: division_t, needed_by, owner
   use kinds, only: dp
   use omp_lib, only: omp_get_thread_num
   use particles, only: particles_t, state_t
   use strips, only: strips_t
   implicit none
   private

   public :: halo_t, find_halo, start_copies, finish_copies, let_messages_go_on

   !> Slots in a row.
   type :: segment_t
      integer :: first = 1, last = 0
   end type segment_t

   !> What goes to and comes from each process, the slots of one behind those of the other.
   type :: halo_t
      logical :: exists = .false.
      logical :: hides = .true.   !! what needs no copy is computed while they travel; false for measurements of what that gains
      integer, allocatable, private :: out_end(:), in_end(:)   !! (-1:processes-1) slots until that of a process
      type(segment_t), allocatable, private :: outgoing(:), incoming(:)
      type(exchange_t) :: exchange                             !! on its way
   end type halo_t

   interface start_copies
      procedure start_state, start_gradients, start_field
   end interface start_copies

   interface finish_copies
      procedure finish_state, finish_gradients, finish_field
   end interface finish_copies

contains

   !> The copies that a sort has made room for.
   subroutine find_halo(self, division, strips)
      type(halo_t), intent(inout) :: self
      type(division_t), intent(in) :: division
      type(strips_t), intent(in) :: strips   !! of all slots held
      character(2) :: overlap
      integer :: process, k, n

      n = n_processes()
      self%exists = n > 1
      if (.not. self%exists) return
      call get_environment_variable('DYNSPH_OVERLAP', overlap)
      self%hides = overlap /= 'no'
      if (.not. allocated(self%out_end)) allocate (self%out_end(-1:n - 1), self%in_end(-1:n - 1))
      self%out_end(-1) = 0
      self%in_end(-1) = 0
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

   !> To be called for each block that is computed between `start_copies` and `finish_copies`: long messages need the sender's and
   !! the receiver's hand meanwhile. The thread that talks to others looks after some blocks.
   subroutine let_messages_go_on(self, block)
      type(halo_t), intent(inout) :: self
      integer, intent(in) :: block   !! of the blocks, which
      integer, parameter :: interval = 8

      if (.not. self%exists .or. mod(block, interval) /= 0) return
      if (omp_get_thread_num() == 0) call self%exchange%go_on()
   end subroutine let_messages_go_on

   ! All that a state has.
   subroutine start_state(self, state)
      type(halo_t), intent(inout) :: self
      type(state_t), intent(in) :: state
      integer :: i, k, n

      if (.not. self%exists) return
      call self%exchange%make_room(6, self%out_end, self%in_end)
      n = 0
      associate (buffer => self%exchange%outgoing)
         do k = 1, size(self%outgoing)
            do i = self%outgoing(k)%first, self%outgoing(k)%last
               buffer(n + 1:n + 6) = [state%x(i), state%y(i), state%u(i), state%v(i), state%s(i), state%volume(i)]
               n = n + 6
            end do
         end do
      end associate
      call self%exchange%start()
   end subroutine start_state

   subroutine finish_state(self, state)
      type(halo_t), intent(inout) :: self
      type(state_t), intent(inout) :: state
      integer :: i, k, n

      if (.not. self%exists) return
      call self%exchange%finish()
      n = 0
      associate (buffer => self%exchange%incoming)
         do k = 1, size(self%incoming)
            do i = self%incoming(k)%first, self%incoming(k)%last
               state%x(i) = buffer(n + 1)
               state%y(i) = buffer(n + 2)
               state%u(i) = buffer(n + 3)
               state%v(i) = buffer(n + 4)
               state%s(i) = buffer(n + 5)
               state%volume(i) = buffer(n + 6)
               n = n + 6
            end do
         end do
      end associate
   end subroutine finish_state

   ! Of the first passes what the second one needs of neighbours: G, alpha_i and delta_i, as far as there are any.
   subroutine start_gradients(self, p)
      type(halo_t), intent(inout) :: self
      type(particles_t), intent(in) :: p
      integer :: i, k, n

      if (.not. self%exists .or. values_of(p) == 0) return
      call self%exchange%make_room(values_of(p), self%out_end, self%in_end)
      n = 0
      associate (buffer => self%exchange%outgoing)
         do k = 1, size(self%outgoing)
            do i = self%outgoing(k)%first, self%outgoing(k)%last
               if (p%features%diffusion) then
                  buffer(n + 1:n + 2) = [p%grad_x(i), p%grad_y(i)]
                  n = n + 2
               end if
               if (p%features%eddy) then
                  buffer(n + 1:n + 2) = [p%alpha(i), p%delta(i)]
                  n = n + 2
               end if
            end do
         end do
      end associate
      call self%exchange%start()
   end subroutine start_gradients

   subroutine finish_gradients(self, p)
      type(halo_t), intent(inout) :: self
      type(particles_t), intent(inout) :: p
      integer :: i, k, n

      if (.not. self%exists .or. values_of(p) == 0) return
      call self%exchange%finish()
      n = 0
      associate (buffer => self%exchange%incoming)
         do k = 1, size(self%incoming)
            do i = self%incoming(k)%first, self%incoming(k)%last
               if (p%features%diffusion) then
                  p%grad_x(i) = buffer(n + 1)
                  p%grad_y(i) = buffer(n + 2)
                  n = n + 2
               end if
               if (p%features%eddy) then
                  p%alpha(i) = buffer(n + 1)
                  p%delta(i) = buffer(n + 2)
                  n = n + 2
               end if
            end do
         end do
      end associate
   end subroutine finish_gradients

   pure integer function values_of(p)
      type(particles_t), intent(in) :: p

      values_of = merge(2, 0, p%features%diffusion) + merge(2, 0, p%features%eddy)
   end function values_of

   ! One field.
   subroutine start_field(self, field)
      type(halo_t), intent(inout) :: self
      real(dp), intent(in) :: field(:)   !! (slots)
      integer :: k, n

      if (.not. self%exists) return
      call self%exchange%make_room(1, self%out_end, self%in_end)
      n = 0
      do k = 1, size(self%outgoing)
         associate (first => self%outgoing(k)%first, last => self%outgoing(k)%last)
            self%exchange%outgoing(n + 1:n + last - first + 1) = field(first:last)
            n = n + last - first + 1
         end associate
      end do
      call self%exchange%start()
   end subroutine start_field

   subroutine finish_field(self, field)
      type(halo_t), intent(inout) :: self
      real(dp), intent(inout) :: field(:)   !! (slots)
      integer :: k, n

      if (.not. self%exists) return
      call self%exchange%finish()
      n = 0
      do k = 1, size(self%incoming)
         associate (first => self%incoming(k)%first, last => self%incoming(k)%last)
            field(first:last) = self%exchange%incoming(n + 1:n + last - first + 1)
            n = n + last - first + 1
         end associate
      end do
   end subroutine finish_field

end module halo
