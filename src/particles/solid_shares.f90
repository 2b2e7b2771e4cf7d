!> Which pairs act where cells of solids have a ghost for each of several faces.
!!
!! Source: ours (docs/equations.md, Thin solids). A particle and a ghost act on each other if the way to the ghost first leads
!! through its face; the ghost has its pressure also of particles that come through faces that do not look the other way.
module solid_shares
   use box, only: box_t
   use candidates, only: candidates_t
   use kinds, only: dp
   use lanes, only: nl
   use particles, only: state_t
   use polygons, only: nearest_edge
   use solid_cells, only: turned_away
   use solid_ghosts, only: solid_ghosts_t
   use solids, only: obstacle_t
   implicit none
   private

   public :: shares_t, share_of_fluid, share_of_ghosts

   !> Of the pairs of a cluster, 1 or 0 by its lanes and places in its list.
   type :: shares_t
      integer :: n = 0                       !! rows: one for each place, or one for all where no cell has several ghosts
      real(dp), allocatable :: mine(:, :)    !! (nl, n) the two act on each other
      real(dp), allocatable :: given(:, :)   !! (nl, n) the ghost has its pressure also of the particle
   end type shares_t

   ! The faces that the ways of a cluster lead through first.
   type :: crossed_t
      real(dp) :: face(nl) = 0                           ! number; below 0 if all of the solid is behind walls
      real(dp) :: normal_x(nl) = 0, normal_y(nl) = 0
   end type crossed_t

