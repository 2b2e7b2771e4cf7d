!> Checks what no single key can tell: whether the values of a scene go together.
!!
!! Each check runs only if nothing was wrong in the groups it looks at, so that
!! one slip gives one message.
module settings_check
   use body_check, only: check_bodies
   use derived_settings, only: start_speed
   use domain_check, only: check_domain
   use findings, only: findings_t, place_t
   use integrators, only: new_integrator
   use kinds, only: dp
   use known_solutions, only: known_solutions_t
   use linear_stability, only: new_stability, stability_t
   use namelist_document, only: document_t
   use output_check, only: check_output
   use scene_keys, only: largest_mach
   use settings, only: settings_t
   use text, only: quoted, rounded_down, rounded_up, short, to_text
   implicit none
   private

   public :: check_settings

   real(dp), parameter :: good_mach = 0.1_dp         ! eq. 4: density varies by 1 %
   real(dp), parameter :: most_particles = 2.0e8_dp  ! positions in the arrays stay below 2**31
   real(dp), parameter :: most_steps = 2.0e9_dp      ! counted in default integers
   real(dp), parameter :: many_times = 2.0_dp        ! shorter steps that are worth a warning
   real(dp), parameter :: slack = 1.0e-9_dp          ! relative; rounding of the input

contains

   !> Runs all checks. What follows from the keys must be worked out.
   subroutine check_settings(document, solutions, setup, notes)
      type(document_t), intent(in) :: document
      class(known_solutions_t), intent(in) :: solutions
      type(settings_t), intent(in) :: setup
      type(findings_t), intent(inout) :: notes

      call check_domain(document, setup, notes)
      call check_units(document, setup, notes)
      call check_mach(document, solutions, setup, notes)
      call check_stability(document, setup, notes)
      call check_viscosity(document, setup, notes)
      call check_bodies(document, setup, notes)
      call check_particle_number(document, setup, notes)
      call check_step_number(document, setup, notes)
      call solutions%check(document, setup, notes)
      call check_output(document, setup, notes)
   end subroutine check_settings

   !> Energies must not overflow, and snapshots in single precision must hold density and pressure.
   subroutine check_units(document, setup, notes)
      type(document_t), intent(in) :: document
      type(settings_t), intent(in) :: setup
      type(findings_t), intent(inout) :: notes

      real(dp), parameter :: largest = 1.0e30_dp

      if (.not. (notes%clean('fluid') .and. notes%clean('scene'))) return
      associate (d => setup%scene%reference_length, rho => setup%fluid%density, c0 => setup%fluid%sound_speed)
         if (maxval(abs(log10([d, rho, c0]))) < log10(largest) .and. abs(log10(rho) + 2*log10(c0)) < log10(largest)) return
         call notes%mistake(document%place_of('fluid', 1, 'density'), 'fluid', '&fluid: reference_length = '//short(d) &
                            //', density = '//short(rho)//', sound speed = '//short(c0)//' and density*(sound speed)**2 must all ' &
                            //'be between 1e-30 and 1e30: choose other units')
      end associate
   end subroutine check_units

   !> The fluid should be only weakly compressible.
   subroutine check_mach(document, solutions, setup, notes)
      type(document_t), intent(in) :: document
      class(known_solutions_t), intent(in) :: solutions
      type(settings_t), intent(in) :: setup
      type(findings_t), intent(inout) :: notes

      real(dp) :: mach
      character(:), allocatable :: key

      if (.not. notes%clean('fluid')) return
      call check_speeds(document, solutions, setup, notes)
      associate (fluid => setup%fluid)
         mach = fluid%reference_speed/fluid%sound_speed
         if (fluid%find_reference_speed) mach = fluid%mach
         key = 'mach'
         if (.not. fluid%mach > 0.0_dp) key = 'sound_speed'
      end associate
      if (mach > largest_mach*(1.0_dp + slack)) then
         call notes%mistake(document%place_of('fluid', 1, key), 'fluid', '&fluid: reference_speed/sound_speed = ' &
                            //to_text(mach)//' is a Mach number above '//to_text(largest_mach) &
                            //'; raise sound_speed, best to 10 times reference_speed')
      else if (mach > good_mach*(1.0_dp + slack)) then
         call notes%warning(document%place_of('fluid', 1, key), '&fluid: the Mach number '//to_text(mach) &
                            //' is above 0.1: the density will vary by more than 1 %')
      end if
   end subroutine check_mach

   ! What the bodies start with must be slower than sound, and so must falling by their own height and moving walls.
   subroutine check_speeds(document, solutions, setup, notes)
      type(document_t), intent(in) :: document
      class(known_solutions_t), intent(in) :: solutions
      type(settings_t), intent(in) :: setup
      type(findings_t), intent(inout) :: notes

      real(dp) :: speed
      integer :: i

      if (notes%clean('domain')) call check_speed(maxval(abs(setup%domain%wall_speeds)), '&domain: the speed of a wall', &
                                                  document%place_of('domain', 1, 'wall_speeds'), setup, notes)
      if (.not. (notes%clean('body') .and. notes%clean('exact') .and. notes%clean('force'))) return
      do i = 1, size(setup%bodies)
         associate (body => setup%bodies(i))
            speed = max(start_speed(setup, body, solutions), sqrt(setup%fluid%gravity*max(0.0_dp, body%upper(2) - body%lower(2))))
            call check_speed(speed, '&body number '//to_text(i)//': its speed, given or by the forces on it,', &
                             document%place_of('body', i, 'velocity'), setup, notes)
         end associate
      end do
   end subroutine check_speeds

   !> One speed must be slower than sound.
   subroutine check_speed(speed, what, place, setup, notes)
      real(dp), intent(in) :: speed          !! [m/s]
      character(*), intent(in) :: what       !! for the message
      type(place_t), intent(in) :: place
      type(settings_t), intent(in) :: setup
      type(findings_t), intent(inout) :: notes

      associate (c0 => setup%fluid%sound_speed)
         if (speed > 2*c0) then
            call notes%mistake(place, 'fluid', what//' is '//short(speed/c0)//' times the sound speed '//short(c0) &
                               //'; raise sound_speed (or lower mach)')
         else if (speed > largest_mach*c0) then
            call notes%warning(place, what//' is '//short(speed/c0)//' times the sound speed')
         end if
      end associate
   end subroutine check_speed

   !> No wave may grow from step to step: a cfl beyond the limit will not be used, or is a mistake if the user wants that.
   !!
   !! The dynamic model's coefficients are known only in the run; it shortens its steps by itself.
   subroutine check_stability(document, setup, notes)
      type(document_t), intent(in) :: document
      type(settings_t), intent(in) :: setup
      type(findings_t), intent(inout) :: notes

      type(stability_t) :: stability
      real(dp) :: limit, delta
      character(:), allocatable :: what
      logical :: damped   ! sound by diffusive terms alone, so that limits go together

      if (.not. all([notes%clean('time'), notes%clean('model'), notes%clean('fluid'), notes%clean('scene')])) return
      damped = setup%time%integrator == 'rk2'
      ! With a sound speed that is a guess, viscosity is no known alpha: when it is known.
      if (damped .and. setup%fluid%find_reference_speed .and. setup%fluid%viscosity > 0.0_dp) return
      stability = stability_of(setup)
      associate (cfl => setup%time%cfl, model => setup%model)
         delta = constant_delta(setup)
         limit = stability%largest_cfl(delta, 0.0_dp)
         if (damped) limit = stability%largest_cfl(delta, setup%alpha_total())
         if (.not. limit > 0.0_dp) then
            call notes%mistake(document%place_of('time', 1, 'integrator'), 'time', '&time integrator = ' &
                               //quoted(setup%time%integrator)//' needs a constant alpha or delta that damps sound ' &
                               //'neither too weakly nor too strongly for cfl = 0.2; with '//short(setup%alpha_total())//' and ' &
                               //short(delta)//': use rk4')
         else if (cfl > limit*(1.0_dp + slack)) then
            what = 'the limit of '//trim(setup%time%integrator)//' is '//rounded_down(limit)
            if (damped) then
               what = what//' with alpha = '//short(setup%alpha_total())//' and delta = '//short(delta)
            else if (limit < stability%sound) then
               what = 'with delta = '//to_text(delta)//' the limit is '//rounded_down(limit)//' = ' &
                      //rounded_down(stability%times_delta)//'/delta'
            end if
            if (cfl <= stability%sound .and. .not. damped) &
               what = what//'; lower cfl, or delta to '//rounded_down(stability%times_delta/cfl)
            call beyond_limit(setup, document%place_of('time', 1, 'cfl'), what, notes)
         else if (model%diffusion == 'dynamic' .and. model%limit*cfl > many_times*stability%times_delta) then
            call notes%warning(document%place_of('model', 1, 'limit'), '&model limit = '//to_text(model%limit) &
                               //' may make steps '//short(model%limit*cfl/stability%times_delta)//' times shorter: delta_i = ' &
                               //to_text(model%limit)//' is stable to cfl = ' &
                               //rounded_down(stability%times_delta/model%limit)//' only')
         end if
      end associate
   end subroutine check_stability

   !> A warning or a mistake, as the user wants it.
   subroutine beyond_limit(setup, place, what, notes)
      type(settings_t), intent(in) :: setup
      type(place_t), intent(in) :: place      !! that is to be changed
      character(*), intent(in) :: what        !! the limit, and what to do
      type(findings_t), intent(inout) :: notes

      if (setup%time%beyond_limit == 'refuse') then
         call notes%mistake(place, 'time', '&time cfl = '//to_text(setup%time%cfl)//' is unstable: '//what)
      else
         call notes%warning(place, '&time cfl = '//to_text(setup%time%cfl)//' will not be used: '//what)
      end if
   end subroutine beyond_limit

   ! What the time step of the scene may be. Its viscosity must be known.
   type(stability_t) function stability_of(setup) result(stability)
      type(settings_t), intent(in) :: setup

      stability = new_stability(new_integrator(setup%time%integrator), setup%time%diffusion == 'frozen', &
                                setup%model%smoothing_ratio, constant_delta(setup), setup%alpha_total())
   end function stability_of

   ! The delta that acts everywhere.
   pure real(dp) function constant_delta(setup) result(delta)
      type(settings_t), intent(in) :: setup

      delta = 0.0_dp
      if (setup%model%diffusion == 'constant') delta = setup%model%delta
   end function constant_delta

   !> Says when two viscosities act, and when the viscous limit will rule the time step.
   subroutine check_viscosity(document, setup, notes)
      type(document_t), intent(in) :: document
      type(settings_t), intent(in) :: setup
      type(findings_t), intent(inout) :: notes

      type(stability_t) :: stability
      type(place_t) :: place
      real(dp) :: alpha, by_model, room, factor
      character(:), allocatable :: advice

      if (.not. all([notes%clean('time'), notes%clean('model'), notes%clean('fluid'), notes%clean('scene')])) return
      ! With a sound speed that is a guess so far: when it is known.
      if (setup%fluid%find_reference_speed) return
      alpha = setup%alpha_total()
      by_model = 0.0_dp
      if (setup%model%diffusion == 'constant') by_model = setup%model%alpha
      place = document%place_of('fluid', 1, 'viscosity')
      if (setup%fluid%reynolds > 0.0_dp) place = document%place_of('fluid', 1, 'reynolds')
      if (setup%fluid%viscosity > 0.0_dp .and. by_model > 0.0_dp) then
         call notes%warning(place, '&fluid viscosity and &model alpha = '//to_text(by_model)//' both act, alpha = ' &
                            //short(alpha)//' in all; set alpha = 0 for the viscosity alone')
      end if
      stability = stability_of(setup)
      room = stability%times_alpha/min(setup%time%cfl, stability%sound)
      ! All limits of rk2 go together: check_stability.
      if (setup%time%integrator == 'rk2' .or. alpha <= room*(1.0_dp + slack)) return
      if (by_model >= room .or. .not. setup%fluid%viscosity > 0.0_dp) then
         place = document%place_of('model', 1, 'alpha')
         advice = 'lower alpha of &model to '//rounded_down(room)
      else
         factor = (alpha - by_model)/(room - by_model)
         advice = 'not so with &scene resolution below '//rounded_down(setup%scene%resolution/factor) &
                  //' or a sound speed above '//rounded_up(setup%fluid%sound_speed*factor)
      end if
      ! alpha = 8 nu/(c0 h): the limit of alpha is one of dt nu/h**2.
      call beyond_limit(setup, place, 'with alpha = '//short(alpha)//', viscosity included, the viscous limit dt <= ' &
                        //rounded_down(stability%times_alpha/8.0_dp)//' h**2/nu is that of cfl = ' &
                        //rounded_down(stability%times_alpha/alpha)//', '//short(alpha/room)//' times as many steps; '//advice, &
                        notes)
   end subroutine check_viscosity

   !> A run that cannot end is a slip: with more steps than can be counted, time would not even get on by one.
   subroutine check_step_number(document, setup, notes)
      type(document_t), intent(in) :: document
      type(settings_t), intent(in) :: setup
      type(findings_t), intent(inout) :: notes

      type(stability_t) :: stability
      real(dp) :: cfl, per_step
      character(:), allocatable :: advice

      if (.not. (notes%clean('time') .and. notes%clean('model') .and. notes%clean('fluid') .and. notes%clean('scene'))) return
      if (setup%time%max_steps > 0) return
      stability = stability_of(setup)
      cfl = min(setup%time%cfl, stability%largest_cfl(constant_delta(setup), setup%alpha_total()))
      per_step = cfl*setup%smoothing_length()/setup%fluid%sound_speed
      if (setup%time%end_time <= most_steps*per_step) return
      advice = 'raise cfl, or lower end_time or the sound speed '//short(setup%fluid%sound_speed)
      if (cfl < setup%time%cfl) advice = 'lower '//shortening_key(setup, stability)//', which makes them so short, or end_time'
      call notes%mistake(document%place_of('time', 1, 'end_time'), 'time', '&time end_time = '//to_text(setup%time%end_time) &
                         //' is more than '//to_text(most_steps)//' steps of '//short(per_step)//': '//advice)
   end subroutine check_step_number

   ! What limits the step most.
   function shortening_key(setup, stability) result(words)
      type(settings_t), intent(in) :: setup
      type(stability_t), intent(in) :: stability
      character(:), allocatable :: words

      words = 'the viscosity'
      if (setup%model%diffusion == 'constant' .and. 2.0_dp*setup%model%alpha > setup%alpha_total()) words = 'alpha of &model'
      if (stability%largest_cfl(constant_delta(setup), 0.0_dp) < stability%largest_cfl(0.0_dp, setup%alpha_total())) &
         words = 'delta of &model'
   end function shortening_key

   !> All particles must fit.
   subroutine check_particle_number(document, setup, notes)
      type(document_t), intent(in) :: document
      type(settings_t), intent(in) :: setup
      type(findings_t), intent(inout) :: notes

      real(dp) :: particles
      integer :: i

      if (.not. (notes%clean('body') .and. notes%clean('scene'))) return
      particles = 0.0_dp
      do i = 1, size(setup%bodies)
         associate (body => setup%bodies(i))
            particles = particles + product((body%upper - body%lower)/setup%spacing())
         end associate
      end do
      if (particles >= most_particles) then
         call notes%mistake(document%place_of('scene', 1, 'resolution'), 'scene', '&scene resolution = ' &
                            //to_text(setup%scene%resolution)//' makes about '//rounded_down(particles)//' particles; at most ' &
                            //to_text(most_particles)//' are possible: lower it')
      end if
   end subroutine check_particle_number

end module settings_check
