!> Checks that a scene is one that its exact solution holds for.
!!
!! What a solution needs is gathered first: all that a scene lacks is told at once, each at the key that is to be changed.
module exact_check
   use findings, only: findings_t
   use kinds, only: dp
   use document, only: document_t
   use scene_needs, only: need_full_box, need_no_weight, need_one_body, need_open_sides, need_width, needs_t, &
                          same, slack
   use scene_keys, only: with_waves
   use settings, only: choice_length, settings_t, side_names
   use text, only: short, to_text
   implicit none
   private

   public :: check_exact

   ! Solutions that move at the start; the others begin at rest, or with velocities that the bodies name.
   character(choice_length), parameter :: moving(*) = [character(choice_length) :: &
      'standing_wave', 'oscillating_drop', 'taylor_green', 'acoustic_wave', 'rotating_square']

contains

   !> Runs all checks of &exact.
   subroutine check_exact(document, setup, notes)
      type(document_t), intent(in) :: document
      type(settings_t), intent(in) :: setup
      type(findings_t), intent(inout) :: notes

      type(needs_t) :: needs
      integer :: i

      if (.not. (notes%clean('exact') .and. notes%clean('body') .and. notes%clean('domain') .and. notes%clean('scene') &
                 .and. notes%clean('fluid') .and. notes%clean('force') .and. notes%clean('model'))) return
      call check_start(document, setup, notes)
      if (setup%exact%solution == 'none') return
      call add_needs(setup, needs)
      do i = 1, needs%n
         associate (need => needs%items(i))
            call notes%mistake(document%place_of(trim(need%group), need%number, trim(need%key)), 'exact', &
                               "&exact solution = '"//trim(setup%exact%solution)//"' needs "//need%what)
         end associate
      end do
   end subroutine check_exact

   !> Bodies can start with a solution's velocity or pressure if there is one.
   subroutine check_start(document, setup, notes)
      type(document_t), intent(in) :: document
      type(settings_t), intent(in) :: setup
      type(findings_t), intent(inout) :: notes

      character(*), parameter :: own_pressure(*) = [character(choice_length) :: &
                                                    'oscillating_drop', 'taylor_green', 'rotating_square']
      character(:), allocatable :: key, why
      integer :: i

      do i = 1, size(setup%bodies)
         associate (body => setup%bodies(i), solution => setup%exact%solution)
            key = ''
            if (body%pressure == 'exact') key = 'pressure'
            if (body%flow == 'exact') key = 'flow'
            if (key /= '' .and. (solution == 'none' .or. solution == 'impact')) then
               why = 'needs an &exact solution; docs/scenes.md says which there are'
               if (solution == 'impact') why = "is unknown to &exact solution = 'impact', which has no fields; give velocity"
               call notes%mistake(document%place_of('body', i, key), 'exact', '&body '//key//" = 'exact' "//why)
            else if (any(solution == own_pressure) .and. body%pressure /= 'exact') then
               call notes%warning(document%place_of('body', i, 'pressure'), "&body starts without the pressure of &exact " &
                                  //"solution = '"//trim(solution)//"'; pressure = 'exact' would have it")
            end if
         end associate
      end do
   end subroutine check_start

   !> What the scene lacks for its solution.
   subroutine add_needs(setup, needs)
      type(settings_t), intent(in) :: setup
      type(needs_t), intent(inout) :: needs

      associate (solution => setup%exact%solution)
         if (any(solution == moving)) then
            call needs%unless(abs(setup%exact%amplitude) > 0.0_dp, 'an amplitude that is not 0', 'exact', 'amplitude')
            call needs%unless(all(setup%bodies%flow == 'exact'), "&body flow = 'exact', or its motion is not there", 'body', 'flow')
         end if
         if (any(solution == with_waves)) call need_long_waves(setup, needs)
         select case (solution)
         case ('hydrostatic', 'standing_wave')
            call need_tank(setup, needs)
         case ('oscillating_drop')
            call need_drop(setup, needs)
         case ('impact')
            call need_impact(setup, needs)
         case ('taylor_green')
            call need_periodic_box(setup, needs)
         case ('acoustic_wave')
            call need_periodic_box(setup, needs)
            ! The speed of sound on a lattice is worked out along its rows.
            call needs%unless(all(setup%bodies%lattice == 'aligned'), "lattice = 'aligned'", 'body', 'lattice')
         case ('couette', 'poiseuille')
            call need_channel(setup, needs)
         case ('rotating_square')
            call need_no_weight(setup, needs)
            call need_open_sides(setup, needs)
            call need_one_body(setup, 'rectangle', needs)
         end select
         if (solution /= 'oscillating_drop') call needs%unless(.not. setup%force%central_rate > 0.0_dp, &
                                                               'no central field: central_rate = 0', 'force', 'central_rate')
         if (solution /= 'poiseuille') call needs%unless(.not. setup%has_acceleration(), &
                                                         'no acceleration: acceleration = 0, 0', 'force', 'acceleration')
      end associate
   end subroutine add_needs

   ! Waves that particles can show.
   subroutine need_long_waves(setup, needs)
      type(settings_t), intent(in) :: setup
      type(needs_t), intent(inout) :: needs

      real(dp), parameter :: least_length = 4.0_dp   ! of a wave, in dx
      real(dp) :: most

      most = (setup%domain%upper(1) - setup%domain%lower(1))/(least_length*setup%spacing())
      call needs%unless(setup%exact%waves <= most*(1.0_dp + slack), 'at most '//to_text(int(min(most*(1.0_dp + slack), 1.0e9_dp))) &
                        //' waves in the box: shorter ones than 4 dx cannot be seen in particles', 'exact', 'waves')
   end subroutine need_long_waves

   ! Water on a floor from one side to the other.
   subroutine need_tank(setup, needs)
      type(settings_t), intent(in) :: setup
      type(needs_t), intent(inout) :: needs

      character(choice_length) :: kinds_there(4)
      integer :: i

      call needs%unless(setup%fluid%gravity > 0.0_dp, 'gravity above 0', 'fluid', 'gravity')
      kinds_there = setup%side_kinds()
      if (setup%exact%solution == 'standing_wave') then
         call needs%unless(abs(setup%exact%amplitude) < 1.0_dp, 'an amplitude between -1 and 1: it is wave height/depth', &
                           'exact', 'amplitude')
         do i = 1, 3
            call needs%unless(kinds_there(i) == 'free_slip' .or. (kinds_there(i) == 'periodic' .and. i < 3), &
                              trim(side_names(i))//" = 'free_slip'", 'domain', trim(side_names(i)))
         end do
      else
         do i = 1, 3
            call needs%unless(kinds_there(i) /= 'open', 'a wall at the '//trim(side_names(i)), 'domain', trim(side_names(i)))
         end do
         call needs%unless(all([(norm2(setup%bodies(i)%velocity) <= 0.0_dp, i=1, size(setup%bodies))]), &
                           'fluid at rest: velocity = 0, 0', 'body', 'velocity')
      end if
      call need_one_body(setup, 'rectangle', needs)
      if (size(setup%bodies) /= 1) return
      call need_width(setup, needs)
      call needs%unless(same(setup, setup%bodies(1)%lower(2), setup%domain%lower(2)), &
                        'a body on the floor: lower(2) = '//to_text(setup%domain%lower(2)), 'body', 'lower')
   end subroutine need_tank

   ! A disc around the centre of the field, and room for it to stretch.
   subroutine need_drop(setup, needs)
      type(settings_t), intent(in) :: setup
      type(needs_t), intent(inout) :: needs

      character(choice_length) :: kinds_there(4)
      real(dp) :: distance(4), half, room
      integer :: i

      call need_no_weight(setup, needs)
      call needs%unless(setup%force%central_rate > 0.0_dp, 'a central field: &force central_rate above 0', &
                        'force', 'central_rate')
      call need_one_body(setup, 'disc', needs)
      if (size(setup%bodies) /= 1 .or. .not. setup%force%central_rate > 0.0_dp) return
      associate (body => setup%bodies(1), domain => setup%domain)
         if (body%shape /= 'disc') return
         call needs%unless(all(same(setup, body%centre, setup%force%centre)), 'a disc in the centre of the field: centre = ' &
                           //to_text(setup%force%centre), 'body', 'centre')
         ! Largest half axis: w**2 (a**2 + R**4/a**2) = 2 R**2 (A0**2 + w**2), where all its energy is potential.
         half = 1.0_dp + (setup%exact%amplitude/setup%force%central_rate)**2
         room = body%radius*sqrt(half + sqrt(half**2 - 1.0_dp)) + 2.0_dp*setup%smoothing_length()
         kinds_there = setup%side_kinds()
         distance = [body%centre(1) - domain%lower(1), domain%upper(1) - body%centre(1), &
                     body%centre(2) - domain%lower(2), domain%upper(2) - body%centre(2)]
         do i = 1, 4
            call needs%unless(kinds_there(i) == 'open' .or. distance(i) >= room, trim(side_names(i))//" = 'open', or that side " &
                              //short(room)//' from the centre: the drop stretches so far', 'domain', trim(side_names(i)))
         end do
      end associate
   end subroutine need_drop

   ! Two equal rectangles that touch along a whole edge and move towards each other.
   subroutine need_impact(setup, needs)
      type(settings_t), intent(in) :: setup
      type(needs_t), intent(inout) :: needs

      integer :: across, along
      real(dp) :: gap, towards(2)

      call need_no_weight(setup, needs)
      call need_open_sides(setup, needs)
      call needs%unless(size(setup%bodies) == 2, 'two bodies, not '//to_text(size(setup%bodies)), 'body', '', &
                        min(3, size(setup%bodies)))
      if (size(setup%bodies) /= 2) return
      call needs%unless(all(setup%bodies%shape == 'rectangle'), "bodies of shape = 'rectangle'", 'body', 'shape')
      if (.not. all(setup%bodies%shape == 'rectangle')) return
      associate (one => setup%bodies(1), other => setup%bodies(2))
         across = 2
         if (abs(one%velocity(1)) > abs(one%velocity(2))) across = 1
         along = 3 - across
         call needs%unless(all(same(setup, one%upper - one%lower, other%upper - other%lower)), &
                           'two bodies of one size: '//to_text(one%upper - one%lower), 'body', 'upper', 2)
         gap = max(other%lower(across) - one%upper(across), one%lower(across) - other%upper(across))
         call needs%unless(same(setup, gap, 0.0_dp) .and. same(setup, one%lower(along), other%lower(along)), &
                           'bodies that touch along a whole edge, across which they move', 'body', 'lower', 2)
         ! from the first to the second body
         towards = 0.0_dp
         towards(across) = sign(1.0_dp, other%lower(across) - one%lower(across))
         call needs%unless(dot_product(one%velocity, towards) > 0.0_dp, 'bodies that move towards each other', 'body', 'velocity')
         call needs%unless(norm2(one%velocity + other%velocity) <= slack*norm2(one%velocity), 'opposite velocities: ' &
                           //to_text(0.0_dp - one%velocity), 'body', 'velocity', 2)
         call needs%unless(.not. abs(one%velocity(along)) > 0.0_dp, 'velocities along one axis', 'body', 'velocity')
      end associate
   end subroutine need_impact

   ! A box that is full of fluid and goes on for ever.
   subroutine need_periodic_box(setup, needs)
      type(settings_t), intent(in) :: setup
      type(needs_t), intent(inout) :: needs

      call need_no_weight(setup, needs)
      call needs%unless(setup%domain%left == 'periodic', "left = 'periodic' and right = 'periodic'", 'domain', 'left')
      associate (domain => setup%domain)
         if (setup%exact%solution == 'taylor_green') then
            call needs%unless(domain%bottom == 'periodic', "bottom = 'periodic' and top = 'periodic'", 'domain', 'bottom')
            call needs%unless(same(setup, domain%upper(1) - domain%lower(1), domain%upper(2) - domain%lower(2)), &
                              'a square box; it is '//to_text(domain%upper - domain%lower)//' wide and high', 'domain', 'upper')
         else
            call needs%unless(all(any_of(setup%side_kinds(), 'free_slip', 'periodic')), &
                              "bottom and top that are 'free_slip' or 'periodic'", 'domain', 'bottom')
            call needs%unless(abs(setup%exact%amplitude) < 0.1_dp, &
                              'an amplitude between -0.1 and 0.1: it is a share of the density', 'exact', 'amplitude')
            call needs%unless(all(setup%bodies%pressure == 'exact'), "&body pressure = 'exact', or it does not travel", &
                              'body', 'pressure')
         end if
      end associate
      call need_one_body(setup, 'rectangle', needs)
      call need_full_box(setup, needs)
   end subroutine need_periodic_box

   ! Fluid at rest between walls that it sticks to, and what sets it in motion.
   subroutine need_channel(setup, needs)
      type(settings_t), intent(in) :: setup
      type(needs_t), intent(inout) :: needs

      integer :: i

      associate (domain => setup%domain, acceleration => setup%force%acceleration)
         call needs%unless(domain%left == 'periodic', "left = 'periodic' and right = 'periodic'", 'domain', 'left')
         call needs%unless(domain%bottom == 'no_slip', "bottom = 'no_slip'", 'domain', 'bottom')
         call needs%unless(domain%top == 'no_slip', "top = 'no_slip'", 'domain', 'top')
         call needs%unless(setup%alpha_total() > 0.0_dp, 'viscosity above 0', 'fluid', 'viscosity')
         if (setup%exact%solution == 'couette') then
            call needs%unless(any(abs(domain%wall_speeds(3:4)) > 0.0_dp), &
                              'a wall that moves: wall_speeds = 0, 0, 0, 1 for the top', 'domain', 'wall_speeds')
         else
            call needs%unless(abs(acceleration(1)) > 0.0_dp, 'acceleration along the channel: acceleration = 1, 0', &
                              'force', 'acceleration')
            call needs%unless(.not. abs(acceleration(2)) > 0.0_dp, 'no acceleration across the channel: acceleration(2) = 0', &
                              'force', 'acceleration')
         end if
      end associate
      call needs%unless(all([(norm2(setup%bodies(i)%velocity) <= 0.0_dp, i=1, size(setup%bodies))]), &
                        'fluid at rest: velocity = 0, 0', 'body', 'velocity')
      call need_one_body(setup, 'rectangle', needs)
      call need_full_box(setup, needs)
   end subroutine need_channel

   elemental logical function any_of(kind_there, one, other)
      character(*), intent(in) :: kind_there, one, other

      any_of = kind_there == one .or. kind_there == other
   end function any_of

end module exact_check
