!> Ghosts of solids: points inside of them that stand for their volume in the sums of the fluid near them.
!!
!! Source: ours (docs/equations.md, Solid bodies). Module `solid_cells` places them. They take slots behind the fluid's images, in
!! strips of their own, and have images like the fluid's. They are in no list of the fluid's own sums.
module solid_ghosts
   use box, only: box_t, way_back
   use candidates, only: shared_candidates_t
   use free_ghosts, only: free_ghosts_t, new_free_ghosts
   use ghost_faces, only: ghost_faces_t
   use image_laws, only: as_position, beyond, law_t
   use images, only: fill_ghosts, images_t, list_images
   use kinds, only: dp, i8
   use motions, only: move_point, pose_t, turn
   use particles, only: far_away, particles_t, reserve_slots, state_t
   use rigid_bodies, only: coasting
   use solid_cells, only: cell_t, find_cells, move_cell
   use solids, only: new_obstacle, obstacle_t, solid_t
   use strip_extents, only: measure_strips
   use strips, only: group_slots, sort_into_strips, strips_t
   implicit none
   private

   public :: solid_ghosts_t, make_ghosts, sort_ghosts, move_ghosts, mirror_ghosts

   !> All ghosts, and what is near them.
   type :: solid_ghosts_t
      integer :: n = 0                             !! of all solids
      integer :: before = 0                        !! slots before theirs
      integer :: n_slots = 0                       !! of theirs, padding included; their images come behind
      type(cell_t), allocatable :: drawn(:)        !! (n) before the solids' motion
      logical :: shared = .false.                  !! some cell has a ghost for each of several faces
      type(obstacle_t), allocatable :: obstacles(:)   !! solids where the ghosts are; only then
      logical, allocatable :: through(:, :)        !! (4, solids) it moves, and reaches through the side
      real(dp) :: acceleration = 0                 !! [m/s2] none has more
      type(pose_t), allocatable :: poses(:)        !! (solids) where the ghosts are
      logical :: moves = .false.                   !! some solid does
      type(free_ghosts_t), allocatable :: free     !! where some solids are free
      real(dp) :: creep = 0                        !! [m/s] by which those that walls cut may move otherwise than their solid,
      real(dp) :: width = 0                        !! [m] and less than which they stand beside where they are sorted
      type(strips_t) :: strips
      type(images_t) :: images
      integer :: n_blocks = 0
      type(shared_candidates_t), allocatable :: fluid(:)  !! (n_blocks) of ghosts: slots of the fluid near each cluster
      type(shared_candidates_t), allocatable :: near(:)   !! (blocks of the fluid) ghosts and their images near each cluster
      logical, allocatable :: meets(:)             !! (blocks of the fluid) some are; beside the lists, most of which are empty
      ! By slot, counted from their first:
      integer, allocatable :: solid_of(:)          !! (n_slots) the ghost's solid; 0 for a dummy
      integer, allocatable :: face(:)              !! (n_slots and images) the face that it is for; 0: for all
      real(dp), allocatable :: area(:)             !! [m2] (n_slots) as drawn
      real(dp), allocatable :: pull_x(:), pull_y(:)   !! [m/s2] (n_slots) (A.n) n, A the solid's acceleration there
      real(dp), allocatable :: exchange(:)         !! (n_slots and images) q_b/S_b without constant factors
      type(ghost_faces_t) :: faces                 !! how they rub on the fluid
      real(dp), allocatable :: force(:, :)         !! [N/m] (2, n_slots) of pressure on the ghost's part of the solid
      real(dp), allocatable :: power(:)            !! [W/m] (n_slots) that this gives to the fluid
      real(dp), allocatable :: friction(:, :)      !! [N/m] (4, n_slots) force of friction, and the same as its power goes with
      real(dp), allocatable :: work(:)             !! [J/m] (n_slots) of the step, given to the fluid,
      real(dp), allocatable :: rubbed(:)           !! [J/m] (n_slots) of it by friction
      real(dp), allocatable :: x(:)                !! [m] (n_slots) when they were sorted
      real(dp), allocatable :: place(:, :)         !! [m] (2, n_slots) now, in the solid
      real(dp), allocatable :: way(:, :)           !! [m] (2, n_slots) from there to where the ghost is in a periodic box
   contains
      procedure :: exist
      procedure :: are_near
      procedure :: signs
      procedure :: passes
      procedure :: bytes => ghosts_bytes
   end type solid_ghosts_t

