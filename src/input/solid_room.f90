!> Checks where solids lie, and that they and the gaps beside them are wide enough for the particles.
!!
!! A particle feels what is within its kernel's radius. In what is thinner, it would feel the fluid behind a solid; in narrower
!! gaps there is no fluid but what feels both walls. A disc must be twice as thick: it has too many faces for a ghost for each. A
!! wall across the box may be thinner by dx: particles stand dx/2 before it (2 dx: 0.6 % of the force are missing).
module solid_room
   use draft, only: draft_t
   use kinds, only: dp
   use polygons, only: clip_polygon, is_inside, narrowest, polygon_area, thinnest
   use scene_keys, only: resolution_range
   use settings, only: choice_length, is_wall, settings_t, side_names, solid_settings
   use solid_outlines, only: n_corners, starting_outline
   use text, only: quoted, short, to_text
   implicit none
   private

   public :: check_room, check_gaps_between, in_words, ways_across

   real(dp), parameter :: pi = acos(-1.0_dp)
   real(dp), parameter :: sharpest = 20*pi/180      ! interior angle that is no thin tip yet
   real(dp), parameter :: wedge = pi/3              ! below, `thinnest` sees the two edges of a corner face each other
   real(dp), parameter :: radius = 2.0_dp           ! of the kernel [h]
   real(dp), parameter :: diameter = 2*radius
   real(dp), parameter :: slack = 1.0e-9_dp         ! relative; rounding of the input
   real(dp), parameter :: wide_enough = 0.99_dp     ! of a gap: discs are polygons whose corners stand out
   real(dp), parameter :: coarsest = 1.0e-5_dp      ! steps of coordinates [dx]

