!> A plane sound wave that travels along x.
!!
!! To first order in the amplitude eps, (rho - rho0)/rho0 = eps cos(k (x - c t)) exp(-sigma t), u = c0 eps (the same), with
!! p = c0**2 (rho - rho0). In the continuum c = c0, and the viscous term of eq. 5 damps by sigma = (3/8) alpha h c0 k**2/2: it acts
!! on compression three times as on shear, and only on the velocity. The density diffusion vanishes for long waves.
!! Speed and damping on a lattice come from module `square_lattice`.
module acoustic_wave
   use columns, only: columns_t
   use equation_of_state, only: pressure_of
   use fitting, only: line_fit, unwrapped
   use kinds, only: dp
   use model, only: model_t
   use scene_needs, only: need_full_box, need_no_weight, need_one_body, needs_t
   use settings, only: body_settings, settings_t
   use solution, only: n_sums, solution_t
   use solution_results, only: history_t, last, log_fit, result_t, share
   use square_lattice, only: lattice_sound, sound_t
   implicit none
   private

   public :: sound_wave_t, continuum_damping, acoustic_wave_solution_t, acoustic_wave_solution

   real(dp), parameter :: pi = acos(-1.0_dp)

   !> A wave of given speed and damping.
   type :: sound_wave_t
      real(dp) :: k = 1             !! wave number
      real(dp) :: compression = 0   !! eps
      real(dp) :: c0 = 1            !! speed that relates velocity and compression
      real(dp) :: speed = 1         !! c
      real(dp) :: damping = 0       !! sigma
   contains
      procedure :: density
      procedure :: velocity
   end type sound_wave_t

   !> A wave that fills the scene's box.
   type, extends(solution_t) :: acoustic_wave_solution_t
      type(sound_wave_t) :: sound     !! of the continuum
      type(sound_wave_t) :: lattice   !! with speed and damping of the lattice
   contains
      procedure :: add_needs
      procedure :: set_up
      procedure :: start_speed
      procedure :: velocity => velocity_in_box
      procedure :: lattice_velocity
      procedure :: pressure
      procedure :: terms
      procedure :: add_columns
      procedure :: results
   end type acoustic_wave_solution_t

