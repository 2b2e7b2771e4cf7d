!> Which pairs act where cells of solids have a ghost for each of several faces.
!!
!! Source: ours (docs/equations.md, Thin solids). A particle and a ghost act on each other if the way to the ghost first leads
!! through its face; the ghost has its pressure also of particles that come through faces that do not look the other way. Found
!! once a step: the energy that the fluid gets is the solids' as long as the same pairs act for both, whichever they are.
module solid_shares
   use box, only: box_t
   use candidates, only: acts, candidates_t, gives
   use kinds, only: dp
   use lanes, only: nl
   use particles, only: state_t
   use polygons, only: nearest_edge
   use solid_cells, only: turned_away
   use solid_faces, only: edge_t, faces_of, faces_t, find_faces, hull, keep_only, meet, near_faces_t, only_before
   use solid_ghosts, only: solid_ghosts_t
   use solids, only: obstacle_t
   implicit none
   private

   public :: find_shares

   real(dp), parameter :: reach = 1.5_dp   ! times the kernel's support: pairs that are farther do not come near in a step
   real(dp), parameter :: flatter = 1.0e-6_dp, beside(2) = [0.6e-9_dp, 1.0e-9_dp]   ! more than rounding, less than matters
   real(dp), parameter :: slightly = 1.0e-3_dp   ! of the support: more than both
   real(dp), parameter :: nowhere = 2            ! on a way, where 1 is its end

   ! The faces that the ways of a cluster lead through first.
   type :: crossed_t
      real(dp) :: face(nl) = 0                           ! number; 0 of ways that are too long, -1 if all is behind walls
      real(dp) :: normal_x(nl) = 0, normal_y(nl) = 0
   end type crossed_t

