!> Polygons: area, cuts, what is nearest, and what is wrong or too fine with them.
!!
!! Vertices are (2, n), counter-clockwise and without the first one again at the end. Edge k goes from vertex k to the
!! next, the last one back to the first; its outward normal is to the right of its direction.
module polygons
   use kinds, only: dp
   implicit none
   private

   public :: polygon_area, polygon_centroid, polygon_second_moment, clip_polygon, regular_polygon, turned
   public :: is_inside, nearest_edge, edge_normal, edge_distance, edge_point, find_crossing, sharpest_corner, thinnest, narrowest

   real(dp), parameter :: pi = acos(-1.0_dp)
   integer, parameter :: most_samples = 50   ! of an edge, so that a long one does not take most of the time

contains

   !> Area, below 0 if clockwise.
   pure real(dp) function polygon_area(vertices) result(area)
      real(dp), intent(in) :: vertices(:, :)   !! (2, n) [m]
      integer :: k

      area = 0
      ! Triangles from the first vertex: far from the origin nothing cancels.
      do k = 2, size(vertices, 2) - 1
         area = area + side(vertices(:, 1), vertices(:, k), vertices(:, k+1))/2
      end do
   end function polygon_area

   !> Centre of the area; of the vertices if the area is 0.
   pure function polygon_centroid(vertices) result(centre)
      real(dp), intent(in) :: vertices(:, :)   !! (2, n) [m] n > 0
      real(dp) :: centre(2), area, part, moment(2)
      integer :: k

      area = 0
      moment = 0
      do k = 2, size(vertices, 2) - 1
         part = side(vertices(:, 1), vertices(:, k), vertices(:, k+1))/2
         area = area + part
         moment = moment + part*((vertices(:, k) - vertices(:, 1)) + (vertices(:, k+1) - vertices(:, 1)))/3
      end do
      if (abs(area) > 0) then
         ! Of an area that is all rounding the quotient can be anywhere.
         centre = min(max(vertices(:, 1) + moment/area, minval(vertices, dim=2)), maxval(vertices, dim=2))
      else
         centre = sum(vertices, dim=2)/size(vertices, 2)
      end if
   end function polygon_centroid

   !> Polar second moment of area, the integral of r**2; times density it is the moment of inertia. Below 0 if clockwise.
   pure real(dp) function polygon_second_moment(vertices, about) result(moment)
      real(dp), intent(in) :: vertices(:, :)   !! (2, n) [m]
      real(dp), intent(in) :: about(2)         !! point from which r is measured [m]
      real(dp) :: a(2), b(2)
      integer :: k, n

      n = size(vertices, 2)
      moment = 0
      do k = 1, n
         a = vertices(:, k) - about
         b = vertices(:, mod(k, n) + 1) - about
         moment = moment + cross(a, b)*(dot_product(a, a) + dot_product(a, b) + dot_product(b, b))/12
      end do
   end function polygon_second_moment

   !> Cuts off what is on the other side of a line than its normal; n = 0 if no area is left.
   !!
   !! A convex polygon gets at most one vertex more, others up to n/2; there must be room for them. Where the line cuts
   !! others into several parts, these stay connected by edges along the line.
   pure subroutine clip_polygon(vertices, n, point, normal)
      real(dp), intent(inout) :: vertices(:, :)   !! (2, room) [m] the first n are used
      integer, intent(inout) :: n
      real(dp), intent(in) :: point(2)            !! on the line [m]
      real(dp), intent(in) :: normal(2)           !! to where the polygon stays, of any length
      real(dp) :: height(n), kept(2, n + n/2)
      integer :: k, next, n_kept

      do k = 1, n
         height(k) = dot_product(normal, vertices(:, k) - point)
      end do
      n_kept = 0
      if (any(height > 0)) then
         do k = 1, n
            next = mod(k, n) + 1
            if (height(k) >= 0) then
               n_kept = n_kept + 1
               kept(:, n_kept) = vertices(:, k)
            end if
            if (min(height(k), height(next)) < 0 .and. max(height(k), height(next)) > 0) then
               n_kept = n_kept + 1
               ! The same from both ends, so that two polygons that share the edge share the new vertex.
               kept(:, n_kept) = (vertices(:, k)*abs(height(next)) + vertices(:, next)*abs(height(k))) &
                  /(abs(height(k)) + abs(height(next)))
            end if
         end do
         vertices(:, :n_kept) = kept(:, :n_kept)
      end if
      n = n_kept
   end subroutine clip_polygon

   !> Whether a point is inside; of two polygons that share an edge a point on it is in exactly one.
   pure logical function is_inside(vertices, place)
      real(dp), intent(in) :: vertices(:, :)   !! (2, n) [m]
      real(dp), intent(in) :: place(2)         !! [m]
      integer :: k, n, lower, upper

      n = size(vertices, 2)
      is_inside = .false.
      do k = 1, n
         lower = k
         upper = mod(k, n) + 1
         if ((vertices(2, lower) > place(2)) .eqv. (vertices(2, upper) > place(2))) cycle
         ! From below for either polygon, or rounding could put the point in both.
         if (vertices(2, lower) > vertices(2, upper)) then
            upper = k
            lower = mod(k, n) + 1
         end if
         if (side(vertices(:, lower), vertices(:, upper), place) > 0) is_inside = .not. is_inside
      end do
   end function is_inside

   !> The nearest of the edges that count, and its nearest point; edge = 0 if none counts.
   !!
   !! Beyond a corner both edges are equally near: it is the one that faces the place more.
   pure subroutine nearest_edge(vertices, counts, place, edge, distance, foot, normal)
      real(dp), intent(in) :: vertices(:, :)   !! (2, n) [m]
      logical, intent(in) :: counts(:)         !! (n) edges of length 0 never count
      real(dp), intent(in) :: place(2)         !! [m]
      integer, intent(out) :: edge
      real(dp), intent(out) :: distance        !! >= 0 [m]
      real(dp), intent(out) :: foot(2)         !! point of the edge that is nearest to the place [m]
      real(dp), intent(out) :: normal(2)       !! outward normal of the edge, at its ends too
      real(dp) :: a(2), b(2), near(2), outward(2), gap, rounding, facing, most_facing
      integer :: k, n

      n = size(vertices, 2)
      edge = 0
      distance = huge(distance)
      foot = 0
      normal = 0
      most_facing = -1
      do k = 1, n
         if (.not. counts(k)) cycle
         a = vertices(:, k)
         b = vertices(:, mod(k, n) + 1)
         if (.not. any(abs(b - a) > 0)) cycle
         near = nearest_point(a, b, place)
         gap = length_of(place - near)
         rounding = 4*epsilon(gap)*sum(abs(a) + abs(b) + abs(place))
         if (gap > distance + rounding) cycle
         outward = outward_normal(a, b)
         facing = abs(dot_product(outward, place - near))
         if (gap >= distance - rounding .and. facing <= most_facing) cycle
         edge = k
         distance = gap
         foot = near
         normal = outward
         most_facing = facing
      end do
   end subroutine nearest_edge

   !> Outward normal of an edge.
   pure function edge_normal(vertices, edge) result(normal)
      real(dp), intent(in) :: vertices(:, :)   !! (2, n) [m]
      integer, intent(in) :: edge
      real(dp) :: normal(2)

      normal = outward_normal(vertices(:, edge), vertices(:, mod(edge, size(vertices, 2)) + 1))
   end function edge_normal

   !> Distance from a point to an edge [m].
   pure real(dp) function edge_distance(vertices, edge, place) result(distance)
      real(dp), intent(in) :: vertices(:, :)   !! (2, n) [m]
      integer, intent(in) :: edge
      real(dp), intent(in) :: place(2)         !! [m]

      distance = length_of(place - edge_point(vertices, edge, place))
   end function edge_distance

   !> Point of an edge that is nearest to a place [m].
   pure function edge_point(vertices, edge, place) result(point)
      real(dp), intent(in) :: vertices(:, :)   !! (2, n) [m]
      integer, intent(in) :: edge
      real(dp), intent(in) :: place(2)         !! [m]
      real(dp) :: point(2)

      point = nearest_point(vertices(:, edge), vertices(:, mod(edge, size(vertices, 2)) + 1), place)
   end function edge_point

   !> The first two edges that cross, touch or, as neighbours, fold back onto each other; 0, 0 if there are none.
   !!
   !! Less apart than rounding is a touch. So is a vertex that comes twice: its two edges are no neighbours.
   pure subroutine find_crossing(vertices, first, second)
      real(dp), intent(in) :: vertices(:, :)   !! (2, n) [m]
      integer, intent(out) :: first, second
      real(dp) :: margin
      integer :: i, j, n
      logical :: found

      n = size(vertices, 2)
      margin = 4*epsilon(margin)*maxval(abs(vertices))
      do i = 1, n
         do j = i + 1, n
            if (j == i + 1) then
               found = folds_back(vertices(:, i), vertices(:, j), vertices(:, mod(j, n) + 1))
            else if (i == 1 .and. j == n) then
               found = folds_back(vertices(:, n), vertices(:, 1), vertices(:, 2))
            else
               found = touch(vertices(:, i), vertices(:, i+1), vertices(:, j), vertices(:, mod(j, n) + 1), margin)
            end if
            if (found) then
               first = i
               second = j
               return
            end if
         end do
      end do
      first = 0
      second = 0
   end subroutine find_crossing

   !> The vertex with the smallest interior angle; 0 if there is none between edges of a length.
   pure subroutine sharpest_corner(vertices, corner, angle)
      real(dp), intent(in) :: vertices(:, :)   !! (2, n) [m]
      integer, intent(out) :: corner
      real(dp), intent(out) :: angle           !! 0 to 2 pi [rad]
      real(dp) :: before(2), after(2), inner
      integer :: k, n

      n = size(vertices, 2)
      corner = 0
      angle = 2*pi
      do k = 1, n
         before = vertices(:, k) - vertices(:, mod(k + n - 2, n) + 1)
         after = vertices(:, mod(k, n) + 1) - vertices(:, k)
         if (.not. (any(abs(before) > 0) .and. any(abs(after) > 0))) cycle
         inner = pi - atan2(cross(before, after), dot_product(before, after))
         if (inner >= 2*pi) inner = 0   ! folded back: the sign of a zero says nothing
         if (inner < angle) then
            corner = k
            angle = inner
         end if
      end do
   end subroutine sharpest_corner

   !> The smallest thickness: from an edge straight inward to the next edge that faces away; both must count.
   !!
   !! Rays start inside of each edge, at most reach/4 apart, of long edges length/50. At corners below 60 degrees they
   !! find less the nearer they start.
   pure subroutine thinnest(vertices, counts, reach, width, place)
      real(dp), intent(in) :: vertices(:, :)   !! (2, n) [m]
      logical, intent(in) :: counts(:)         !! (n) which edges count
      real(dp), intent(in) :: reach            !! what is thicker does not matter, > 0 [m]
      real(dp), intent(out) :: width           !! huge if nothing is within reach [m]
      real(dp), intent(out) :: place(2)        !! where the shortest ray starts [m]
      real(dp) :: normals(2, size(vertices, 2)), start(2), depth
      integer :: i, j, k, m, n, next

      n = size(vertices, 2)
      width = huge(width)
      place = 0
      do k = 1, n
         normals(:, k) = outward_normal(vertices(:, k), vertices(:, mod(k, n) + 1))
      end do
      do k = 1, n
         if (.not. counts(k)) cycle
         next = mod(k, n) + 1
         m = max(1, ceiling(min(real(most_samples, dp), length_of(vertices(:, next) - vertices(:, k))/(reach/4))))
         do j = 1, n
            if (.not. counts(j)) cycle
            if (.not. dot_product(normals(:, k), normals(:, j)) < -0.5_dp) cycle
            do i = 1, m
               start = vertices(:, k) + (vertices(:, next) - vertices(:, k))*((i - 0.5_dp)/m)
               depth = ray_length(start, -normals(:, k), vertices(:, j), vertices(:, mod(j, n) + 1))
               if (depth < width .and. depth <= reach) then
                  width = depth
                  place = start
               end if
            end do
         end do
      end do
   end subroutine thinnest

   !> The smallest gap between the edges of two polygons, 0 if they cross. That one is inside the other is not noticed.
   pure subroutine narrowest(vertices, others, reach, width, place)
      real(dp), intent(in) :: vertices(:, :)   !! (2, n) [m]
      real(dp), intent(in) :: others(:, :)     !! (2, n of the other) [m]
      real(dp), intent(in) :: reach            !! wider gaps do not matter [m]
      real(dp), intent(out) :: width           !! huge if nothing is within reach [m]
      real(dp), intent(out) :: place(2)        !! point of the first polygon at the gap [m]
      real(dp) :: a(2), b(2), c(2), d(2), low(2), high(2), near(2), gap
      integer :: i, j

      width = huge(width)
      place = 0
      low = minval(others, dim=2)
      high = maxval(others, dim=2)
      do i = 1, size(vertices, 2)
         a = vertices(:, i)
         b = vertices(:, mod(i, size(vertices, 2)) + 1)
         if (box_gap(a, b, low, high) > min(reach, width)) cycle
         do j = 1, size(others, 2)
            c = others(:, j)
            d = others(:, mod(j, size(others, 2)) + 1)
            if (box_gap(a, b, c, d) > min(reach, width)) cycle
            call measure_gap(a, b, c, d, gap, near)
            if (gap < width .and. gap <= reach) then
               width = gap
               place = near
            end if
         end do
      end do
   end subroutine narrowest

   !> A regular polygon with the area of a disc; its corners are a little outside of it, the first one to the right.
   pure function regular_polygon(centre, radius, n) result(vertices)
      real(dp), intent(in) :: centre(2)   !! [m]
      real(dp), intent(in) :: radius      !! of the disc [m]
      integer, intent(in) :: n            !! how many corners, > 2
      real(dp) :: vertices(2, n), corner
      integer :: k

      corner = radius*sqrt(2*pi/(n*sin(2*pi/n)))
      do k = 1, n
         vertices(:, k) = centre + corner*[cos(2*pi*(k - 1)/n), sin(2*pi*(k - 1)/n)]
      end do
   end function regular_polygon

   !> A polygon turned about a point.
   pure function turned(vertices, about, angle) result(rotated)
      real(dp), intent(in) :: vertices(:, :)   !! (2, n) [m]
      real(dp), intent(in) :: about(2)         !! [m]
      real(dp), intent(in) :: angle            !! counter-clockwise [rad]
      real(dp) :: rotated(2, size(vertices, 2)), arm(2)
      integer :: k

      do k = 1, size(vertices, 2)
         arm = vertices(:, k) - about
         rotated(1, k) = about(1) + cos(angle)*arm(1) - sin(angle)*arm(2)
         rotated(2, k) = about(2) + sin(angle)*arm(1) + cos(angle)*arm(2)
      end do
   end function turned

   pure real(dp) function cross(a, b)
      real(dp), intent(in) :: a(2), b(2)

      cross = a(1)*b(2) - a(2)*b(1)
   end function cross

   ! Above 0 to the left of the line from a to b: distance from it times its length.
   pure real(dp) function side(a, b, place)
      real(dp), intent(in) :: a(2), b(2), place(2)

      side = cross(b - a, place - a)
   end function side

   pure real(dp) function length_of(vector)
      real(dp), intent(in) :: vector(2)

      length_of = sqrt(dot_product(vector, vector))
   end function length_of

   ! 0 for an edge without length, so that it faces nothing.
   pure function outward_normal(a, b) result(normal)
      real(dp), intent(in) :: a(2), b(2)
      real(dp) :: normal(2)

      normal = 0
      if (length_of(b - a) > 0) normal = [b(2) - a(2), a(1) - b(1)]/length_of(b - a)
   end function outward_normal

   ! Exactly an end where it is one, so that both edges of a corner find the same point.
   pure function nearest_point(a, b, place) result(near)
      real(dp), intent(in) :: a(2), b(2), place(2)
      real(dp) :: near(2), along, whole

      along = dot_product(b - a, place - a)
      whole = dot_product(b - a, b - a)
      if (along <= 0) then
         near = a
      else if (along >= whole) then
         near = b
      else
         near = a + (b - a)*(along/whole)
      end if
   end function nearest_point

   ! How far apart two boxes are in the direction in which it is more; each spanned by two points.
   pure real(dp) function box_gap(a, b, c, d)
      real(dp), intent(in) :: a(2), b(2), c(2), d(2)

      box_gap = max(0.0_dp, maxval(min(c, d) - max(a, b)), maxval(min(a, b) - max(c, d)))
   end function box_gap

   ! Whether b is the tip of an edge that comes back on itself.
   pure logical function folds_back(a, b, c)
      real(dp), intent(in) :: a(2), b(2), c(2)

      folds_back = dot_product(b - a, c - b) < 0 .and. &
         abs(cross(b - a, c - b)) <= 8*epsilon(1.0_dp)*abs(dot_product(b - a, c - b))
   end function folds_back

   ! Whether the edges a-b and c-d have a point in common, or less than a margin between them.
   pure logical function touch(a, b, c, d, margin)
      real(dp), intent(in) :: a(2), b(2), c(2), d(2), margin

      touch = box_gap(a, b, c, d) <= margin
      if (touch) touch = on_both_sides(a, b, c, d, margin)
      if (touch) touch = on_both_sides(c, d, a, b, margin)
   end function touch

   ! Whether c and d are on different sides of the line through a and b, or within a margin of it.
   pure logical function on_both_sides(a, b, c, d, margin)
      real(dp), intent(in) :: a(2), b(2), c(2), d(2), margin
      real(dp) :: slack

      slack = margin*length_of(b - a)
      on_both_sides = min(side(a, b, c), side(a, b, d)) <= slack .and. max(side(a, b, c), side(a, b, d)) >= -slack
   end function on_both_sides

   ! How far a ray goes to an edge that faces it at least half; huge if it misses.
   pure real(dp) function ray_length(start, direction, a, b) result(length)
      real(dp), intent(in) :: start(2), direction(2), a(2), b(2)
      real(dp) :: slope, along

      length = huge(length)
      slope = cross(direction, b - a)
      along = cross(a - start, direction)/slope
      if (along < 0 .or. along > 1) return
      along = cross(a - start, b - a)/slope
      if (along > 0) length = along
   end function ray_length

   ! The gap between the edges a-b and c-d and the point of a-b where it is.
   pure subroutine measure_gap(a, b, c, d, gap, near)
      real(dp), intent(in) :: a(2), b(2), c(2), d(2)
      real(dp), intent(out) :: gap, near(2)
      real(dp) :: candidates(2, 4), gaps(4)

      if (max(side(c, d, a), side(c, d, b)) > 0 .and. min(side(c, d, a), side(c, d, b)) < 0 .and. &
         max(side(a, b, c), side(a, b, d)) > 0 .and. min(side(a, b, c), side(a, b, d)) < 0) then
         gap = 0
         near = a + (b - a)*(side(c, d, a)/(side(c, d, a) - side(c, d, b)))
         return
      end if
      ! Without a crossing the nearest point is an end of one of the two.
      candidates(:, 1) = a
      candidates(:, 2) = b
      candidates(:, 3) = nearest_point(a, b, c)
      candidates(:, 4) = nearest_point(a, b, d)
      gaps(1) = length_of(a - nearest_point(c, d, a))
      gaps(2) = length_of(b - nearest_point(c, d, b))
      gaps(3) = length_of(c - candidates(:, 3))
      gaps(4) = length_of(d - candidates(:, 4))
      gap = minval(gaps)
      near = candidates(:, minloc(gaps, dim=1))
   end subroutine measure_gap

end module polygons