contains

   !> Of a cluster of the fluid and the ghosts near it.
   pure subroutine share_of_fluid(ghosts, block, c, state, box, support, shares)
      type(solid_ghosts_t), intent(in) :: ghosts
      type(candidates_t), intent(in) :: block      !! of the fluid
      integer, intent(in) :: c                     !! cluster
      type(state_t), intent(in) :: state           !! of all slots
      type(box_t), intent(in) :: box               !! at any time
      real(dp), intent(in) :: support              !! of the kernel
      type(shares_t), intent(inout) :: shares
      type(crossed_t) :: crossed
      real(dp), dimension(nl) :: x, y, from_x, from_y, to_x, to_y, face, normal_x, normal_y
      real(dp) :: sign(2), place(2), last(2), way(2)
      integer :: i0, j, k, m, number, only
      logical :: some, mirrored, is_other

      associate (near => block%slot(block%first(c):block%first(c + 1) - 1))
         some = ghosts%shared
         if (some) some = any(ghosts%face(near - ghosts%before) > 0)
         call begin_rows(some, size(near), shares)
         if (.not. some) return
         i0 = block%before + (c - 1)*nl
         x = state%x(i0 + 1:i0 + nl)
         y = state%y(i0 + 1:i0 + nl)
         number = 0
         only = 0
         last = 0
         way = 0
         do k = 1, size(near)
            j = near(k)
            m = j - ghosts%before
            mirrored = m > ghosts%n_slots
            if (mirrored) m = ghosts%images%source(m - ghosts%n_slots) - ghosts%before
            if (ghosts%face(m) == 0) cycle
            associate (solid => ghosts%obstacles(ghosts%solid_of(m)), normal => ghosts%obstacles(ghosts%solid_of(m))%normal)
               is_other = number /= ghosts%solid_of(m) .or. any(abs(ghosts%way(:, m) - way) > 0)
               number = ghosts%solid_of(m)
               way = ghosts%way(:, m)
               if (is_other) only = only_face(solid, around(x - way(1), y - way(2), support))
               if (only > 0 .and. .not. mirrored) then
                  shares%mine(:, k) = merge(1, 0, only == ghosts%face(m))
                  shares%given(:, k) = merge(1, 0, dot_product(normal(:, only), normal(:, ghosts%face(m))) > turned_away)
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
            call take_parts(crossed, face, normal_x, normal_y, shares%mine(:, k), shares%given(:, k))
         end do
      end associate
   end subroutine share_of_fluid

   !> Of a cluster of ghosts and the fluid near it.
   pure subroutine share_of_ghosts(ghosts, block, c, state, support, shares)
      type(solid_ghosts_t), intent(in) :: ghosts
      type(candidates_t), intent(in) :: block      !! of ghosts
      integer, intent(in) :: c                     !! cluster
      type(state_t), intent(in) :: state           !! of all slots
      real(dp), intent(in) :: support              !! of the kernel
      type(shares_t), intent(inout) :: shares
      type(crossed_t) :: crossed, of_solid
      real(dp), dimension(nl) :: from_x, from_y, to_x, to_y, face, normal_x, normal_y
      logical :: leads(nl)                         ! first lanes of their solids
      integer :: number(nl), i0, k, l, m0
      logical :: some

      associate (near => block%slot(block%first(c):block%first(c + 1) - 1))
         i0 = block%before + (c - 1)*nl
         m0 = i0 - ghosts%before
         some = ghosts%shared
         if (some) some = any(ghosts%face(m0 + 1:m0 + nl) > 0)
         call begin_rows(some, size(near), shares)
         if (.not. some) return
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
         do k = 1, size(near)
            from_x = to_x + (state%x(near(k)) - state%x(i0 + 1:i0 + nl))
            from_y = to_y + (state%y(near(k)) - state%y(i0 + 1:i0 + nl))
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
            call take_parts(crossed, face, normal_x, normal_y, shares%mine(:, k), shares%given(:, k))
         end do
      end associate
   end subroutine share_of_ghosts

   ! Ones: a row for each place if some ghosts are not alone in their cells, else one for all.
   pure subroutine begin_rows(some, n_near, shares)
      logical, intent(in) :: some
      integer, intent(in) :: n_near
      type(shares_t), intent(inout) :: shares
      integer :: n

      n = 1
      if (some) n = max(1, n_near)
      if (allocated(shares%mine)) then
         if (size(shares%mine, 2) < n) deallocate (shares%mine, shares%given)
      end if
      if (.not. allocated(shares%mine)) allocate (shares%mine(nl, n + n/4), shares%given(nl, n + n/4))
      shares%n = n
      shares%mine(:, :n) = 1
      shares%given(:, :n) = 1
   end subroutine begin_rows

   ! The parts of pairs, from the faces of the ghosts and those that are crossed.
   pure subroutine take_parts(crossed, face, normal_x, normal_y, mine, given)
      type(crossed_t), intent(in) :: crossed
      real(dp), intent(in) :: face(nl), normal_x(nl), normal_y(nl)   ! of the ghosts; 0 for those that are alone in their cells
      real(dp), intent(out) :: mine(nl), given(nl)
      real(dp) :: alike, alone
      integer :: l

      !$omp simd private(alike, alone)
      do l = 1, nl
         alike = normal_x(l)*crossed%normal_x(l) + normal_y(l)*crossed%normal_y(l)
         alone = merge(1.0_dp, 0.0_dp, face(l) < 0.5_dp)
         mine(l) = max(alone, merge(1.0_dp, 0.0_dp, abs(crossed%face(l) - face(l)) < 0.5_dp))
         given(l) = max(alone, merge(1.0_dp, 0.0_dp, min(alike - turned_away, crossed%face(l)) > 0))
      end do
   end subroutine take_parts

   ! What straight ways lead through first. Where a way leads through nothing, as from inside, it is what is nearest to its begin.
   pure subroutine find_crossed(solid, support, from_x, from_y, to_x, to_y, crossed)
      type(obstacle_t), intent(in) :: solid
      real(dp), intent(in) :: support             ! ways that are longer do not matter
      real(dp), dimension(nl), intent(in) :: from_x, from_y, to_x, to_y
      type(crossed_t), intent(out) :: crossed
      real(dp), dimension(nl) :: distance_2, first
      real(dp) :: room(4), foot(2), normal(2), distance
      integer :: edge, k, l, only

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