contains

   !> Of all pairs in the lists, as fluid, ghosts and images are in a state. Only where cells have several ghosts.
   subroutine find_shares(ghosts, n_blocks, state, box, support)
      type(solid_ghosts_t), intent(inout) :: ghosts
      integer, intent(in) :: n_blocks              !! of the fluid
      type(state_t), intent(in) :: state           !! of all slots
      type(box_t), intent(in) :: box               !! at any time
      real(dp), intent(in) :: support              !! of the kernel
      type(faces_t) :: faces
      type(near_faces_t) :: scratch
      real(dp), allocatable :: part(:, :)          ! (nl, places in the list and more) of a cluster
      integer :: b, c, n
      logical :: mixed

      faces = faces_of(ghosts%obstacles)
      !$omp parallel default(none) shared(ghosts, n_blocks, state, box, support, faces) private(c, n, mixed, scratch, part)
      allocate (part(nl, 0), scratch%edge(size(faces%edge)))
      !$omp do schedule(dynamic)
      do b = 1, n_blocks
         if (.not. ghosts%meets(b)) cycle
         associate (block => ghosts%near(b))
            do c = 1, block%n_clusters
               call take_room(block%all, c, part, n)
               call share_of_fluid(ghosts, block%all, c, state, faces, box, reach*support, n, mixed, part, scratch)
               call block%choose(c, mixed, part)
            end do
         end associate
      end do
      !$omp end do
      !$omp do schedule(dynamic)
      do b = 1, ghosts%n_blocks
         associate (block => ghosts%fluid(b))
            do c = 1, block%n_clusters
               call take_room(block%all, c, part, n)
               call share_of_ghosts(ghosts, block%all, c, state, faces, reach*support, n, mixed, part, scratch)
               call block%choose(c, mixed, part)
            end do
         end associate
      end do
      !$omp end do
      !$omp end parallel
   end subroutine find_shares

   ! Room for the list of a cluster.
   pure subroutine take_room(block, c, part, n)
      type(candidates_t), intent(in) :: block
      integer, intent(in) :: c
      real(dp), allocatable, intent(inout) :: part(:, :)
      integer, intent(out) :: n   ! places in it

      n = block%first(c + 1) - block%first(c)
      if (size(part, 2) >= n) return
      deallocate (part)
      allocate (part(nl, n + n/4))
   end subroutine take_room

   ! Of a cluster of the fluid and the ghosts near it.
   pure subroutine share_of_fluid(ghosts, block, c, state, faces, box, support, n, mixed, part, scratch)
      type(solid_ghosts_t), intent(in) :: ghosts
      type(candidates_t), intent(in) :: block         ! of the fluid
      integer, intent(in) :: c                        ! cluster
      type(state_t), intent(in) :: state
      type(faces_t), intent(in) :: faces
      type(box_t), intent(in) :: box
      real(dp), intent(in) :: support                 ! farther pairs do not matter
      integer, intent(in) :: n                        ! places in the list
      logical, intent(out) :: mixed                   ! some ghosts are not alone in their cells; parts are set only then
      real(dp), intent(inout) :: part(nl, n)
      type(near_faces_t), intent(inout) :: scratch
      type(crossed_t) :: crossed
      real(dp), dimension(nl) :: x, y, to_x, to_y, face, normal_x, normal_y
      real(dp) :: here(4), there(4), begin(4), sign(2), place(2), last(2), way(2)
      integer :: i0, j, k, m, number
      logical :: mirrored, was_mirrored, is_other, done

      associate (near => block%slot(block%first(c):block%first(c + 1) - 1))
         mixed = any_shares(n, near, ghosts%before, size(ghosts%face), ghosts%face)
         if (.not. mixed) return
         i0 = block%before + (c - 1)*nl
         x = state%x(i0 + 1:i0 + nl)
         y = state%y(i0 + 1:i0 + nl)
         here = [minval(x), maxval(x), minval(y), maxval(y)]
         number = 0
         last = 0
         way = 0
         was_mirrored = .false.
         call share_at_once(ghosts, n, near, faces, x, y, here, support, done, part, scratch)
         if (done) return
         do k = 1, n
            j = near(k)
            m = j - ghosts%before
            mirrored = m > ghosts%n_slots
            if (mirrored) m = ghosts%images%source(m - ghosts%n_slots) - ghosts%before
            part(:, k) = acts
            if (ghosts%face(m) == 0) cycle
            associate (solid => ghosts%obstacles(ghosts%solid_of(m)))
               is_other = number /= ghosts%solid_of(m) .or. any(abs(ghosts%way(:, m) - way) > 0) &
                          .or. (mirrored .neqv. was_mirrored)
               number = ghosts%solid_of(m)
               way = ghosts%way(:, m)
               was_mirrored = mirrored
               if (is_other) call find_faces(faces, number, here - way([1, 1, 2, 2]), merge(huge(support), support, mirrored), &
                                             scratch)
               if (is_other .and. .not. mirrored) call keep_only(faces, number, x - way(1), y - way(2), slightly*support, scratch)
               if (scratch%n == 1) then
                  part(:, k) = part_of(scratch%edge(1), ghosts%face(m), solid%normal(1, ghosts%face(m)), &
                                       solid%normal(2, ghosts%face(m)))
                  cycle
               end if
               face = ghosts%face(m)
               normal_x = solid%normal(1, ghosts%face(m))
               normal_y = solid%normal(2, ghosts%face(m))
               place = [state%x(j), state%y(j)]
               ! The ghosts of a cell follow each other in the list.
               if (is_other .or. any(abs(place - last) > 0)) then
                  sign = ghosts%signs(box, j)
                  to_x = ghosts%place(1, m)
                  to_y = ghosts%place(2, m)
                  there = ghosts%place([1, 1, 2, 2], m)
                  begin = there + sign([1, 1, 2, 2])*(here - place([1, 1, 2, 2]))
                  if (mirrored) begin = hull(begin, begin([2, 1, 4, 3]), 0.0_dp)
                  call find_crossed(solid, scratch%edge(:scratch%n), hull(begin, there, slightly*support), support, &
                                    to_x + sign(1)*(x - place(1)), to_y + sign(2)*(y - place(2)), to_x, to_y, crossed)
               end if
               last = place
            end associate
            call take_parts(crossed, face, normal_x, normal_y, part(:, k))
         end do
      end associate
   end subroutine share_of_fluid

   ! The same where all ghosts are of one solid, of which ways can lead through one face only.
   pure subroutine share_at_once(ghosts, n, near, faces, x, y, here, support, done, part, scratch)
      type(solid_ghosts_t), intent(in) :: ghosts
      integer, intent(in) :: n, near(n)
      type(faces_t), intent(in) :: faces
      real(dp), intent(in) :: x(nl), y(nl), here(4)   ! of the fluid; the room around it
      real(dp), intent(in) :: support
      logical, intent(out) :: done                    ! parts are set only then
      real(dp), intent(inout) :: part(nl, n)
      type(near_faces_t), intent(inout) :: scratch
      real(dp) :: way(2)

      done = are_together(n, near, ghosts%before, ghosts%n_slots, ghosts%solid_of, ghosts%way)
      if (.not. done) return
      associate (first => near(1) - ghosts%before)
         way = ghosts%way(:, first)
         call find_faces(faces, ghosts%solid_of(first), here - way([1, 1, 2, 2]), support, scratch)
         call keep_only(faces, ghosts%solid_of(first), x - way(1), y - way(2), slightly*support, scratch)
         done = scratch%n == 1
         if (done) call take_parts_of(scratch%edge(1), ghosts%obstacles(ghosts%solid_of(first)), n, near, ghosts%before, &
                                      size(ghosts%face), ghosts%face, part)
      end associate
   end subroutine share_at_once

   ! Whether some ghosts in a list are not alone in their cells.
   pure logical function any_shares(n, near, before, n_ghosts, face)
      integer, intent(in) :: n, near(n), before, n_ghosts, face(n_ghosts)
      integer :: k, faces

      faces = 0
      !$omp simd reduction(ior:faces)
      do k = 1, n
         faces = ior(faces, face(near(k) - before))
      end do
      any_shares = faces > 0
   end function any_shares

   ! Whether the ghosts in a list are of one solid, moved alike in a periodic box, and none is an image: images come last.
   pure logical function are_together(n, near, before, n_slots, solid_of, way) result(are)
      integer, intent(in) :: n, near(n), before, n_slots, solid_of(n_slots)
      real(dp), intent(in) :: way(2, n_slots)
      real(dp) :: farthest
      integer :: k, one, others

      are = near(n) - before <= n_slots
      if (.not. are) return
      one = near(1) - before
      others = 0
      farthest = 0
      !$omp simd reduction(ior:others) reduction(max:farthest)
      do k = 1, n
         others = ior(others, ieor(solid_of(near(k) - before), solid_of(one)))
         farthest = max(farthest, abs(way(1, near(k) - before) - way(1, one)) + abs(way(2, near(k) - before) - way(2, one)))
      end do
      are = others == 0 .and. .not. farthest > 0
   end function are_together

   ! The parts of ghosts of one solid where all ways lead through one face.
   pure subroutine take_parts_of(edge, solid, n, near, before, n_ghosts, face, part)
      type(edge_t), intent(in) :: edge
      type(obstacle_t), intent(in) :: solid
      integer, intent(in) :: n, near(n), before, n_ghosts, face(n_ghosts)
      real(dp), intent(out) :: part(nl, n)
      real(dp) :: of_face(0:size(solid%normal, 2))
      integer :: k

      of_face(0) = acts
      do k = 1, ubound(of_face, 1)
         of_face(k) = part_of(edge, k, solid%normal(1, k), solid%normal(2, k))
      end do
      do k = 1, n
         part(:, k) = of_face(face(near(k) - before))
      end do
   end subroutine take_parts_of

   ! Of a cluster of ghosts and the fluid near it.
   pure subroutine share_of_ghosts(ghosts, block, c, state, faces, support, n, mixed, part, scratch)
      type(solid_ghosts_t), intent(in) :: ghosts
      type(candidates_t), intent(in) :: block         ! of ghosts
      integer, intent(in) :: c                        ! cluster
      type(state_t), intent(in) :: state
      type(faces_t), intent(in) :: faces
      real(dp), intent(in) :: support                 ! farther pairs do not matter
      integer, intent(in) :: n                        ! places in the list
      logical, intent(out) :: mixed                   ! some ghosts are not alone in their cells; parts are set only then
      real(dp), intent(inout) :: part(nl, n)
      type(near_faces_t), intent(inout) :: scratch
      type(crossed_t) :: crossed
      real(dp), dimension(nl) :: to_x, to_y, shift_x, shift_y, face, normal_x, normal_y, of_solid
      real(dp) :: there(4), shifts(4), begin(4)
      logical :: alike(nl)                            ! lanes of one solid
      logical :: together                             ! which is convex, and they see each particle at one place
      integer :: owner(nl)                            ! its faces that they are for
      integer :: i0, k, l, m0, number, only, last_only

      i0 = block%before + (c - 1)*nl
      m0 = i0 - ghosts%before
      mixed = any(ghosts%face(m0 + 1:m0 + nl) > 0)
      if (.not. mixed) return
      associate (near => block%slot(block%first(c):block%first(c + 1) - 1))
         part = acts
         to_x = ghosts%place(1, m0 + 1:m0 + nl)
         to_y = ghosts%place(2, m0 + 1:m0 + nl)
         shift_x = to_x - state%x(i0 + 1:i0 + nl)
         shift_y = to_y - state%y(i0 + 1:i0 + nl)
         do l = 1, nl
            number = ghosts%solid_of(m0 + l)
            if (number == 0 .or. any(ghosts%solid_of(m0 + 1:m0 + l - 1) == number)) cycle
            alike = ghosts%solid_of(m0 + 1:m0 + nl) == number
            there = [minval(to_x, alike), maxval(to_x, alike), minval(to_y, alike), maxval(to_y, alike)]
            shifts = [minval(shift_x, alike), maxval(shift_x, alike), minval(shift_y, alike), maxval(shift_y, alike)]
            associate (solid => ghosts%obstacles(number))
               owner = merge(ghosts%face(m0 + 1:m0 + nl), 0, alike)
               call take_faces(solid, owner, face, normal_x, normal_y)
               call find_faces(faces, number, there, support, scratch)
               together = faces%convex(number) .and. maxval(shifts([2, 4]) - shifts([1, 3])) < slightly*slightly*support
               last_only = 0
               do k = 1, n
                  only = 0
                  if (together) only = only_before(faces, number, scratch%edge(:scratch%n), &
                                                   [state%x(near(k)), state%y(near(k))] + shifts([1, 3]), slightly*support)
                  if (only > 0) then
                     if (only /= last_only) of_solid = part_of(scratch%edge(only), owner, normal_x, normal_y)
                     last_only = only
                     part(:, k) = min(part(:, k), of_solid)
                     cycle
                  end if
                  last_only = 0
                  begin = shifts + [state%x(near(k)), state%x(near(k)), state%y(near(k)), state%y(near(k))]
                  call find_crossed(solid, scratch%edge(:scratch%n), hull(begin, there, slightly*support), support, &
                                    to_x + (state%x(near(k)) - state%x(i0 + 1:i0 + nl)), &
                                    to_y + (state%y(near(k)) - state%y(i0 + 1:i0 + nl)), to_x, to_y, crossed)
                  call take_parts(crossed, face, normal_x, normal_y, of_solid)
                  part(:, k) = min(part(:, k), of_solid)
               end do
            end associate
         end do
      end associate
   end subroutine share_of_ghosts

   ! Faces of ghosts, 0 for those that are alone in their cells, and their normals.
   pure subroutine take_faces(solid, number, face, normal_x, normal_y)
      type(obstacle_t), intent(in) :: solid
      integer, intent(in) :: number(nl)
      real(dp), intent(out) :: face(nl), normal_x(nl), normal_y(nl)
      integer :: l

      face = number
      normal_x = 0
      normal_y = 0
      do l = 1, nl
         if (number(l) == 0) cycle
         normal_x(l) = solid%normal(1, number(l))
         normal_y(l) = solid%normal(2, number(l))
      end do
   end subroutine take_faces

   ! The parts of pairs whose ways lead through an edge.
   elemental real(dp) function part_of(edge, face, normal_x, normal_y)
      type(edge_t), intent(in) :: edge
      integer, intent(in) :: face                       ! of the ghost; 0 if it is alone in its cell
      real(dp), intent(in) :: normal_x, normal_y        ! of that

      part_of = merge(gives, 0.0_dp, normal_x*edge%normal(1) + normal_y*edge%normal(2) > turned_away)
      if (face == edge%number .or. face == 0) part_of = acts
   end function part_of

   ! The parts of pairs, from the faces of the ghosts and those that are crossed.
   pure subroutine take_parts(crossed, face, normal_x, normal_y, part)
      type(crossed_t), intent(in) :: crossed
      real(dp), intent(in) :: face(nl), normal_x(nl), normal_y(nl)   ! of the ghosts; 0 for those that are alone in their cells
      real(dp), intent(out) :: part(nl)
      real(dp) :: alike, mine, given
      integer :: l

      !$omp simd private(alike, mine, given)
      do l = 1, nl
         alike = normal_x(l)*crossed%normal_x(l) + normal_y(l)*crossed%normal_y(l)
         given = merge(gives, 0.0_dp, min(alike - turned_away, crossed%face(l)) > 0)
         mine = merge(acts, given, abs(crossed%face(l) - face(l)) < 0.5_dp)
         part(l) = merge(acts, mine, face(l) < 0.5_dp)
      end do
   end subroutine take_parts

   ! What straight ways lead through first. Where a way leads through nothing, as from inside, it is what is nearest to its begin.
   !
   ! Ways on a lattice lead exactly through corners, where rounding would decide. So they are taken to be a little flatter, which
   ! is the same to the left and to the right, and to begin beside the particle by still less, for those that are level.
   pure subroutine find_crossed(solid, edges, room, support, particle_x, particle_y, to_x, to_y, crossed)
      type(obstacle_t), intent(in) :: solid
      type(edge_t), intent(in) :: edges(:)         ! of it that ways as long as the support may lead through
      real(dp), intent(in) :: room(4)              ! around all ways
      real(dp), intent(in) :: support              ! ways that are longer do not matter
      real(dp), dimension(nl), intent(in) :: particle_x, particle_y, to_x, to_y
      type(crossed_t), intent(inout) :: crossed
      real(dp), dimension(nl) :: first, from_x, from_y
      real(dp) :: foot(2), normal(2), distance
      integer :: edge, k, l

      !$omp simd
      do l = 1, nl
         from_x(l) = particle_x(l) + flatter*(particle_x(l) - to_x(l)) + beside(1)*support
         from_y(l) = particle_y(l) + beside(2)*support
         first(l) = merge(nowhere, 0.0_dp, (from_x(l) - to_x(l))**2 + (from_y(l) - to_y(l))**2 < support**2)
         crossed%face(l) = 0
         crossed%normal_x(l) = 0
         crossed%normal_y(l) = 0
      end do
      do k = 1, size(edges)
         if (meet(edges(k)%room, room)) call cross_edge(edges(k), from_x, from_y, to_x, to_y, first, crossed)
      end do
      if (maxval(first) < nowhere) return
      do l = 1, nl
         if (first(l) < nowhere) cycle
         call nearest_edge(solid%outline, solid%is_face, [from_x(l), from_y(l)], edge, distance, foot, normal)
         crossed%face(l) = merge(edge, -1, edge > 0)
         crossed%normal_x(l) = normal(1)
         crossed%normal_y(l) = normal(2)
      end do
   end subroutine find_crossed

   ! Takes an edge for ways that lead through it before they do through others. Without a branch, or it would not be vectorised.
   pure subroutine cross_edge(edge, from_x, from_y, to_x, to_y, first, crossed)
      type(edge_t), intent(in) :: edge
      real(dp), dimension(nl), intent(in) :: from_x, from_y, to_x, to_y
      real(dp), intent(inout) :: first(nl)        ! where on a way, 0 to 1
      type(crossed_t), intent(inout) :: crossed   ! what is there
      real(dp) :: ax, ay, bx, by, nx, ny, number, before, behind, left, right, crosses, share, newer
      integer :: l

      ax = edge%a(1)
      ay = edge%a(2)
      bx = edge%b(1)
      by = edge%b(2)
      nx = edge%normal(1)
      ny = edge%normal(2)
      number = edge%number
      !$omp simd private(before, behind, left, right, crosses, share, newer)
      do l = 1, nl
         before = (bx - ax)*(from_y(l) - ay) - (by - ay)*(from_x(l) - ax)
         behind = (bx - ax)*(to_y(l) - ay) - (by - ay)*(to_x(l) - ax)
         left = (to_x(l) - from_x(l))*(ay - from_y(l)) - (to_y(l) - from_y(l))*(ax - from_x(l))
         right = (to_x(l) - from_x(l))*(by - from_y(l)) - (to_y(l) - from_y(l))*(bx - from_x(l))
         crosses = max(side(before)*side(behind), side(left)*side(right))   ! -1 if it does, else 1
         share = merge(before/merge(before - behind, 1.0_dp, crosses < 0), nowhere, crosses < 0)
         newer = merge(1.0_dp, 0.0_dp, share < first(l))
         crossed%face(l) = crossed%face(l) + newer*(number - crossed%face(l))
         crossed%normal_x(l) = crossed%normal_x(l) + newer*(nx - crossed%normal_x(l))
         crossed%normal_y(l) = crossed%normal_y(l) + newer*(ny - crossed%normal_y(l))
         first(l) = min(first(l), share)
      end do
   end subroutine cross_edge

   ! 1 above 0, else -1.
   elemental real(dp) function side(value)
      real(dp), intent(in) :: value

      side = merge(1.0_dp, -1.0_dp, value > 0)
   end function side

end module solid_shares
