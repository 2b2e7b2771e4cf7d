!> Which pairs act where cells of solids have a ghost for each of several faces.
!!
!! Source: ours (docs/equations.md, Thin solids). A particle and a ghost act on each other if the way to the ghost first leads
!! through its face; the ghost has its pressure also of particles that come through faces that do not look the other way. Found
!! once a step: the energy that the fluid gets is the solids' as long as the same pairs act for both, whichever they are.
module solid_shares
   use box, only: box_t
   use candidates, only: acts, gives, shared_candidates_t
   use kinds, only: dp
   use lanes, only: nl
   use particles, only: state_t
   use polygons, only: nearest_edge
   use solid_cells, only: turned_away
   use solid_ghosts, only: solid_ghosts_t
   use solids, only: obstacle_t
   implicit none
   private

   public :: find_shares

   real(dp), parameter :: reach = 1.5_dp   ! times the kernel's support: pairs that are farther do not come near in a step
   real(dp), parameter :: flatter = 1.0e-6_dp, beside(2) = [0.6e-9_dp, 1.0e-9_dp]   ! more than rounding, less than matters

   ! The faces that the ways of a cluster lead through first.
   type :: crossed_t
      real(dp) :: face(nl) = 0                           ! number; below 0 if all of the solid is behind walls
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
      integer :: b, c, m0
      logical :: mixed

      !$omp parallel default(none) shared(ghosts, n_blocks, state, box, support) private(c, m0, mixed)
      !$omp do schedule(dynamic)
      do b = 1, n_blocks
         do c = 1, ghosts%near(b)%n_clusters
            associate (block => ghosts%near(b))
               mixed = any(ghosts%face(block%slot(block%first(c):block%first(c + 1) - 1) - ghosts%before) > 0)
               call begin_parts(block, c, mixed)
            end associate
            if (mixed) call share_of_fluid(ghosts, b, c, state, box, reach*support)
         end do
      end do
      !$omp end do
      !$omp do schedule(dynamic)
      do b = 1, ghosts%n_blocks
         do c = 1, ghosts%fluid(b)%n_clusters
            m0 = ghosts%fluid(b)%before + (c - 1)*nl - ghosts%before
            mixed = any(ghosts%face(m0 + 1:m0 + nl) > 0)
            call begin_parts(ghosts%fluid(b), c, mixed)
            if (mixed) call share_of_ghosts(ghosts, b, c, state, reach*support)
         end do
      end do
      !$omp end do
      !$omp end parallel
   end subroutine find_shares

   ! Room for the parts of a block, where some ghosts of a cluster are not alone in their cells.
   pure subroutine begin_parts(block, c, mixed)
      type(shared_candidates_t), intent(inout) :: block
      integer, intent(in) :: c
      logical, intent(in) :: mixed
      integer :: n

      block%shared(c) = mixed
      n = block%first(block%n_clusters + 1) - 1
      if (.not. mixed .or. ubound(block%part, 2) >= n) return
      deallocate (block%part)
      allocate (block%part(nl, 0:n + n/8), source=acts)
   end subroutine begin_parts

   ! Of a cluster of the fluid and the ghosts near it.
   pure subroutine share_of_fluid(ghosts, b, c, state, box, support)
      type(solid_ghosts_t), intent(inout) :: ghosts
      integer, intent(in) :: b, c                  ! block of the fluid, and its cluster
      type(state_t), intent(in) :: state
      type(box_t), intent(in) :: box
      real(dp), intent(in) :: support              ! farther pairs do not matter
      type(crossed_t) :: crossed
      real(dp), dimension(nl) :: x, y, from_x, from_y, to_x, to_y, face, normal_x, normal_y
      real(dp) :: sign(2), place(2), last(2), way(2)
      integer :: i0, j, k, m, number, only
      logical :: mirrored, is_other

      associate (block => ghosts%near(b))
         i0 = block%before + (c - 1)*nl
         x = state%x(i0 + 1:i0 + nl)
         y = state%y(i0 + 1:i0 + nl)
         number = 0
         only = 0
         last = 0
         way = 0
         do k = block%first(c), block%first(c + 1) - 1
            j = block%slot(k)
            m = j - ghosts%before
            mirrored = m > ghosts%n_slots
            if (mirrored) m = ghosts%images%source(m - ghosts%n_slots) - ghosts%before
            block%part(:, k) = acts
            if (ghosts%face(m) == 0) cycle
            associate (solid => ghosts%obstacles(ghosts%solid_of(m)), normal => ghosts%obstacles(ghosts%solid_of(m))%normal)
               is_other = number /= ghosts%solid_of(m) .or. any(abs(ghosts%way(:, m) - way) > 0)
               number = ghosts%solid_of(m)
               way = ghosts%way(:, m)
               if (is_other) only = only_face(solid, around(x - way(1), y - way(2), support))
               if (only > 0 .and. .not. mirrored) then
                  if (only == ghosts%face(m)) cycle
                  block%part(:, k) = merge(gives, 0.0_dp, dot_product(normal(:, only), normal(:, ghosts%face(m))) > turned_away)
                  cycle
               end if
               place = [state%x(j), state%y(j)]
               ! The ghosts of a cell follow each other in the list.
               if (is_other .or. only > 0 .or. any(abs(place - last) > 0)) then
                  sign = ghosts%signs(box, j)
                  to_x = ghosts%place(1, m)
                  to_y = ghosts%place(2, m)
                  from_x = to_x + sign(1)*(x - place(1))
                  from_y = to_y + sign(2)*(y - place(2))
                  call find_crossed(solid, support, from_x, from_y, to_x, to_y, crossed)
               end if
               last = place
               face = ghosts%face(m)
               normal_x = normal(1, ghosts%face(m))
               normal_y = normal(2, ghosts%face(m))
            end associate
            call take_parts(crossed, face, normal_x, normal_y, block%part(:, k))
         end do
      end associate
   end subroutine share_of_fluid

   ! Of a cluster of ghosts and the fluid near it.
   pure subroutine share_of_ghosts(ghosts, b, c, state, support)
      type(solid_ghosts_t), intent(inout) :: ghosts
      integer, intent(in) :: b, c                  ! block of ghosts, and its cluster
      type(state_t), intent(in) :: state
      real(dp), intent(in) :: support              ! farther pairs do not matter
      type(crossed_t) :: crossed, of_solid
      real(dp), dimension(nl) :: from_x, from_y, to_x, to_y, face, normal_x, normal_y
      logical :: leads(nl)                         ! first lanes of their solids
      integer :: number(nl), i0, j, k, l, m0

      associate (block => ghosts%fluid(b))
         i0 = block%before + (c - 1)*nl
         m0 = i0 - ghosts%before
         normal_x = 0
         normal_y = 0
         number = 0
         leads = .false.
         do l = 1, nl
            if (ghosts%face(m0 + l) == 0) cycle
            leads(l) = all(number(:l - 1) /= ghosts%solid_of(m0 + l))
            number(l) = ghosts%solid_of(m0 + l)
            normal_x(l) = ghosts%obstacles(number(l))%normal(1, ghosts%face(m0 + l))
            normal_y(l) = ghosts%obstacles(number(l))%normal(2, ghosts%face(m0 + l))
         end do
         face = ghosts%face(m0 + 1:m0 + nl)
         to_x = ghosts%place(1, m0 + 1:m0 + nl)
         to_y = ghosts%place(2, m0 + 1:m0 + nl)
         do k = block%first(c), block%first(c + 1) - 1
            j = block%slot(k)
            from_x = to_x + (state%x(j) - state%x(i0 + 1:i0 + nl))
            from_y = to_y + (state%y(j) - state%y(i0 + 1:i0 + nl))
            do l = 1, nl
               if (.not. leads(l)) cycle
               call find_crossed(ghosts%obstacles(number(l)), support, from_x, from_y, to_x, to_y, of_solid)
               if (count(leads) == 1) then
                  crossed = of_solid
               else
                  where (number == number(l))
                     crossed%face = of_solid%face
                     crossed%normal_x = of_solid%normal_x
                     crossed%normal_y = of_solid%normal_y
                  end where
               end if
            end do
            call take_parts(crossed, face, normal_x, normal_y, block%part(:, k))
         end do
      end associate
   end subroutine share_of_ghosts

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
   pure subroutine find_crossed(solid, support, particle_x, particle_y, to_x, to_y, crossed)
      type(obstacle_t), intent(in) :: solid
      real(dp), intent(in) :: support              ! ways that are longer do not matter
      real(dp), dimension(nl), intent(in) :: particle_x, particle_y, to_x, to_y
      type(crossed_t), intent(out) :: crossed
      real(dp), dimension(nl) :: distance_2, first, from_x, from_y
      real(dp) :: room(4), foot(2), normal(2), distance
      integer :: edge, k, l, only

      from_x = particle_x + flatter*(particle_x - to_x) + beside(1)*support
      from_y = particle_y + beside(2)*support
      room = around(from_x, from_y, support)
      only = only_face(solid, room)
      if (only > 0) then
         crossed%face = only
         crossed%normal_x = solid%normal(1, only)
         crossed%normal_y = solid%normal(2, only)
         return
      end if
      distance_2 = (from_x - to_x)**2 + (from_y - to_y)**2
      if (.not. minval(distance_2) < support**2) return
      first = 2
      do k = 1, size(solid%is_face)
         if (.not. may_meet(solid, k, room)) cycle
         call cross_edge(real(k, dp), solid%outline(:, k), solid%outline(:, mod(k, size(solid%is_face)) + 1), from_x, from_y, &
                         to_x, to_y, first, crossed%face)
      end do
      do l = 1, nl
         edge = nint(crossed%face(l))
         if (edge == 0 .and. distance_2(l) < support**2) then
            call nearest_edge(solid%outline, solid%is_face, [from_x(l), from_y(l)], edge, distance, foot, normal)
            crossed%face(l) = merge(edge, -1, edge > 0)
         end if
         if (edge == 0) cycle
         crossed%normal_x(l) = solid%normal(1, edge)
         crossed%normal_y(l) = solid%normal(2, edge)
      end do
   end subroutine find_crossed

   ! All that is within reach of a cluster.
   pure function around(x, y, reach) result(room)
      real(dp), intent(in) :: x(nl), y(nl), reach
      real(dp) :: room(4)   ! left, right, bottom, top

      room = [minval(x) - reach, maxval(x) + reach, minval(y) - reach, maxval(y) + reach]
   end function around

   ! The face that is the only one that may be in a rectangle; 0 if none or several may be.
   pure integer function only_face(solid, room)
      type(obstacle_t), intent(in) :: solid
      real(dp), intent(in) :: room(4)   ! left, right, bottom, top
      integer :: k

      only_face = 0
      do k = 1, size(solid%is_face)
         if (.not. may_meet(solid, k, room)) cycle
         if (only_face > 0) then
            only_face = 0
            return
         end if
         only_face = k
      end do
   end function only_face

   pure logical function may_meet(solid, k, room)
      type(obstacle_t), intent(in) :: solid
      integer, intent(in) :: k          ! edge
      real(dp), intent(in) :: room(4)

      may_meet = .false.
      if (.not. solid%is_face(k)) return
      associate (a => solid%outline(:, k), b => solid%outline(:, mod(k, size(solid%is_face)) + 1))
         may_meet = max(a(1), b(1)) >= room(1) .and. min(a(1), b(1)) <= room(2) &
                    .and. max(a(2), b(2)) >= room(3) .and. min(a(2), b(2)) <= room(4)
      end associate
   end function may_meet

   ! Takes an edge for ways that lead through it before they do through others. Without a branch, or it would not be vectorised.
   pure subroutine cross_edge(number, a, b, from_x, from_y, to_x, to_y, first, face)
      real(dp), intent(in) :: number, a(2), b(2)
      real(dp), dimension(nl), intent(in) :: from_x, from_y, to_x, to_y
      real(dp), intent(inout) :: first(nl)   ! where on a way, 0 to 1
      real(dp), intent(inout) :: face(nl)    ! that is there
      real(dp) :: ax, ay, bx, by, before, behind, left, right, crosses, share, newer
      integer :: l

      ax = a(1)
      ay = a(2)
      bx = b(1)
      by = b(2)
      !$omp simd private(before, behind, left, right, crosses, share, newer)
      do l = 1, nl
         before = (bx - ax)*(from_y(l) - ay) - (by - ay)*(from_x(l) - ax)
         behind = (bx - ax)*(to_y(l) - ay) - (by - ay)*(to_x(l) - ax)
         left = (to_x(l) - from_x(l))*(ay - from_y(l)) - (to_y(l) - from_y(l))*(ax - from_x(l))
         right = (to_x(l) - from_x(l))*(by - from_y(l)) - (to_y(l) - from_y(l))*(bx - from_x(l))
         crosses = max(side(before)*side(behind), side(left)*side(right))   ! -1 if it does, else 1
         share = merge(before/merge(before - behind, 1.0_dp, crosses < 0), 2.0_dp, crosses < 0)
         newer = merge(1.0_dp, 0.0_dp, share < first(l))
         face(l) = face(l) + newer*(number - face(l))
         first(l) = min(first(l), share)
      end do
   end subroutine cross_edge

   ! 1 above 0, else -1.
   elemental real(dp) function side(value)
      real(dp), intent(in) :: value

      side = merge(1.0_dp, -1.0_dp, value > 0)
   end function side

end module solid_shares
