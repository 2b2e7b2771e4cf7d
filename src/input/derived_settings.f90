!> Works out what follows from the keys: the model, boxes around discs, pivots of solids, strokes of wave makers, pressure without
!! weight, the sound speed, the viscosity.
module derived_settings
   use draft, only: draft_t
   use kinds, only: dp
   use known_solutions, only: known_solutions_t
   use motions, only: motion_t
   use resting_fluid, only: resting_force, resting_force_t
   use settings, only: body_settings, is_wall, settings_t, solid_settings
   use solid_outlines, only: homogeneous_inertia, motion_of, shape_centroid, solid_radius
   use text, only: to_text
   use wave_motions, only: resolve_wave_makers
   implicit none
   private

   public :: resolve_model, resolve_settings, set_reference_speed, start_speed, solid_speed, tank_speed, reach

contains

   !> Sets the model of a scene that names none: the dynamic one, or the constants of which it gives one.
   !! Which keys have an effect depends on it.
   pure subroutine resolve_model(draft)
      type(draft_t), intent(inout) :: draft

      associate (model => draft%scene%model, document => draft%document)
         model%by_default = .not. document%given('model', 1, 'diffusion')
         if (.not. model%by_default) return
         if (document%given('model', 1, 'alpha') .or. document%given('model', 1, 'delta')) model%diffusion = 'constant'
      end associate
   end subroutine resolve_model

   !> Sets all else that is worked out. What cannot be is a mistake.
   subroutine resolve_settings(draft)
      type(draft_t), intent(inout) :: draft

      call enclose_discs(draft%scene%bodies)
      if (draft%notes%clean('solid scene')) call resolve_pivots(draft)
      if (draft%notes%clean('solid scene fluid domain')) call resolve_wave_makers(draft)
      if (draft%notes%clean('fluid force domain')) call resolve_pressures(draft)
      if (draft%notes%clean('fluid')) call resolve_sound_speed(draft)
      if (draft%notes%clean('fluid scene')) call resolve_viscosity(draft)
   end subroutine resolve_settings

   !> Takes the speed that a preliminary run has found for &fluid reference_speed = 'auto'.
   pure subroutine set_reference_speed(scene, speed)
      type(settings_t), intent(inout) :: scene   !! mach is above 0
      real(dp), intent(in) :: speed              !! U_ref > 0 [m/s]

      scene%fluid%reference_speed = speed
      scene%fluid%sound_speed = speed/scene%fluid%mach
      scene%fluid%find_reference_speed = .false.
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

   !> Solids turn about their centroids unless their pivots are given; free ones are homogeneous unless it is said otherwise.
   pure subroutine resolve_pivots(draft)
      type(draft_t), intent(inout) :: draft
      integer :: i

      do i = 1, size(draft%scene%solids)
         if (draft%document%given('solid', i, 'pivot')) cycle
         draft%scene%solids(i)%pivot = shape_centroid(draft%scene, draft%scene%solids(i))
      end do
      do i = 1, size(draft%scene%solids)
         if (draft%scene%solids(i)%motion /= 'free' .or. draft%document%given('solid', i, 'moment_of_inertia')) cycle
         draft%scene%solids(i)%moment_of_inertia = homogeneous_inertia(draft%scene, draft%scene%solids(i))
      end do
   end subroutine resolve_pivots

   !> Without a force that it balances, hydrostatic pressure is none.
   subroutine resolve_pressures(draft)
      type(draft_t), intent(inout) :: draft
      integer :: i
      type(resting_force_t) :: force

      force = resting_force(draft%scene)
      if (force%size > 0.0_dp) return
      do i = 1, size(draft%scene%bodies)
         if (draft%scene%bodies(i)%pressure /= 'hydrostatic') cycle
         draft%scene%bodies(i)%pressure = 'zero'
         if (draft%document%given('body', i, 'pressure')) &
            call draft%warning('body', i, 'pressure', "&body pressure = 'hydrostatic' has no effect: gravity is 0")
      end do
   end subroutine resolve_pressures

   !> Works out the sound speed from Mach number and reference speed unless it is given.
   subroutine resolve_sound_speed(draft)
      type(draft_t), intent(inout) :: draft

      associate (fluid => draft%scene%fluid)
         if (fluid%find_reference_speed) then
            call guess_sound_speed(draft)
         else if (fluid%sound_speed > 0.0_dp) then
            if (fluid%mach > 0.0_dp) call draft%warning('fluid', 1, 'mach', '&fluid mach = '//to_text(fluid%mach) &
               //' has no effect: sound_speed is given; leave one of them out')
            fluid%mach = 0.0_dp
         else if (.not. fluid%mach > 0.0_dp) then
            call draft%mistake('fluid', 1, 'mach', '&fluid needs mach and reference_speed, or sound_speed')
         else if (.not. fluid%reference_speed > 0.0_dp) then
            call draft%mistake('fluid', 1, 'reference_speed', '&fluid mach needs a reference_speed above 0 to give the sound speed')
         else
            fluid%sound_speed = fluid%reference_speed/fluid%mach
         end if
      end associate
   end subroutine resolve_sound_speed

   !> Sound speed for the checks, and for the coarse run that will find reference_speed.
   subroutine guess_sound_speed(draft)
      type(draft_t), intent(inout) :: draft
      character(*), parameter :: auto = "&fluid reference_speed = 'auto' "
      real(dp) :: speed
      integer :: i

      associate (fluid => draft%scene%fluid)
         if (fluid%sound_speed > 0.0_dp) then
            call draft%mistake('fluid', 1, 'sound_speed', &
                               auto//'finds the sound speed, and sound_speed is given; leave one of them out')
         else if (.not. fluid%mach > 0.0_dp) then
            call draft%mistake('fluid', 1, 'reference_speed', auto//'needs mach, the Mach number to have: mach = 0.1')
         else
            speed = guessed_speed(draft%scene, draft%solutions)
            if (draft%notes%clean('solid scene')) then
               do i = 1, size(draft%scene%solids)
                  speed = max(speed, solid_speed(draft%scene, draft%scene%solids(i)))
               end do
            end if
            if (draft%notes%clean('tank domain')) speed = max(speed, tank_speed(draft%scene))
            if (.not. speed > 0.0_dp .and. draft%notes%any_mistake()) then
               speed = 1.0_dp   ! what moves the fluid may be what is wrong
            else if (.not. speed > 0.0_dp) then
               call draft%mistake('fluid', 1, 'reference_speed', auto//'has nothing to find: no gravity, ' &
                                  //'force, velocity, moving wall, solid or tank; give one, or sound_speed in the place of mach')
            end if
            fluid%sound_speed = speed/fluid%mach
         end if
      end associate
   end subroutine guess_sound_speed

   !> Speed that the fluid may reach: from the start, by falling, by the other forces, at moving walls [m/s].
   real(dp) function guessed_speed(scene, solutions) result(speed)
      type(settings_t), intent(in) :: scene
      class(known_solutions_t), intent(in) :: solutions
      real(dp) :: floor_at, top
      integer :: i

      associate (domain => scene%domain, force => scene%force, bodies => scene%bodies)
         speed = maxval(abs(domain%wall_speeds))
         speed = max(speed, sqrt(2*dot_product(abs(force%acceleration), abs(domain%upper - domain%lower))))
         if (size(bodies) == 0) return
         top = maxval(bodies%upper(2))
         floor_at = minval(bodies%lower(2))
         if (is_wall(domain%bottom)) floor_at = domain%lower(2)
         speed = max(speed, sqrt(2*scene%fluid%gravity*max(0.0_dp, top - floor_at)))
         do i = 1, size(bodies)
            speed = max(speed, start_speed(scene, bodies(i), solutions))
         end do
      end associate
   end function guessed_speed

   !> Bound of the speed of any point of a solid, at any time [m/s].
   pure real(dp) function solid_speed(scene, solid) result(speed)
      type(settings_t), intent(in) :: scene
      type(solid_settings), intent(in) :: solid   !! its pivot is known
      type(motion_t) :: motion

      motion = motion_of(solid)
      speed = motion%largest_speed(solid_radius(scene, solid))
   end function solid_speed

   !> Bound of the speed of any point of the box as it is drawn, at any time [m/s].
   pure real(dp) function tank_speed(scene) result(speed)
      type(settings_t), intent(in) :: scene
      type(motion_t) :: motion

      associate (domain => scene%domain, pivot => scene%tank%pivot)
         motion = motion_of(scene%tank)
         speed = motion%largest_speed(norm2(max(abs(domain%lower - pivot), abs(domain%upper - pivot))))
      end associate
   end function tank_speed

   !> Largest speed that a body starts with or the central field soon gives it [m/s].
   real(dp) function start_speed(scene, body, solutions) result(speed)
      type(settings_t), intent(in) :: scene
      type(body_settings), intent(in) :: body   !! its box is known
      class(known_solutions_t), intent(in) :: solutions

      speed = scene%force%central_rate*reach(body, scene%force%centre)
      if (body%flow == 'uniform') then
         speed = max(speed, norm2(body%velocity))
      else
         speed = max(speed, solutions%start_speed(scene, body))
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
   subroutine resolve_viscosity(draft)
      type(draft_t), intent(inout) :: draft
      real(dp) :: speed
      character(:), allocatable :: problem

      if (.not. draft%scene%fluid%reynolds > 0.0_dp) return
      problem = ''
      associate (fluid => draft%scene%fluid, d => draft%scene%scene%reference_length)
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
         if (problem /= '') call draft%mistake('fluid', 1, 'reynolds', '&fluid reynolds = '//to_text(fluid%reynolds)//problem)
      end associate
   end subroutine resolve_viscosity

end module derived_settings
