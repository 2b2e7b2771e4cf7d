!> Sorts the particles and lists what each cluster can reach during the next steps.
!!
!! In a time t a particle goes from x to about x + u t. Sorting by the position predicted for the middle of the steps that the
!! lists are for, x + u tau, halves the margin that lists need. `list_neighbours` is told how long before or after that time its
!! lists are to hold, and allows for accelerations by a slack of each block; the time step verifies both, and has lists made again
!! in time.
module neighbours
   use candidates, only: block_groups, candidates_t, group_extent, list_group, trim_lists
   use communication, only: any_process, largest_of_all, n_processes
   use division, only: division_t
   use halo, only: find_halo
   use migration, only: migrate
   use box, only: left_wall, box_t
   use image_laws, only: as_scalar
   use images, only: fill_ghosts, images_t, list_images
   use kernel, only: kernel_t
   use kinds, only: dp, i8, sp
   use lanes, only: nl
   use particles, only: far_away, particles_t, reserve_slots, state_t, swap_states
   use motions, only: pose_t
   use solid_ghosts, only: make_ghosts, solid_ghosts_t, sort_ghosts
   use solid_lists, only: list_near_solids
   use solids, only: solid_t
   use strip_extents, only: measure_strips, take_slack
   use strips, only: add_ranges, extent_t, group_slots, ranges_t, sort_into_strips, strips_t, too_scattered
   implicit none
   private

   public :: neighbours_t, margin_t, sort_particles, keep_order, list_neighbours, ranges_around

   real(dp), parameter :: image_slack = 0.125_dp   ! in supports, at least: images are few

   !> How far accelerations may lead the particles of a block away from where they would be with the velocity that they had
   !! when they were sorted, and how far they have.
   type :: margin_t
      real(dp) :: slack = 0          !! length that the lists allow for
      real(dp) :: unsure = 0         !! length by which the way that lists were made from may be beside the true one
      real(dp) :: stray = 0          !! length until the base state, at most
      real(dp) :: next_stray = 0     !! and until the next one
      real(dp) :: drift = 0          !! max |u - u when sorted|, mean of the last step
      real(dp) :: acceleration = 0   !! largest since the particles were sorted, until the base state,
      real(dp) :: next_acceleration = 0   !! and until the next one
   end type margin_t

   !> What is near what.
   type :: neighbours_t
      real(dp) :: age = 0       !! time of the base state since the particles were sorted
      real(dp) :: tau = 0       !! time that sorting looks ahead
      real(dp) :: travel = 0    !! time before and after tau that the lists allow for
      real(dp) :: image_travel = 0   !! time before and after tau that images were made for
      real(dp) :: slack = 0     !! that every block has at least
      real(dp) :: slack_time_2 = 0   !! slack of a block for its acceleration
      real(dp) :: image_slack = 0    !! that images were made for: no block may have more
      real(dp) :: mean_acceleration = 0, largest_acceleration = 0   !! of all blocks, until the last step's end
      type(extent_t) :: extent       !! of all particles in x at the last step's end, and of their velocities; empty: not known
      logical :: jumped = .false.    !! a particle went through a periodic side since: the lists are void
      logical :: lasts = .false.     !! the lists serve for the next step
      integer :: n_blocks = 0
      integer, allocatable :: order(:)               !! (n_blocks) those first that no copy and no image of one is near
      integer :: n_inner = 0                         !! of these
      integer, allocatable :: first_block(:)         !! (own strips+1) of each own strip
      integer :: sorts = 0      !! so far
      type(division_t) :: division           !! among the processes
      type(strips_t) :: strips               !! of the slots held
      type(images_t) :: images               !! behind the own slots
      type(solid_ghosts_t) :: ghosts         !! of solids, and what is near them
      type(candidates_t), allocatable :: blocks(:)   !! (n_blocks) slots that each cluster can reach
      type(margin_t), allocatable :: margins(:)      !! (n_blocks)
   contains
      procedure :: computes
      procedure :: part
      procedure :: bytes => neighbours_bytes
   end type neighbours_t

