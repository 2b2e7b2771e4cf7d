!> Solids that come too near to each other or to a wall: in a gap narrower than the kernel's radius the fluid feels what is on both
!! sides, and where two solids have met, neither knows of the other.
!!
!! What touches from the start may do so: it is drawn so. What is beyond a wall may be there: solids go on beyond walls.
module solid_contacts
   use box, only: axis_of, box_t, inward, is_wall, opposite
   use kinds, only: dp, i8
   use polygons, only: clip_polygon, is_inside, narrowest
   use solids, only: obstacle_t
   implicit none
   private

   public :: contact_t, contacts_t

   real(dp), parameter :: touching = 1.0e-9_dp   ! a gap, over the least that is allowed

   !> A gap that has just become too narrow, or that has closed.
   type :: contact_t
      integer :: solid = 0          !! number of one that moves, or that meets one that does
      integer :: other = 0          !! solid; 0: a wall
      integer :: side = 0           !! of the box; 0: a solid
      logical :: collides = .false. !! solids that were apart have met
      real(dp) :: gap = 0           !! [m]
      real(dp) :: place(2) = 0      !! [m] where it is narrowest, on the first solid
   end type contact_t

   !> What is known already.
   type :: contacts_t
      integer(i8) :: sort = -1   !! of the particles, at which it was looked last
      logical, allocatable, private :: met(:, :)       ! (n, n) solids that touch or overlap, the larger number first
      logical, allocatable, private :: told(:, :)      ! (n, n) gaps between them that were found before
      logical, allocatable, private :: at_wall(:, :)   ! (4, n) gaps to walls that were
   contains
      procedure :: find => find_contacts
   end type contacts_t

contains

   !> Contacts that were not found before: each gap once, in the order of the solids. At the first call solids may touch.
   pure subroutine find_contacts(self, obstacles, moves, box, least, found)
      class(contacts_t), intent(inout) :: self
      type(obstacle_t), intent(in) :: obstacles(:)   !! (n) at the box's time
      logical, intent(in) :: moves(:)                !! (n) two that rest are no concern
      type(box_t), intent(in) :: box
      real(dp), intent(in) :: least                  !! gap that the fluid needs [m]
      type(contact_t), allocatable, intent(out) :: found(:)
      type(contact_t) :: contact
      logical :: first, meet
      integer :: i, k, n, side

      n = size(obstacles)
      allocate (found(0))
      first = .not. allocated(self%met)
      if (first) then
         allocate (self%met(n, n), self%told(n, n), source=.false.)
         allocate (self%at_wall(4, n), source=.false.)
      end if
      do i = 1, n
         do k = 1, i - 1
            if (.not. (moves(i) .or. moves(k))) cycle
            call measure_gap(obstacles(i), obstacles(k), box, least, contact, meet)
            contact%solid = i
            contact%other = k
            contact%collides = meet .and. .not. (self%met(i, k) .or. first)
            self%met(i, k) = meet
            if (contact%collides .or. .not. (meet .or. self%told(i, k) .or. contact%gap >= least)) then
               found = [found, contact]
               self%told(i, k) = .true.
            end if
         end do
         do side = 1, 4
            if (.not. moves(i) .or. .not. is_wall(box%kind(side)) .or. self%at_wall(side, i)) cycle
            call measure_height(obstacles(i), box, side, contact)
            if (contact%gap <= touching*least .or. contact%gap >= least) cycle
            contact%solid = i
            found = [found, contact]
            self%at_wall(side, i) = .true.
         end do
      end do
   end subroutine find_contacts

   ! The gap between two solids in the box, huge if it is wide enough, and whether they touch or overlap.
   pure subroutine measure_gap(one, other, box, least, contact, meet)
      type(obstacle_t), intent(in) :: one, other
      type(box_t), intent(in) :: box
      real(dp), intent(in) :: least
      type(contact_t), intent(out) :: contact   ! gap and place
      logical, intent(out) :: meet
      real(dp), allocatable :: mine(:, :), yours(:, :)

      contact%gap = huge(contact%gap)
      meet = .false.
      if (any(one%lower - other%upper >= least .or. other%lower - one%upper >= least)) return
      call cut(one%outline, box, is_wall(box%kind), mine)
      call cut(other%outline, box, is_wall(box%kind), yours)
      if (min(size(mine, 2), size(yours, 2)) < 3) return
      call narrowest(mine, yours, least, contact%gap, contact%place)
      meet = contact%gap <= touching*least
      if (.not. meet) meet = is_inside(mine, yours(:, 1)) .or. is_inside(yours, mine(:, 1))
   end subroutine measure_gap

   ! How far a solid is from a wall, at or below 0 where it reaches through; huge if it is wholly beyond others.
   pure subroutine measure_height(obstacle, box, side, contact)
      type(obstacle_t), intent(in) :: obstacle
      type(box_t), intent(in) :: box
      integer, intent(in) :: side
      type(contact_t), intent(out) :: contact   ! side, gap and place
      real(dp), allocatable :: part(:, :)
      logical :: across(4)
      integer :: k

      contact%side = side
      contact%gap = huge(contact%gap)
      across = is_wall(box%kind)
      across([side, opposite(side)]) = .false.
      call cut(obstacle%outline, box, across, part)
      if (size(part, 2) < 3) return
      k = minloc(inward(side)*part(axis_of(side), :), 1)
      contact%gap = inward(side)*(part(axis_of(side), k) - box%at(side))
      contact%place = part(:, k)
   end subroutine measure_height

   ! The part of an outline that some sides of the box leave.
   pure subroutine cut(outline, box, sides, part)
      real(dp), intent(in) :: outline(:, :)
      type(box_t), intent(in) :: box
      logical, intent(in) :: sides(4)
      real(dp), allocatable, intent(out) :: part(:, :)
      real(dp) :: room(2, 8*size(outline, 2) + 8), normal(2)   ! each cut adds a half at most
      integer :: n, side

      n = size(outline, 2)
      room(:, :n) = outline
      do side = 1, 4
         if (.not. sides(side) .or. n == 0) cycle
         normal = 0
         normal(axis_of(side)) = inward(side)
         call clip_polygon(room, n, [box%at(side), box%at(side)], normal)
      end do
      allocate (part(2, n))
      part(:, :) = room(:, :n)
   end subroutine cut

end module solid_contacts