contains

   !> Checks one solid in its box, at t = 0.
   subroutine check_room(draft, number, well)
      type(draft_t), intent(inout) :: draft
      integer, intent(in) :: number
      logical, intent(out) :: well            !! nothing is wrong
      real(dp) :: outline(2, n_corners(draft%scene, draft%scene%solids(number)))
      real(dp), allocatable :: inner(:, :)
      character(:), allocatable :: key, problem

      outline = starting_outline(draft%scene, draft%scene%solids(number))
      key = ''
      problem = ''
      if (draft%scene%solids(number)%shape == 'disc') problem = disc_problem(draft%scene, draft%scene%solids(number))
      if (problem == '') problem = place_problem(draft%scene, outline)
      if (problem == '') problem = period_problem(draft, number)
      if (problem == '') then
         inner = within_walls(draft%scene, outline, is_wall(draft%scene%side_kinds()))
         if (draft%scene%solids(number)%shape /= 'disc') then
            problem = tip_problem(inner, edges_in_fluid(draft%scene, inner))
            if (problem == '') problem = thin_problem(draft%scene, outline, inner, draft%scene%solids(number)%motion == 'none')
         end if
         if (problem == '') problem = wall_problem(draft%scene, outline)
      end if
      well = problem == ''
      if (.not. well) call draft%mistake('solid', number, key, '&solid '//quoted(draft%scene%solids(number)%name)//' '//problem)
   end subroutine check_room

   !> Between two solids that rest, fluid must find room, or there must be none.
   subroutine check_gaps_between(draft, well)
      type(draft_t), intent(inout) :: draft
      logical, intent(in) :: well(:)          !! nothing else is wrong with them
      real(dp), allocatable :: one(:, :), other(:, :), ways(:, :)
      logical :: walls(4)
      real(dp) :: place(2), width, least
      integer :: i, k, m

      walls = is_wall(draft%scene%side_kinds())
      associate (scene => draft%scene, solids => draft%scene%solids)
         least = radius*scene%smoothing_length()
         allocate (ways, source=ways_across(scene))
         do i = 2, size(solids)
            if (.not. well(i) .or. solids(i)%motion /= 'none') cycle
            one = within_walls(scene, starting_outline(scene, solids(i)), walls)
            do k = 1, i - 1
               if (.not. well(k) .or. solids(k)%motion /= 'none') cycle
               other = within_walls(scene, starting_outline(scene, solids(k)), walls)
               do m = 1, size(ways, 2)
                  call narrowest(one + spread(ways(:, m), 2, size(one, 2)), other, least, width, place)
                  if (width <= scene%margin() .or. width >= wide_enough*least) cycle
                  if (is_inside(one, other(:, 1) - ways(:, m)) .or. is_inside(other, one(:, 1) + ways(:, m))) cycle
                  call draft%mistake('solid', i, '', '&solid '//quoted(solids(i)%name)//' leaves a gap of ' &
                                     //measured(scene, width)//' to '//quoted(solids(k)%name)//' at '//in_words(place) &
                                     //': let them touch or overlap, or leave '//short(least/scene%spacing())//' dx')
               end do
            end do
         end do
      end associate
   end subroutine check_gaps_between

   ! Why a solid cannot lie where it does; '' if it can.
   function place_problem(scene, outline) result(problem)
      type(settings_t), intent(in) :: scene
      real(dp), intent(in) :: outline(:, :)   ! (2, n) [m]
      character(:), allocatable :: problem
      real(dp), allocatable :: inner(:, :)

      problem = ''
      inner = within_walls(scene, outline, spread(.true., 1, 4))
      if (size(inner, 2) < 3) then
         problem = 'lies outside of the box of &domain: move it or leave it out'
      else if (abs(polygon_area(inner)) <= scene%margin()*scene%spacing()) then
         problem = 'lies outside of the box of &domain: move it or leave it out'
      else if (spacing(maxval(abs(outline))) > coarsest*scene%spacing()) then
         problem = 'reaches so far from 0 that coordinates are '//short(spacing(maxval(abs(outline)))) &
                   //' apart, too coarse for dx = '//short(scene%spacing())//': make it smaller'
      end if
   end function place_problem

   ! Where a solid that reaches through periodic sides would meet itself; '' if it does nowhere. Motions are looked at in steps.
   function period_problem(draft, number) result(problem)
      type(draft_t), intent(in) :: draft
      integer, intent(in) :: number
      character(:), allocatable :: problem
      integer, parameter :: steps = 1000
      character(choice_length) :: sides(4)
      real(dp), allocatable :: outline(:, :)
      real(dp) :: extent(2), least, period(2), time
      integer :: axis, k, last

      problem = ''
      associate (scene => draft%scene, solid => draft%scene%solids(number))
         sides = scene%side_kinds()
         period = scene%domain%upper - scene%domain%lower
         least = radius*scene%smoothing_length()
         allocate (outline(2, n_corners(scene, solid)))
         last = 0
         if (solid%motion /= 'none' .and. draft%notes%clean('time')) last = steps
         do k = 0, merge(last, -1, any(sides == 'periodic'))
            time = 0
            if (k > 0) time = scene%time%end_time*k/steps
            outline(:, :) = starting_outline(scene, solid, time)
            extent = maxval(outline, 2) - minval(outline, 2)
            do axis = 1, 2
               if (sides(2*axis) /= 'periodic' .or. extent(axis) <= period(axis) - wide_enough*least) cycle
               if (minval([heights(scene, outline, 2*axis - 1), heights(scene, outline, 2*axis)]) >= -scene%margin()) cycle
               problem = 'reaches through the periodic sides '//trim(side_names(2*axis - 1))//' and '//trim(side_names(2*axis)) &
                         //' of &domain at t = '//short(time)//', '//short(period(axis))//' apart, and is ' &
                         //measured(scene, extent(axis))//' long: leave '//short(least/scene%spacing())//' dx between its ends'
               return
            end do
         end do
      end associate
   end function period_problem

   !> By how much a solid is moved for itself and its neighbours beyond periodic sides.
   pure function ways_across(scene) result(ways)
      type(settings_t), intent(in) :: scene
      real(dp), allocatable :: ways(:, :)   !! (2, n) [m]
      character(choice_length) :: sides(4)
      integer :: i, j, last(2)

      sides = scene%side_kinds()
      last = merge(1, 0, sides([2, 4]) == 'periodic')
      associate (period => scene%domain%upper - scene%domain%lower)
         ways = reshape([(([i*period(1), j*period(2)], i=-last(1), last(1)), j=-last(2), last(2))], [2, product(2*last + 1)])
      end associate
   end function ways_across

   ! The part of a polygon that some sides of the box leave.
   pure function within_walls(scene, outline, sides) result(inner)
      type(settings_t), intent(in) :: scene
      real(dp), intent(in) :: outline(:, :)
      logical, intent(in) :: sides(4)         ! which cut: left, right, bottom, top
      real(dp), allocatable :: inner(:, :)
      real(dp), allocatable :: room(:, :)
      real(dp) :: normal(2)
      integer :: n, side

      n = size(outline, 2)
      allocate (room(2, 8*n + 8), source=0.0_dp)   ! each cut adds a half at most
      room(:, :n) = outline
      do side = 1, 4
         if (.not. sides(side) .or. n == 0) cycle
         normal = inward(side)
         call clip_polygon(room, n, merge(scene%domain%lower, scene%domain%upper, mod(side, 2) == 1), normal)
      end do
      allocate (inner(2, n))
      inner(:, :) = room(:, :n)
   end function within_walls

   ! From a side of the box inwards.
   pure function inward(side) result(normal)
      integer, intent(in) :: side
      real(dp) :: normal(2)

      normal = 0.0_dp
      normal((side + 1)/2) = merge(1.0_dp, -1.0_dp, mod(side, 2) == 1)
   end function inward

   ! Distances of places from a side of the box, below 0 beyond it [m].
   pure function heights(scene, outline, side) result(distances)
      type(settings_t), intent(in) :: scene
      real(dp), intent(in) :: outline(:, :)
      integer, intent(in) :: side
      real(dp) :: distances(size(outline, 2))

      associate (axis => (side + 1)/2)
         if (mod(side, 2) == 1) distances = outline(axis, :) - scene%domain%lower(axis)
         if (mod(side, 2) == 0) distances = scene%domain%upper(axis) - outline(axis, :)
      end associate
   end function heights

   ! Which edges can meet fluid: those that do not run along a wall or beyond it.
   pure function edges_in_fluid(scene, outline) result(counts)
      type(settings_t), intent(in) :: scene
      real(dp), intent(in) :: outline(:, :)
      logical :: counts(size(outline, 2))

      counts = edges_within(scene, outline, is_wall(scene%side_kinds()))
   end function edges_in_fluid

   ! Edges that do not run along some sides of the box or beyond them.
   pure function edges_within(scene, outline, sides) result(counts)
      type(settings_t), intent(in) :: scene
      real(dp), intent(in) :: outline(:, :)
      logical, intent(in) :: sides(4)
      logical :: counts(size(outline, 2)), hidden(size(outline, 2))
      integer :: side

      counts = .true.
      do side = 1, 4
         if (.not. sides(side)) cycle
         hidden = heights(scene, outline, side) <= scene%margin()
         counts = counts .and. .not. (hidden .and. cshift(hidden, 1))
      end do
   end function edges_within

   ! Interior angles of a polygon, pi where there is no corner [rad].
   pure function interior_angles(outline) result(angles)
      real(dp), intent(in) :: outline(:, :)
      real(dp) :: angles(size(outline, 2)), before(2, size(outline, 2)), after(2, size(outline, 2))

      after = cshift(outline, 1, 2) - outline
      before = cshift(after, -1, 2)
      angles = pi - atan2(before(1, :)*after(2, :) - before(2, :)*after(1, :), sum(before*after, 1))
      where (norm2(before, 1) <= 0.0_dp .or. norm2(after, 1) <= 0.0_dp) angles = pi
   end function interior_angles

   ! Where the fluid meets a tip that is too sharp; '' if it does nowhere.
   pure function tip_problem(inner, counts) result(problem)
      real(dp), intent(in) :: inner(:, :)
      logical, intent(in) :: counts(:)        ! edges that meet fluid
      character(:), allocatable :: problem
      real(dp) :: angles(size(inner, 2))
      integer :: corner

      problem = ''
      if (size(inner, 2) < 3) return
      angles = interior_angles(inner)
      where (.not. (counts .and. cshift(counts, -1))) angles = 2*pi
      corner = minloc(angles, 1)
      if (angles(corner) >= sharpest*(1.0_dp - slack)) return
      problem = 'has a thin tip at '//in_words(inner(:, corner))//', of '//short(angles(corner)*180/pi)//' degrees; ' &
                //short(sharpest*180/pi)//' are needed: make it blunt'
   end function tip_problem

   ! Where a solid is too thin; '' if it is nowhere. Between faces that sides of the box part for ever, as of a wall across it, it
   ! may be thinner: no fluid comes round an end.
   function thin_problem(scene, outline, inner, rests) result(problem)
      type(settings_t), intent(in) :: scene
      real(dp), intent(in) :: outline(:, :), inner(:, :)   ! all of it, and what walls leave
      logical, intent(in) :: rests
      character(:), allocatable :: problem
      real(dp), allocatable :: across(:, :)   ! what no side leaves
      integer, allocatable :: run(:)
      real(dp) :: needed, place(2), width   ! needed: [h]
      logical :: parted, sides(4)
      integer :: k

      problem = ''
      sides = scene%side_kinds() /= 'periodic'
      across = within_walls(scene, outline, sides)
      run = runs_of(edges_within(scene, across, sides))
      parted = rests .and. maxval(run) > 1
      call measure_extent(outline, width, place)
      needed = radius
      if (parted) needed = radius - scene%spacing()/scene%smoothing_length()
      if (width < needed*scene%smoothing_length() - scene%margin()) problem = too_thin(scene, needed, width, place)
      if (problem == '' .and. .not. parted) problem = thin_between(scene, inner, edges_in_fluid(scene, inner), radius)
      if (problem == '' .and. parted) problem = thin_between(scene, across, run > 0, needed)
      do k = 1, merge(maxval(run), 0, parted)
         if (problem == '') problem = thin_between(scene, across, run == k, radius)
      end do
   end function thin_problem

   ! Where what is left of a solid is too thin between some of its edges; '' if it is nowhere.
   function thin_between(scene, inner, edges, needed) result(problem)
      type(settings_t), intent(in) :: scene
      real(dp), intent(in) :: inner(:, :)
      logical, intent(in) :: edges(:)
      real(dp), intent(in) :: needed          ! [h]
      character(:), allocatable :: problem
      real(dp), allocatable :: blunt(:, :)
      logical, allocatable :: counts(:)
      real(dp) :: least, place(2), width

      problem = ''
      least = needed*scene%smoothing_length()
      call leave_out_tips(inner, edges, least, blunt, counts)
      call thinnest(blunt, counts, least, width, place)
      if (width < least - scene%margin()) problem = too_thin(scene, needed, width, place)
   end function thin_between

   ! Numbers runs of edges that count, one behind the other around the polygon; 0 for those that do not.
   pure function runs_of(counts) result(run)
      logical, intent(in) :: counts(:)
      integer :: run(size(counts)), k, n
      logical :: goes_on

      run = 0
      n = 0
      goes_on = .false.
      do k = 1, size(counts)
         if (counts(k) .and. .not. goes_on) n = n + 1
         if (counts(k)) run(k) = n
         goes_on = counts(k)
      end do
      ! The last one may go on with the first edge.
      if (n > 1) then
         if (counts(1) .and. counts(size(counts))) where (run == n) run = 1
      end if
   end function runs_of

   ! Whether a disc is too small; '' if it is not. Its polygon is a little thinner.
   function disc_problem(scene, solid) result(problem)
      type(settings_t), intent(in) :: scene
      type(solid_settings), intent(in) :: solid
      character(:), allocatable :: problem

      problem = ''
      if (2*solid%radius < diameter*scene%smoothing_length() - scene%margin()) &
         problem = too_thin(scene, diameter, 2*solid%radius, solid%centre)
   end function disc_problem

   ! How thin it is, and what to do.
   function too_thin(scene, needed, width, place) result(problem)
      type(settings_t), intent(in) :: scene
      real(dp), intent(in) :: needed             ! [h]
      real(dp), intent(in) :: width, place(2)
      character(:), allocatable :: problem
      real(dp) :: least, resolution

      least = needed*scene%smoothing_length()
      problem = 'is only '//measured(scene, width)//' thick at '//in_words(place)//'; '//short(least/scene%spacing()) &
                //' dx are needed: '
      resolution = scene%scene%resolution*least/max(width, 1.0e-9_dp*least)
      if (resolution <= resolution_range(2)) &
         problem = problem//'raise resolution to '//to_text(ceiling(resolution*(1.0_dp - slack)))//' or '
      problem = problem//'make it thicker'
   end function too_thin

   ! The least extent of a polygon, across one of its edges, and the middle of that edge.
   pure subroutine measure_extent(outline, width, place)
      real(dp), intent(in) :: outline(:, :)
      real(dp), intent(out) :: width          ! [m]
      real(dp), intent(out) :: place(2)       ! [m]
      real(dp) :: across(size(outline, 2)), along(2)
      integer :: k, next

      width = huge(width)
      place = 0.0_dp
      do k = 1, size(outline, 2)
         next = mod(k, size(outline, 2)) + 1
         along = outline(:, next) - outline(:, k)
         if (.not. norm2(along) > 0.0_dp) cycle
         along = along/norm2(along)
         across = along(1)*(outline(2, :) - outline(2, k)) - along(2)*(outline(1, :) - outline(1, k))
         if (maxval(across) - minval(across) >= width) cycle
         width = maxval(across) - minval(across)
         place = (outline(:, k) + outline(:, next))/2
      end do
   end subroutine measure_extent

   ! Parts the edges at corners that are sharp, though not too sharp, where they are a thickness apart: what is nearer to the tip
   ! is thinner, as a tip must be, and does not count.
   subroutine leave_out_tips(inner, in_fluid, least, blunt, counts)
      real(dp), intent(in) :: inner(:, :)
      logical, intent(in) :: in_fluid(:)      ! edges that count
      real(dp), intent(in) :: least           ! thickness [m]
      real(dp), allocatable, intent(out) :: blunt(:, :)
      logical, allocatable, intent(out) :: counts(:)
      real(dp) :: angles(size(inner, 2)), far(size(inner, 2))   ! from a tip [m]
      real(dp) :: along(2), length
      real(dp) :: points(2, 3*size(inner, 2))
      logical :: count_of(3*size(inner, 2))
      integer :: k, n, next

      angles = interior_angles(inner)
      far = 0.0_dp
      where (angles < wedge .and. in_fluid .and. cshift(in_fluid, -1)) far = least/tan(max(angles, sharpest/2))
      n = 0
      do k = 1, size(inner, 2)
         next = mod(k, size(inner, 2)) + 1
         along = inner(:, next) - inner(:, k)
         length = norm2(along)
         call put(inner(:, k), in_fluid(k) .and. .not. far(k) > 0.0_dp .and. far(next) < length)
         if (far(k) + far(next) >= length) cycle
         if (far(k) > 0.0_dp) call put(inner(:, k) + along*(far(k)/length), in_fluid(k))
         if (far(next) > 0.0_dp) call put(inner(:, next) - along*(far(next)/length), .false.)
      end do
      allocate (blunt(2, n), counts(n))
      blunt(:, :) = points(:, :n)
      counts(:) = count_of(:n)

   contains

      ! Adds a vertex, and whether the edge that begins there counts.
      subroutine put(place, does_count)
         real(dp), intent(in) :: place(2)
         logical, intent(in) :: does_count

         n = n + 1
         points(:, n) = place
         count_of(n) = does_count
      end subroutine put

   end subroutine leave_out_tips

   ! Where a solid leaves a narrow gap to a wall, or ends on it; '' if it does nowhere.
   function wall_problem(scene, outline) result(problem)
      type(settings_t), intent(in) :: scene
      real(dp), intent(in) :: outline(:, :)
      character(:), allocatable :: problem, wall
      real(dp), allocatable :: between(:, :), height(:)
      logical :: walls(4), others(4)
      logical, allocatable :: is_end(:)
      real(dp) :: least
      integer :: k, side

      problem = ''
      walls = is_wall(scene%side_kinds())
      least = radius*scene%smoothing_length()
      do side = 1, 4
         if (.not. walls(side)) cycle
         ! What lies beyond the walls across meets no fluid.
         others = walls
         others([(side + 1)/2*2 - 1, (side + 1)/2*2]) = .false.
         between = within_walls(scene, outline, others)
         height = heights(scene, between, side)
         ! Its ends towards the wall: not the bottom of a hollow, which has the solid below.
         is_end = height <= cshift(height, 1) .and. height <= cshift(height, -1) .and. interior_angles(between) < pi
         is_end = is_end .and. height > scene%margin() - scene%spacing() .and. height < wide_enough*least
         if (.not. any(is_end)) cycle
         k = findloc(is_end, .true., 1)
         wall = ' the '//trim(side_names(side))//' wall at '//in_words(between(:, k))//': let it reach beyond by at least dx = ' &
                //short(scene%spacing())//', or leave '//short(least/scene%spacing())//' dx'
         if (height(k) > scene%margin()) then
            problem = 'leaves a gap of '//measured(scene, height(k))//' to'//wall
         else
            problem = 'ends on'//wall
            if (height(k) < -scene%margin()) problem = 'ends only '//measured(scene, -height(k))//' beyond'//wall
         end if
         return
      end do
   end function wall_problem

   ! A length, also in dx.
   function measured(scene, length) result(words)
      type(settings_t), intent(in) :: scene
      real(dp), intent(in) :: length
      character(:), allocatable :: words

      words = short(length)//' = '//short(length/scene%spacing())//' dx'
   end function measured

   !> A place for a message.
   pure function in_words(place) result(words)
      real(dp), intent(in) :: place(2)   !! [m]
      character(:), allocatable :: words

      words = '('//short(place(1))//', '//short(place(2))//')'
   end function in_words

end module solid_room
