!> Sorts the particles at the start of a step and lists what each cluster can reach during it.
!!
!! A step moves a particle from x to about x + u dt. Sorting by the position predicted for the
!! middle of the step, x + u tau with tau = dt/2 of the step before, halves the margin that ranges need.
!! `list_ranges` is told how long before or after that time its ranges are to hold, and allows for
!! accelerations by `slack`; the time step verifies both.
module neighbours
   use images, only: bottom_wall, fill_images, images_t, list_images, walls_t
   use kernel, only: kernel_t
   use kinds, only: dp, i8
   use lanes, only: nl
   use particles, only: far_away, particles_t, reserve_slots
   use strips, only: add_ranges, extent_t, ranges_t, sort_into_strips, strips_t
   implicit none
   private

   public :: neighbours_t, sort_particles, list_ranges, ranges_around

   !> What is near what.
   type :: neighbours_t
      real(dp) :: tau = 0       !! time that sorting looks ahead
      real(dp) :: travel = 0    !! time that the ranges allow for
      real(dp) :: image_travel = 0   !! time that images were made for
      real(dp) :: slack = 0     !! length that the ranges allow accelerations to lead a particle
      real(dp) :: stray = 0     !! length that they did, in the last step
      integer :: n_clusters = 0
      type(strips_t) :: strips               !! of the own slots
      type(images_t) :: images               !! behind the own slots
      type(ranges_t), allocatable :: ranges(:)   !! (n_clusters) slots that a cluster can reach
      type(extent_t), allocatable, private :: clusters(:)   !! (n_clusters) predicted positions, velocities
   contains
      procedure :: bytes => neighbours_bytes
   end type neighbours_t

