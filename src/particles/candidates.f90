!> The slots that a cluster's particles may come close to during a step: listed once, visited by every pass over pairs.
!!
!! Clusters are dealt with in blocks of a fixed number of slots, whatever the number of threads: a block has the lists of its
!! clusters.
module candidates
   use kinds, only: dp, i8
   use lanes, only: nl
   use particles, only: far_away, state_t
   use strips, only: extent_t, group_slots, ranges_t
   implicit none
   private

   public :: candidates_t, shared_candidates_t, group_extent, list_group, trim_lists

   integer, parameter, public :: block_slots = 128                 !! slots in a block
   integer, parameter, public :: block_clusters = block_slots/nl   !! clusters in a block
   integer, parameter, public :: block_groups = block_slots/group_slots   !! groups in a block
   integer, parameter :: group_clusters = group_slots/nl

   !> The lists of a block, one cluster's behind the other's.
   type :: candidates_t
      integer :: before = 0                           !! slots before the block's first
      integer :: n_clusters = 0
      integer :: first(block_clusters + 1) = 1        !! where a cluster's list begins in `slot`
      integer :: first_image(block_clusters) = 1      !! where its images begin: they come last
      integer, allocatable :: slot(:)
   contains
      procedure :: bytes => candidates_bytes
   end type candidates_t

   !> Lists between the fluid and ghosts of solids, and how each pair acts. Of thin solids only what acts in a step.
   type, extends(candidates_t) :: shared_candidates_t
      type(candidates_t) :: all                     !! of thin solids
      logical :: shared(block_clusters) = .false.   !! some pairs of the cluster may not act
      real(dp), allocatable :: part(:, :)           !! (nl, 0:places in `slot`) acts, gives or 0; place 0: acts
   contains
      procedure :: bytes => shared_candidates_bytes
      procedure :: parts
      procedure :: choose
   end type shared_candidates_t

   real(dp), parameter, public :: gives = 1   !! of a pair: the ghost has its pressure also of the particle
   real(dp), parameter, public :: acts = 2    !! and the two act on each other

