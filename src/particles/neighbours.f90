!> Sorts the particles and lists what each cluster can reach during the next steps.
!!
!! In a time t a particle goes from x to about x + u t. Sorting by the position predicted for the middle of the steps that the
!! lists are for, x + u tau, halves the margin that lists need. `list_neighbours` is told how long before or after that time its
!! lists are to hold, and allows for accelerations by `slack`; the time step verifies both, and sorts again in time.
module neighbours
   use candidates, only: block_groups, block_slots, candidates_t, list_group, trim_lists
   use images, only: bottom_wall, fill_images, images_t, list_images, walls_t
   use kernel, only: kernel_t
   use kinds, only: dp, i8, sp
   use particles, only: far_away, particles_t, reserve_slots, swap_states
   use strips, only: add_ranges, extent_t, group_slots, ranges_t, sort_into_strips, strips_t
   implicit none
   private

   public :: neighbours_t, sort_particles, keep_order, list_neighbours, ranges_around

   !> What is near what.
   type :: neighbours_t
      real(dp) :: age = 0       !! time of the base state since the particles were sorted
      real(dp) :: tau = 0       !! time that sorting looks ahead
      real(dp) :: travel = 0    !! time before and after tau that the lists allow for
      real(dp) :: image_travel = 0   !! time before and after tau that images were made for
      real(dp) :: slack = 0     !! length that the lists allow accelerations to lead a particle
      real(dp) :: stray = 0     !! length that they have until the base state, at most
      real(dp) :: next_stray = 0     !! and until the next one
      real(dp) :: drift = 0          !! max |u - u when sorted|, mean of the last step
      real(dp) :: acceleration = -1  !! largest since the particles were sorted; before the first step not known
      logical :: jumped = .false.    !! a particle went through a periodic side since: the lists are void
      integer :: n_groups = 0
      integer :: n_blocks = 0
      type(strips_t) :: strips               !! of the own slots
      type(images_t) :: images               !! behind the own slots
      type(candidates_t), allocatable :: blocks(:)   !! (n_blocks) slots that each cluster can reach
      type(extent_t), allocatable, private :: groups(:)   !! (n_groups) predicted positions, velocities
   contains
      procedure :: bytes => neighbours_bytes
   end type neighbours_t

