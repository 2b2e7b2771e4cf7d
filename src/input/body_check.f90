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
   real(dp), parameter :: slack = 1.0e-9_dp   ! of lengths in units of d: rounding of the input

contains

   !> Runs all checks of each &body.
   subroutine check_bodies(draft)
      type(draft_t), intent(inout) :: draft
      integer :: i

      do i = 1, size(draft%scene%bodies)
         call check_size(draft, i)
         call check_turned(draft, i)
         call check_place(draft, i)
         call check_pressure(draft, i)
      end do
      call check_overlaps(draft)
      call check_rest(draft)
   end subroutine check_bodies

   !> The key that says where a body is.
   pure function place_key(body) result(key)
      type(body_settings), intent(in) :: body
      character(:), allocatable :: key

      key = 'lower'
      if (body%shape == 'disc') key = 'centre'
   end function place_key

   !> A body must have particles.
   subroutine check_size(draft, number)
      type(draft_t), intent(inout) :: draft
      integer, intent(in) :: number
      real(dp) :: extent(2), margin

      if (.not. draft%clean('body scene')) return
      associate (body => draft%scene%bodies(number), dx => draft%scene%spacing())
         margin = slack*draft%scene%scene%reference_length
         extent = body%upper - body%lower
         if (body%shape == 'disc') then
            if (body%radius < dx - margin) then
               call draft%mistake('body', 'radius', '&body radius = ' &
                                  //to_text(body%radius)//' is less than one particle, dx = '//short(dx) &
                                  //': raise it or the resolution', number)
            end if
         else if (any(extent < dx - margin)) then
            call draft%mistake('body', 'upper', '&body is '//to_text(extent) &
                               //' wide and high; it must be at least one particle, dx = '//short(dx)//', each way', number)
         else if (any(abs(extent/dx - anint(extent/dx)) > 1.0e-6_dp)) then
            call draft%warning('body', 'upper', '&body is '//to_text(extent) &
                               //' wide and high, no multiple of dx = '//short(dx)//': its particles are spread to fill it', number)
         end if
      end associate
   end subroutine check_size

   !> Whole cells of the turned lattice must fill the body without being stretched much.
   subroutine check_turned(draft, number)
      type(draft_t), intent(inout) :: draft
      integer, intent(in) :: number
      real(dp), parameter :: cell = sqrt(34.0_dp), largest_stretch = 1.25_dp   ! cell in dx: module body_particles
      real(dp) :: cells(2), stretch(2)

      if (.not. draft%clean('body scene')) return
      associate (body => draft%scene%bodies(number), dx => draft%scene%spacing())
         if (body%shape == 'disc' .or. body%lattice /= 'turned') return
         cells = (body%upper - body%lower)/(cell*dx)
         stretch = cells/max(1.0_dp, anint(cells))
         if (all(max(stretch, 1.0_dp/stretch) <= largest_stretch)) return
         call draft%mistake('body', 'lattice', "&body lattice = 'turned' consists of cells of " &
                            //short(cell*dx)//' (5.83 dx), and '//to_text(body%upper - body%lower)//' is no multiple of that; ' &
                            //"raise the resolution or choose lattice = 'aligned'", number)
      end associate
   end subroutine check_turned

   !> A body must stay behind walls and between periodic sides.
   subroutine check_place(draft, number)
      type(draft_t), intent(inout) :: draft
      integer, intent(in) :: number
      character(choice_length) :: kinds_there(4)
      character(:), allocatable :: which
      real(dp) :: beyond(4)
      integer :: side

      if (.not. draft%clean('body scene domain')) return
      associate (body => draft%scene%bodies(number), domain => draft%scene%domain)
         if (spacing(maxval(abs([body%lower, body%upper]))) > coarsest*draft%scene%spacing()) then
            call draft%mistake('body', place_key(body), '&body from '//to_text(body%lower) &
                               //' to '//to_text(body%upper)//' is so far from 0 that coordinates are ' &
                               //short(spacing(maxval(abs([body%lower, body%upper]))))//' apart, too coarse for dx = ' &
                               //short(draft%scene%spacing())//'; move the scene towards the origin', number)
            return
         end if
         kinds_there = draft%scene%side_kinds()
         beyond([1, 3]) = domain%lower - body%lower
         beyond([2, 4]) = body%upper - domain%upper
         side = findloc(kinds_there /= 'open' .and. beyond > slack*draft%scene%scene%reference_length, .true., 1)
         if (side == 0) return
         which = trim(side_names(side))//' wall'
         if (.not. is_wall(kinds_there(side))) which = 'periodic '//trim(side_names(side))//' side'
         call draft%mistake('body', place_key(body), '&body from '//to_text(body%lower) &
                            //' to '//to_text(body%upper)//' lies beyond the '//which//' of &domain; move the body or the ' &
                            //which(index(which, ' ', back=.true.) + 1:), number)
      end associate
   end subroutine check_place

   !> The series of the incompressible pressure holds for a column in a corner with one free side.
   subroutine check_pressure(draft, number)
      type(draft_t), intent(inout) :: draft
      integer, intent(in) :: number
      character(*), parameter :: what = "&body pressure = 'incompressible' needs "
      character(*), parameter :: instead = "; choose 'hydrostatic' or 'zero'"
      real(dp) :: margin
      character(:), allocatable :: need

      if (draft%scene%bodies(number)%pressure /= 'incompressible') return
      if (.not. draft%clean('body scene domain fluid force')) return
      associate (body => draft%scene%bodies(number), domain => draft%scene%domain)
         margin = slack*draft%scene%scene%reference_length
         need = ''
         if (count(draft%scene%leans(body)) /= 1) need = 'one side at a wall and the other free'
         if (.not. is_wall(domain%bottom) .or. abs(body%lower(2) - domain%lower(2)) > margin) then
            need = 'a body that stands on the floor'
         end if
         if (body%shape /= 'rectangle') need = "shape = 'rectangle'"
         if (.not. draft%scene%fluid%gravity > draft%scene%force%acceleration(2)) &
            need = 'gravity above 0, or acceleration downwards'
      end associate
      if (need /= '') call draft%mistake('body', 'pressure', what//need//instead, number)
   end subroutine check_pressure

   !> Hydrostatic pressure is that of fluid that rests: what falls, or is pushed aside, starts with a bang.
   subroutine check_rest(draft)
      type(draft_t), intent(inout) :: draft
      type(resting_force_t) :: force
      logical, allocatable :: falls(:)
      integer :: i

      if (.not. draft%clean('body scene domain fluid force')) return
      force = resting_force(draft%scene)
      falls = .not. carried(draft%scene, force) .and. draft%scene%bodies%pressure == 'hydrostatic'
      do i = 1, size(draft%scene%bodies)
         if (falls(i)) call draft%warning('body', 'pressure', '&body number '//to_text(i)//' lies on no ' &
                                          //"wall and on no fluid that does: with pressure = 'hydrostatic' it starts as if it " &
                                          //"stood, and bursts; with 'zero' it falls freely", i)
      end do
      if (force%left_over > 0.0_dp .and. any(draft%scene%bodies%pressure == 'hydrostatic')) &
         call draft%warning('force', 'acceleration', "&body pressure = 'hydrostatic' balances the larger " &
                            //'component of gravity and acceleration; the other one, '//short(force%left_over) &
                            //', sets the fluid in motion')
   end subroutine check_rest

   !> Bodies must not lie on each other. The first one that does is told of all before it that it overlaps.
   subroutine check_overlaps(draft)
      type(draft_t), intent(inout) :: draft
      character(:), allocatable :: words
      real(dp), allocatable :: depth(:)
      real(dp) :: margin
      integer :: number, other

      if (.not. draft%clean('body scene')) return
      words = ''
      margin = slack*draft%scene%scene%reference_length
      associate (bodies => draft%scene%bodies)
         number = first_overlapping(bodies, margin)
         if (number > size(bodies)) return
         do other = 1, number - 1
            depth = overlap(bodies(number), bodies(other))
            if (.not. all(depth > margin)) cycle
            words = short(depth(1))
            if (size(depth) == 2) words = words//', '//short(depth(2))
            call draft%mistake('body', place_key(bodies(number)), '&body number '//to_text(number)//' overlaps number ' &
                               //to_text(other)//' by '//words//'; move one of them', number)
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
      real(dp), allocatable :: depth(:)   !! (2) in x and y of two rectangles, (1) with a disc [m]

      if (one%shape == 'rectangle' .and. other%shape == 'rectangle') then
         depth = min(one%upper, other%upper) - max(one%lower, other%lower)
      else if (one%shape == 'disc' .and. other%shape == 'disc') then
         depth = [one%radius + other%radius - norm2(one%centre - other%centre)]
      else if (one%shape == 'disc') then
         depth = [depth_in_rectangle(one, other)]
      else
         depth = [depth_in_rectangle(other, one)]
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
