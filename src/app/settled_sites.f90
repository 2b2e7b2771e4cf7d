!> Particles beside slopes of solids: moved to where their neighbours leave them at rest.
!!
!! A lattice that a slope has cut through is crowded here and has gaps there. Pressure pushes its particles about for long, and rows
!! of them slide along the slope. So before t = 0 those near it follow -grad C, C = sum V W over fluid and solids, as if slowed down
!! by friction, until C is even. Source: Colagrossi, Bouscasse, Antuono & Marrone, Comput. Phys. Commun. 183 (2012) 1641-1653. Ours:
!! their areas adapt, because a slope does not leave room for a whole number of cells: what is left over would press on the others.
module settled_sites
   use body_particles, only: count_sites, place_sites, sites_t
   use box, only: box_t, free_slip_wall
   use kernel, only: kernel_gradient, kernel_t, kernel_value
   use kinds, only: dp
   use open_sites, only: place_open
   use polygons, only: edge_normal, nearest_edge
   use settings, only: body_settings
   use solid_cells, only: cell_t, find_cells
   use solids, only: cover, obstacle_t, solid_t
   implicit none
   private

   public :: place_settled

   real(dp), parameter :: reach = 2.0_dp        ! in kernel supports: sites farther from slopes stay
   integer, parameter :: rounds = 200           ! after which grad C is a thousandth of what it was
   real(dp), parameter :: pace = 0.15_dp        ! of a round's step, in h**2 grad C
   real(dp), parameter :: kept = 0.9_dp         ! of this step in the next round
   real(dp), parameter :: ease = 0.02_dp        ! of the areas' way to the lattice's C, in a round
   real(dp), parameter :: aligned = 1.0e-6_dp   ! component of a normal below which a face lies along the lattice
   integer, parameter :: chunk = 65536          ! sites that are looked at at a time

   !> Sites near slopes and cells of solids, in squares as wide as the kernel reaches.
   type :: crowd_t
      integer :: n_moving = 0                !! sites that move; they come first
      real(dp), allocatable :: x(:), y(:)    !! (n) [m]
      real(dp), allocatable :: area(:)       !! (n) [m2]
      integer, allocatable :: first(:, :)    !! in a square, from the body's lower left corner; 0: it is empty
      integer, allocatable :: next(:)        !! (n) in the same square; 0: none
   end type crowd_t

