!> Faces of solids that the ways between fluid and ghosts lead through.
!!
!! Source: ours (docs/equations.md, Thin solids).
module solid_faces
   use kinds, only: dp
   use lanes, only: nl
   use solids, only: obstacle_t
   implicit none
   private

   public :: edge_t, faces_t, near_faces_t, faces_of, find_faces, keep_only, only_before, hull, meet

   !> A face of a solid.
   type :: edge_t
      integer :: number                         !! in its solid
      real(dp) :: a(2), b(2)                    !! [m] ends
      real(dp) :: normal(2)                     !! outwards
      real(dp) :: room(4)                       !! [m] around it: left, right, bottom, top
   end type edge_t

   !> Edges of all solids, one's behind the other's: its faces, then what is behind walls.
   type :: faces_t
      integer, allocatable :: first(:)          !! (solids+1) where they begin
      integer, allocatable :: last(:)           !! (solids) where the faces end
      type(edge_t), allocatable :: edge(:)
      logical, allocatable :: convex(:)         !! (solids)
   end type faces_t

   !> Faces of a solid that ways may lead through.
   type :: near_faces_t
      type(edge_t), allocatable :: edge(:)      !! (all faces)
      integer :: n = 0                          !! of them
   end type near_faces_t

contains

   !> The edges of all solids.
   pure type(faces_t) function faces_of(solids) result(faces)
      type(obstacle_t), intent(in) :: solids(:)
      integer :: k, n, next, solid

      allocate (faces%first(size(solids) + 1), faces%last(size(solids)), faces%convex(size(solids)))
      allocate (faces%edge(sum([(size(solids(k)%is_face), k=1, size(solids))])))
      n = 0
      do solid = 1, size(solids)
         faces%first(solid) = n + 1
         call add_edges(solids(solid), .true., faces%edge, n)
         faces%last(solid) = n
         call add_edges(solids(solid), .false., faces%edge, n)
         faces%convex(solid) = .true.
         associate (normal => solids(solid)%normal)
            do k = 1, size(normal, 2)
               next = 1 + mod(k, size(normal, 2))
               faces%convex(solid) = faces%convex(solid) .and. normal(1, k)*normal(2, next) - normal(2, k)*normal(1, next) >= 0
            end do
         end associate
      end do
      faces%first(size(solids) + 1) = n + 1
   end function faces_of

   ! Those edges of a solid that are faces, or the others.
   pure subroutine add_edges(solid, faces, edge, n)
      type(obstacle_t), intent(in) :: solid
      logical, intent(in) :: faces
      type(edge_t), intent(inout) :: edge(:)
      integer, intent(inout) :: n               ! of all so far
      integer :: k, next

      do k = 1, size(solid%is_face)
         if (solid%is_face(k) .neqv. faces) cycle
         n = n + 1
         next = 1 + mod(k, size(solid%is_face))
         associate (a => solid%outline(:, k), b => solid%outline(:, next))
            edge(n) = edge_t(k, a, b, solid%normal(:, k), hull(a([1, 1, 2, 2]), b([1, 1, 2, 2]), 0.0_dp))
         end associate
      end do
   end subroutine add_edges

   !> Those of a solid that are nearer to a room than `reach`, along the axes.
   pure subroutine find_faces(faces, solid, room, reach, near)
      type(faces_t), intent(in) :: faces
      integer, intent(in) :: solid
      real(dp), intent(in) :: room(4)           !! [m] left, right, bottom, top
      real(dp), intent(in) :: reach             !! [m]
      type(near_faces_t), intent(inout) :: near
      integer :: k

      near%n = 0
      do k = faces%first(solid), faces%last(solid)
         if (.not. meet(faces%edge(k)%room, room + reach*[-1, 1, -1, 1])) cycle
         near%n = near%n + 1
         near%edge(near%n) = faces%edge(k)
      end do
   end subroutine find_faces

   !> The room around two others, and some more.
   pure function hull(one, other, margin)
      real(dp), intent(in) :: one(4), other(4)   !! left, right, bottom, top
      real(dp), intent(in) :: margin             !! [m]
      real(dp) :: hull(4)

      hull = [min(one(1), other(1)) - margin, max(one(2), other(2)) + margin, &
              min(one(3), other(3)) - margin, max(one(4), other(4)) + margin]
   end function hull

   !> Whether two rooms have a point in common.
   pure logical function meet(one, other)
      real(dp), intent(in) :: one(4), other(4)   !! left, right, bottom, top

      meet = one(2) >= other(1) .and. one(1) <= other(2) .and. one(4) >= other(3) .and. one(3) <= other(4)
   end function meet

   !> The only one of some edges of a convex solid that a particle is before: ways from it lead in through this one. 0 where there
   !! are others, or could be but for rounding, or edges that are no faces.
   pure integer function only_before(faces, solid, edges, place, margin) result(only)
      type(faces_t), intent(in) :: faces
      integer, intent(in) :: solid
      type(edge_t), intent(in) :: edges(:)      !! faces of it that ways may lead through
      real(dp), intent(in) :: place(2), margin   !! [m]
      real(dp) :: height
      integer :: k

      only = 0
      do k = faces%last(solid) + 1, faces%first(solid + 1) - 1
         if (height_over(faces%edge(k), place) > -margin) return
      end do
      do k = 1, size(edges)
         height = height_over(edges(k), place)
         if (height < -margin) cycle
         if (height < margin .or. only > 0) then
            only = 0
            return
         end if
         only = k
      end do
   end function only_before

   !> Of the faces that ways may lead through the only one, where it is the same for all particles of a cluster.
   pure subroutine keep_only(faces, solid, x, y, margin, near)
      type(faces_t), intent(in) :: faces
      integer, intent(in) :: solid
      real(dp), intent(in) :: x(nl), y(nl), margin   !! [m]
      type(near_faces_t), intent(inout) :: near
      integer :: l, only

      if (near%n < 2 .or. .not. faces%convex(solid)) return
      only = only_before(faces, solid, near%edge(:near%n), [x(1), y(1)], margin)
      if (only == 0) return
      do l = 2, nl
         if (only_before(faces, solid, near%edge(:near%n), [x(l), y(l)], margin) /= only) return
      end do
      near%edge(1) = near%edge(only)
      near%n = 1
   end subroutine keep_only

   ! How far a place is before an edge; less than 0 behind it.
   pure real(dp) function height_over(edge, place)
      type(edge_t), intent(in) :: edge
      real(dp), intent(in) :: place(2)

      height_over = edge%normal(1)*(place(1) - edge%a(1)) + edge%normal(2)*(place(2) - edge%a(2))
   end function height_over

end module solid_faces
