!> Checks the bodies: their shapes, where they lie, what they start with.
module body_check
   use draft, only: draft_t
   use kinds, only: dp
   use resting_fluid, only: carried, resting_force, resting_force_t
   use settings, only: body_settings, choice_length, is_wall, side_names
   use sorting, only: ascending
   use text, only: short, to_text
   implicit none
   private

   public :: check_bodies

   real(dp), parameter :: coarsest = 1.0e-5_dp  ! steps of coordinates in units of dx

contains

   !> Runs all checks of each &body.
   subroutine check_bodies(draft)
      type(draft_t), intent(inout) :: draft
      integer :: i

      do i = 1, size(draft%scene%bodies)
         associate (body => draft%scene%bodies(i))
            if (draft%notes%clean('body scene')) call check_size(draft, body, i)
            if (draft%notes%clean('body scene')) call check_turned(draft, body, i)
            if (draft%notes%clean('body scene domain')) call check_place(draft, body, i)
            if (draft%notes%clean('body scene domain fluid force')) call check_pressure(draft, body, i)
         end associate
      end do
      if (draft%notes%clean('body scene')) call check_overlaps(draft)
      if (draft%notes%clean('body scene domain fluid force')) call check_rest(draft)
   end subroutine check_bodies

   ! The key that says where a body is.
   pure function place_key(body) result(key)
      type(body_settings), intent(in) :: body
      character(:), allocatable :: key

      key = 'lower'
      if (body%shape == 'disc') key = 'centre'
   end function place_key

   !> A body must have particles.
   subroutine check_size(draft, body, number)
      type(draft_t), intent(inout) :: draft
      type(body_settings), intent(in) :: body
      integer, intent(in) :: number
      real(dp) :: extent(2)

      extent = body%upper - body%lower
      associate (dx => draft%scene%spacing(), least => draft%scene%spacing() - draft%scene%margin())
         if (body%shape == 'disc') then
            if (body%radius < least) call draft%mistake('body', number, 'radius', '&body radius = '//to_text(body%radius) &
               //' is less than one particle, dx = '//short(dx)//': raise it or the resolution')
         else if (any(extent < least)) then
            call draft%mistake('body', number, 'upper', '&body is '//to_text(extent) &
                               //' wide and high; it must be at least one particle, dx = '//short(dx)//', each way')
         else if (any(abs(extent/dx - anint(extent/dx)) > 1.0e-6_dp)) then
            call draft%warning('body', number, 'upper', '&body is '//to_text(extent) &
                               //' wide and high, no multiple of dx = '//short(dx)//': its particles are spread to fill it')
         end if
      end associate
   end subroutine check_size

   !> Whole cells of the turned lattice must fill the body without being stretched much.
   subroutine check_turned(draft, body, number)
      type(draft_t), intent(inout) :: draft
      type(body_settings), intent(in) :: body
      integer, intent(in) :: number
      real(dp), parameter :: cell = sqrt(34.0_dp), largest_stretch = 1.25_dp   ! cell in dx: module body_particles
      real(dp) :: cells(2), stretch(2)

      if (body%shape == 'disc' .or. body%lattice /= 'turned') return
      cells = (body%upper - body%lower)/(cell*draft%scene%spacing())
      stretch = cells/max(1.0_dp, anint(cells))
      if (any(max(stretch, 1.0_dp/stretch) > largest_stretch)) &
         call draft%mistake('body', number, 'lattice', "&body lattice = 'turned' consists of cells of " &
                            //short(cell*draft%scene%spacing())//' (5.83 dx), and '//to_text(body%upper - body%lower) &
                            //" is no multiple of that; raise the resolution or choose lattice = 'aligned'")
   end subroutine check_turned

   !> A body must stay behind walls and between periodic sides.
   subroutine check_place(draft, body, number)
      type(draft_t), intent(inout) :: draft
      type(body_settings), intent(in) :: body
      integer, intent(in) :: number
      character(choice_length) :: kinds_there(4)
      character(:), allocatable :: problem, which
      real(dp) :: beyond(4), step
      integer :: side

      step = spacing(maxval(abs([body%lower, body%upper])))
      if (step > coarsest*draft%scene%spacing()) then
         problem = 'is so far from 0 that coordinates are '//short(step)//' apart, too coarse for dx = ' &
                   //short(draft%scene%spacing())//'; move the scene towards the origin'
      else
         kinds_there = draft%scene%side_kinds()
         beyond([1, 3]) = draft%scene%domain%lower - body%lower
         beyond([2, 4]) = body%upper - draft%scene%domain%upper
         side = findloc(kinds_there /= 'open' .and. beyond > draft%scene%margin(), .true., 1)
         if (side == 0) return
         which = 'periodic '//trim(side_names(side))//' side'
         if (is_wall(kinds_there(side))) which = trim(side_names(side))//' wall'
         problem = 'lies beyond the '//which//' of &domain; move the body or the '//which(index(which, ' ', back=.true.) + 1:)
      end if
      call draft%mistake('body', number, place_key(body), '&body from '//to_text(body%lower)//' to '//to_text(body%upper) &
                         //' '//problem)
   end subroutine check_place

   !> The series of the incompressible pressure holds for a column in a corner with one free side.
   subroutine check_pressure(draft, body, number)
      type(draft_t), intent(inout) :: draft
      type(body_settings), intent(in) :: body
      integer, intent(in) :: number
      character(:), allocatable :: need

      if (body%pressure /= 'incompressible') return
      need = ''
      associate (scene => draft%scene)
         if (count(scene%leans(body)) /= 1) need = 'one side at a wall and the other free'
         if (.not. is_wall(scene%domain%bottom) .or. abs(body%lower(2) - scene%domain%lower(2)) > scene%margin()) &
            need = 'a body that stands on the floor'
         if (body%shape /= 'rectangle') need = "shape = 'rectangle'"
         if (.not. scene%fluid%gravity > scene%force%acceleration(2)) need = 'gravity above 0, or acceleration downwards'
      end associate
      if (need /= '') call draft%mistake('body', number, 'pressure', "&body pressure = 'incompressible' needs "//need &
                                         //"; choose 'hydrostatic' or 'zero'")
   end subroutine check_pressure

   !> Hydrostatic pressure is that of fluid that rests: what falls, or is pushed aside, starts with a bang.
   subroutine check_rest(draft)
      type(draft_t), intent(inout) :: draft
      type(resting_force_t) :: force
      logical :: falls(size(draft%scene%bodies))
      integer :: i

      force = resting_force(draft%scene)
      falls = .not. carried(draft%scene, force) .and. draft%scene%bodies%pressure == 'hydrostatic'
      do i = 1, size(falls)
         if (falls(i)) call draft%warning('body', i, 'pressure', '&body number '//to_text(i)//' lies on no wall and on no ' &
            //"fluid that does: with pressure = 'hydrostatic' it starts as if it stood, and bursts; with 'zero' it falls freely")
      end do
      if (force%left_over > 0.0_dp .and. any(draft%scene%bodies%pressure == 'hydrostatic')) &
         call draft%warning('force', 1, 'acceleration', "&body pressure = 'hydrostatic' balances the larger component of " &
                            //'gravity and acceleration; the other one, '//short(force%left_over)//', sets the fluid in motion')
   end subroutine check_rest

   !> Bodies must not lie on each other. The first one that does is told of all before it that it overlaps.
   subroutine check_overlaps(draft)
      type(draft_t), intent(inout) :: draft
      character(:), allocatable :: words
      real(dp) :: depth(2)
      integer :: number, other

      words = ''
      associate (bodies => draft%scene%bodies)
         number = first_overlapping(bodies, draft%scene%margin())
         if (number > size(bodies)) return
         do other = 1, number - 1
            depth = overlap(bodies(number), bodies(other))
            if (.not. all(depth > draft%scene%margin())) cycle
            words = short(depth(1))
            if (all(bodies([number, other])%shape == 'rectangle')) words = words//', '//short(depth(2))
            call draft%mistake('body', number, place_key(bodies(number)), '&body number '//to_text(number) &
                               //' overlaps number '//to_text(other)//' by '//words//'; move one of them')
         end do
      end associate
   end subroutine check_overlaps

   !> The first body that overlaps one before it; one more than there are if none does.
   pure integer function first_overlapping(bodies, margin) result(first)
      type(body_settings), intent(in) :: bodies(:)
      real(dp), intent(in) :: margin        !! overlaps up to this do not count [m]
      real(dp) :: starts(size(bodies))
      integer :: order(size(bodies)), axis, i, k

      ! Along the axis on which fewer lie side by side, only bodies that begin before one ends can overlap it.
      axis = 1
      if (sum(bodies%upper(1) - bodies%lower(1))*(maxval(bodies%upper(2)) - minval(bodies%lower(2))) > &
          sum(bodies%upper(2) - bodies%lower(2))*(maxval(bodies%upper(1)) - minval(bodies%lower(1)))) axis = 2
      starts = bodies%lower(axis)
      order = ascending(starts)
      first = size(bodies) + 1
      do i = 1, size(bodies)
         if (order(i) >= first) cycle
         do k = i + 1, size(bodies)
            if (bodies(order(k))%lower(axis) > bodies(order(i))%upper(axis)) exit
            if (order(k) >= first) cycle
            if (all(overlap(bodies(order(i)), bodies(order(k))) > margin)) first = max(order(i), order(k))
         end do
      end do
   end function first_overlapping

   !> How deep two bodies lie in each other; not above 0 in some direction if they do not.
   pure function overlap(one, other) result(depth)
      type(body_settings), intent(in) :: one, other
      real(dp) :: depth(2)   !! in x and y of two rectangles, twice the same with a disc [m]

      if (one%shape == 'rectangle' .and. other%shape == 'rectangle') then
         depth = min(one%upper, other%upper) - max(one%lower, other%lower)
      else if (one%shape == 'disc' .and. other%shape == 'disc') then
         depth = one%radius + other%radius - norm2(one%centre - other%centre)
      else if (one%shape == 'disc') then
         depth = depth_in_rectangle(one, other)
      else
         depth = depth_in_rectangle(other, one)
      end if
   end function overlap

   !> How deep a disc lies in a rectangle.
   pure real(dp) function depth_in_rectangle(disc, rectangle) result(depth)
      type(body_settings), intent(in) :: disc, rectangle
      real(dp) :: nearest(2)

      nearest = min(max(disc%centre, rectangle%lower), rectangle%upper)
      depth = disc%radius - norm2(disc%centre - nearest)
      ! With its centre inside, the disc reaches to its far side from the nearest edge.
      if (all(abs(disc%centre - nearest) <= 0.0_dp)) &
         depth = disc%radius + minval([disc%centre - rectangle%lower, rectangle%upper - disc%centre])
   end function depth_in_rectangle

end module body_check
