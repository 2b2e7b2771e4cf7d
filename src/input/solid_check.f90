!> Checks the solids: their names and shapes, how they move, and whether fluid lies where they are. Module `solid_room` checks
!! where they lie.
module solid_check
   use derived_settings, only: solid_speed
   use draft, only: draft_t
   use kernel, only: k_2d
   use kinds, only: dp
   use motion_check, only: compare_with_sound, warn_of_rest
   use name_table, only: name_table_t
   use polygons, only: edge_normal, find_crossing, is_inside, narrowest, polygon_area, regular_polygon
   use scanner, only: letters
   use settings, only: body_settings, is_wall, side_names
   use rigid_bodies, only: rigid_body_t
   use solid_outlines, only: body_of, starting_outline
   use solid_room, only: check_gaps_between, check_room, in_words, ways_across
   use text, only: quoted, short, to_text
   implicit none
   private

   public :: check_solids

   integer, parameter :: disc_corners = 120 ! of a polygon that stands for a disc of fluid

contains

   !> Runs all checks of each &solid.
   subroutine check_solids(draft)
      type(draft_t), intent(inout) :: draft
      logical :: well(size(draft%scene%solids))   ! nothing is wrong with its shape
      integer :: i

      call check_names(draft)
      if (.not. draft%notes%clean('solid scene')) return
      call check_surfaces(draft)
      do i = 1, size(well)
         call check_motion(draft, i)
         call check_shape(draft, i, well(i))
      end do
      if (.not. draft%notes%clean('domain model')) return
      do i = 1, size(well)
         if (well(i)) call check_room(draft, i, well(i))
         if (well(i)) call check_sides(draft, i, well(i))
         if (well(i)) call check_friction(draft, i)
         if (well(i) .and. draft%notes%clean('body')) call check_fluid(draft, i)
      end do
      call check_gaps_between(draft, well)
      call check_overlaps(draft, well)
   end subroutine check_solids

   ! A name heads columns: it must be one word and its own.
   subroutine check_names(draft)
      type(draft_t), intent(inout) :: draft
      type(name_table_t) :: before
      character(:), allocatable :: name, problem
      integer :: i

      do i = 1, size(draft%scene%solids)
         name = trim(draft%scene%solids(i)%name)
         if (name == '') cycle   ! it is said already
         problem = ''
         if (verify(name, letters//'0123456789_-') > 0) then
            problem = ' may have letters, digits, _ and - only'
         else if (name == 'time' .or. name == 'time_scaled') then
            problem = ' is the name of another column; choose another'
         else if (before%find(name) > 0) then
            problem = ' is the name of an earlier solid; choose another'
         end if
         call before%put(name, i)
         if (problem /= '') call draft%mistake('solid', i, 'name', '&solid name = '//quoted(name)//problem)
      end do
   end subroutine check_names

   !> Without viscosity, no slip is free slip.
   subroutine check_surfaces(draft)
      type(draft_t), intent(inout) :: draft
      integer :: i

      if (.not. draft%notes%clean('fluid model')) return
      associate (model => draft%scene%model)
         if (draft%scene%fluid%viscosity > 0.0_dp .or. model%diffusion /= 'constant' .or. model%alpha > 0.0_dp) return
      end associate
      i = findloc(draft%scene%solids%surface, 'no_slip', 1)
      if (i > 0) call draft%warning('solid', i, 'surface', "&solid surface = 'no_slip' has no effect without viscosity: set " &
                                    //'&fluid viscosity or &model alpha')
   end subroutine check_surfaces

   ! What moves must be slower than sound.
   subroutine check_motion(draft, number)
      type(draft_t), intent(inout) :: draft
      integer, intent(in) :: number
      character(:), allocatable :: what
      real(dp) :: speed

      associate (solid => draft%scene%solids(number))
         if (solid%motion == 'none') return
         speed = solid_speed(draft%scene, solid)
         what = '&solid '//quoted(solid%name)
         if (solid%motion == 'free') call check_free_body(draft, number)
         if (solid%motion /= 'free' .and. .not. speed > 0.0_dp) call warn_of_rest(draft, 'solid', number, what, solid%motion)
         call compare_with_sound(draft, 'solid', number, what, speed)
      end associate
   end subroutine check_motion

   ! What forces move begins as it is let, and its springs are slow for the steps.
   subroutine check_free_body(draft, number)
      type(draft_t), intent(inout) :: draft
      integer, intent(in) :: number
      real(dp), parameter :: pi = acos(-1.0_dp), fewest_steps = 20
      type(rigid_body_t) :: body
      real(dp) :: rates(3), rate, step
      character(:), allocatable :: what

      associate (solid => draft%scene%solids(number))
         what = '&solid '//quoted(solid%name)//' '
         body = body_of(solid)
         if (.not. body%is_free()) call draft%mistake('solid', number, 'freedoms', what//"is free in nothing: give freedoms, or " &
                                                      //"motion = 'none'")
         if (any(.not. body%moves .and. abs([solid%velocity, solid%spin]) > 0.0_dp)) call draft%mistake('solid', number, &
            'freedoms', what//'starts with a velocity in which it is held: leave it out, or add it to freedoms')
         if (.not. draft%notes%clean('fluid time scene model') .or. .not. (solid%mass > 0 .and. solid%moment_of_inertia > 0)) return
         rates = body%damping/body%masses() + sqrt(body%stiffness/body%masses())
         rate = maxval(merge(rates, 0.0_dp, body%moves))
         step = draft%scene%time%cfl*draft%scene%smoothing_length()/draft%scene%fluid%sound_speed
         if (rate*step*fewest_steps > 2*pi) call draft%mistake('solid', number, 'stiffness', what//'has springs or dampers of ' &
            //short(2*pi/rate)//' s, less than '//short(fewest_steps)//' steps: make them softer, the body heavier or cfl smaller')
      end associate
   end subroutine check_free_body

   !> What walls hold is not free.
   subroutine check_sides(draft, number, well)
      type(draft_t), intent(inout) :: draft
      integer, intent(in) :: number
      logical, intent(out) :: well
      real(dp), allocatable :: outline(:, :)
      real(dp) :: beyond(4)
      integer :: side

      well = .true.
      associate (scene => draft%scene, solid => draft%scene%solids(number))
         if (solid%motion /= 'free') return
         outline = starting_outline(scene, solid)
         beyond([1, 3]) = scene%domain%lower - minval(outline, 2)
         beyond([2, 4]) = maxval(outline, 2) - scene%domain%upper
         side = findloc(is_wall(scene%side_kinds()) .and. beyond > scene%margin(), .true., 1)
         well = side == 0
         if (.not. well) call draft%mistake('solid', number, 'motion', '&solid '//quoted(solid%name)//' reaches '// &
            short(beyond(side))//' beyond the '//trim(side_names(side))//' wall, and nothing holds a free body there: ' &
            //'move it or the wall')
      end associate
   end subroutine check_sides

   !> Free bodies do not hold each other up.
   subroutine check_overlaps(draft, well)
      type(draft_t), intent(inout) :: draft
      logical, intent(in) :: well(:)   !! nothing is wrong with them
      integer :: i, k

      associate (scene => draft%scene, solids => draft%scene%solids)
         do i = 2, size(solids)
            do k = 1, i - 1
               if (.not. all(solids([i, k])%motion == 'free' .and. well([i, k]))) cycle
               if (overlaps(starting_outline(scene, solids(i)), starting_outline(scene, solids(k)))) &
                  call draft%warning('solid', i, 'motion', '&solid '//quoted(solids(i)%name)//' begins on ' &
                                     //quoted(solids(k)%name)//', and both are free: they go through each other; move one of them')
            end do
         end do
      end associate
   end subroutine check_overlaps

   !> Friction is explicit: in a step it must not turn the motion of a light body round. That of fluid at rest on an edge, per
   !! length and speed, is about 3 mu/h (measured); of that across the edge if the fluid slips along it.
   subroutine check_friction(draft, number)
      type(draft_t), intent(inout) :: draft
      integer, intent(in) :: number
      real(dp), parameter :: per_edge = 3, largest = 1   ! [mu/h]; change of speed in a step, over the speed
      type(rigid_body_t) :: body
      real(dp), allocatable :: arm(:, :)
      real(dp) :: normal(2), along(2), rubbed(3), rate, step
      integer :: k

      associate (scene => draft%scene, solid => draft%scene%solids(number), h => draft%scene%smoothing_length())
         if (solid%motion /= 'free' .or. .not. draft%notes%clean('fluid time scene model solid')) return
         body = body_of(solid)
         arm = starting_outline(scene, solid)
         arm = arm - spread(solid%pivot, 2, size(arm, 2))
         rubbed = 0
         do k = 1, size(arm, 2)
            normal = edge_normal(arm, k)
            along = [-normal(2), normal(1)]
            associate (a => arm(:, k), b => arm(:, mod(k, size(arm, 2)) + 1))
               rubbed = rubbed + norm2(b - a)*[normal**2, mean_square(dot_product(a, along), dot_product(b, along))]
               if (solid%surface == 'no_slip') &
                  rubbed = rubbed + norm2(b - a)*[along**2, mean_square(dot_product(a, normal), dot_product(b, normal))]
            end associate
         end do
         step = scene%time%cfl*h/scene%fluid%sound_speed
         rate = maxval(merge(rubbed/body%masses(), 0.0_dp, body%moves)) &
                *per_edge/h*scene%alpha_total()*scene%fluid%density*scene%fluid%sound_speed*h/k_2d
         if (rate*step > largest) call draft%mistake('solid', number, 'mass', '&solid '//quoted(solid%name) &
            //' is too light for its friction, which would stop it in '//short(1/rate)//' s, less than a step of '//short(step) &
            //' s: make it heavier, or alpha or cfl smaller')
      end associate
   end subroutine check_friction

   ! Mean square of what grows evenly from one value to another.
   pure real(dp) function mean_square(one, other)
      real(dp), intent(in) :: one, other

      mean_square = (one**2 + one*other + other**2)/3
   end function mean_square

   !> A shape must have an inside.
   subroutine check_shape(draft, number, well)
      type(draft_t), intent(inout) :: draft
      integer, intent(in) :: number
      logical, intent(out) :: well
      character(:), allocatable :: key, problem

      problem = ''
      key = 'vertices'
      associate (solid => draft%scene%solids(number))
         if (solid%shape == 'polygon') then
            if (.not. draft%document%given('solid', number, key)) key = 'vertices_file'
            problem = polygon_problem(reshape(solid%vertices%values, [2, solid%vertices%n()/2]), draft%scene%margin())
         else if (solid%shape == 'rectangle' .and. any(solid%upper <= solid%lower)) then
            key = 'upper'
            problem = 'is empty: upper = '//to_text(solid%upper)//' must lie above and right of lower = '//to_text(solid%lower)
         end if
         well = problem == ''
         if (.not. well) call draft%mistake('solid', number, key, '&solid '//quoted(solid%name)//' '//problem)
      end associate
   end subroutine check_shape

   ! Why vertices are not those of a polygon that does; '' if they are.
   pure function polygon_problem(vertices, margin) result(problem)
      real(dp), intent(in) :: vertices(:, :)   ! (2, n) [m]
      real(dp), intent(in) :: margin           ! [m]
      character(:), allocatable :: problem
      integer :: first, second

      problem = ''
      call find_twin(vertices, margin, first, second)
      if (first > 0) then
         problem = 'has its vertices '//to_text(first)//' and '//to_text(second)//' in one place, '//in_words(vertices(:, first)) &
                   //': move one of them or leave it out'
         return
      end if
      call find_crossing(vertices, first, second)
      if (first > 0) then
         problem = 'is no polygon: its edges '//to_text(first)//' and '//to_text(second)//' cross or touch at ' &
                   //in_words(crossing(vertices, first, second))//' (edge 1 is that from vertex 1 to 2): move a vertex'
      else if (abs(polygon_area(vertices)) <= margin*maxval(maxval(vertices, 2) - minval(vertices, 2))) then
         problem = 'has no area: its vertices lie on one line'
      else if (polygon_area(vertices) < 0.0_dp) then
         problem = 'has vertices that run clockwise; list them counter-clockwise'
      end if
   end function polygon_problem

   ! The first two vertices in one place; 0, 0 if there are none.
   pure subroutine find_twin(vertices, margin, first, second)
      real(dp), intent(in) :: vertices(:, :)
      real(dp), intent(in) :: margin
      integer, intent(out) :: first, second

      do first = 1, size(vertices, 2)
         do second = first + 1, size(vertices, 2)
            if (all(abs(vertices(:, first) - vertices(:, second)) <= margin)) return
         end do
      end do
      first = 0
      second = 0
   end subroutine find_twin

   ! Where two edges cross; of parallel ones an end.
   pure function crossing(vertices, first, second) result(place)
      real(dp), intent(in) :: vertices(:, :)
      integer, intent(in) :: first, second   ! edges
      real(dp) :: place(2), along(2), across(2), between(2), turn, share

      associate (n => size(vertices, 2))
         along = vertices(:, mod(first, n) + 1) - vertices(:, first)
         across = vertices(:, mod(second, n) + 1) - vertices(:, second)
      end associate
      between = vertices(:, second) - vertices(:, first)
      turn = along(1)*across(2) - along(2)*across(1)
      share = 1.0_dp
      if (abs(turn) > epsilon(turn)*norm2(along)*norm2(across)) share = (between(1)*across(2) - between(2)*across(1))/turn
      place = vertices(:, first) + min(max(share, 0.0_dp), 1.0_dp)*along
   end function crossing

   !> No fluid may be where a solid is that refuses it.
   subroutine check_fluid(draft, number)
      type(draft_t), intent(inout) :: draft
      integer, intent(in) :: number
      real(dp), allocatable :: outline(:, :), ways(:, :)
      integer :: i, k

      associate (scene => draft%scene, solid => draft%scene%solids(number))
         if (solid%fluid /= 'refuse') return
         outline = starting_outline(scene, solid)
         allocate (ways, source=ways_across(scene))
         do i = 1, size(scene%bodies)
            if (any([(overlaps(outline + spread(ways(:, k), 2, size(outline, 2)), body_outline(scene%bodies(i), scene%margin())), &
                      k=1, size(ways, 2))])) call draft%mistake('solid', number, 'fluid', &
               '&solid '//quoted(solid%name)//' overlaps &body number '//to_text(i)//", and refuses it: move one of them, or set " &
               //"fluid = 'cut'")
         end do
      end associate
   end subroutine check_fluid

   ! A body of fluid as a polygon, smaller by a margin, so that what touches it does not overlap.
   pure function body_outline(body, margin) result(vertices)
      type(body_settings), intent(in) :: body
      real(dp), intent(in) :: margin
      real(dp), allocatable :: vertices(:, :)

      if (body%shape == 'disc') then
         allocate (vertices(2, disc_corners))
         vertices(:, :) = regular_polygon(body%centre, body%radius - margin, disc_corners)
      else
         allocate (vertices(2, 4))
         vertices(1, :) = [body%lower(1) + margin, body%upper(1) - margin, body%upper(1) - margin, body%lower(1) + margin]
         vertices(2, :) = [body%lower(2) + margin, body%lower(2) + margin, body%upper(2) - margin, body%upper(2) - margin]
      end if
   end function body_outline

   ! Whether two polygons have some of their area in common.
   pure logical function overlaps(one, other)
      real(dp), intent(in) :: one(:, :), other(:, :)
      real(dp) :: place(2), width

      call narrowest(one, other, 0.0_dp, width, place)
      overlaps = width <= 0.0_dp .or. is_inside(one, other(:, 1)) .or. is_inside(other, one(:, 1))
   end function overlaps

end module solid_check