contains

   !> Whether the scene has solids.
   elemental logical function exist(self)
      class(solid_ghosts_t), intent(in) :: self

      exist = self%n > 0
   end function exist

   !> Whether some may be near a block of the fluid.
   pure logical function are_near(self, b)
      class(solid_ghosts_t), intent(in) :: self
      integer, intent(in) :: b   !! its number

      are_near = self%exist()
      if (are_near) are_near = self%meets(b)
   end function are_near

   !> -1 for axes along which the ghost in a slot is mirrored, else 1.
   pure function signs(self, box, slot)
      class(solid_ghosts_t), intent(in) :: self
      type(box_t), intent(in) :: box
      integer, intent(in) :: slot
      real(dp) :: signs(2)
      type(law_t) :: law(2)

      signs = 1
      if (slot <= self%images%n_held) return
      law = [as_position(box, 1), as_position(box, 2)]
      associate (kind => self%images%kind(slot - self%images%n_held))
         signs = [law(1)%factor(kind), law(2)%factor(kind)]
      end associate
   end function signs

   !> -1 for axes along which the velocity of a ghost's image of some kind is not mirrored, because its solid goes on beyond the
   !! wall; else 1.
   pure function passes(self, k, kind)
      class(solid_ghosts_t), intent(in) :: self
      integer, intent(in) :: k       !! slot of the ghost, counted from the first one's
      integer, intent(in) :: kind    !! of the image
      real(dp) :: passes(2)
      integer :: axis

      passes = 1
      if (self%solid_of(k) == 0) return
      do axis = 1, 2
         if (beyond(axis, kind) == 0) cycle
         if (self%through(beyond(axis, kind), self%solid_of(k))) passes(axis) = -1
      end do
   end function passes

   !> Bytes that all arrays take.
   pure integer(i8) function ghosts_bytes(self) result(bytes)
      class(solid_ghosts_t), intent(in) :: self

      bytes = 0
      if (.not. self%exist()) return
      bytes = self%strips%bytes() + self%images%bytes() + size(self%drawn, kind=i8)*storage_size(self%drawn)/8 + self%faces%bytes()
      if (allocated(self%fluid)) bytes = bytes + sum(self%fluid%bytes()) + sum(self%near%bytes())
   end function ghosts_bytes

   !> The ghosts of all solids, as far as fluid may come near them.
   subroutine make_ghosts(self, solids, box, dx, support)
      type(solid_ghosts_t), intent(inout) :: self
      type(solid_t), intent(in) :: solids(:)
      type(box_t), intent(in) :: box             !! at time 0
      real(dp), intent(in) :: dx, support        !! width of cells; of the kernel
      integer :: k

      call find_cells(solids, box, dx, support, self%drawn)
      self%n = size(self%drawn)
      self%width = dx
      allocate (self%through(4, size(solids)), source=.false.)
      self%shared = any(self%drawn%edge > 0)
      do k = 1, size(solids)
         self%acceleration = max(self%acceleration, solids(k)%motion%largest_acceleration(solids(k)%radius()))
      end do
      if (any(solids%body%is_free())) self%free = new_free_ghosts(size(solids), dx)
   end subroutine make_ghosts

   !> Gives the ghosts slots behind the fluid and its images, in the order of strips, and finds their images.
   subroutine sort_ghosts(self, solids, poses, box, p, widths, times, slack)
      type(solid_ghosts_t), intent(inout) :: self
      type(solid_t), intent(in) :: solids(:)
      type(pose_t), intent(in) :: poses(:)       !! (solids) at the time of `base`
      type(box_t), intent(in) :: box             !! then
      type(particles_t), intent(inout) :: p      !! n_slots counts the fluid and its images; on return the ghosts and theirs too
      real(dp), intent(in) :: widths(3)          !! of a strip, of a bin, of the kernel
      real(dp), intent(in) :: times(2)           !! that positions are predicted ahead by, and that lists last before and after then
      real(dp), intent(in) :: slack              !! that a block may have
      type(box_t) :: then
      real(dp) :: x(self%n), y(self%n), way(2, self%n), reach(4)
      integer :: k

      then = box%after(times(1))
      call predict_places(self, solids, poses, times(1), then, x, y, way)
      self%strips%width = widths(1)
      self%strips%bin_height = widths(2)
      self%strips%origin = box%at(1)
      self%creep = 0
      do k = 1, size(solids)
         if (solids(k)%motion%moves()) self%creep = max(self%creep, creep_of(solids(k), poses(k), box))
      end do
      self%before = p%n_slots
      call sort_into_strips(self%strips, self%n, [(k, k=1, self%n)], x, y, self%before + 1, .true.)
      self%n_slots = self%strips%n_slots
      p%n_slots = self%before + self%n_slots
      call reserve_slots(p, p%n_slots + group_slots)
      p%id(self%before + 1:p%n_slots) = self%strips%point_of(:self%n_slots)
      call make_room(self)
      call seat_ghosts(self, way)
      if (allocated(self%free)) call self%free%make_room(self%n_slots)
      if (allocated(self%free)) call self%free%expect(solids, poses)
      call move_ghosts(self, solids, poses, box, p%base)
      call measure_strips(self%strips, p%base)
      self%images%strips%width = widths(1)
      self%images%strips%bin_height = widths(2)
      self%images%strips%origin = box%at(1)
      reach = widths(3) + 2*slack + sum(times)*maxval(abs([self%strips%overall%slowest, self%strips%overall%fastest]))
      if (allocated(self%free)) reach = reach + self%free%allowance(sum(times))
      call list_images(self%images, then, p, times(1), times(2), reach, self%before)
      call fill_ghosts(self%images, box, p%base)
      call measure_strips(self%images%strips, p%base)
      if (allocated(self%exchange)) deallocate (self%exchange)
      allocate (self%exchange(self%n_slots + self%images%n), source=0.0_dp)
      call self%faces%make_room(self%n_slots, self%images%n)
      call set_faces(self)
      do k = 1, self%n_slots
         self%x(k) = far_away
         if (self%solid_of(k) == 0) cycle
         self%x(k) = x(self%strips%point_of(k))
         call self%faces%stand_behind(k, solids(self%solid_of(k)), self%drawn(self%strips%point_of(k)))
      end do
      call self%faces%copy(self%images%source(:self%images%n) - self%before)
   end subroutine sort_ghosts

   ! The speed of a solid that reaches beyond a wall; 0 of others.
   pure real(dp) function creep_of(solid, pose, box)
      type(solid_t), intent(in) :: solid
      type(pose_t), intent(in) :: pose
      type(box_t), intent(in) :: box
      type(obstacle_t) :: now

      creep_of = 0
      now = new_obstacle(solid, pose, box)
      if (any(now%reaches_through(box))) creep_of = solid%motion%largest_speed(solid%radius())
   end function creep_of

   ! Where the ghosts are at the box's time, some time after the poses, and by how much they are moved to be in it.
   subroutine predict_places(self, solids, poses, time, box, x, y, way)
      type(solid_ghosts_t), intent(in) :: self
      type(solid_t), intent(in) :: solids(:)
      type(pose_t), intent(in) :: poses(:)
      real(dp), intent(in) :: time
      type(box_t), intent(in) :: box
      real(dp), intent(out) :: x(self%n), y(self%n), way(2, self%n)
      type(pose_t) :: pose(size(solids))
      real(dp) :: place(2), velocity(2), acceleration(2)
      integer :: k

      do k = 1, size(solids)
         pose(k) = solids(k)%motion%at(box%time)
         if (solids(k)%body%is_free()) pose(k) = coasting(poses(k), time)
      end do
      do k = 1, self%n
         associate (ghost => self%drawn(k))
            call move_point(pose(ghost%solid), solids(ghost%solid)%pivot, ghost%place, place, velocity, acceleration)
            way(:, k) = way_back(box, place)
            x(k) = place(1) + way(1, k)
            y(k) = place(2) + way(2, k)
         end associate
      end do
   end subroutine predict_places

   ! Arrays by slot.
   subroutine make_room(self)
      type(solid_ghosts_t), intent(inout) :: self

      if (allocated(self%power)) then
         if (size(self%power) == self%n_slots) return
         deallocate (self%pull_x, self%pull_y, self%power, self%work, self%rubbed, self%x, self%place, self%force, &
                     self%friction, self%area, self%way, self%solid_of)
      end if
      associate (n => self%n_slots)
         allocate (self%pull_x(n), self%pull_y(n), self%power(n), self%work(n), self%rubbed(n), self%x(n), self%place(2, n), &
                   self%force(2, n), self%friction(4, n), self%area(n), self%way(2, n), source=0.0_dp)
         allocate (self%solid_of(n))
      end associate
   end subroutine make_room

   ! What resting ghosts keep until they are sorted anew.
   subroutine seat_ghosts(self, way)
      type(solid_ghosts_t), intent(inout) :: self
      real(dp), intent(in) :: way(2, self%n)   ! of each ghost
      integer :: k

      do k = 1, self%n_slots
         self%solid_of(k) = 0
         self%place(:, k) = far_away
         self%pull_x(k) = 0
         self%pull_y(k) = 0
         self%area(k) = 0
         self%way(:, k) = 0
         if (self%strips%point_of(k) == 0) cycle
         associate (cell => self%drawn(self%strips%point_of(k)))
            self%solid_of(k) = cell%solid
            self%place(:, k) = cell%place
            self%area(k) = cell%area
            self%way(:, k) = way(:, self%strips%point_of(k))
         end associate
      end do
   end subroutine seat_ghosts

   ! The faces that ghosts and their images are for.
   subroutine set_faces(self)
      type(solid_ghosts_t), intent(inout) :: self
      integer :: k

      self%face = [(0, k=1, self%n_slots + self%images%n)]
      if (.not. self%shared) return
      do k = 1, self%n_slots
         if (self%solid_of(k) > 0) self%face(k) = self%drawn(self%strips%point_of(k))%edge
      end do
      do k = 1, self%images%n
         self%face(self%n_slots + k) = self%face(self%images%source(k) - self%before)
      end do
   end subroutine set_faces

   !> Puts the ghosts where they are in some poses of the solids, with their velocity there.
   subroutine move_ghosts(self, solids, poses, box, state)
      type(solid_ghosts_t), intent(inout) :: self
      type(solid_t), intent(in) :: solids(:)
      type(pose_t), intent(in) :: poses(:)     !! (solids) accelerations of free ones do not matter
      type(box_t), intent(in) :: box           !! at the same time
      type(state_t), intent(inout) :: state    !! x, y, u, v and volume of the ghosts are set; density to 0
      type(obstacle_t) :: now
      logical :: moves(size(solids))
      integer :: k

      self%poses = poses
      do k = 1, size(solids)
         moves(k) = solids(k)%motion%moves()
         self%through(:, k) = .false.
         if (solids(k)%body%is_free()) self%poses(k) = coasting(poses(k), 0.0_dp)
         if (.not. moves(k)) cycle
         now = new_obstacle(solids(k), poses(k), box)
         self%through(:, k) = now%reaches_through(box)
      end do
      if (self%shared) self%obstacles = [(new_obstacle(solids(k), poses(k), box), k=1, size(solids))]
      call rest(self, state)
      self%moves = any(moves)
      if (.not. self%moves) return
      !$omp parallel do default(none) shared(self, solids, box, state, moves)
      do k = 1, self%n_slots
         if (self%solid_of(k) == 0) cycle
         if (moves(self%solid_of(k))) call move_ghost(self, solids(self%solid_of(k)), box, k, state)
      end do
      !$omp end parallel do
   end subroutine move_ghosts

   ! All where they were, and at rest.
   subroutine rest(self, state)
      type(solid_ghosts_t), intent(in) :: self
      type(state_t), intent(inout) :: state
      integer :: i, k

      !$omp parallel do simd default(none) shared(self, state) private(i)
      do k = 1, self%n_slots
         i = self%before + k
         state%x(i) = self%place(1, k) + self%way(1, k)
         state%y(i) = self%place(2, k) + self%way(2, k)
         state%u(i) = 0
         state%v(i) = 0
         state%s(i) = 0
         state%volume(i) = self%area(k)
      end do
      !$omp end parallel do simd
   end subroutine rest

   pure subroutine move_ghost(self, solid, box, k, state)
      type(solid_ghosts_t), intent(inout) :: self
      type(solid_t), intent(in) :: solid       ! the ghost's
      type(box_t), intent(in) :: box
      integer, intent(in) :: k
      type(state_t), intent(inout) :: state
      real(dp) :: place(2), velocity(2), acceleration(2), normal(2), pull(2), area

      associate (cell => self%drawn(self%strips%point_of(k)), pose => self%poses(self%solid_of(k)))
         call move_cell(cell, solid%pivot, pose, box, place, velocity, acceleration, area)
         normal = turn(pose%angle, cell%normal)
      end associate
      pull = dot_product(acceleration, normal)*normal
      self%pull_x(k) = pull(1)
      self%pull_y(k) = pull(2)
      self%place(:, k) = place
      associate (i => self%before + k)
         state%x(i) = place(1) + self%way(1, k)
         state%y(i) = place(2) + self%way(2, k)
         state%u(i) = velocity(1)
         state%v(i) = velocity(2)
         state%volume(i) = area
      end associate
   end subroutine move_ghost

   !> Gives the images of ghosts what they have of these.
   subroutine mirror_ghosts(self, box, state)
      type(solid_ghosts_t), intent(inout) :: self
      type(box_t), intent(in) :: box             !! at the state's time
      type(state_t), intent(inout) :: state      !! density of the ghosts is set, as is their exchange
      real(dp) :: pass(2)
      integer :: k, source

      if (self%moves .or. .not. self%faces%are_turned) call self%faces%turn(self%poses%angle, self%solid_of)
      if (self%images%n == 0) return
      call fill_ghosts(self%images, box, state)
      call mirror_field(self, self%exchange)
      call self%faces%mirror(box, self%images%kind(:self%images%n), self%images%source(:self%images%n) - self%before)
      if (.not. any(self%through)) return
      do k = 1, self%images%n
         source = self%images%source(k)
         pass = self%passes(source - self%before, self%images%kind(k))
         if (pass(1) < 0) state%u(self%images%n_held + k) = state%u(source)
         if (pass(2) < 0) state%v(self%images%n_held + k) = state%v(source)
      end do
   end subroutine mirror_ghosts

   ! What images have as their sources do.
   pure subroutine mirror_field(self, field)
      type(solid_ghosts_t), intent(in) :: self
      real(dp), intent(inout) :: field(:)   ! (n_slots and images)
      integer :: k

      do k = 1, self%images%n
         field(self%n_slots + k) = field(self%images%source(k) - self%before)
      end do
   end subroutine mirror_field

end module solid_ghosts
