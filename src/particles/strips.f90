!> Neighbour search: upright strips of slots, sorted in y, that a group's neighbours lie in
!! as a few contiguous ranges.
!!
!! Strips are half a search radius wide. Inside a strip, points are counting-sorted in y by bins much lower
!! than the particle spacing, so the slots that a group of particles can reach are one range a strip. Tanks are longer than high:
!! strips are short, and what is near in them is near in memory.
!! The order of slots is that of strip, bin and number of the point: neither threads nor where a point was before matter.
module strips
   use, intrinsic :: iso_fortran_env, only: int64
   use kinds, only: dp, i8
   use lanes, only: nl
   use omp_lib, only: omp_get_max_threads
   implicit none
   private

   public :: strips_t, ranges_t, extent_t, sort_into_strips, too_scattered, add_ranges, relative_speed

   integer, parameter, public :: group_slots = max(8, nl)   !! slots whose neighbours are searched for together
   integer, parameter :: strip_ranges = 24               ! strips that a group reaches, at least
   integer, parameter, public :: max_ranges = strip_ranges + 4   !! a group's ranges

   integer(i8), parameter, public :: all_places = 2_i8**60   !! from minus to plus this

   !> Contiguous slot ranges.
   type :: ranges_t
      integer :: n = 0
      integer :: first(max_ranges), last(max_ranges)
   end type ranges_t

   !> Box of positions and box of velocities of some particles; empty at first.
   type :: extent_t
      real(dp) :: lower(2) = huge(1.0_dp), upper(2) = -huge(1.0_dp)
      real(dp) :: slowest(2) = huge(1.0_dp), fastest(2) = -huge(1.0_dp)
      real(dp) :: slack = 0   !! length that accelerations may lead one of them
   end type extent_t

   !> The strips of a set of points and where their slots begin. Where there is no point there is no strip.
   type :: strips_t
      integer :: n = 0                              !! strips
      integer :: n_places = 0                       !! strips that would stand side by side from the first to the last
      real(dp) :: origin = 0                        !! x of some strip's left edge, set by the caller
      real(dp) :: left = 0                          !! x of the first strip's left edge
      real(dp) :: width = 1                         !! of a strip
      real(dp) :: bin_height = 1                    !! in y
      integer(i8) :: first_place = 0                !! of the first strip, counted from the origin
      integer(i8) :: own_places(2) = [-all_places, all_places]   !! that this process computes, from and to; set by the caller
      integer :: own(2) = [1, 0]                    !! strips there, from and to: their slots come first
      integer :: slots_before = 0                   !! slots before those of the strips
      integer :: n_own_slots = 0                    !! slots of the own strips, padding included
      integer :: n_slots = 0                        !! slots taken, padding included
      integer, allocatable :: place(:)              !! (n) of a strip, counted from the left
      integer, allocatable :: before(:)             !! (n_places+1) strips to the left of a place
      integer, allocatable :: first(:), last(:)     !! (n) slots of a strip
      real(dp), allocatable :: lowest(:)            !! (n) y of a strip's first bin
      integer, allocatable :: bins(:)               !! (n) bins of a strip
      integer, allocatable :: bin_offset(:)         !! (n) where a strip's bins are in bin_start
      integer, allocatable :: bin_start(:)          !! first slot of each bin, and one past the strip's last
      type(extent_t), allocatable :: extent(:)      !! (n) velocities and slack in a strip, set by the caller
      type(extent_t) :: overall                     !! of all strips
      integer, allocatable, private :: strip_of(:)  !! (points) scratch
      integer, allocatable, private :: by_strip(:)  !! (points) scratch
      integer, allocatable :: point_of(:)           !! (n_slots) point in a slot, 0 for a dummy; counted from the first slot taken
   contains
      procedure :: place_of
      procedure :: bytes => strips_bytes
   end type strips_t