contains

   !> (rho - rho0)/rho0 at a place.
   elemental real(dp) function density(self, x, time)
      class(sound_wave_t), intent(in) :: self
      real(dp), intent(in) :: x, time

      density = self%compression*cos(self%k*(x - self%speed*time))*exp(-self%damping*time)
   end function density

   !> Velocity along x at a place.
   elemental real(dp) function velocity(self, x, time)
      class(sound_wave_t), intent(in) :: self
      real(dp), intent(in) :: x, time

      velocity = self%c0*self%density(x, time)
   end function velocity

   !> sigma of long waves.
   elemental real(dp) function continuum_damping(alpha, h, c0, k) result(damping)
      real(dp), intent(in) :: alpha, h, c0
      real(dp), intent(in) :: k   !! wave number
      real(dp), parameter :: compression = 3.0_dp/8

      damping = compression*alpha*h*c0*k**2/2
   end function continuum_damping

   pure type(acoustic_wave_solution_t) function acoustic_wave_solution() result(self)
      self%has_amplitude = .true.
      self%has_waves = .true.
      self%by_lattice = .true.
   end function acoustic_wave_solution

   ! A box that is full of fluid and goes on for ever along x.
   subroutine add_needs(self, scene, needs)
      class(acoustic_wave_solution_t), intent(in) :: self
      type(settings_t), intent(in) :: scene
      type(needs_t), intent(inout) :: needs

      call need_no_weight(scene, needs)
      associate (domain => scene%domain)
         call needs%unless(domain%left == 'periodic', "left = 'periodic' and right = 'periodic'", 'domain', 'left')
         call needs%unless(all(scene%side_kinds() == 'free_slip' .or. scene%side_kinds() == 'periodic'), &
                           "bottom and top that are 'free_slip' or 'periodic'", 'domain', 'bottom')
         call needs%unless(abs(scene%exact%amplitude) < 0.1_dp, &
                           'an amplitude between -0.1 and 0.1: it is a share of the density', 'exact', 'amplitude')
         call needs%unless(all(scene%bodies%pressure == 'exact'), "&body pressure = 'exact', or it does not travel", &
                           'body', 'pressure')
      end associate
      call need_one_body(scene, 'rectangle', needs)
      call need_full_box(scene, needs)
      ! The speed of sound on a lattice is worked out along its rows.
      call needs%unless(all(scene%bodies%lattice == 'aligned'), "lattice = 'aligned'", 'body', 'lattice')
   end subroutine add_needs

   subroutine set_up(self, scene, model)
      class(acoustic_wave_solution_t), intent(inout) :: self
      type(settings_t), intent(in) :: scene
      type(model_t), intent(in) :: model
      type(sound_t) :: sound
      real(dp) :: k

      k = 2*pi*scene%exact%waves/self%extent(1)
      self%sound = sound_wave_t(k=k, compression=self%amplitude, c0=model%c0, speed=model%c0, &
                                damping=continuum_damping(model%alpha, model%kernel%h, model%c0, k))
      sound = lattice_sound(model%kernel%h/model%dx, k*model%dx)
      self%lattice = self%sound
      self%lattice%speed = sound%speed*model%c0
      self%lattice%damping = (model%delta*sound%s_delta + model%alpha*sound%s_alpha)*model%c0/model%dx
      self%speed_scale = model%c0*abs(self%amplitude)
      self%pressure_scale = model%c0**2*model%rho0*abs(self%amplitude)
   end subroutine set_up

   pure real(dp) function start_speed(self, scene, body) result(speed)
      class(acoustic_wave_solution_t), intent(in) :: self
      type(settings_t), intent(in) :: scene
      type(body_settings), intent(in) :: body

      speed = abs(scene%exact%amplitude)*scene%fluid%sound_speed
   end function start_speed

   pure function velocity_in_box(self, position) result(u)
      class(acoustic_wave_solution_t), intent(in) :: self
      real(dp), intent(in) :: position(2)
      real(dp) :: u(2)

      u = [self%sound%velocity(position(1) - self%origin(1), self%time), 0.0_dp]
   end function velocity_in_box

   pure function lattice_velocity(self, position) result(u)
      class(acoustic_wave_solution_t), intent(in) :: self
      real(dp), intent(in) :: position(2)
      real(dp) :: u(2)

      u = [self%lattice%velocity(position(1) - self%origin(1), self%time), 0.0_dp]
   end function lattice_velocity

   pure real(dp) function pressure(self, position) result(p)
      class(acoustic_wave_solution_t), intent(in) :: self
      real(dp), intent(in) :: position(2)

      p = pressure_of(self%c0, self%rho0*self%sound%density(position(1) - self%origin(1), self%time))
   end function pressure

   ! Fourier coefficient of the density.
   pure function terms(self, r, u, s, w, m)
      class(acoustic_wave_solution_t), intent(in) :: self
      real(dp), intent(in) :: r(2), u(2), s, w, m
      real(dp) :: terms(n_sums)

      terms = 0
      terms(1:2) = w*s*[cos(self%sound%k*r(1)), sin(self%sound%k*r(1))]
   end function terms

   subroutine add_columns(self, now, first, fastest, row)
      class(acoustic_wave_solution_t), intent(in) :: self
      real(dp), intent(in) :: now(n_sums), first(n_sums), fastest
      type(columns_t), intent(inout) :: row
      character(*), parameter :: radian = 'radian, -pi to pi'

      associate (t => self%time, sound => self%sound, on => self%lattice)
         call row%add('mode', 'share of mode at t = 0', norm2(now(1:2))/norm2(first(1:2)))
         call row%add('mode_exact', 'share of mode at t = 0', exp(-sound%damping*t))
         call row%add('mode_lattice', 'share of mode at t = 0', exp(-on%damping*t))
         call row%add('phase', radian, phase(now(1), now(2)))
         call row%add('phase_exact', radian, turned(sound%k*sound%speed*t))
         call row%add('phase_lattice', radian, turned(on%k*on%speed*t))
      end associate
   end subroutine add_columns

   ! Angle of a point, 0 for the origin.
   pure real(dp) function phase(x, y)
      real(dp), intent(in) :: x, y

      phase = 0
      if (abs(x) + abs(y) > 0) phase = atan2(y, x)
   end function phase

   ! An angle between -pi and pi.
   pure real(dp) function turned(angle)
      real(dp), intent(in) :: angle

      turned = angle - 2*pi*nint(angle/(2*pi))
   end function turned

   ! Slopes of the phase and of the mode's logarithm, over at least a period.
   function results(self, history)
      class(acoustic_wave_solution_t), intent(in) :: self
      type(history_t), intent(in) :: history
      type(result_t), allocatable :: results(:)
      real(dp) :: offset, rate, slope
      logical :: found(2), long

      associate (exact => self%sound, on => self%lattice, times => history%times)
         long = (last(times) - times(1))*exact%k*exact%speed >= 2*pi
         call line_fit(times, unwrapped(history%column('phase')), offset, rate, found(1))
         call log_fit(times, history%column('mode'), offset, slope, found(2))
         found = found .and. long
         results = [result_t('acoustic_speed', rate/exact%k, found(1)), &
                    share('acoustic_speed_over_c0', rate/exact%k, exact%speed, found(1)), &
                    share('acoustic_speed_over_lattice', rate/exact%k, on%speed, found(1)), &
                    result_t('acoustic_damping', -slope, found(2)), &
                    share('acoustic_damping_over_lattice', -slope, on%damping, found(2))]
      end associate
   end function results

end module acoustic_wave
