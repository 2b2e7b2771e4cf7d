!> Checks what no single key can tell: whether the values of a scene go together.
!!
!! Each check runs only if nothing was wrong in the groups it looks at, so that
!! one slip gives one message.
module settings_check
   use body_check, only: check_bodies
   use derived_settings, only: start_speed
   use domain_check, only: check_domain
   use draft, only: draft_t
   use integrators, only: new_integrator
   use kernel, only: k_2d
   use kinds, only: dp
   use linear_stability, only: new_stability, stability_t
   use output_check, only: check_output
   use resting_fluid, only: held_force
   use scene_keys, only: largest_mach
   use settings, only: settings_t
   use solid_check, only: check_solids
   use sponge_check, only: check_sponges
   use tank_check, only: check_tank
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
   subroutine check_settings(draft)
      type(draft_t), intent(inout) :: draft

      call check_domain(draft)
      if (draft%notes%clean('fluid scene')) call check_units(draft)
      if (draft%notes%clean('fluid')) call check_mach(draft)
      if (draft%notes%clean('time model fluid scene')) call check_stability(draft)
      ! With a sound speed that is a guess so far: when it is known.
      if (draft%notes%clean('time model fluid scene') .and. .not. draft%scene%fluid%find_reference_speed) &
         call check_viscosity(draft)
      call check_tank(draft)
      call check_bodies(draft)
      call check_solids(draft)
      call check_sponges(draft)
      if (draft%notes%clean('body scene')) call check_particle_number(draft)
      if (draft%notes%clean('time model fluid scene')) call check_step_number(draft)
      call draft%solutions%check(draft%document, draft%scene, draft%notes)
      call check_output(draft)
   end subroutine check_settings

   !> Energies must not overflow, and snapshots in single precision must hold density and pressure.
   subroutine check_units(draft)
      type(draft_t), intent(inout) :: draft
      real(dp), parameter :: largest = 1.0e30_dp

      associate (d => draft%scene%scene%reference_length, rho => draft%scene%fluid%density, c0 => draft%scene%fluid%sound_speed)
         if (maxval(abs(log10([d, rho, c0]))) < log10(largest) .and. abs(log10(rho) + 2*log10(c0)) < log10(largest)) return
         call draft%mistake('fluid', 1, 'density', '&fluid: reference_length = '//short(d)//', density = '//short(rho) &
                            //', sound speed = '//short(c0)//' and density*(sound speed)**2 must all be between 1e-30 and ' &
                            //'1e30: choose other units')
      end associate
   end subroutine check_units

   !> The fluid should be only weakly compressible.
   subroutine check_mach(draft)
      type(draft_t), intent(inout) :: draft
      real(dp) :: mach
      character(:), allocatable :: key

      call check_speeds(draft)
      associate (fluid => draft%scene%fluid)
         mach = fluid%reference_speed/fluid%sound_speed
         if (fluid%find_reference_speed) mach = fluid%mach
         key = 'mach'
         if (.not. fluid%mach > 0.0_dp) key = 'sound_speed'
      end associate
      if (mach > largest_mach*(1.0_dp + slack)) then
         call draft%mistake('fluid', 1, key, '&fluid: reference_speed/sound_speed = '//to_text(mach)//' is a Mach number above ' &
                            //to_text(largest_mach)//'; raise sound_speed, best to 10 times reference_speed')
      else if (mach > good_mach*(1.0_dp + slack)) then
         call draft%warning('fluid', 1, key, '&fluid: the Mach number '//to_text(mach) &
                            //' is above 0.1: the density will vary by more than 1 %')
      end if
   end subroutine check_mach

   ! What the bodies start with must be slower than sound, and so must falling by their own extent and moving walls.
   subroutine check_speeds(draft)
      type(draft_t), intent(inout) :: draft
      real(dp) :: speed, force(2)
      integer :: i

      if (draft%notes%clean('domain')) call check_speed(draft, maxval(abs(draft%scene%domain%wall_speeds)), 'domain', 1, &
                                                        'wall_speeds', '&domain: the speed of a wall')
      if (.not. draft%notes%clean('body exact force')) return
      force = abs(held_force(draft%scene))
      do i = 1, size(draft%scene%bodies)
         associate (body => draft%scene%bodies(i))
            speed = max(start_speed(draft%scene, body, draft%solutions), &
                        sqrt(maxval(force*max(0.0_dp, body%upper - body%lower))))
         end associate
         call check_speed(draft, speed, 'body', i, 'velocity', '&body number '//to_text(i) &
                          //': its speed, given or by the forces on it,')
      end do
   end subroutine check_speeds

   !> One speed must be slower than sound.
   subroutine check_speed(draft, speed, group, number, key, what)
      type(draft_t), intent(inout) :: draft
      real(dp), intent(in) :: speed          !! [m/s]
      character(*), intent(in) :: group, key !! that says it
      integer, intent(in) :: number          !! of the group
      character(*), intent(in) :: what       !! for the message

      associate (c0 => draft%scene%fluid%sound_speed)
         if (speed > 2*c0) then
            call draft%notes%mistake(draft%document%place_of(group, number, key), 'fluid', what//' is '//short(speed/c0) &
                                     //' times the sound speed '//short(c0)//'; raise sound_speed (or lower mach)')
         else if (speed > largest_mach*c0) then
            call draft%warning(group, number, key, what//' is '//short(speed/c0)//' times the sound speed')
         end if
      end associate
   end subroutine check_speed

   !> No wave may grow from step to step: a cfl beyond the limit will not be used, or is a mistake if the user wants that.
   !!
   !! The dynamic model's coefficients are known only in the run; it shortens its steps by itself.
   subroutine check_stability(draft)
      type(draft_t), intent(inout) :: draft
      type(stability_t) :: stability
      real(dp) :: limit, delta
      character(:), allocatable :: what, advice
      logical :: damped   ! sound by diffusive terms alone, so that limits go together

      associate (scene => draft%scene, cfl => draft%scene%time%cfl, model => draft%scene%model)
         damped = scene%time%integrator == 'rk2'
         ! With a sound speed that is a guess, viscosity is no known alpha: when it is known.
         if (damped .and. scene%fluid%find_reference_speed .and. scene%fluid%viscosity > 0.0_dp) return
         stability = stability_of(scene)
         delta = constant_delta(scene)
         limit = stability%largest_cfl(delta, merge(scene%alpha_total(), 0.0_dp, damped))
         if (.not. limit > 0.0_dp) then
            advice = 'use rk4'
            if (model%diffusion == 'dynamic') advice = "use rk4, or set &model diffusion = 'constant'"
            call draft%mistake('time', 1, 'integrator', '&time integrator = '//quoted(scene%time%integrator) &
                               //' needs a constant alpha or delta that damps sound neither too weakly nor too strongly for ' &
                               //'cfl = 0.2; with '//short(scene%alpha_total())//' and '//short(delta)//': '//advice)
         else if (cfl > limit*(1.0_dp + slack)) then
            what = 'the limit of '//trim(scene%time%integrator)//' is '//rounded_down(limit)
            if (damped) then
               what = what//' with alpha = '//short(scene%alpha_total())//' and delta = '//short(delta)
            else if (limit < stability%sound) then
               what = 'with delta = '//to_text(delta)//' the limit is '//rounded_down(limit)//' = ' &
                      //rounded_down(stability%times_delta)//'/delta'
            end if
            if (cfl <= stability%sound .and. .not. damped) &
               what = what//'; lower cfl, or delta to '//rounded_down(stability%times_delta/cfl)
            call beyond_limit(draft, 'time', 'cfl', what)
         else if (model%diffusion == 'dynamic' .and. model%limit*cfl > many_times*stability%times_delta) then
            call draft%warning('model', 1, 'limit', '&model limit = '//to_text(model%limit)//' may make steps ' &
                               //short(model%limit*cfl/stability%times_delta)//' times shorter: delta_i = '//to_text(model%limit) &
                               //' is stable to cfl = '//rounded_down(stability%times_delta/model%limit)//' only')
         end if
      end associate
   end subroutine check_stability

   !> A warning or a mistake, as the user wants it.
   subroutine beyond_limit(draft, group, key, what)
      type(draft_t), intent(inout) :: draft
      character(*), intent(in) :: group, key  !! to be changed
      character(*), intent(in) :: what        !! the limit, and what to do

      associate (cfl => '&time cfl = '//to_text(draft%scene%time%cfl))
         if (draft%scene%time%beyond_limit == 'refuse') then
            call draft%notes%mistake(draft%document%place_of(group, 1, key), 'time', cfl//' is unstable: '//what)
         else
            call draft%warning(group, 1, key, cfl//' will not be used: '//what)
         end if
      end associate
   end subroutine beyond_limit

   ! What the time step of the scene may be. Its viscosity must be known.
   type(stability_t) function stability_of(scene) result(stability)
      type(settings_t), intent(in) :: scene

      stability = new_stability(new_integrator(scene%time%integrator), scene%time%diffusion == 'frozen', &
                                scene%model%smoothing_ratio, constant_delta(scene), scene%alpha_total())
   end function stability_of

   ! The delta that acts everywhere.
   pure real(dp) function constant_delta(scene) result(delta)
      type(settings_t), intent(in) :: scene

      delta = merge(scene%model%delta, 0.0_dp, scene%model%diffusion == 'constant')
   end function constant_delta

   !> Says when two viscosities act, and when the viscous limit will rule the time step.
   subroutine check_viscosity(draft)
      type(draft_t), intent(inout) :: draft
      type(stability_t) :: stability
      real(dp) :: alpha, by_model, room, factor
      character(:), allocatable :: advice, group, key

      associate (scene => draft%scene, fluid => draft%scene%fluid)
         alpha = scene%alpha_total()
         by_model = merge(scene%model%alpha, 0.0_dp, scene%model%diffusion == 'constant')
         group = 'fluid'
         key = 'viscosity'
         if (fluid%reynolds > 0.0_dp) key = 'reynolds'
         if (fluid%viscosity > 0.0_dp .and. by_model > 0.0_dp) &
            call draft%warning(group, 1, key, '&fluid viscosity and &model alpha = '//to_text(by_model)//' both act, alpha = ' &
                               //short(alpha)//' in all; set alpha = 0 for the viscosity alone')
         stability = stability_of(scene)
         room = stability%times_alpha/min(scene%time%cfl, stability%sound)
         ! All limits of rk2 go together: check_stability.
         if (scene%time%integrator == 'rk2' .or. alpha <= room*(1.0_dp + slack)) return
         if (by_model >= room .or. .not. fluid%viscosity > 0.0_dp) then
            group = 'model'
            key = 'alpha'
            advice = 'lower alpha of &model to '//rounded_down(room)
         else
            factor = (alpha - by_model)/(room - by_model)
            advice = 'not so with &scene resolution below '//rounded_down(scene%scene%resolution/factor) &
                     //' or a sound speed above '//rounded_up(fluid%sound_speed*factor)
         end if
      end associate
      ! alpha = K nu/(c0 h): the limit of alpha is one of dt nu/h**2.
      call beyond_limit(draft, group, key, 'with alpha = '//short(alpha)//', viscosity included, the viscous limit dt <= ' &
                        //rounded_down(stability%times_alpha/k_2d)//' h**2/nu is that of cfl = ' &
                        //rounded_down(stability%times_alpha/alpha)//', '//short(alpha/room)//' times as many steps; '//advice)
   end subroutine check_viscosity

   !> A run that cannot end is a slip: with more steps than can be counted, time would not even get on by one.
   subroutine check_step_number(draft)
      type(draft_t), intent(inout) :: draft
      type(stability_t) :: stability
      real(dp) :: cfl, per_step
      character(:), allocatable :: advice

      associate (scene => draft%scene, time => draft%scene%time)
         if (time%max_steps > 0) return
         stability = stability_of(scene)
         cfl = min(time%cfl, stability%largest_cfl(constant_delta(scene), scene%alpha_total()))
         per_step = cfl*scene%smoothing_length()/scene%fluid%sound_speed
         if (time%end_time <= most_steps*per_step) return
         advice = 'raise cfl, or lower end_time or the sound speed '//short(scene%fluid%sound_speed)
         if (cfl < time%cfl) advice = 'lower '//shortening_key(scene, stability)//', which makes them so short, or end_time'
         call draft%mistake('time', 1, 'end_time', '&time end_time = '//to_text(time%end_time)//' is more than ' &
                            //to_text(most_steps)//' steps of '//short(per_step)//': '//advice)
      end associate
   end subroutine check_step_number

   ! What limits the step most.
   function shortening_key(scene, stability) result(words)
      type(settings_t), intent(in) :: scene
      type(stability_t), intent(in) :: stability
      character(:), allocatable :: words

      words = 'the viscosity'
      if (scene%model%diffusion == 'constant' .and. 2.0_dp*scene%model%alpha > scene%alpha_total()) words = 'alpha of &model'
      if (stability%largest_cfl(constant_delta(scene), 0.0_dp) < stability%largest_cfl(0.0_dp, scene%alpha_total())) &
         words = 'delta of &model'
   end function shortening_key

   !> All particles must fit.
   subroutine check_particle_number(draft)
      type(draft_t), intent(inout) :: draft
      real(dp) :: particles
      integer :: i

      particles = 0.0_dp
      do i = 1, size(draft%scene%bodies)
         associate (body => draft%scene%bodies(i))
            particles = particles + product((body%upper - body%lower)/draft%scene%spacing())
         end associate
      end do
      if (particles >= most_particles) &
         call draft%mistake('scene', 1, 'resolution', '&scene resolution = '//to_text(draft%scene%scene%resolution) &
                            //' makes about '//rounded_down(particles)//' particles; at most '//to_text(most_particles) &
                            //' are possible: lower it')
   end subroutine check_particle_number

end module settings_check