contains

   !> Bytes that all arrays take.
   pure integer(i8) function neighbours_bytes(self) result(bytes)
      class(neighbours_t), intent(in) :: self

      bytes = self%strips%bytes() + self%images%bytes()
      if (allocated(self%blocks)) bytes = bytes + sum(self%blocks%bytes()) &
         + size(self%groups, kind=i8)*storage_size(self%groups)/8
   end function neighbours_bytes

   !> Moves the particles of `next` into `base` in the order of strips, and finds the images.
   !!
   !! The images are filled. The state of `next` is not changed.
   subroutine sort_particles(self, p, kernel, walls, dx, span, scattered)
      type(neighbours_t), intent(inout) :: self
      type(particles_t), intent(inout) :: p
      type(kernel_t), intent(in) :: kernel
      type(walls_t), intent(in) :: walls
      real(dp), intent(in) :: dx           !! particle spacing
      real(dp), intent(in) :: span         !! time that the steps to come are expected to take
      logical, intent(out) :: scattered    !! some particle is too far away to go on
      integer :: i, n_old
      real(dp) :: outwards(4), reach(4)

      self%tau = span/2
      self%age = 0
      self%stray = 0
      self%jumped = .false.
      n_old = p%n_own
      !$omp parallel do default(none) shared(self, p, n_old)
      do i = 1, n_old
         p%stage(1)%x(i) = p%next%x(i) + self%tau*p%next%u(i)
         p%stage(1)%y(i) = p%next%y(i) + self%tau*p%next%v(i)
      end do
      !$omp end parallel do
      self%strips%height = kernel%support/2
      self%strips%bin_width = dx/4
      self%strips%origin = walls%at(bottom_wall)
      call sort_into_strips(self%strips, n_old, p%id(1:n_old), p%stage(1)%x(1:n_old), p%stage(1)%y(1:n_old), 1, .true.)
      scattered = self%strips%n < 0
      if (scattered) return
      call permute(self, p)
      call measure_groups(self, p)
      self%images%strips%height = self%strips%height
      self%images%strips%bin_width = dx   ! images stand in narrow stripes far apart, and many bins are empty
      self%images%strips%origin = self%strips%origin
      ! Room for steps half as long again as expected.
      self%image_travel = 2*self%tau
      associate (overall => self%strips%overall)
         ! Others may be beyond a side by what they move outwards.
         outwards = max(0.0_dp, [-overall%slowest(1), overall%fastest(1), -overall%slowest(2), overall%fastest(2)])
         if (walls%periodic(1)) outwards(1:2) = maxval(outwards(1:2))
         if (walls%periodic(2)) outwards(3:4) = maxval(outwards(3:4))
         reach = kernel%support + 2*self%slack + (self%tau + self%image_travel)*outwards
      end associate
      call list_images(self%images, walls, p, self%tau, self%image_travel, reach)
      call fill_images(self%images, walls, p%n_own, p%base)
      call measure_images(self, p)
   end subroutine sort_particles

   !> Takes the state of `next` into `base` as it is, with the order and the lists that there are.
   subroutine keep_order(self, p, walls, step)
      type(neighbours_t), intent(inout) :: self
      type(particles_t), intent(inout) :: p
      type(walls_t), intent(in) :: walls
      real(dp), intent(in) :: step   !! from base to next

      self%age = self%age + step
      self%stray = self%next_stray
      call swap_states(p%base, p%next)
      call fill_images(self%images, walls, p%n_own, p%base)
   end subroutine keep_order

   ! Gathers state, mass and number of each slot from where its particle was.
   subroutine permute(self, p)
      type(neighbours_t), intent(inout) :: self
      type(particles_t), intent(inout) :: p
      real(dp), allocatable :: spare(:)
      integer, allocatable :: spare_id(:)
      integer :: i, old

      call reserve_slots(p, self%strips%n_slots)
      if (p%features%dissipation) call permute_dissipated(self, p)
      p%n_own = self%strips%n_slots
      p%n_slots = p%n_own
      !$omp parallel do default(none) shared(self, p) private(old)
      do i = 1, p%n_own
         old = self%strips%point_of(i)
         if (old > 0) then
            p%base%x(i) = p%next%x(old)
            p%base%y(i) = p%next%y(old)
            p%base%u(i) = p%next%u(old)
            p%base%v(i) = p%next%v(old)
            p%sorted_u(i) = real(p%next%u(old), sp)
            p%sorted_v(i) = real(p%next%v(old), sp)
            p%base%s(i) = p%next%s(old)
            p%base%w(i) = p%next%w(old)
            p%stage(2)%w(i) = p%m(old)
            p%sorted_id(i) = p%id(old)
         else
            p%base%x(i) = far_away
            p%base%y(i) = far_away
            p%base%u(i) = 0
            p%base%v(i) = 0
            p%sorted_u(i) = 0
            p%sorted_v(i) = 0
            p%base%s(i) = 0
            p%base%w(i) = 0
            p%stage(2)%w(i) = 0
            p%sorted_id(i) = 0
         end if
      end do
      !$omp end parallel do
      call move_alloc(p%m, spare)
      call move_alloc(p%stage(2)%w, p%m)
      call move_alloc(spare, p%stage(2)%w)
      call move_alloc(p%id, spare_id)
      call move_alloc(p%sorted_id, p%id)
      call move_alloc(spare_id, p%sorted_id)
   end subroutine permute

   subroutine permute_dissipated(self, p)
      type(neighbours_t), intent(in) :: self
      type(particles_t), intent(inout) :: p
      real(dp), allocatable :: spare(:)
      integer :: i, old

      do i = 1, self%strips%n_slots
         old = self%strips%point_of(i)
         p%dissipating(i) = 0
         if (old > 0) p%dissipating(i) = p%dissipated(old)
      end do
      call move_alloc(p%dissipated, spare)
      call move_alloc(p%dissipating, p%dissipated)
      call move_alloc(spare, p%dissipating)
   end subroutine permute_dissipated

   ! Positions and velocities of each group of slots, velocities of each strip and of all.
   subroutine measure_groups(self, p)
      type(neighbours_t), intent(inout) :: self
      type(particles_t), intent(in) :: p
      integer :: g, k

      self%n_groups = p%n_own/group_slots
      self%n_blocks = (p%n_own + block_slots - 1)/block_slots
      if (allocated(self%groups)) then
         if (size(self%groups) < self%n_groups) deallocate (self%blocks, self%groups)
      end if
      if (.not. allocated(self%groups)) &
         allocate (self%blocks(self%n_blocks + self%n_blocks/8 + 1), self%groups(self%n_groups + self%n_groups/8))
      !$omp parallel do default(none) shared(self, p) private(g)
      do k = 1, self%strips%n
         self%strips%extent(k) = extent_t()
         do g = (self%strips%slot_start(k) - 1)/group_slots + 1, (self%strips%slot_start(k + 1) - 1)/group_slots
            self%groups(g) = group_extent(p, g, self%tau)
            call widen(self%strips%extent(k), self%groups(g)%slowest, self%groups(g)%fastest)
         end do
      end do
      !$omp end parallel do
      call measure_all(self%strips)
   end subroutine measure_groups

   ! Velocities of each strip of images and of all images.
   subroutine measure_images(self, p)
      type(neighbours_t), intent(inout) :: self
      type(particles_t), intent(in) :: p
      integer :: k, j

      associate (strips => self%images%strips)
         do k = 1, strips%n
            strips%extent(k) = extent_t()
            do j = strips%slot_start(k), strips%slot_start(k + 1) - 1
               call widen(strips%extent(k), [p%base%u(j), p%base%v(j)], [p%base%u(j), p%base%v(j)])
            end do
         end do
      end associate
      call measure_all(self%images%strips)
   end subroutine measure_images

   subroutine measure_all(strips)
      type(strips_t), intent(inout) :: strips
      integer :: k

      strips%overall = extent_t()
      do k = 1, strips%n
         call widen(strips%overall, strips%extent(k)%slowest, strips%extent(k)%fastest)
      end do
   end subroutine measure_all

   pure subroutine widen(extent, slowest, fastest)
      type(extent_t), intent(inout) :: extent
      real(dp), intent(in) :: slowest(2), fastest(2)

      extent%slowest = min(extent%slowest, slowest)
      extent%fastest = max(extent%fastest, fastest)
   end subroutine widen

   !> Lists the slots that each cluster can reach until `travel` before or after the time that the
   !! particles were sorted for.
   !!
   !! All particles are displaced by the same time, so two of them come closer by no more than their relative
   !! velocity times `travel`, and what accelerations add: the slack.
   subroutine list_neighbours(self, p, kernel, travel)
      type(neighbours_t), intent(inout) :: self
      type(particles_t), intent(inout) :: p   !! base is as sorted; the first stage's positions are scratch
      type(kernel_t), intent(in) :: kernel
      real(dp), intent(in) :: travel
      real(dp) :: reach
      integer :: b, i

      self%travel = travel
      reach = kernel%support + 2*self%slack
      !$omp parallel default(none) shared(self, p, travel, reach) private(i)
      !$omp do simd
      do i = 1, p%n_slots
         p%stage(1)%x(i) = p%base%x(i) + self%tau*p%base%u(i)
         p%stage(1)%y(i) = p%base%y(i) + self%tau*p%base%v(i)
      end do
      !$omp end do simd
      !$omp do schedule(dynamic)
      do b = 1, self%n_blocks
         call list_block(self, p, b, reach, travel)
      end do
      !$omp end do
      !$omp end parallel
   end subroutine list_neighbours

   ! The lists of a block's clusters.
   subroutine list_block(self, p, b, reach, travel)
      type(neighbours_t), intent(inout) :: self
      type(particles_t), intent(in) :: p
      integer, intent(in) :: b
      real(dp), intent(in) :: reach, travel
      type(ranges_t) :: own, images
      integer :: g

      do g = (b - 1)*block_groups + 1, min(b*block_groups, self%n_groups)
         own%n = 0
         images%n = 0
         call add_ranges(self%strips, self%groups(g), reach, travel, own)
         call add_ranges(self%images%strips, self%groups(g), reach, travel, images)
         call list_group(self%blocks(b), g - (b - 1)*block_groups, own, images, p%capacity, p%stage(1)%x, p%stage(1)%y, &
                         p%base%u, p%base%v, (g - 1)*group_slots, self%groups(g), reach, travel)
      end do
      call trim_lists(self%blocks(b))
   end subroutine list_block

   ! Where a group's particles are predicted and how fast they are.
   pure type(extent_t) function group_extent(p, g, tau) result(group)
      type(particles_t), intent(in) :: p
      integer, intent(in) :: g
      real(dp), intent(in) :: tau
      real(dp) :: x, y
      integer :: i

      do i = (g - 1)*group_slots + 1, g*group_slots
         if (p%id(i) == 0) cycle
         x = p%base%x(i) + tau*p%base%u(i)
         y = p%base%y(i) + tau*p%base%v(i)
         group%lower = [min(group%lower(1), x), min(group%lower(2), y)]
         group%upper = [max(group%upper(1), x), max(group%upper(2), y)]
         group%slowest = [min(group%slowest(1), p%base%u(i)), min(group%slowest(2), p%base%v(i))]
         group%fastest = [max(group%fastest(1), p%base%u(i)), max(group%fastest(2), p%base%v(i))]
      end do
   end function group_extent

   !> Slots, own and images, that may be closer than `reach` to a point in the base state.
   pure subroutine ranges_around(self, x, y, reach, ranges)
      type(neighbours_t), intent(in) :: self
      real(dp), intent(in) :: x, y
      real(dp), intent(in) :: reach
      type(ranges_t), intent(out) :: ranges
      type(extent_t) :: point
      real(dp) :: margin

      point = extent_t(lower=[x, y], upper=[x, y], slowest=0.0_dp, fastest=0.0_dp)
      margin = reach + self%stray
      call add_ranges(self%strips, point, margin, abs(self%tau - self%age), ranges)
      call add_ranges(self%images%strips, point, margin, abs(self%tau - self%age), ranges)
   end subroutine ranges_around

end module neighbours