contains

   !> Bytes that a block takes.
   pure elemental integer(i8) function candidates_bytes(self) result(bytes)
      class(candidates_t), intent(in) :: self

      bytes = storage_size(self, kind=i8)/8
      if (allocated(self%slot)) bytes = bytes + size(self%slot, kind=i8)*storage_size(self%slot)/8
   end function candidates_bytes

   pure elemental integer(i8) function shared_candidates_bytes(self) result(bytes)
      class(shared_candidates_t), intent(in) :: self

      bytes = self%candidates_t%bytes() + self%all%bytes()
      if (allocated(self%part)) bytes = bytes + size(self%part, kind=i8)*storage_size(self%part)/8
   end function shared_candidates_bytes

   !> First and last place in `part` of a cluster: one for each place in its list, or one for all.
   pure function parts(self, c)
      class(shared_candidates_t), intent(in) :: self
      integer, intent(in) :: c   !! cluster
      integer :: parts(2)

      parts = 0
      if (self%shared(c)) parts = [self%first(c), self%first(c + 1) - 1]
   end function parts

   !> Takes from all lists that of a cluster, after those of the clusters before it, but what does not act on any of its lanes.
   pure subroutine choose(self, c, shared, part)
      class(shared_candidates_t), intent(inout) :: self
      integer, intent(in) :: c             !! cluster
      logical, intent(in) :: shared        !! else all pairs act
      real(dp), intent(in) :: part(:, :)   !! (nl, places in its list and more) only then
      integer :: m, n, n_near

      if (shared .and. ubound(self%part, 2) < size(self%slot)) then
         deallocate (self%part)
         allocate (self%part(nl, 0:size(self%slot)), source=acts)
      end if
      self%shared(c) = shared
      associate (all => self%all, first => self%first(c))
         n_near = all%first(c + 1) - all%first(c)
         m = all%first_image(c) - all%first(c)
         n = n_near
         if (shared) then
            call keep_acting(n_near, all%slot(all%first(c):), part, self%slot(first:), self%part(:, first:), m, n)
         else
            self%slot(first:first + n - 1) = all%slot(all%first(c):all%first(c) + n - 1)
         end if
         self%first_image(c) = first + m
         self%first(c + 1) = first + n
      end associate
   end subroutine choose

   ! Without a branch: what does not act is written, and written over.
   pure subroutine keep_acting(n_near, slot, part, kept, kept_part, m, n)
      integer, intent(in) :: n_near, slot(n_near)
      real(dp), intent(in) :: part(nl, n_near)
      integer, intent(inout) :: kept(n_near)
      real(dp), intent(inout) :: kept_part(nl, n_near)
      integer, intent(inout) :: m    ! of these before the first image; of those kept
      integer, intent(out) :: n      ! kept
      real(dp) :: most
      integer :: k, l, images

      n = 0
      images = m + 1
      do k = 1, n_near
         if (k == images) m = n
         kept(n + 1) = slot(k)
         kept_part(:, n + 1) = part(:, k)
         most = part(1, k)
         !GCC$ unroll 8
         do l = 2, nl
            most = max(most, part(l, k))
         end do
         n = n + min(1, int(most))
      end do
      if (images > n_near) m = n
   end subroutine keep_acting

   !> Where a group's particles are predicted, how fast they are, and their slack.
   pure type(extent_t) function group_extent(id, predicted, base, i0) result(group)
      integer, intent(in) :: id(:)                !! of slots; 0 for dummies
      type(state_t), intent(in) :: predicted      !! positions, and slack in place of the volume
      type(state_t), intent(in) :: base
      integer, intent(in) :: i0                   !! slot before the group's first
      integer :: i

      do i = i0 + 1, i0 + group_slots
         if (id(i) == 0) cycle
         group%lower = min(group%lower, [predicted%x(i), predicted%y(i)])
         group%upper = max(group%upper, [predicted%x(i), predicted%y(i)])
         group%slowest = min(group%slowest, [base%u(i), base%v(i)])
         group%fastest = max(group%fastest, [base%u(i), base%v(i)])
      end do
      group%slack = predicted%volume(i0 + 1)
   end function group_extent

   !> Lists, for each cluster of the block's next group, what of the ranges may come closer than `support` to one of its
   !! particles while all move on for up to `travel`, forwards or backwards, from where they are predicted.
   !!
   !! Two particles come closer by no more than their relative velocity times `travel`, and by their slack; that velocity is
   !! taken from the box of the group's velocities.
   pure subroutine list_group(self, group, own, images, n, x, y, u, v, slack, i0, extent, support, travel, found)
      type(candidates_t), intent(inout) :: self
      integer, intent(in) :: group                 !! 1 for the block's first
      type(ranges_t), intent(in) :: own, images
      integer, intent(in) :: n                     !! slots that there are; group_slots - 1 behind a range are looked at
      real(dp), intent(in) :: x(n), y(n)           !! predicted positions
      real(dp), intent(in) :: u(n), v(n)
      real(dp), intent(in) :: slack(n)
      integer, intent(in) :: i0                    !! slot before the group's first
      type(extent_t), intent(in) :: extent         !! the group's velocities and slack
      real(dp), intent(in) :: support, travel
      integer, allocatable, intent(inout) :: found(:)   !! scratch; grows with what ranges hold
      ! Places before a list's first, of its last particle, of its last.
      integer :: begin(group_clusters), own_end(group_clusters), listed(group_clusters)
      integer :: c, m, room, n_here

      self%n_clusters = group*group_clusters
      if (own%n + images%n == 0) then
         call make_room(self%slot, 0, 0)
         do c = self%n_clusters - group_clusters + 1, self%n_clusters
            self%first_image(c) = self%first(c)
            self%first(c + 1) = self%first(c)
         end do
         return
      end if
      room = sum(own%last(:own%n) - own%first(:own%n) + 1) + sum(images%last(:images%n) - images%first(:images%n) + 1) &
             + group_slots
      call make_room(found, 0, group_clusters*room)
      begin = [((m - 1)*room, m=1, group_clusters)]
      listed = begin
      call pick(own, n, x, y, u, v, slack, x(i0 + 1), y(i0 + 1), extent%slowest, extent%fastest, support + extent%slack, &
                travel, size(found), found, listed)
      own_end = listed
      call pick(images, n, x, y, u, v, slack, x(i0 + 1), y(i0 + 1), extent%slowest, extent%fastest, support + extent%slack, &
                travel, size(found), found, listed)
      do m = 1, group_clusters
         c = (group - 1)*group_clusters + m
         n_here = listed(m) - begin(m)
         call make_room(self%slot, self%first(c) - 1, n_here)
         self%slot(self%first(c):self%first(c) + n_here - 1) = found(begin(m) + 1:listed(m))
         self%first_image(c) = self%first(c) + own_end(m) - begin(m)
         self%first(c + 1) = self%first(c) + n_here
      end do
   end subroutine list_group

   ! From ranges of slots, in whole vectors. Neither loop has a branch: the first would not be vectorised, because of which it
   ! takes the sign of `beyond` instead of a comparison; the second writes every slot, and keeps it if it is near.
   pure subroutine pick(ranges, n, x, y, u, v, slack, xi, yi, slowest, fastest, reach, travel, room, slot, listed)
      type(ranges_t), intent(in) :: ranges
      integer, intent(in) :: n, room
      real(dp), intent(in) :: x(n), y(n), u(n), v(n), slack(n), xi(nl, group_clusters), yi(nl, group_clusters)
      real(dp), intent(in) :: slowest(2), fastest(2), reach, travel
      integer, intent(inout) :: slot(room), listed(group_clusters)
      integer :: k, j0, j, l, m
      real(dp), parameter :: lane(group_slots) = [(real(j, dp), j=1, group_slots)]
      real(dp) :: near, least, beyond, left
      integer(i8) :: is_near(group_slots, group_clusters), place

      do k = 1, ranges%n
         do j0 = ranges%first(k) - 1, ranges%last(k) - 1, group_slots
            left = ranges%last(k) - j0
            !$omp simd private(m, near, least, beyond)
            do j = 1, group_slots
               near = reach + slack(j0 + j) + travel*(max(u(j0 + j) - slowest(1), fastest(1) - u(j0 + j)) &
                                                         + max(v(j0 + j) - slowest(2), fastest(2) - v(j0 + j)))
               !GCC$ unroll 8
               do m = 1, group_clusters
                  least = (x(j0 + j) - xi(1, m))**2 + (y(j0 + j) - yi(1, m))**2
                  !GCC$ unroll 8
                  do l = 2, nl
                     least = min(least, (x(j0 + j) - xi(l, m))**2 + (y(j0 + j) - yi(l, m))**2)
                  end do
                  beyond = least - near*near + far_away**2*max(0.0_dp, lane(j) - left)
                  is_near(j, m) = shiftr(transfer(beyond, 1_i8), 63)
               end do
            end do
            !GCC$ unroll 8
            do m = 1, group_clusters
               place = listed(m)
               !GCC$ unroll 8
               do j = 1, group_slots
                  slot(place + 1) = j0 + j
                  place = place + is_near(j, m)
               end do
               listed(m) = int(place)
            end do
         end do
      end do
   end subroutine pick

   !> Gives back what a block has much more of than its lists take.
   pure subroutine trim_lists(self)
      type(candidates_t), intent(inout) :: self
      integer, allocatable :: fitting(:)

      associate (listed => self%first(self%n_clusters + 1) - 1)
         if (size(self%slot) <= listed + listed/4) return
         allocate (fitting(listed + listed/16))
         fitting(:listed) = self%slot(:listed)
         call move_alloc(fitting, self%slot)
      end associate
   end subroutine trim_lists

   ! Room for `more` numbers behind the first `used`, which are kept.
   pure subroutine make_room(slot, used, more)
      integer, allocatable, intent(inout) :: slot(:)
      integer, intent(in) :: used, more
      integer, allocatable :: larger(:)

      if (allocated(slot)) then
         if (used + more <= size(slot)) return
      end if
      allocate (larger(used + more + (used + more)/8))
      if (used > 0) larger(:used) = slot(:used)
      call move_alloc(larger, slot)
   end subroutine make_room

end module candidates