contains

   !> Places some of a body's particles that no solid covers, counted from 1. A rectangle's lattice settles at slopes.
   subroutine place_settled(body, dx, kernel, solids, obstacles, first, last, sites)
      type(body_settings), intent(in) :: body
      real(dp), intent(in) :: dx
      type(kernel_t), intent(in) :: kernel
      type(solid_t), intent(in) :: solids(:)
      type(obstacle_t), intent(in) :: obstacles(:)   !! these at t = 0
      integer, intent(in) :: first, last
      type(sites_t), intent(out) :: sites
      type(crowd_t) :: crowd
      integer, allocatable :: number(:)
      integer :: k

      call place_open(body, dx, obstacles, first, last, sites)
      if (body%shape == 'disc' .or. body%lattice == 'turned') return
      ! Each process settles all of them: what moves one moves the next.
      call gather(body, dx, kernel, obstacles, number, crowd)
      if (crowd%n_moving == 0) return
      call add_solids(body, dx, kernel, solids, obstacles, crowd)
      call settle(body, kernel, obstacles, crowd)
      do k = 1, crowd%n_moving
         if (number(k) < first .or. number(k) > last) cycle
         sites%x(number(k)) = crowd%x(k)
         sites%y(number(k)) = crowd%y(k)
         sites%area(number(k)) = crowd%area(k)
      end do
   end subroutine place_settled

   ! The sites near slopes, those that move and behind them those that they may meet; with their numbers.
   pure subroutine gather(body, dx, kernel, obstacles, number, crowd)
      type(body_settings), intent(in) :: body
      real(dp), intent(in) :: dx
      type(kernel_t), intent(in) :: kernel
      type(obstacle_t), intent(in) :: obstacles(:)
      integer, allocatable, intent(out) :: number(:)
      type(crowd_t), intent(out) :: crowd
      type(obstacle_t) :: slopes(size(obstacles))
      type(sites_t) :: sites
      real(dp), allocatable :: near(:, :)   ! (4, n) x, y, area, distance from a slope
      real(dp) :: distance
      integer :: begin, i, n, n_open, total

      slopes = slopes_of(obstacles)
      total = 0
      if (any([(any(slopes(i)%is_face), i=1, size(slopes))])) total = count_sites(body, dx)
      allocate (number(64), near(4, 64))
      n = 0
      n_open = 0
      do begin = 1, total, chunk
         call place_sites(body, dx, sites, begin, min(begin + chunk - 1, total))
         do i = lbound(sites%x, 1), ubound(sites%x, 1)
            if (cover(obstacles, [sites%x(i), sites%y(i)]) > 0) cycle
            n_open = n_open + 1
            distance = slope_distance(slopes, [sites%x(i), sites%y(i)], (reach + 2)*kernel%support)
            if (distance > (reach + 2)*kernel%support) cycle
            if (n == size(number)) near = reshape(near, [4, 2*n], pad=[0.0_dp])
            if (n == size(number)) number = [number, number]
            n = n + 1
            number(n) = n_open
            near(:, n) = [sites%x(i), sites%y(i), sites%area(i), distance]
         end do
      end do
      associate (moves => near(4, :n) <= reach*kernel%support)
         crowd%n_moving = count(moves)
         number = pack(number(:n), moves)
         crowd%x = [pack(near(1, :n), moves), pack(near(1, :n), .not. moves)]
         crowd%y = [pack(near(2, :n), moves), pack(near(2, :n), .not. moves)]
         crowd%area = [pack(near(3, :n), moves), pack(near(3, :n), .not. moves)]
      end associate
   end subroutine gather

   ! The solids, of their faces those alone that the lattice does not lie along.
   pure function slopes_of(obstacles) result(slopes)
      type(obstacle_t), intent(in) :: obstacles(:)
      type(obstacle_t) :: slopes(size(obstacles))
      integer :: edge, k

      slopes = obstacles
      do k = 1, size(slopes)
         associate (is_face => slopes(k)%is_face)
            is_face = [(is_face(edge) .and. all(abs(edge_normal(slopes(k)%outline, edge)) > aligned), edge=1, size(is_face))]
         end associate
      end do
   end function slopes_of

   ! To the nearest slope; huge where all are farther than a limit.
   pure real(dp) function slope_distance(slopes, place, limit) result(distance)
      type(obstacle_t), intent(in) :: slopes(:)
      real(dp), intent(in) :: place(2), limit
      real(dp) :: gap, foot(2), normal(2)
      integer :: edge, k

      distance = huge(distance)
      do k = 1, size(slopes)
         if (any(place < slopes(k)%lower - limit .or. place > slopes(k)%upper + limit)) cycle
         call nearest_edge(slopes(k)%outline, slopes(k)%is_face, place, edge, gap, foot, normal)
         distance = min(distance, gap)
      end do
   end function slope_distance

   ! What solids cover of the body's rectangle.
   subroutine add_solids(body, dx, kernel, solids, obstacles, crowd)
      type(body_settings), intent(in) :: body
      real(dp), intent(in) :: dx
      type(kernel_t), intent(in) :: kernel
      type(solid_t), intent(in) :: solids(:)
      type(obstacle_t), intent(in) :: obstacles(:)
      type(crowd_t), intent(inout) :: crowd
      type(solid_t) :: still(size(solids))
      type(cell_t), allocatable :: cells(:)
      type(box_t) :: box
      integer :: k

      box%kind = free_slip_wall
      box%at = [body%lower(1), body%upper(1), body%lower(2), body%upper(2)]
      do k = 1, size(solids)
         still(k)%outline = obstacles(k)%outline
         still(k)%pivot = obstacles(k)%pivot
         still(k)%angle = solids(k)%angle + obstacles(k)%pose%angle
      end do
      call find_cells(still, box, dx, kernel%support, cells)
      ! A cell that has a ghost for each of several faces comes several times, with the faces in the order of their numbers.
      associate (once => [(first_of(cells, k), k=1, size(cells))])
         crowd%x = [crowd%x, pack([(cells(k)%place(1), k=1, size(cells))], once)]
         crowd%y = [crowd%y, pack([(cells(k)%place(2), k=1, size(cells))], once)]
         crowd%area = [crowd%area, pack([(cells(k)%area, k=1, size(cells))], once)]
      end associate
   end subroutine add_solids

   ! Whether the ghost is the first of its cell: others come right behind it.
   pure logical function first_of(cells, k)
      type(cell_t), intent(in) :: cells(:)
      integer, intent(in) :: k

      first_of = .true.
      if (k > 1) first_of = cells(k)%solid /= cells(k - 1)%solid .or. any(abs(cells(k)%place - cells(k - 1)%place) > 0)
   end function first_of

   ! Steps down the slope of C, each with a part of the step before. None leads out of the body or into a solid. Areas grow where C
   ! is below the lattice's.
   subroutine settle(body, kernel, obstacles, crowd)
      type(body_settings), intent(in) :: body
      type(kernel_t), intent(in) :: kernel
      type(obstacle_t), intent(in) :: obstacles(:)
      type(crowd_t), intent(inout) :: crowd
      real(dp), allocatable :: step(:, :), place(:, :), area(:)
      real(dp) :: near(3), even
      integer :: i, round

      allocate (step(2, crowd%n_moving), place(2, crowd%n_moving), source=0.0_dp)
      allocate (area(crowd%n_moving))
      even = lattice_sum(kernel, crowd%area(1))
      do round = 1, rounds
         call sort_into_squares(body, kernel%support, crowd)
         !$omp parallel do default(none) shared(body, kernel, obstacles, crowd, step, place, area, even) private(near)
         do i = 1, crowd%n_moving
            place(:, i) = [crowd%x(i), crowd%y(i)]
            near = crowding(crowd, body, kernel, place(:, i))
            area(i) = crowd%area(i)*(1 + ease*(even - near(3)))
            step(:, i) = kept*step(:, i) - pace*kernel%h**2*near(1:2)
            if (any(place(:, i) + step(:, i) < body%lower .or. place(:, i) + step(:, i) > body%upper)) step(:, i) = 0
            if (cover(obstacles, place(:, i) + step(:, i)) > 0) step(:, i) = 0
            place(:, i) = place(:, i) + step(:, i)
         end do
         !$omp end parallel do
         crowd%x(:crowd%n_moving) = place(1, :)
         crowd%y(:crowd%n_moving) = place(2, :)
         crowd%area(:crowd%n_moving) = area
      end do
   end subroutine settle

   ! C of the lattice, whose cells have an area.
   pure real(dp) function lattice_sum(kernel, area) result(total)
      type(kernel_t), intent(in) :: kernel
      real(dp), intent(in) :: area   ! [m2]
      integer :: i, j, n

      n = int(kernel%support/sqrt(area)) + 1
      total = 0
      do j = -n, n
         total = total + area*sum(kernel_value(kernel, [(sqrt(area*(i**2 + j**2)), i=-n, n)]))
      end do
   end function lattice_sum

   subroutine sort_into_squares(body, width, crowd)
      type(body_settings), intent(in) :: body
      real(dp), intent(in) :: width            ! [m]
      type(crowd_t), intent(inout) :: crowd
      integer :: at(2), k

      if (.not. allocated(crowd%first)) then
         at = square_of(body, width, body%upper)
         allocate (crowd%first(at(1), at(2)), crowd%next(size(crowd%x)))
      end if
      crowd%first = 0
      do k = 1, size(crowd%x)
         at = min(max(square_of(body, width, [crowd%x(k), crowd%y(k)]), 1), shape(crowd%first))
         crowd%next(k) = crowd%first(at(1), at(2))
         crowd%first(at(1), at(2)) = k
      end do
   end subroutine sort_into_squares

   pure function square_of(body, width, place) result(at)
      type(body_settings), intent(in) :: body
      real(dp), intent(in) :: width, place(2)
      integer :: at(2)

      at = floor((place - body%lower)/width) + 1
   end function square_of

   ! grad C and C at a place, with all that is mirrored at the body's sides: where its image is, sums are those of the images.
   pure function crowding(crowd, body, kernel, place) result(sums)
      type(crowd_t), intent(in) :: crowd
      type(body_settings), intent(in) :: body
      type(kernel_t), intent(in) :: kernel
      real(dp), intent(in) :: place(2)
      real(dp) :: sums(3), seen(2), sign(2)
      real(dp) :: images(2, 3)   ! of each coordinate
      integer :: i, j

      sums = 0
      images = reshape([place, 2*body%lower - place, 2*body%upper - place], [2, 3])
      do j = 1, 3
         do i = 1, 3
            seen = [images(1, i), images(2, j)]
            if (any(seen < body%lower - kernel%support .or. seen > body%upper + kernel%support)) cycle
            sign = merge(1.0_dp, -1.0_dp, [i, j] == 1)
            sums = sums + [sign, 1.0_dp]*sum_near(crowd, body, kernel, seen)
         end do
      end do
   end function crowding

   ! sum_j V_j F (r_j - r), sum_j V_j W
   pure function sum_near(crowd, body, kernel, place) result(total)
      type(crowd_t), intent(in) :: crowd
      type(body_settings), intent(in) :: body
      type(kernel_t), intent(in) :: kernel
      real(dp), intent(in) :: place(2)
      real(dp) :: total(3), way(2), distance
      integer :: at(2), i, j, k

      total = 0
      at = square_of(body, kernel%support, place)
      do j = max(1, at(2) - 1), min(size(crowd%first, 2), at(2) + 1)
         do i = max(1, at(1) - 1), min(size(crowd%first, 1), at(1) + 1)
            k = crowd%first(i, j)
            do while (k > 0)
               way = [crowd%x(k), crowd%y(k)] - place
               distance = norm2(way)
               total = total + crowd%area(k)*[kernel_gradient(kernel, distance)*way, kernel_value(kernel, distance)]
               k = crowd%next(k)
            end do
         end do
      end do
   end function sum_near

end module settled_sites
