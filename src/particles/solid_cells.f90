!> Cells of solids: each stands for a part of the volume, and is where a ghost is.
!!
!! Source: ours (docs/equations.md, Solid bodies). A cell is what the solid covers of a square of a lattice, about dx wide; its
!! ghost stands at its centroid. Walls of the box cut it off. Where fluid comes near to a cell through faces that look in opposite
!! directions, as in a thin plate, there is a ghost for each face.
module solid_cells
   use box, only: axis_of, box_t, inward, is_wall
   use kinds, only: dp
   use motions, only: move_point, pose_t, turn
   use polygons, only: clip_polygon, edge_distance, edge_normal, edge_point, nearest_edge, polygon_area, polygon_centroid, turned
   use solids, only: new_obstacle, obstacle_t, solid_t, walls_crossed
   implicit none
   private

   public :: cell_t, find_cells, move_cell

   integer, parameter :: most_corners = 24          ! of a cell that walls cut at each time anew
   real(dp), parameter :: least_area = 1.0e-6_dp    ! in dx**2; what is less is left out
   !> Product of the normals of faces that share no ghost: 120 degrees and, whatever rounding does, those as well.
   real(dp), parameter, public :: turned_away = -0.5_dp + 1.0e-9_dp

   !> As drawn, before the solid's motion.
   type :: cell_t
      integer :: solid = 0              !! number
      integer :: edge = 0               !! the face that the ghost is for; 0: for all
      real(dp) :: place(2) = 0          !! [m] centroid
      real(dp) :: normal(2) = 0         !! of that face, or the nearest one, outwards
      real(dp) :: depth = 0             !! [m] of the centroid behind it
      real(dp) :: area = 0              !! [m2]
      integer :: n_corners = 0          !! 0: no wall ever cuts it
      real(dp) :: corner(2, most_corners) = 0
   end type cell_t

