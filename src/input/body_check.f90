!> Checks the bodies: their shapes, where they lie, what they start with.
module body_check
   use findings, only: findings_t
   use kinds, only: dp
   use namelist_document, only: document_t
   use resting_fluid, only: carried, resting_force, resting_force_t
   use settings, only: body_settings, choice_length, is_wall, settings_t, side_names
   use text, only: short, to_text
   implicit none
   private

   public :: check_bodies

   real(dp), parameter :: coarsest = 1.0e-5_dp  ! steps of coordinates in units of dx
   real(dp), parameter :: slack = 1.0e-9_dp   ! of lengths in units of d: rounding of the input

contains

   !> Runs all checks of each &body.
   subroutine check_bodies(document, setup, notes)
      type(document_t), intent(in) :: document
      type(settings_t), intent(in) :: setup
      type(findings_t), intent(inout) :: notes

      integer :: i

      do i = 1, size(setup%bodies)
         call check_size(document, setup, i, notes)
         call check_turned(document, setup, i, notes)
         call check_place(document, setup, i, notes)
         call check_pressure(document, setup, i, notes)
         call check_overlap(document, setup, i, notes)
      end do
      call check_rest(document, setup, notes)
   end subroutine check_bodies

   !> The key that says where a body is.
   pure function place_key(body) result(key)
      type(body_settings), intent(in) :: body
      character(:), allocatable :: key

      key = 'lower'
      if (body%shape == 'disc') key = 'centre'
   end function place_key

   !> A body must have particles.
   subroutine check_size(document, setup, number, notes)
      type(document_t), intent(in) :: document
      type(settings_t), intent(in) :: setup
      integer, intent(in) :: number
      type(findings_t), intent(inout) :: notes

      real(dp) :: extent(2), margin

      if (.not. (notes%clean('body') .and. notes%clean('scene'))) return
      associate (body => setup%bodies(number), dx => setup%spacing())
         margin = slack*setup%scene%reference_length
         extent = body%upper - body%lower
         if (body%shape == 'disc') then
            if (body%radius < dx - margin) then
               call notes%mistake(document%place_of('body', number, 'radius'), 'body', '&body radius = ' &
                                  //to_text(body%radius)//' is less than one particle, dx = '//short(dx) &
                                  //': raise it or the resolution')
            end if
         else if (any(extent < dx - margin)) then
            call notes%mistake(document%place_of('body', number, 'upper'), 'body', '&body is '//to_text(extent) &
                               //' wide and high; it must be at least one particle, dx = '//short(dx)//', each way')
         else if (any(abs(extent/dx - anint(extent/dx)) > 1.0e-6_dp)) then
            call notes%warning(document%place_of('body', number, 'upper'), '&body is '//to_text(extent) &
                               //' wide and high, no multiple of dx = '//short(dx)//': its particles are spread to fill it')
         end if
      end associate
   end subroutine check_size

   !> Whole cells of the turned lattice must fill the body without being stretched much.
   subroutine check_turned(document, setup, number, notes)
      type(document_t), intent(in) :: document
      type(settings_t), intent(in) :: setup
      integer, intent(in) :: number
      type(findings_t), intent(inout) :: notes

      real(dp), parameter :: cell = sqrt(34.0_dp), largest_stretch = 1.25_dp   ! cell in dx: module body_particles
      real(dp) :: cells(2), stretch(2)

      if (.not. (notes%clean('body') .and. notes%clean('scene'))) return
      associate (body => setup%bodies(number), dx => setup%spacing())
         if (body%shape == 'disc' .or. body%lattice /= 'turned') return
         cells = (body%upper - body%lower)/(cell*dx)
         stretch = cells/max(1.0_dp, anint(cells))
         if (all(max(stretch, 1.0_dp/stretch) <= largest_stretch)) return
         call notes%mistake(document%place_of('body', number, 'lattice'), 'body', "&body lattice = 'turned' consists of cells of " &
                            //short(cell*dx)//' (5.83 dx), and '//to_text(body%upper - body%lower)//' is no multiple of that; ' &
                            //"raise the resolution or choose lattice = 'aligned'")
      end associate
   end subroutine check_turned

   !> A body must stay behind walls and between periodic sides.
   subroutine check_place(document, setup, number, notes)
      type(document_t), intent(in) :: document
      type(settings_t), intent(in) :: setup
      integer, intent(in) :: number
      type(findings_t), intent(inout) :: notes

      character(choice_length) :: kinds_there(4)
      character(:), allocatable :: which
      real(dp) :: beyond(4)
      integer :: side

      if (.not. (notes%clean('body') .and. notes%clean('scene') .and. notes%clean('domain'))) return
      associate (body => setup%bodies(number), domain => setup%domain)
         if (spacing(maxval(abs([body%lower, body%upper]))) > coarsest*setup%spacing()) then
            call notes%mistake(document%place_of('body', number, place_key(body)), 'body', '&body from '//to_text(body%lower) &
                               //' to '//to_text(body%upper)//' is so far from 0 that coordinates are ' &
                               //short(spacing(maxval(abs([body%lower, body%upper]))))//' apart, too coarse for dx = ' &
                               //short(setup%spacing())//'; move the scene towards the origin')
            return
         end if
         kinds_there = setup%side_kinds()
         beyond([1, 3]) = domain%lower - body%lower
         beyond([2, 4]) = body%upper - domain%upper
         side = findloc(kinds_there /= 'open' .and. beyond > slack*setup%scene%reference_length, .true., 1)
         if (side == 0) return
         which = trim(side_names(side))//' wall'
         if (.not. is_wall(kinds_there(side))) which = 'periodic '//trim(side_names(side))//' side'
         call notes%mistake(document%place_of('body', number, place_key(body)), 'body', '&body from '//to_text(body%lower) &
                            //' to '//to_text(body%upper)//' lies beyond the '//which//' of &domain; move the body or the ' &
                            //which(index(which, ' ', back=.true.) + 1:))
      end associate
   end subroutine check_place

   !> The series of the incompressible pressure holds for a column in a corner with one free side.
   subroutine check_pressure(document, setup, number, notes)
      type(document_t), intent(in) :: document
      type(settings_t), intent(in) :: setup
      integer, intent(in) :: number
      type(findings_t), intent(inout) :: notes

      character(*), parameter :: what = "&body pressure = 'incompressible' needs "
      character(*), parameter :: instead = "; choose 'hydrostatic' or 'zero'"
      real(dp) :: margin
      character(:), allocatable :: need

      if (setup%bodies(number)%pressure /= 'incompressible') return
      if (.not. (notes%clean('body') .and. notes%clean('scene') .and. notes%clean('domain') .and. notes%clean('fluid') .and. &
                 notes%clean('force'))) return
      associate (body => setup%bodies(number), domain => setup%domain)
         margin = slack*setup%scene%reference_length
         need = ''
         if (count(setup%leans(body)) /= 1) need = 'one side at a wall and the other free'
         if (.not. is_wall(domain%bottom) .or. abs(body%lower(2) - domain%lower(2)) > margin) then
            need = 'a body that stands on the floor'
         end if
         if (body%shape /= 'rectangle') need = "shape = 'rectangle'"
         if (.not. setup%fluid%gravity > setup%force%acceleration(2)) need = 'gravity above 0, or acceleration downwards'
      end associate
      if (need /= '') call notes%mistake(document%place_of('body', number, 'pressure'), 'body', what//need//instead)
   end subroutine check_pressure

   !> Hydrostatic pressure is that of fluid that rests: what falls, or is pushed aside, starts with a bang.
   subroutine check_rest(document, setup, notes)
      type(document_t), intent(in) :: document
      type(settings_t), intent(in) :: setup
      type(findings_t), intent(inout) :: notes

      type(resting_force_t) :: force
      logical, allocatable :: falls(:)
      integer :: i

      if (.not. (notes%clean('body') .and. notes%clean('scene') .and. notes%clean('domain') .and. notes%clean('fluid') .and. &
                 notes%clean('force'))) return
      force = resting_force(setup)
      falls = .not. carried(setup, force) .and. setup%bodies%pressure == 'hydrostatic'
      do i = 1, size(setup%bodies)
         if (falls(i)) call notes%warning(document%place_of('body', i, 'pressure'), '&body number '//to_text(i)//' lies on no ' &
                                          //"wall and on no fluid that does: with pressure = 'hydrostatic' it starts as if it " &
                                          //"stood, and bursts; with 'zero' it falls freely")
      end do
      if (force%left_over > 0.0_dp .and. any(setup%bodies%pressure == 'hydrostatic')) &
         call notes%warning(document%place_of('force', 1, 'acceleration'), "&body pressure = 'hydrostatic' balances the larger " &
                            //'component of gravity and acceleration; the other one, '//short(force%left_over) &
                            //', sets the fluid in motion')
   end subroutine check_rest

   !> Bodies must not lie on each other.
   subroutine check_overlap(document, setup, number, notes)
      type(document_t), intent(in) :: document
      type(settings_t), intent(in) :: setup
      integer, intent(in) :: number
      type(findings_t), intent(inout) :: notes

      real(dp), allocatable :: depth(:)
      character(:), allocatable :: words
      integer :: other

      if (.not. (notes%clean('body') .and. notes%clean('scene'))) return
      words = ''
      do other = 1, number - 1
         associate (body => setup%bodies(number))
            depth = overlap(body, setup%bodies(other))
            if (all(depth > slack*setup%scene%reference_length)) then
               words = short(depth(1))
               if (size(depth) == 2) words = words//', '//short(depth(2))
               call notes%mistake(document%place_of('body', number, place_key(body)), 'body', '&body number ' &
                                  //to_text(number)//' overlaps number '//to_text(other)//' by '//words//'; move one of them')
            end if
         end associate
      end do
   end subroutine check_overlap

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
