!> Images of particles beyond the sides of the box: which there are, and one way to fill them.
!!
!! What an image has of its source, module `image_laws` tells; by default density is corrected by the hydrostatic difference
!! between image and source, so that a linear hydrostatic field is continued exactly (docs/equations.md).
module images
   use box, only: box_t, open_side
   use halo, only: finish_copies, halo_t, start_copies
   use image_laws, only: as_gradient, as_position, as_scalar, as_slip, as_velocity, as_wall_velocity, beyond, image_of, &
      law_t, n_kinds
   use kinds, only: dp, i8
   use particles, only: particles_t, state_t, reserve_slots
   use strips, only: group_slots, strips_t, sort_into_strips
   implicit none
   private

   public :: images_t, list_images, fill_ghosts, begin_fill, finish_fill, fill_slip

   integer, parameter :: chunk = 1024   ! slots that a thread looks at at a time

   !> The images of a step: slot `n_held + k` is an image of slot `source(k)`.
   type :: images_t
      type(halo_t) :: halo                 !! copies among the sources
      integer :: n = 0
      integer :: n_own = 0                 !! slots of own particles,
      integer :: n_held = 0                !! and of copies: all before them
      integer :: n_before = 0              !! slots before the first source
      integer, allocatable :: source(:)    !! (n) slot of the source
      integer, allocatable :: kind(:)      !! (n) of module image_laws
      type(strips_t) :: strips             !! where to find them
      integer, allocatable, private :: unsorted_source(:), unsorted_kind(:), number(:)
      real(dp), allocatable, private :: x(:), y(:)
   contains
      procedure :: bytes => images_bytes
   end type images_t

   !> Gives all copies and images what they have of their sources.
   interface fill_ghosts
      procedure fill_state, fill_field, fill_from
   end interface fill_ghosts

   !> The same in two parts: images of copies, and these, are filled by the second one. What needs none of them can be computed
   !! between the two.
   interface begin_fill
      procedure begin_state, begin_gradients
   end interface begin_fill

   interface finish_fill
      procedure finish_state, finish_gradients
   end interface finish_fill