contains

   !> Sorts points into strips; slot `first_slot + k - 1` then belongs to point `point_of(k)`.
   !!
   !! Points with number 0 are left out. With more than `max_strips` strips nothing is done and
   !! n = -1: some point is absurdly far from the others.
   subroutine sort_into_strips(self, n_points, number, x, y, first_slot, whole_groups)
      type(strips_t), intent(inout) :: self      !! width and bin_height are set by the caller
      integer, intent(in) :: n_points
      integer, intent(in) :: number(n_points)    !! of each point, no two alike
      real(dp), intent(in) :: x(n_points), y(n_points)
      integer, intent(in) :: first_slot
      logical, intent(in) :: whole_groups        !! pad each strip to whole groups
      integer, allocatable :: strip_start(:)

      call assign_strips(self, n_points, number, x, whole_groups)
      if (self%n < 0) return
      call list_by_strip(self, n_points, strip_start)
      call lay_out(self, strip_start, y, first_slot, whole_groups)
      call fill_bins(self, strip_start, number, y)
   end subroutine sort_into_strips

   !> Where the strip of a point is, counted from the origin: that depends on no other point.
   elemental integer(i8) function place_of(self, x) result(place)
      class(strips_t), intent(in) :: self
      real(dp), intent(in) :: x

      place = floor((x - self%origin)/self%width, i8)
   end function place_of

   !> Whether there are points too far from others, or from the origin, for strips.
   pure logical function too_scattered(self, first, last, is_fluid)
      type(strips_t), intent(in) :: self
      real(dp), intent(in) :: first, last   !! least and largest x
      logical, intent(in) :: is_fluid       !! there may be images beyond them
      integer, parameter :: for_images = 8
      integer, parameter :: max_strips = 4000000
      real(dp), parameter :: max_offset = 2.0_dp**52   ! strips further from the origin than this are not told from their neighbours

      too_scattered = .not. (last - first < self%width*(max_strips - merge(for_images, 0, is_fluid)) &
                             .and. abs((first - self%origin)/self%width) < max_offset)
   end function too_scattered

   ! The strip of each point; 0 for points that take no part.
   subroutine assign_strips(self, n_points, number, x, is_fluid)
      type(strips_t), intent(inout) :: self
      integer, intent(in) :: n_points, number(n_points)
      real(dp), intent(in) :: x(n_points)
      logical, intent(in) :: is_fluid
      real(dp) :: first, last
      integer :: i

      first = huge(1.0_dp)
      last = -huge(1.0_dp)
      !$omp parallel do default(none) shared(n_points, number, x) reduction(min:first) reduction(max:last)
      do i = 1, n_points
         if (number(i) == 0) cycle
         first = min(first, x(i))
         last = max(last, x(i))
      end do
      !$omp end parallel do
      self%n = 0
      self%n_places = 0
      if (last >= first) then
         self%n = -1
         if (too_scattered(self, first, last, is_fluid)) return
         self%first_place = self%place_of(first)
         self%left = self%origin + self%width*self%first_place
         self%n_places = int(self%place_of(last) - self%first_place) + 1
      end if
      call resize(self%strip_of, n_points)
      call resize(self%before, self%n_places + 1)
      self%before(:self%n_places + 1) = 0
      !$omp parallel do default(none) shared(self, n_points, number, x)
      do i = 1, n_points
         self%strip_of(i) = 0
         if (number(i) == 0) cycle
         self%strip_of(i) = int(self%place_of(x(i)) - self%first_place) + 1
         !$omp atomic write
         self%before(self%strip_of(i)) = 1
      end do
      !$omp end parallel do
      call number_strips(self)
      !$omp parallel do default(none) shared(self, n_points)
      do i = 1, n_points
         if (self%strip_of(i) > 0) self%strip_of(i) = self%before(self%strip_of(i)) + 1
      end do
      !$omp end parallel do
   end subroutine assign_strips

   ! Strips where there are points, which `before` has marked by 1.
   subroutine number_strips(self)
      type(strips_t), intent(inout) :: self
      integer :: here, p

      self%n = sum(self%before(:self%n_places))
      call resize(self%place, self%n)
      self%n = 0
      do p = 1, self%n_places + 1
         here = self%before(p)
         self%before(p) = self%n
         if (here == 0) cycle
         self%n = self%n + 1
         self%place(self%n) = p
      end do
   end subroutine number_strips

   ! Points in the order of their strips, by a counting sort with a histogram for each chunk of points.
   subroutine list_by_strip(self, n_points, strip_start)
      type(strips_t), intent(inout) :: self
      integer, intent(in) :: n_points
      integer, allocatable, intent(out) :: strip_start(:)   !! (n+1) into by_strip
      integer, allocatable :: place(:, :)
      integer :: chunk, n_chunks, i, k, total, here

      n_chunks = omp_get_max_threads()
      allocate (place(self%n, n_chunks), strip_start(self%n + 1))
      call resize(self%by_strip, n_points)
      !$omp parallel do default(none) shared(self, n_points, n_chunks, place) private(i, k) schedule(static, 1)
      do chunk = 1, n_chunks
         place(:, chunk) = 0
         do i = chunk_start(chunk), chunk_start(chunk + 1) - 1
            k = self%strip_of(i)
            if (k > 0) place(k, chunk) = place(k, chunk) + 1
         end do
      end do
      !$omp end parallel do
      total = 1
      do k = 1, self%n
         strip_start(k) = total
         do chunk = 1, n_chunks
            here = place(k, chunk)
            place(k, chunk) = total
            total = total + here
         end do
      end do
      strip_start(self%n + 1) = total
      !$omp parallel do default(none) shared(self, n_points, n_chunks, place) private(i, k) schedule(static, 1)
      do chunk = 1, n_chunks
         do i = chunk_start(chunk), chunk_start(chunk + 1) - 1
            k = self%strip_of(i)
            if (k == 0) cycle
            self%by_strip(place(k, chunk)) = i
            place(k, chunk) = place(k, chunk) + 1
         end do
      end do
      !$omp end parallel do

   contains

      pure integer function chunk_start(c)
         integer, intent(in) :: c

         chunk_start = int((int(c - 1, int64)*n_points)/n_chunks) + 1
      end function chunk_start

   end subroutine list_by_strip

   ! Where each strip's slots and bins begin.
   subroutine lay_out(self, strip_start, y, first_slot, whole_groups)
      type(strips_t), intent(inout) :: self
      integer, intent(in) :: strip_start(:)
      real(dp), intent(in) :: y(:)
      integer, intent(in) :: first_slot
      logical, intent(in) :: whole_groups
      real(dp) :: lowest, highest
      integer :: k, i, n_here, slot, offset, max_bins, pass

      call resize(self%first, self%n)
      call resize(self%last, self%n)
      call resize(self%bins, self%n)
      call resize(self%bin_offset, self%n)
      call resize_real(self%lowest, self%n)
      if (allocated(self%extent)) then
         if (size(self%extent) < self%n) deallocate (self%extent)
      end if
      if (.not. allocated(self%extent)) allocate (self%extent(self%n + self%n/8))
      !$omp parallel do default(none) shared(self, strip_start, y) &
      !$omp private(i, lowest, highest, n_here, max_bins) schedule(dynamic, max(1, self%n/256))
      do k = 1, self%n
         lowest = huge(1.0_dp)
         highest = -huge(1.0_dp)
         do i = strip_start(k), strip_start(k + 1) - 1
            lowest = min(lowest, y(self%by_strip(i)))
            highest = max(highest, y(self%by_strip(i)))
         end do
         n_here = strip_start(k + 1) - strip_start(k)
         ! A whole number of bins from y = 0: who else is there does not matter.
         self%lowest(k) = self%bin_height*(aint(lowest/self%bin_height) - merge(1, 0, lowest < 0))
         ! A strip of few far-apart points is not worth a bin every quarter spacing.
         max_bins = 64*n_here + 64
         self%bins(k) = int(min(real(max_bins, dp), (highest - self%lowest(k))/self%bin_height)) + 1
      end do
      !$omp end parallel do
      call find_own(self)
      slot = first_slot
      offset = 0
      do pass = 1, 2
         if (pass == 2) self%n_own_slots = slot - first_slot
         do k = 1, self%n
            if ((k >= self%own(1) .and. k <= self%own(2)) .neqv. pass == 1) cycle
            n_here = strip_start(k + 1) - strip_start(k)
            if (whole_groups) n_here = group_slots*((n_here + group_slots - 1)/group_slots)
            self%first(k) = slot
            slot = slot + n_here
            self%last(k) = slot - 1
            self%bin_offset(k) = offset
            offset = offset + self%bins(k) + 1
         end do
      end do
      self%slots_before = first_slot - 1
      self%n_slots = slot - first_slot
      call resize(self%bin_start, offset)
      call resize(self%point_of, self%n_slots)
   end subroutine lay_out

   ! The strips among `own_places`.
   pure subroutine find_own(self)
      type(strips_t), intent(inout) :: self
      integer(i8) :: from, to

      from = max(1_i8, self%own_places(1) - self%first_place + 1)
      to = min(int(self%n_places, i8), self%own_places(2) - self%first_place + 1)
      self%own = [1, 0]
      if (from <= to) self%own = [self%before(from) + 1, self%before(to + 1)]
   end subroutine find_own

   ! Counting sort in y inside each strip, and by number inside each bin.
   subroutine fill_bins(self, strip_start, number, y)
      type(strips_t), intent(inout) :: self
      integer, intent(in) :: strip_start(:), number(:)
      real(dp), intent(in) :: y(:)
      integer :: k, i, b, slot, here, first

      first = self%slots_before
      !$omp parallel do default(none) shared(self, strip_start, number, y, first) private(i, b, slot, here) &
      !$omp schedule(dynamic, max(1, self%n/256))
      do k = 1, self%n
         associate (start => self%bin_start(self%bin_offset(k) + 1:self%bin_offset(k) + self%bins(k) + 1))
            start = 0
            do i = strip_start(k), strip_start(k + 1) - 1
               b = bin(self, k, y(self%by_strip(i)))
               start(b) = start(b) + 1
            end do
            slot = self%first(k)
            do b = 1, self%bins(k) + 1
               here = start(b)
               start(b) = slot
               slot = slot + here
            end do
            self%point_of(self%first(k) - first:self%last(k) - first) = 0
            do i = strip_start(k), strip_start(k + 1) - 1
               b = bin(self, k, y(self%by_strip(i)))
               self%point_of(start(b) - first) = self%by_strip(i)
               start(b) = start(b) + 1
            end do
            ! Each start has moved on to the next bin's: shift them back.
            do b = self%bins(k) + 1, 2, -1
               start(b) = start(b - 1)
            end do
            start(1) = self%first(k)
            do b = 1, self%bins(k)
               if (start(b + 1) - start(b) > 1) call put_in_order(number, self%point_of(start(b) - first:start(b + 1) - 1 - first))
            end do
         end associate
      end do
      !$omp end parallel do
   end subroutine fill_bins

   ! Points in the order of their numbers: Shell's sort, for bins of few points and, where points are scattered, of many.
   pure subroutine put_in_order(number, points)
      integer, intent(in) :: number(:)
      integer, contiguous, intent(inout) :: points(:)
      integer :: gap, i, j, held

      gap = 1
      do while (3*gap < size(points))
         gap = 3*gap + 1
      end do
      do while (gap > 0)
         do i = gap + 1, size(points)
            held = points(i)
            j = i
            do while (j > gap)
               if (number(points(j - gap)) < number(held)) exit
               points(j) = points(j - gap)
               j = j - gap
            end do
            points(j) = held
         end do
         gap = gap/3
      end do
   end subroutine put_in_order

   ! Bin of height y in strip k, clamped to the strip's bins.
   pure integer function bin(self, k, y)
      type(strips_t), intent(in) :: self
      integer, intent(in) :: k
      real(dp), intent(in) :: y

      bin = int(max(0.0_dp, min(real(self%bins(k) - 1, dp), (y - self%lowest(k))/self%bin_height))) + 1
   end function bin

   !> Adds the slot ranges that hold every point that may come closer than `support` to a box of particles while
   !! all move on for up to `travel`, forwards or backwards, and stray from there by their slack.
   pure subroutine add_ranges(self, box, support, travel, ranges)
      type(strips_t), intent(in) :: self
      type(extent_t), intent(in) :: box
      real(dp), intent(in) :: support
      real(dp), intent(in) :: travel   !! time
      type(ranges_t), intent(inout) :: ranges
      real(dp) :: reach, gap, half_height, strip_left, widest, closing(2)
      integer :: k, k1, k2, first, last, part, part_before

      if (self%n == 0) return
      part_before = 0
      closing = travel*relative_speed(box, self%overall)
      widest = support + box%slack + self%overall%slack + closing(1)
      k1 = int(max(0.0_dp, min(real(self%n_places, dp), (box%lower(1) - widest - self%left)/self%width))) + 1
      k2 = int(max(-1.0_dp, min(self%n_places - 1.0_dp, (box%upper(1) + widest - self%left)/self%width))) + 1
      do k = self%before(k1) + 1, self%before(k2 + 1)
         closing = travel*relative_speed(box, self%extent(k))
         reach = support + box%slack + self%extent(k)%slack
         strip_left = self%left + (self%place(k) - 1)*self%width
         gap = max(0.0_dp, strip_left - box%upper(1) - closing(1), box%lower(1) - (strip_left + self%width) - closing(1))
         if (gap >= reach) cycle
         half_height = sqrt((reach - gap)*(reach + gap)) + closing(2)
         if (box%upper(2) + half_height < self%lowest(k)) cycle
         first = self%bin_start(self%bin_offset(k) + bin(self, k, box%lower(2) - half_height))
         last = self%bin_start(self%bin_offset(k) + bin(self, k, box%upper(2) + half_height) + 1) - 1
         if (last < first) cycle
         ! Left of the own strips, these, right of them: slots ascend within a part only.
         part = merge(1, merge(2, 3, k <= self%own(2)), k < self%own(1))
         call add_range(ranges, first, last, anew=part /= part_before)
         part_before = part
      end do
   end subroutine add_ranges

   ! Slots ascend from strip to strip, so where there is no place left the last range can take in all up to this one.
   pure subroutine add_range(ranges, first, last, anew)
      type(ranges_t), intent(inout) :: ranges
      integer, intent(in) :: first, last
      logical, intent(in) :: anew   ! not behind the last range: there is a place for each such

      if (ranges%n < strip_ranges .or. anew) then
         ranges%n = ranges%n + 1
         ranges%first(ranges%n) = first
      end if
      ranges%last(ranges%n) = last
   end subroutine add_range

   !> Largest difference of velocity components between any particle of one box and any of the other.
   pure function relative_speed(a, b) result(speed)
      type(extent_t), intent(in) :: a, b
      real(dp) :: speed(2)

      speed = max(0.0_dp, a%fastest - b%slowest, b%fastest - a%slowest)
   end function relative_speed

   !> Bytes that all arrays take.
   pure integer(i8) function strips_bytes(self) result(bytes)
      class(strips_t), intent(in) :: self

      bytes = 0
      if (.not. allocated(self%point_of)) return   ! nothing was sorted yet
      associate (integers => size(self%place, kind=i8) + size(self%before) + 2*size(self%first) + size(self%bins) &
                             + size(self%bin_offset) + size(self%bin_start) + size(self%strip_of) + size(self%by_strip) &
                             + size(self%point_of))
         bytes = (integers*storage_size(self%bins) + size(self%lowest, kind=i8)*storage_size(self%lowest) &
                  + size(self%extent, kind=i8)*storage_size(self%extent))/8
      end associate
   end function strips_bytes

   subroutine resize(array, n)
      integer, allocatable, intent(inout) :: array(:)
      integer, intent(in) :: n

      if (allocated(array)) then
         if (size(array) >= n) return
         deallocate (array)
      end if
      allocate (array(n + n/8))
   end subroutine resize

   subroutine resize_real(array, n)
      real(dp), allocatable, intent(inout) :: array(:)
      integer, intent(in) :: n

      if (allocated(array)) then
         if (size(array) >= n) return
         deallocate (array)
      end if
      allocate (array(n + n/8))
   end subroutine resize_real

end module strips