contains

   !> Bytes that all arrays take.
   pure integer(i8) function neighbours_bytes(self) result(bytes)
      class(neighbours_t), intent(in) :: self

      bytes = self%strips%bytes() + self%images%bytes() + self%ghosts%bytes()
      if (allocated(self%blocks)) bytes = bytes + sum(self%blocks%bytes()) &
         + size(self%margins, kind=i8)*storage_size(self%margins)/8
   end function neighbours_bytes

   !> From where to where in `order`: 1 for what can be computed while copies are on their way, 2 for the rest.
   pure function part(self, number) result(span)
      class(neighbours_t), intent(in) :: self
      integer, intent(in) :: number
      integer :: span(2)

      span = merge([1, self%n_inner], [self%n_inner + 1, self%n_blocks], number == 1)
   end function part

   !> Whether this process has all that is near a line across the box.
   elemental logical function computes(self, x)
      class(neighbours_t), intent(in) :: self
      real(dp), intent(in) :: x   !! of the line

      associate (strips => self%strips)
         computes = strips%place_of(x) >= strips%own_places(1) .and. strips%place_of(x) <= strips%own_places(2)
      end associate
   end function computes

   !> Moves the particles of `next` into `base` in the order of strips, and finds the images.
   !!
   !! The images are filled. The state of `next` is not changed.
   subroutine sort_particles(self, p, kernel, box, dx, span, scattered, solids, poses)
      type(neighbours_t), intent(inout) :: self
      type(particles_t), intent(inout) :: p
      type(kernel_t), intent(in) :: kernel
      type(box_t), intent(in) :: box       !! at the time of `next`
      real(dp), intent(in) :: dx           !! particle spacing
      real(dp), intent(in) :: span         !! time that the steps to come are expected to take
      logical, intent(out) :: scattered    !! some particle is too far away to go on
      type(solid_t), intent(in), optional :: solids(:)   !! none if left out,
      type(pose_t), intent(in), optional :: poses(:)     !! (solids) and theirs at that time
      integer, allocatable :: number(:)
      integer :: n_points
      type(extent_t) :: extent
      real(dp) :: outwards(4), reach(4)

      if (present(solids) .and. self%sorts == 0) &
         call make_ghosts(self%ghosts, solids, box%after(-box%time), dx, kernel%support)
      self%tau = span/2
      self%jumped = .false.
      self%image_slack = max(self%slack, image_slack*kernel%support)
      ! Room for steps half as long again as expected.
      self%image_travel = 2*self%tau
      call predict(self%tau, 1, p%n_own, p)
      self%strips%width = kernel%support/2
      self%strips%bin_height = dx/4
      self%strips%origin = box%at(left_wall)
      if (n_processes() == 1) then
         call sort_into_strips(self%strips, p%n_own, p%id(1:p%n_own), p%stage(1)%x(1:p%n_own), p%stage(1)%y(1:p%n_own), 1, .true.)
         scattered = self%strips%n < 0
      else
         if (.not. self%extent%lower(1) <= self%extent%upper(1)) self%extent = extent_of_all(p)
         extent = self%extent
         extent%lower(1) = extent%lower(1) + self%tau*extent%slowest(1)
         extent%upper(1) = extent%upper(1) + self%tau*extent%fastest(1)
         ! A gauge looks half a spacing beside what it measures; a solid's ghost has its density of what is near it.
         call migrate(self%division, self%sorts, self%strips, p, box, extent, &
                      kernel%support*merge(2, 1, self%ghosts%exist()) + 2*self%image_slack + dx/2, self%image_travel, &
                      n_points, number, scattered)
         if (.not. scattered) then
            call predict(self%tau, p%n_own + 1, n_points, p)
            call sort_into_strips(self%strips, n_points, number, p%stage(1)%x(1:n_points), p%stage(1)%y(1:n_points), 1, .true.)
         end if
      end if
      if (scattered) return
      self%sorts = self%sorts + 1
      call permute(self, p)
      if (n_processes() > 1) call find_halo(self%images%halo, self%division, self%strips)
      call lay_out_blocks(self)
      call set_margins(self, p)
      self%age = 0
      call measure_strips(self%strips, p%base)
      if (n_processes() == 1) extent = self%strips%overall
      self%extent = extent_t()
      self%images%strips%width = self%strips%width
      self%images%strips%bin_height = dx   ! images stand in narrow stripes far apart, and many bins are empty
      self%images%strips%origin = self%strips%origin
      ! Others may be beyond a side by what they move outwards, as the side sees it.
      outwards = [extent%slowest(1), extent%fastest(1), extent%slowest(2), extent%fastest(2)] - box%normal_velocity()
      outwards = max(0.0_dp, outwards*[-1, 1, -1, 1])
      if (box%is_periodic(1)) outwards(1:2) = maxval(outwards(1:2))
      if (box%is_periodic(2)) outwards(3:4) = maxval(outwards(3:4))
      reach = kernel%support + 2*self%image_slack + (self%tau + self%image_travel)*outwards
      call list_images(self%images, box%after(self%tau), p, self%tau, self%image_travel, reach)
      scattered = self%images%strips%n < 0
      ! An image and what it is of are not farther from a side than `reach`.
      if (n_processes() > 1) then
         associate (first => extent%lower(1) - 2*maxval(reach), last => extent%upper(1) + 2*maxval(reach))
            if (too_scattered(self%images%strips, first, last, is_fluid=.false.)) scattered = any_process(scattered)
         end associate
      end if
      if (scattered) return
      call fill_ghosts(self%images, box, p%base)
      call measure_strips(self%images%strips, p%base)
      if (self%ghosts%exist()) call sort_ghosts(self%ghosts, solids, poses, box, p, [self%strips%width, dx, kernel%support], &
                                                [self%tau, self%image_travel], self%image_slack)
   end subroutine sort_particles

   ! Of the state `next` of all processes, in x.
   type(extent_t) function extent_of_all(p) result(extent)
      type(particles_t), intent(in) :: p
      real(dp) :: extremes(6)
      integer :: i

      extremes = -huge(1.0_dp)
      associate (next => p%next)
         do i = 1, p%n_own
            if (p%id(i) > 0) extremes = max(extremes, [-next%x(i), next%x(i), -next%u(i), next%u(i), -next%v(i), next%v(i)])
         end do
      end associate
      call largest_of_all(size(extremes), extremes)
      extent%lower(1) = -extremes(1)
      extent%upper(1) = extremes(2)
      extent%slowest = -extremes([3, 5])
      extent%fastest = extremes([4, 6])
   end function extent_of_all

   ! Where particles will be in the middle of the steps to come.
   subroutine predict(tau, first, last, p)
      real(dp), intent(in) :: tau
      integer, intent(in) :: first, last      !! slots of `next`
      type(particles_t), intent(inout) :: p   !! stage(1) gets the positions
      integer :: i

      !$omp parallel do default(none) shared(tau, first, last, p)
      do i = first, last
         p%stage(1)%x(i) = p%next%x(i) + tau*p%next%u(i)
         p%stage(1)%y(i) = p%next%y(i) + tau*p%next%v(i)
      end do
      !$omp end parallel do
   end subroutine predict

   !> Takes the state of `next` into `base` as it is, with the order and the lists that there are.
   subroutine keep_order(self, p, box, step)
      type(neighbours_t), intent(inout) :: self
      type(particles_t), intent(inout) :: p
      type(box_t), intent(in) :: box         !! at the time of `next`
      real(dp), intent(in) :: step           !! from base to next

      self%age = self%age + step
      self%margins%stray = self%margins%next_stray
      self%margins%acceleration = self%margins%next_acceleration
      call swap_states(p%base, p%next)
      call fill_ghosts(self%images, box, p%base)
   end subroutine keep_order

   ! Gathers state, mass and number of each slot from where its particle was, and how its velocity has changed since it was
   ! sorted last.
   subroutine permute(self, p)
      type(neighbours_t), intent(inout) :: self
      type(particles_t), intent(inout) :: p
      real(dp), allocatable :: spare(:)
      integer, allocatable :: spare_id(:)
      integer :: i, old

      call reserve_slots(p, self%strips%n_slots)
      if (p%features%dissipation) call permute_dissipated(self, p)
      p%n_own = self%strips%n_own_slots
      p%n_held = self%strips%n_slots
      p%n_slots = p%n_held
      !$omp parallel do default(none) shared(self, p) private(old)
      do i = 1, p%n_held
         old = self%strips%point_of(i)
         if (old > 0) then
            p%base%x(i) = p%next%x(old)
            p%base%y(i) = p%next%y(old)
            p%base%u(i) = p%next%u(old)
            p%base%v(i) = p%next%v(old)
            p%stage(1)%volume(i) = sqrt((p%next%u(old) - p%sorted_u(old))**2 + (p%next%v(old) - p%sorted_v(old))**2)
            p%base%s(i) = p%next%s(old)
            p%base%volume(i) = p%next%volume(old)
            p%stage(2)%volume(i) = p%m(old)
            p%sorted_id(i) = p%id(old)
         else
            p%base%x(i) = far_away
            p%base%y(i) = far_away
            p%base%u(i) = 0
            p%base%v(i) = 0
            p%stage(1)%volume(i) = 0
            p%base%s(i) = 0
            p%base%volume(i) = 0
            p%stage(2)%volume(i) = 0
            p%sorted_id(i) = 0
         end if
      end do
      !$omp end parallel do
      call move_alloc(p%m, spare)
      call move_alloc(p%stage(2)%volume, p%m)
      call move_alloc(spare, p%stage(2)%volume)
      call move_alloc(p%id, spare_id)
      call move_alloc(p%sorted_id, p%id)
      call move_alloc(spare_id, p%sorted_id)
   end subroutine permute

   subroutine permute_dissipated(self, p)
      type(neighbours_t), intent(in) :: self
      type(particles_t), intent(inout) :: p
      real(dp), allocatable :: spare(:)
      integer :: i, old

      !$omp parallel do default(none) shared(self, p) private(old)
      do i = 1, self%strips%n_slots
         old = self%strips%point_of(i)
         p%dissipating(i) = 0
         if (old > 0) p%dissipating(i) = p%dissipated(old)
      end do
      !$omp end parallel do
      call move_alloc(p%dissipated, spare)
      call move_alloc(p%dissipating, p%dissipated)
      call move_alloc(spare, p%dissipating)
   end subroutine permute_dissipated

   ! A block lies in one strip, so that it does not depend on what other strips there are; those of a strip are about as long.
   subroutine lay_out_blocks(self)
      type(neighbours_t), intent(inout) :: self
      integer :: b, k, n_own, strip, first, last, n

      n_own = self%strips%own(2) - self%strips%own(1) + 1
      self%first_block = [1, (0, k=1, n_own)]
      do k = 1, n_own
         self%first_block(k + 1) = self%first_block(k) + (groups_in(self%strips, self%strips%own(1) + k - 1) + block_groups - 1) &
                                   /block_groups
      end do
      self%n_blocks = self%first_block(n_own + 1) - 1
      if (allocated(self%blocks)) then
         if (size(self%blocks) < self%n_blocks) deallocate (self%blocks, self%margins)
      end if
      if (.not. allocated(self%blocks)) &
         allocate (self%blocks(self%n_blocks + self%n_blocks/8 + 1), self%margins(self%n_blocks + self%n_blocks/8 + 1))
      do k = 1, n_own
         strip = self%strips%own(1) + k - 1
         n = self%first_block(k + 1) - self%first_block(k)
         last = 0
         do b = 1, n
            first = last
            last = b*groups_in(self%strips, strip)/n
            associate (block => self%blocks(self%first_block(k) + b - 1))
               block%before = self%strips%first(strip) - 1 + first*group_slots
               block%n_clusters = (last - first)*group_slots/nl
            end associate
         end do
      end do
   end subroutine lay_out_blocks

   pure integer function groups_in(strips, strip) result(n)
      type(strips_t), intent(in) :: strips
      integer, intent(in) :: strip

      n = (strips%last(strip) - strips%first(strip) + 1)/group_slots
   end function groups_in

   ! The slack of each block, for the accelerations that its particles had.
   subroutine set_margins(self, p)
      type(neighbours_t), intent(inout) :: self
      type(particles_t), intent(inout) :: p
      integer :: b, i1, i2

      !$omp parallel do default(none) shared(self, p) private(i1, i2)
      do b = 1, self%n_blocks
         i1 = self%blocks(b)%before + 1
         i2 = self%blocks(b)%before + nl*self%blocks(b)%n_clusters
         self%margins(b) = margin_t(slack=self%slack)
         if (self%age > 0) &
            self%margins(b)%slack = max(self%slack, min(self%image_slack, &
                                                        self%slack_time_2*maxval(p%stage(1)%volume(i1:i2))/self%age))
         p%sorted_u(i1:i2) = real(p%base%u(i1:i2), sp)
         p%sorted_v(i1:i2) = real(p%base%v(i1:i2), sp)
      end do
      !$omp end parallel do
   end subroutine set_margins

   ! The slack of each slot, into `slack`, of each strip and of all. An image has its source's.
   subroutine spread_slack(self, slack)
      type(neighbours_t), intent(inout) :: self
      real(dp), contiguous, intent(inout) :: slack(:)   !! (n_slots)
      integer :: b

      !$omp parallel do default(none) shared(self, slack)
      do b = 1, self%n_blocks
         associate (block => self%blocks(b))
            slack(block%before + 1:block%before + nl*block%n_clusters) = self%margins(b)%slack + self%margins(b)%unsure
         end associate
      end do
      !$omp end parallel do
      call fill_ghosts(self%images, as_scalar, slack)
      call take_slack(self%strips, slack)
      call take_slack(self%images%strips, slack)
   end subroutine spread_slack

   !> Lists the slots that each cluster can reach until `travel` before or after the time that the
   !! particles were sorted for.
   !!
   !! All particles are displaced by the same time, so two of them come closer by no more than their relative
   !! velocity times `travel`, and what accelerations add: the slack of both. Where lists are made some time after the particles
   !! were sorted, the way that they were on then is known to the `unsure` of their block.
   subroutine list_neighbours(self, p, kernel, travel)
      type(neighbours_t), intent(inout) :: self
      type(particles_t), intent(inout) :: p   !! base is filled; not changed, but for the first stage's state
      type(kernel_t), intent(in) :: kernel
      real(dp), intent(in) :: travel
      type(state_t) :: predicted              ! and slack in place of the volume
      integer :: b, i

      call swap_states(predicted, p%stage(1))
      self%travel = travel
      call spread_slack(self, predicted%volume)
      !$omp parallel default(none) shared(self, p, predicted, kernel, travel) private(i)
      !$omp do simd
      do i = 1, p%n_slots
         predicted%x(i) = p%base%x(i) + (self%tau - self%age)*p%base%u(i)
         predicted%y(i) = p%base%y(i) + (self%tau - self%age)*p%base%v(i)
      end do
      !$omp end do simd
      !$omp do schedule(dynamic)
      do b = 1, self%n_blocks
         call list_block(self, p%capacity, p%id, predicted, p%base, b, kernel%support, travel)
      end do
      !$omp end do
      !$omp end parallel
      if (self%ghosts%exist()) call list_near_solids(self%ghosts, self%blocks(:self%n_blocks), self%strips, self%images%strips, p, &
                                                     predicted, self%age, [self%tau - self%age, travel], kernel%support)
      call swap_states(predicted, p%stage(1))
      call find_inner(self, p%n_own, p%n_held)
   end subroutine list_neighbours

   ! Blocks that can be computed while copies are on their way.
   subroutine find_inner(self, n_own, n_held)
      type(neighbours_t), intent(inout) :: self
      integer, intent(in) :: n_own, n_held   !! slots
      logical :: outer(self%n_blocks)
      integer :: b, i, k

      outer = .not. self%images%halo%hides
      if (self%images%halo%exists .and. self%images%halo%hides) then
         !$omp parallel do default(none) shared(self, outer, n_own, n_held) private(i, k)
         do b = 1, self%n_blocks
            associate (block => self%blocks(b))
               do k = 1, block%first(block%n_clusters + 1) - 1
                  i = block%slot(k)
                  if (i > n_held) i = self%images%source(i - n_held)
                  outer(b) = outer(b) .or. i > n_own
               end do
               ! Ghosts of solids have their density of copies. Where free ones end, their ghosts say.
               if (self%ghosts%exist()) outer(b) = outer(b) .or. self%ghosts%meets(b) .or. allocated(self%ghosts%free)
            end associate
         end do
         !$omp end parallel do
      end if
      self%n_inner = count(.not. outer)
      self%order = [pack([(b, b=1, self%n_blocks)], .not. outer), pack([(b, b=1, self%n_blocks)], outer)]
   end subroutine find_inner

   ! The lists of a block's clusters.
   subroutine list_block(self, n, id, predicted, base, b, support, travel)
      type(neighbours_t), intent(inout) :: self
      integer, intent(in) :: n                     !! slots that there are
      integer, intent(in) :: id(n)
      type(state_t), intent(in) :: predicted, base
      integer, intent(in) :: b
      real(dp), intent(in) :: support, travel
      type(extent_t) :: group
      type(ranges_t) :: own, images
      integer, allocatable :: found(:)
      integer :: g, i0, n_groups

      n_groups = nl*self%blocks(b)%n_clusters/group_slots
      do g = 1, n_groups
         i0 = self%blocks(b)%before + (g - 1)*group_slots
         group = group_extent(id, predicted, base, i0)
         own%n = 0
         images%n = 0
         call add_ranges(self%strips, group, support, travel, own)
         call add_ranges(self%images%strips, group, support, travel, images)
         call list_group(self%blocks(b), g, own, images, n, predicted%x, predicted%y, base%u, base%v, predicted%volume, i0, group, &
                         support, travel, found)
      end do
      call trim_lists(self%blocks(b))
   end subroutine list_block

   !> Slots, own and images, that may be closer than `reach` to a point in the base state.
   pure subroutine ranges_around(self, x, y, reach, ranges)
      type(neighbours_t), intent(in) :: self
      real(dp), intent(in) :: x, y
      real(dp), intent(in) :: reach
      type(ranges_t), intent(out) :: ranges
      type(extent_t) :: point

      point = extent_t(lower=[x, y], upper=[x, y], slowest=0.0_dp, fastest=0.0_dp)
      call add_ranges(self%strips, point, reach, abs(self%tau - self%age), ranges)
      call add_ranges(self%images%strips, point, reach, abs(self%tau - self%age), ranges)
   end subroutine ranges_around

end module neighbours