contains

   !> Finds the particles that have images, and sorts these into strips behind the slots held; of ghosts of solids, whose slots
   !! come last, behind these.
   !!
   !! Decides on the predicted positions that the strips were sorted by: a particle that may come closer than `reach` to a side
   !! within `travel` before or after that time gets an image.
   subroutine list_images(self, box, p, tau, travel, reach, before)
      type(images_t), intent(inout) :: self
      type(box_t), intent(in) :: box          !! at the predicted time
      type(particles_t), intent(inout) :: p   !! n_slots is set
      real(dp), intent(in) :: tau             !! time that positions are predicted ahead by
      real(dp), intent(in) :: travel          !! time
      real(dp), intent(in) :: reach(4)        !! of each side
      integer, intent(in), optional :: before !! slots before those of ghosts
      integer, allocatable :: begin(:)        ! images before those of a chunk
      integer :: b, i, k, n, n_chunks

      self%n = 0
      self%n_own = p%n_own
      self%n_held = p%n_held
      self%n_before = 0
      if (present(before)) then
         self%n_own = p%n_slots
         self%n_held = p%n_slots
         self%n_before = before
      end if
      n_chunks = (self%n_held - self%n_before + chunk - 1)/chunk
      if (any(box%kind /= open_side)) then
         allocate (begin(n_chunks + 1), source=0)
         !$omp parallel do default(none) shared(self, box, p, tau, travel, reach, n_chunks, begin) schedule(static)
         do b = 1, n_chunks
            call look_at(self, box, p, tau, travel, reach, b, .false., begin(b + 1))
         end do
         !$omp end parallel do
         do b = 1, n_chunks
            begin(b + 1) = begin(b) + begin(b + 1)
         end do
         self%n = begin(n_chunks + 1)
      end if
      call make_room(self, self%n)
      n = self%n
      p%n_slots = self%n_held + n
      call reserve_slots(p, p%n_slots + group_slots)   ! module candidates looks at whole groups
      if (n == 0) then
         self%strips%n = 0
         return
      end if
      !$omp parallel do default(none) shared(self, box, p, tau, travel, reach, n_chunks, begin) private(k) schedule(static)
      do b = 1, n_chunks
         k = begin(b)
         call look_at(self, box, p, tau, travel, reach, b, .true., k)
      end do
      !$omp end parallel do
      call sort_into_strips(self%strips, n, self%number(1:n), self%x(1:n), self%y(1:n), self%n_held + 1, .false.)
      if (self%strips%n < 0) return   ! too long, as the fluid itself can be
      !$omp parallel do default(none) shared(self, n) private(i)
      do k = 1, n
         i = self%strips%point_of(k)
         self%source(k) = self%unsorted_source(i)
         self%kind(k) = self%unsorted_kind(i)
      end do
      !$omp end parallel do
   end subroutine list_images

   ! Counts the images of a chunk of slots, and if there is room for them writes them behind the first `n`.
   subroutine look_at(self, box, p, tau, travel, reach, b, write_them, n)
      type(images_t), intent(inout) :: self
      type(box_t), intent(in) :: box
      type(particles_t), intent(in) :: p
      real(dp), intent(in) :: tau, travel, reach(4)
      integer, intent(in) :: b                 ! number of the chunk
      logical, intent(in) :: write_them
      integer, intent(inout) :: n
      type(law_t) :: law(2)
      real(dp) :: place(2), velocity(2), normal(4), least(4)
      integer :: i, k
      logical :: near(0:4)                     ! whether there is an image beyond a side; 0: none

      law = [as_position(box, 1), as_position(box, 2)]
      normal = box%normal_velocity()
      least = merge(-huge(reach), reach, box%kind == open_side)
      near(0) = .true.
      do i = self%n_before + (b - 1)*chunk + 1, min(self%n_before + b*chunk, self%n_held)
         if (p%id(i) == 0) cycle
         velocity = [p%base%u(i), p%base%v(i)]
         place = [p%base%x(i), p%base%y(i)] + tau*velocity
         near(1:2) = abs(place(1) - box%at(1:2)) < least(1:2) + travel*abs(velocity(1) - normal(1:2))
         near(3:4) = abs(place(2) - box%at(3:4)) < least(3:4) + travel*abs(velocity(2) - normal(3:4))
         if (.not. (near(1) .or. near(2) .or. near(3) .or. near(4))) cycle
         do k = 1, n_kinds
            if (.not. (near(beyond(1, k)) .and. near(beyond(2, k)))) cycle
            n = n + 1
            if (write_them) call put(self, n, i, n_kinds*(p%id(i) - 1) + k, k, &
                                     [image_of(law(1), k, place(1)), image_of(law(2), k, place(2))])
         end do
      end do
   end subroutine look_at

   subroutine put(self, n, i, number, k, place)
      type(images_t), intent(inout) :: self
      integer, intent(in) :: n, i, k
      integer, intent(in) :: number      ! of the image: its order must not depend on that of the slots
      real(dp), intent(in) :: place(2)   ! of the image

      self%unsorted_source(n) = i
      self%unsorted_kind(n) = k
      self%x(n) = place(1)
      self%y(n) = place(2)
      self%number(n) = number
   end subroutine put

   ! The numbers that there are need not be kept.
   subroutine make_room(self, n)
      type(images_t), intent(inout) :: self
      integer, intent(in) :: n
      integer :: larger

      if (allocated(self%source)) then
         if (n <= size(self%source)) return
         deallocate (self%source, self%kind, self%unsorted_source, self%unsorted_kind, self%number, self%x, self%y)
      end if
      larger = n + n/8
      allocate (self%source(larger), self%kind(larger), self%unsorted_source(larger), self%unsorted_kind(larger), &
                self%number(larger), self%x(larger), self%y(larger))
   end subroutine make_room

   !> Bytes that all arrays take.
   pure integer(i8) function images_bytes(self) result(bytes)
      class(images_t), intent(in) :: self

      bytes = self%strips%bytes()
      if (allocated(self%source)) bytes = bytes &
         + size(self%source, kind=i8)*(5*storage_size(self%source) + 2*storage_size(self%x))/8
   end function images_bytes

   ! All that a state has.
   subroutine fill_state(self, box, state)
      type(images_t), intent(inout) :: self
      type(box_t), intent(in) :: box           !! at the state's time
      type(state_t), intent(inout) :: state

      call begin_state(self, box, state)
      call finish_state(self, box, state)
   end subroutine fill_state

   subroutine begin_state(self, box, state)
      type(images_t), intent(inout) :: self
      type(box_t), intent(in) :: box
      type(state_t), intent(inout) :: state

      call start_copies(self%halo, state)
      call fill_images(self, .false., box, state)
   end subroutine begin_state

   subroutine finish_state(self, box, state)
      type(images_t), intent(inout) :: self
      type(box_t), intent(in) :: box
      type(state_t), intent(inout) :: state

      if (.not. self%halo%exists) return
      call finish_copies(self%halo, state)
      call fill_images(self, .true., box, state)
   end subroutine finish_state

   ! Images of own particles, or of copies.
   subroutine fill_images(self, of_copies, box, state)
      type(images_t), intent(in) :: self
      logical, intent(in) :: of_copies
      type(box_t), intent(in) :: box
      type(state_t), intent(inout) :: state
      type(law_t) :: position(2), velocity(2)
      integer :: k, i, j, kind

      if (self%n == 0) return
      position = [as_position(box, 1), as_position(box, 2)]
      velocity = [as_velocity(box, 1), as_velocity(box, 2)]
      !$omp parallel do default(none) shared(self, of_copies, box, state, position, velocity) private(i, j, kind)
      do k = 1, self%n
         i = self%source(k)
         if ((i > self%n_own) .neqv. of_copies) cycle
         j = self%n_held + k
         kind = self%kind(k)
         state%x(j) = image_of(position(1), kind, state%x(i))
         state%y(j) = image_of(position(2), kind, state%y(i))
         state%u(j) = image_of(velocity(1), kind, state%u(i))
         state%v(j) = image_of(velocity(2), kind, state%v(i))
         state%s(j) = state%s(i) + box%density_slope(1)*(state%x(j) - state%x(i)) &
                      + box%density_slope(2)*(state%y(j) - state%y(i))
         state%volume(j) = state%volume(i)
      end do
      !$omp end parallel do
   end subroutine fill_images

   ! Of the first passes what the second one needs of neighbours.
   subroutine begin_gradients(self, box, p)
      type(images_t), intent(inout) :: self
      type(box_t), intent(in) :: box
      type(particles_t), intent(inout) :: p

      call start_copies(self%halo, p)
      call fill_gradients(self, box, p)   ! those of copies not yet rightly
   end subroutine begin_gradients

   subroutine finish_gradients(self, box, p)
      type(images_t), intent(inout) :: self
      type(box_t), intent(in) :: box
      type(particles_t), intent(inout) :: p

      if (.not. self%halo%exists) return
      call finish_copies(self%halo, p)
      call fill_gradients(self, box, p)
   end subroutine finish_gradients

   subroutine fill_gradients(self, box, p)
      type(images_t), intent(in) :: self
      type(box_t), intent(in) :: box
      type(particles_t), intent(inout) :: p

      associate (held => self%n_held)
         if (p%features%diffusion) then
            call fill_from(self, as_gradient(box, 1), p%grad_x(:held), p%grad_x(held + 1:))
            call fill_from(self, as_gradient(box, 2), p%grad_y(:held), p%grad_y(held + 1:))
         end if
         if (p%features%eddy) then
            call fill_from(self, as_scalar, p%alpha(:held), p%alpha(held + 1:))
            call fill_from(self, as_scalar, p%delta(:held), p%delta(held + 1:))
         end if
      end associate
   end subroutine fill_gradients

   ! One field.
   subroutine fill_field(self, law, field)
      type(images_t), intent(inout) :: self
      type(law_t), intent(in) :: law
      real(dp), contiguous, intent(inout) :: field(:)   !! (n_slots)

      call start_copies(self%halo, field)
      call finish_copies(self%halo, field)
      call fill_from(self, law, field(:self%n_held), field(self%n_held + 1:))
   end subroutine fill_field

   ! A field that images alone have.
   subroutine fill_from(self, law, own, field)
      type(images_t), intent(in) :: self
      type(law_t), intent(in) :: law
      real(dp), contiguous, intent(in) :: own(:)        !! (n_held) of the sources
      real(dp), contiguous, intent(inout) :: field(:)   !! (n) of the images
      integer :: k

      !$omp parallel do default(none) shared(self, law, own, field)
      do k = 1, self%n
         field(k) = image_of(law, self%kind(k), own(self%source(k)))
      end do
      !$omp end parallel do
   end subroutine fill_from

   !> Gives every image the difference between its no-slip and its free-slip velocity, and its walls' velocity.
   subroutine fill_slip(self, box, p)
      type(images_t), intent(in) :: self
      type(box_t), intent(in) :: box          !! at the time of the base state
      type(particles_t), intent(inout) :: p   !! jump and wall velocities of the images are set

      associate (own => self%n_held)
         call fill_ghosts(self, as_slip(box, 1), p%base%u(:own), p%jump_u(own + 1:))
         call fill_ghosts(self, as_slip(box, 2), p%base%v(:own), p%jump_v(own + 1:))
         call fill_ghosts(self, as_wall_velocity(box, 1), p%base%u(:own), p%wall_u(own + 1:))
         call fill_ghosts(self, as_wall_velocity(box, 2), p%base%v(:own), p%wall_v(own + 1:))
      end associate
   end subroutine fill_slip

end module images