contains

   !> The cells of all solids, as far as fluid may come near them.
   subroutine find_cells(solids, box, dx, support, cells)
      type(solid_t), intent(in) :: solids(:)
      type(box_t), intent(in) :: box             !! at time 0
      real(dp), intent(in) :: dx, support        !! width of cells; of the kernel
      type(cell_t), allocatable, intent(out) :: cells(:)
      type(cell_t), allocatable :: found(:)
      integer :: k, n

      allocate (found(64))
      n = 0
      do k = 1, size(solids)
         call add_solid(solids(k), k, box, [dx, support], found, n)
      end do
      allocate (cells(n))
      cells(:) = found(:n)
   end subroutine find_cells

   ! Squares as wide as is nearest to dx fill the box around a solid, which is turned as the solid was when it was drawn: so they
   ! fit to a rectangle.
   subroutine add_solid(solid, number, box, lengths, found, n)
      type(solid_t), intent(in) :: solid
      integer, intent(in) :: number
      type(box_t), intent(in) :: box
      real(dp), intent(in) :: lengths(2)         ! dx, support
      type(cell_t), allocatable, intent(inout) :: found(:)
      integer, intent(inout) :: n
      real(dp) :: upright(2, size(solid%outline, 2)), lower(2), width(2)
      real(dp), allocatable :: row(:, :), part(:, :)
      type(obstacle_t) :: start
      type(cell_t) :: cell
      integer :: i, j, n_row, n_part, n_cells(2)

      start = new_obstacle(solid, solid%motion%at(box%time), box)
      ! What moves may come out from behind a wall.
      start%is_face = start%is_face .or. solid%motion%moves()
      if (.not. any(start%is_face)) return
      upright = turned(solid%outline, solid%pivot, -solid%angle)
      lower = minval(upright, 2)
      n_cells = max(1, nint((maxval(upright, 2) - lower)/lengths(1)))
      width = (maxval(upright, 2) - lower)/n_cells
      allocate (row(2, 2*size(upright, 2) + 8), part(2, 2*size(upright, 2) + 8))
      do j = 1, n_cells(2)
         n_row = size(upright, 2)
         row(:, :n_row) = upright
         call clip_polygon(row, n_row, lower + [0.0_dp, (j - 1)*width(2)], [0.0_dp, 1.0_dp])
         call clip_polygon(row, n_row, lower + [0.0_dp, j*width(2)], [0.0_dp, -1.0_dp])
         do i = 1, n_cells(1)
            n_part = n_row
            part(:, :n_part) = row(:, :n_row)
            call clip_polygon(part, n_part, lower + [(i - 1)*width(1), 0.0_dp], [1.0_dp, 0.0_dp])
            call clip_polygon(part, n_part, lower + [i*width(1), 0.0_dp], [-1.0_dp, 0.0_dp])
            if (n_part < 3) cycle
            part(:, :n_part) = turned(part(:, :n_part), solid%pivot, solid%angle)
            call make_cell(solid, box, part, n_part, cell)
            cell%solid = number
            if (cell%area > least_area*lengths(1)**2) call add_cell(solid%outline, start%is_face, lengths(2), cell, found, n)
         end do
      end do
   end subroutine add_solid

   ! Of a part of the solid. Where nothing moves, walls cut it once and for all.
   subroutine make_cell(solid, box, part, n, cell)
      type(solid_t), intent(in) :: solid
      type(box_t), intent(in) :: box
      real(dp), intent(inout) :: part(:, :)
      integer, intent(inout) :: n
      type(cell_t), intent(out) :: cell

      if (.not. solid%motion%moves()) call cut_at_walls(box, part, n)
      if (n < 3) return
      cell%area = polygon_area(part(:, :n))
      cell%place = polygon_centroid(part(:, :n))
      if (.not. solid%motion%moves() .or. n > most_corners) return
      cell%n_corners = n
      cell%corner(:, :n) = part(:, :n)
   end subroutine make_cell

   ! If it is near enough to a face; once for each face if some of these look in opposite directions.
   subroutine add_cell(outline, is_face, support, cell, found, n)
      real(dp), intent(in) :: outline(:, :), support
      logical, intent(in) :: is_face(:)
      type(cell_t), intent(inout) :: cell
      type(cell_t), allocatable, intent(inout) :: found(:)
      integer, intent(inout) :: n
      integer :: faces(size(is_face)), edge, k, m, n_faces
      logical :: alone

      n_faces = 0
      do edge = 1, size(is_face)
         if (.not. is_face(edge)) cycle
         if (edge_distance(outline, edge, cell%place) > support) cycle
         n_faces = n_faces + 1
         faces(n_faces) = edge
      end do
      if (n_faces == 0) return
      call find_face(outline, is_face, 1.0e-9_dp*support, cell)
      alone = .not. any([((opposite(outline, faces(k), faces(m)), k=1, m - 1), m=2, n_faces)])
      do k = 1, merge(1, n_faces, alone)
         if (.not. alone) cell%edge = faces(k)
         if (.not. alone) cell%normal = edge_normal(outline, faces(k))
         if (.not. alone) cell%depth = dot_product(cell%normal, outline(:, faces(k)) - cell%place)
         if (n == size(found)) found = [found, found]
         n = n + 1
         found(n) = cell
      end do
   end subroutine add_cell

   ! The face that is nearest to a cell. Of faces that are as near, as in a corner of a lattice along both, it is what bevels them:
   ! none is before the others, and what is symmetric stays so.
   pure subroutine find_face(outline, is_face, margin, cell)
      real(dp), intent(in) :: outline(:, :), margin   ! (2, n) [m]; that distances may differ by [m]
      logical, intent(in) :: is_face(:)
      type(cell_t), intent(inout) :: cell             ! its normal and depth are set
      real(dp) :: distance, foot(2), nearest(2), total(2)
      integer :: edge, k, n

      call nearest_edge(outline, is_face, cell%place, edge, distance, foot, nearest)
      total = 0
      n = 0
      do k = 1, size(is_face)
         if (.not. is_face(k)) cycle
         associate (normal => edge_normal(outline, k))
            if (edge_distance(outline, k, cell%place) > distance + margin) cycle
            if (dot_product(normal, edge_point(outline, k, cell%place) - cell%place) &
                < dot_product(nearest, foot - cell%place) - margin) cycle
            total = total + normal
            n = n + 1
         end associate
      end do
      cell%normal = nearest
      cell%depth = distance
      if (n < 2 .or. .not. norm2(total) > 1) return
      cell%normal = total/norm2(total)
      cell%depth = n*distance/norm2(total)
   end subroutine find_face

   ! Whether two faces look in directions so different that fluid before one has no part in the ghosts of the other.
   pure logical function opposite(outline, one, other)
      real(dp), intent(in) :: outline(:, :)    ! (2, n) [m]
      integer, intent(in) :: one, other        ! edges

      opposite = dot_product(edge_normal(outline, one), edge_normal(outline, other)) <= turned_away
   end function opposite

   ! What of a polygon is not beyond a wall.
   pure subroutine cut_at_walls(box, part, n)
      type(box_t), intent(in) :: box
      real(dp), intent(inout) :: part(:, :)
      integer, intent(inout) :: n
      real(dp) :: normal(2)
      integer :: side

      do side = 1, 4
         if (.not. is_wall(box%kind(side)) .or. n == 0) cycle
         normal = 0
         normal(axis_of(side)) = inward(side)
         call clip_polygon(part, n, spread(box%at(side), 1, 2), normal)
      end do
   end subroutine cut_at_walls

   !> A cell at a time. Walls may cut it.
   pure subroutine move_cell(cell, pivot, pose, box, place, velocity, acceleration, area)
      type(cell_t), intent(in) :: cell
      real(dp), intent(in) :: pivot(2)           !! [m] as drawn
      type(pose_t), intent(in) :: pose
      type(box_t), intent(in) :: box
      real(dp), intent(out) :: place(2)          !! [m] of its centroid
      real(dp), intent(out) :: velocity(2)       !! [m/s] of the solid there
      real(dp), intent(out) :: acceleration(2)   !! [m/s2]
      real(dp), intent(out) :: area              !! [m2]; 0 if it is beyond a wall
      real(dp) :: corner(2, 2*most_corners + 8), ignored(2), also_ignored(2), drawn(2)
      integer :: k, n

      area = cell%area
      call move_point(pose, pivot, cell%place, place, velocity, acceleration)
      n = cell%n_corners
      if (n == 0) return
      do k = 1, n
         call move_point(pose, pivot, cell%corner(:, k), corner(:, k), ignored, also_ignored)
      end do
      if (.not. any(walls_crossed(box, minval(corner(:, :n), 2), maxval(corner(:, :n), 2)))) return
      call cut_at_walls(box, corner, n)
      area = 0
      if (n >= 3) area = max(0.0_dp, polygon_area(corner(:, :n)))
      if (.not. area > 0) return
      drawn = pivot + turn(-pose%angle, polygon_centroid(corner(:, :n)) - pivot - pose%shift)
      call move_point(pose, pivot, drawn, place, velocity, acceleration)
   end subroutine move_cell

end module solid_cells
