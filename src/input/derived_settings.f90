!> Works out what follows from the keys: boxes around discs, pressure without weight, the sound speed, the viscosity.
module derived_settings
   use findings, only: findings_t
   use kinds, only: dp
   use known_solutions, only: known_solutions_t
   use namelist_document, only: document_t
   use resting_fluid, only: resting_force, resting_force_t
   use settings, only: body_settings, is_wall, settings_t
   use text, only: to_text
   implicit none
   private

   public :: resolve_settings, set_reference_speed, start_speed, reach

contains

   !> Sets all that is worked out. What cannot be is a mistake.
   subroutine resolve_settings(document, solutions, setup, notes)
      type(document_t), intent(in) :: document
      class(known_solutions_t), intent(in) :: solutions
      type(settings_t), intent(inout) :: setup
      type(findings_t), intent(inout) :: notes

      call enclose_discs(setup%bodies)
      call resolve_pressures(document, setup, notes)
      call resolve_sound_speed(document, solutions, setup, notes)
      call resolve_viscosity(document, setup, notes)
   end subroutine resolve_settings

   !> Takes the speed that a preliminary run has found for &fluid reference_speed = 'auto'.
   pure subroutine set_reference_speed(setup, speed)
      type(settings_t), intent(inout) :: setup   !! mach is above 0
      real(dp), intent(in) :: speed              !! U_ref > 0 [m/s]

      setup%fluid%reference_speed = speed
      setup%fluid%sound_speed = speed/setup%fluid%mach
      setup%fluid%find_reference_speed = .false.
   end subroutine set_reference_speed

   !> Sets `lower` and `upper` of discs.
   pure subroutine enclose_discs(bodies)
      type(body_settings), intent(inout) :: bodies(:)

      integer :: i

      do i = 1, size(bodies)
         if (bodies(i)%shape /= 'disc') cycle
         bodies(i)%lower = bodies(i)%centre - bodies(i)%radius
         bodies(i)%upper = bodies(i)%centre + bodies(i)%radius
      end do
   end subroutine enclose_discs

   !> Without a force that it balances, hydrostatic pressure is none.
   subroutine resolve_pressures(document, setup, notes)
      type(document_t), intent(in) :: document
      type(settings_t), intent(inout) :: setup
      type(findings_t), intent(inout) :: notes

      integer :: i
      type(resting_force_t) :: force

      if (.not. (notes%clean('fluid') .and. notes%clean('force') .and. notes%clean('domain'))) return
      force = resting_force(setup)
      if (force%size > 0.0_dp) return
      do i = 1, size(setup%bodies)
         if (setup%bodies(i)%pressure /= 'hydrostatic') cycle
         setup%bodies(i)%pressure = 'zero'
         if (document%given('body', i, 'pressure')) call notes%warning(document%place_of('body', i, 'pressure'), &
                                                                       "&body pressure = 'hydrostatic' has no effect: gravity is 0")
      end do
   end subroutine resolve_pressures

   !> Works out the sound speed from Mach number and reference speed unless it is given.
   subroutine resolve_sound_speed(document, solutions, setup, notes)
      type(document_t), intent(in) :: document
      class(known_solutions_t), intent(in) :: solutions
      type(settings_t), intent(inout) :: setup
      type(findings_t), intent(inout) :: notes

      if (.not. notes%clean('fluid')) return
      associate (fluid => setup%fluid)
         if (fluid%find_reference_speed) then
            call guess_sound_speed(document, solutions, setup, notes)
         else if (fluid%sound_speed > 0.0_dp) then
            if (fluid%mach > 0.0_dp) then
               call notes%warning(document%place_of('fluid', 1, 'mach'), '&fluid mach = '//to_text(fluid%mach) &
                                  //' has no effect: sound_speed is given; leave one of them out')
               fluid%mach = 0.0_dp
            end if
         else if (.not. fluid%mach > 0.0_dp) then
            call notes%mistake(document%place_of('fluid', 1, 'mach'), 'fluid', &
                               '&fluid needs mach and reference_speed, or sound_speed')
         else if (.not. fluid%reference_speed > 0.0_dp) then
            call notes%mistake(document%place_of('fluid', 1, 'reference_speed'), 'fluid', &
                               '&fluid mach needs a reference_speed above 0 to give the sound speed')
         else
            fluid%sound_speed = fluid%reference_speed/fluid%mach
         end if
      end associate
   end subroutine resolve_sound_speed

   !> Sound speed for the checks, and for the coarse run that will find reference_speed.
   subroutine guess_sound_speed(document, solutions, setup, notes)
      type(document_t), intent(in) :: document
      class(known_solutions_t), intent(in) :: solutions
      type(settings_t), intent(inout) :: setup
      type(findings_t), intent(inout) :: notes

      character(*), parameter :: auto = "&fluid reference_speed = 'auto' "
      real(dp) :: speed

      associate (fluid => setup%fluid)
         if (fluid%sound_speed > 0.0_dp) then
            call notes%mistake(document%place_of('fluid', 1, 'sound_speed'), 'fluid', &
                               auto//'finds the sound speed, and sound_speed is given; leave one of them out')
         else if (.not. fluid%mach > 0.0_dp) then
            call notes%mistake(document%place_of('fluid', 1, 'reference_speed'), 'fluid', &
                               auto//'needs mach, the Mach number to have: mach = 0.1')
         else
            speed = guessed_speed(setup, solutions)
            if (.not. speed > 0.0_dp .and. notes%any_mistake()) then
               speed = 1.0_dp   ! what moves the fluid may be what is wrong
            else if (.not. speed > 0.0_dp) then
               call notes%mistake(document%place_of('fluid', 1, 'reference_speed'), 'fluid', auto//'has nothing to find: no ' &
                                  //'gravity, force, velocity or moving wall; give one, or sound_speed in the place of mach')
            end if
            fluid%sound_speed = speed/fluid%mach
         end if
      end associate
   end subroutine guess_sound_speed

   !> Speed that the fluid may reach: from the start, by falling, by the other forces, at moving walls [m/s].
   real(dp) function guessed_speed(setup, solutions) result(speed)
      type(settings_t), intent(in) :: setup
      class(known_solutions_t), intent(in) :: solutions

      real(dp) :: floor_at, top
      integer :: i

      associate (domain => setup%domain, force => setup%force, bodies => setup%bodies)
         speed = maxval(abs(domain%wall_speeds))
         speed = max(speed, sqrt(2*dot_product(abs(force%acceleration), abs(domain%upper - domain%lower))))
         if (size(bodies) == 0) return
         top = maxval(bodies%upper(2))
         floor_at = minval(bodies%lower(2))
         if (is_wall(domain%bottom)) floor_at = domain%lower(2)
         speed = max(speed, sqrt(2*setup%fluid%gravity*max(0.0_dp, top - floor_at)))
         do i = 1, size(bodies)
            speed = max(speed, start_speed(setup, bodies(i), solutions))
         end do
      end associate
   end function guessed_speed

   !> Largest speed that a body starts with or the central field soon gives it [m/s].
   real(dp) function start_speed(setup, body, solutions) result(speed)
      type(settings_t), intent(in) :: setup
      type(body_settings), intent(in) :: body   !! its box is known
      class(known_solutions_t), intent(in) :: solutions

      speed = setup%force%central_rate*reach(body, setup%force%centre)
      if (body%flow == 'uniform') then
         speed = max(speed, norm2(body%velocity))
      else
         speed = max(speed, solutions%start_speed(setup, body))
      end if
   end function start_speed

   !> Largest distance of a body's points from a centre [m].
   pure real(dp) function reach(body, centre)
      type(body_settings), intent(in) :: body
      real(dp), intent(in) :: centre(2)

      if (body%shape == 'disc') then
         reach = norm2(body%centre - centre) + body%radius
      else
         reach = norm2(max(abs(body%lower - centre), abs(body%upper - centre)))
      end if
   end function reach

   !> Works out the viscosity from the Reynolds number if that is given.
   !! Source: Sec. 5.1 of the paper refers Re to U = sqrt(g d) and the depth d; without gravity we take reference_speed.
   subroutine resolve_viscosity(document, setup, notes)
      type(document_t), intent(in) :: document
      type(settings_t), intent(inout) :: setup
      type(findings_t), intent(inout) :: notes

      real(dp) :: speed
      character(:), allocatable :: problem

      if (.not. (notes%clean('fluid') .and. notes%clean('scene'))) return
      if (.not. setup%fluid%reynolds > 0.0_dp) return
      problem = ''
      associate (fluid => setup%fluid, d => setup%scene%reference_length)
         speed = fluid%reference_speed
         if (fluid%gravity > 0.0_dp) speed = sqrt(fluid%gravity*d)
         if (fluid%viscosity > 0.0_dp) then
            problem = ' and viscosity are both given; leave one of them out'
         else if (fluid%find_reference_speed .and. .not. fluid%gravity > 0.0_dp) then
            problem = " refers to reference_speed where there is no gravity, and that is 'auto'; give viscosity instead, " &
                      //'or reference_speed as a number'
         else if (.not. speed > 0.0_dp) then
            problem = ' needs a speed to refer to: gravity or reference_speed above 0; or give viscosity instead'
         else
            fluid%viscosity = fluid%density*speed*d/fluid%reynolds
         end if
         if (problem /= '') call notes%mistake(document%place_of('fluid', 1, 'reynolds'), 'fluid', '&fluid reynolds = ' &
                                               //to_text(fluid%reynolds)//problem)
      end associate
   end subroutine resolve_viscosity

end module derived_settings