contains

   !> Bytes that all arrays take.
   pure integer(i8) function neighbours_bytes(self) result(bytes)
      class(neighbours_t), intent(in) :: self

      bytes = self%strips%bytes() + self%images%bytes()
      if (allocated(self%ranges)) bytes = bytes &
         + size(self%ranges, kind=i8)*(storage_size(self%ranges) + storage_size(self%clusters))/8
   end function neighbours_bytes

   !> Moves the particles of `next` into `base` in the order of strips, and finds the images.
   !!
   !! The images are filled. The state of `next` is not changed.
   subroutine sort_particles(self, p, kernel, walls, dx, step_ahead, scattered)
      type(neighbours_t), intent(inout) :: self
      type(particles_t), intent(inout) :: p
      type(kernel_t), intent(in) :: kernel
      type(walls_t), intent(in) :: walls
      real(dp), intent(in) :: dx           !! particle spacing
      real(dp), intent(in) :: step_ahead   !! expected time step
      logical, intent(out) :: scattered    !! some particle is too far away to go on
      integer :: i, n_old
      real(dp) :: reach

      self%tau = step_ahead/2
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
      call measure_clusters(self, p)
      self%images%strips%height = self%strips%height
      self%images%strips%bin_width = self%strips%bin_width
      self%images%strips%origin = self%strips%origin
      ! Room for a step up to twice as long as expected, should dt turn out larger.
      self%image_travel = 3*self%tau
      associate (overall => self%strips%overall)
         reach = kernel%support + 2*(self%slack + self%image_travel*maxval(abs([overall%slowest, overall%fastest])))
      end associate
      call list_images(self%images, walls, p, self%tau, reach)
      call fill_images(self%images, walls, p%n_own, p%base)
      call measure_images(self, p)
   end subroutine sort_particles

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
         p%owner(i) = i
         if (old > 0) then
            p%base%x(i) = p%next%x(old)
            p%base%y(i) = p%next%y(old)
            p%base%u(i) = p%next%u(old)
            p%base%v(i) = p%next%v(old)
            p%base%s(i) = p%next%s(old)
            p%base%w(i) = p%next%w(old)
            p%stage(2)%w(i) = p%m(old)
            p%sorted_id(i) = p%id(old)
         else
            p%base%x(i) = far_away
            p%base%y(i) = far_away
            p%base%u(i) = 0
            p%base%v(i) = 0
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

   ! Positions and velocities of each cluster, velocities of each strip and of all.
   subroutine measure_clusters(self, p)
      type(neighbours_t), intent(inout) :: self
      type(particles_t), intent(in) :: p
      integer :: c, k

      self%n_clusters = p%n_own/nl
      if (allocated(self%ranges)) then
         if (size(self%ranges) < self%n_clusters) deallocate (self%ranges, self%clusters)
      end if
      if (.not. allocated(self%ranges)) &
         allocate (self%ranges(self%n_clusters + self%n_clusters/8), self%clusters(self%n_clusters + self%n_clusters/8))
      !$omp parallel do default(none) shared(self, p) private(c)
      do k = 1, self%strips%n
         self%strips%extent(k) = extent_t()
         do c = (self%strips%slot_start(k) - 1)/nl + 1, (self%strips%slot_start(k + 1) - 1)/nl
            self%clusters(c) = cluster_extent(p, c, self%tau)
            call widen(self%strips%extent(k), self%clusters(c)%slowest, self%clusters(c)%fastest)
         end do
      end do
      !$omp end parallel do
      call measure_all(self%strips)
   end subroutine measure_clusters

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
   subroutine list_ranges(self, p, kernel, travel)
      type(neighbours_t), intent(inout) :: self
      type(particles_t), intent(in) :: p
      type(kernel_t), intent(in) :: kernel
      real(dp), intent(in) :: travel
      real(dp) :: reach
      integer :: c

      self%travel = travel
      reach = kernel%support + 2*self%slack
      !$omp parallel do default(none) shared(self, p, travel, reach) schedule(dynamic, 64)
      do c = 1, self%n_clusters
         associate (ranges => self%ranges(c), cluster => self%clusters(c))
            ranges%n = 0
            call add_ranges(self%strips, cluster, reach, travel, ranges)
            call add_ranges(self%images%strips, cluster, reach, travel, ranges)
            call trim_ranges(p, self%tau, travel, reach, cluster, ranges)
         end associate
      end do
      !$omp end parallel do
   end subroutine list_ranges

   ! Where a cluster's particles are predicted and how fast they are.
   pure type(extent_t) function cluster_extent(p, c, tau) result(cluster)
      type(particles_t), intent(in) :: p
      integer, intent(in) :: c
      real(dp), intent(in) :: tau
      real(dp) :: x, y
      integer :: i

      do i = (c - 1)*nl + 1, c*nl
         if (p%id(i) == 0) cycle
         x = p%base%x(i) + tau*p%base%u(i)
         y = p%base%y(i) + tau*p%base%v(i)
         cluster%lower = [min(cluster%lower(1), x), min(cluster%lower(2), y)]
         cluster%upper = [max(cluster%upper(1), x), max(cluster%upper(2), y)]
         cluster%slowest = [min(cluster%slowest(1), p%base%u(i)), min(cluster%slowest(2), p%base%v(i))]
         cluster%fastest = [max(cluster%fastest(1), p%base%u(i)), max(cluster%fastest(2), p%base%v(i))]
      end do
   end function cluster_extent

   ! Takes from both ends of each range what stays out of reach, and ranges that are empty then.
   pure subroutine trim_ranges(p, tau, travel, reach, cluster, ranges)
      type(particles_t), intent(in) :: p
      real(dp), intent(in) :: tau, travel, reach
      type(extent_t), intent(in) :: cluster
      type(ranges_t), intent(inout) :: ranges
      integer :: k, n, first, last

      n = 0
      do k = 1, ranges%n
         first = ranges%first(k)
         last = ranges%last(k)
         do while (first <= last)
            if (within_reach(first)) exit
            first = first + 1
         end do
         do while (last > first)
            if (within_reach(last)) exit
            last = last - 1
         end do
         if (last < first) cycle
         n = n + 1
         ranges%first(n) = first
         ranges%last(n) = last
      end do
      ranges%n = n

   contains

      pure logical function within_reach(j)
         integer, intent(in) :: j
         real(dp) :: x, y, dx, dy

         x = p%base%x(j) + tau*p%base%u(j)
         y = p%base%y(j) + tau*p%base%v(j)
         dx = max(cluster%lower(1) - x, x - cluster%upper(1)) &
              - travel*max(p%base%u(j) - cluster%slowest(1), cluster%fastest(1) - p%base%u(j))
         dy = max(cluster%lower(2) - y, y - cluster%upper(2)) &
              - travel*max(p%base%v(j) - cluster%slowest(2), cluster%fastest(2) - p%base%v(j))
         within_reach = max(0.0_dp, dx)**2 + max(0.0_dp, dy)**2 <= reach**2
      end function within_reach

   end subroutine trim_ranges

   !> Slots, own and images, that may be closer than `reach` to a point in the base state.
   pure subroutine ranges_around(self, x, y, reach, ranges)
      type(neighbours_t), intent(in) :: self
      real(dp), intent(in) :: x, y
      real(dp), intent(in) :: reach
      type(ranges_t), intent(out) :: ranges
      type(extent_t) :: point

      point = extent_t(lower=[x, y], upper=[x, y], slowest=0.0_dp, fastest=0.0_dp)
      call add_ranges(self%strips, point, reach, self%tau, ranges)
      call add_ranges(self%images%strips, point, reach, self%tau, ranges)
   end subroutine ranges_around

end module neighbours
