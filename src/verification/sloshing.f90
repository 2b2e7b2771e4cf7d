!> Small waves in a tank that begins to sway: potential flow to first order in its amplitude.
!!
!! Source: ours, by the textbook's method. In the tank, whose shift is A sin(wt) along x, the force f = A w**2 sin(wt) acts besides
!! gravity. Of x, from the left wall,
!!
!!     x - L/2 = -sum over odd n of c_n cos(k_n x),   k_n = n pi/L,   c_n = 4 L/(n pi)**2
!!
!! so the potential is a sum of the same modes, phi = sum phi_n cos(k_n x) cosh(k_n y)/cosh(k_n h). At the surface, which is at
!! h + eta,
!!
!!     phi_n' = -g eta_n - c_n f,   eta_n' = k_n tanh(k_n h) phi_n,   hence   phi_n'' + w_n**2 phi_n = -c_n f'
!!
!! with w_n**2 = g k_n tanh(k_n h). At t = 0 the surface is flat and the fluid at rest in the tank - it moves with it, no wall has
!! to set it going - so that phi_n = phi_n' = 0:
!!
!!     phi_n = -c_n A w**3 (cos(wt) - cos(w_n t))/(w_n**2 - w**2)
!!     p = rho g (h - y) + rho (f (x - L/2) - d phi/dt)
module sloshing
   use columns, only: columns_t
   use fitting, only: fit_oscillation, oscillation_t
   use hydrostatics, only: hydrostatic_pressure
   use kinds, only: dp
   use model, only: model_t
   use scene_needs, only: need_rest, need_water_on_floor, needs_t
   use settings, only: choice_length, settings_t, side_names
   use solution, only: n_sums, solution_t
   use solution_results, only: history_t, result_t
   implicit none
   private

   public :: sloshing_t, new_sloshing, sloshing_solution_t, without_period

   integer, parameter :: n_modes = 60               ! odd ones; what is left out is a share of 1/240 of u at the surface
   real(dp), parameter :: pi = acos(-1.0_dp)
   real(dp), parameter :: nearest = 0.02_dp         ! share of w_1**2 that the speed's scale takes w**2 to be away from it at least
   real(dp), parameter :: least_left = 0.2_dp       ! of the free wave where the forced one is taken off

   !> The flow in a tank at a time.
   type :: sloshing_t
      real(dp) :: width = 1, depth = 1   !! L, h [m]
      real(dp) :: gravity = 1            !! [m/s2]
      real(dp) :: amplitude = 0          !! A [m]
      real(dp) :: forced = 1             !! w [1/s]
      real(dp) :: force = 0              !! f at the time [m/s2]
      real(dp) :: phi(n_modes) = 0       !! phi_n, n = 1, 3, 5... [m2/s]
      real(dp) :: rate(n_modes) = 0      !! phi_n' [m2/s2]
   contains
      procedure :: move_to
      procedure :: wave_number
      procedure :: frequency
      procedure :: velocity
      procedure :: dynamic_pressure
      procedure :: kinetic_energy
      procedure :: largest_speed
   end type sloshing_t

   !> Water on the floor of the box, from side to side.
   type, extends(solution_t) :: sloshing_solution_t
      type(sloshing_t) :: flow
   contains
      procedure :: add_needs
      procedure :: set_up
      procedure :: move_to => move_solution_to
      procedure :: velocity => velocity_in_tank
      procedure :: pressure
      procedure :: terms
      procedure :: add_columns
      procedure :: results
   end type sloshing_solution_t

contains

   !> The flow at t = 0.
   pure type(sloshing_t) function new_sloshing(width, depth, gravity, amplitude, period) result(self)
      real(dp), intent(in) :: width, depth   !! [m]
      real(dp), intent(in) :: gravity        !! > 0 [m/s2]
      real(dp), intent(in) :: amplitude      !! of the tank's shift along x [m]
      real(dp), intent(in) :: period         !! > 0 [s]

      self%width = width
      self%depth = depth
      self%gravity = gravity
      self%amplitude = amplitude
      self%forced = 2*pi/period
   end function new_sloshing

   !> Takes the modes to a time.
   pure subroutine move_to(self, time)
      class(sloshing_t), intent(inout) :: self
      real(dp), intent(in) :: time   !! [s]
      real(dp) :: free, total, difference, c, sine, cosine
      integer :: n

      self%force = self%amplitude*self%forced**2*sin(self%forced*time)
      do n = 1, n_modes
         free = self%frequency(2*n - 1)
         c = 4*self%width/((2*n - 1)*pi)**2
         ! cos(wt) - cos(w_n t) over w_n**2 - w**2 as a product, which resonance leaves finite; and its derivative.
         total = free + self%forced
         difference = free - self%forced
         sine = sin(total*time/2)
         cosine = cos(total*time/2)
         self%phi(n) = -c*self%amplitude*self%forced**3*2*sine/total*sine_over(difference, time)
         self%rate(n) = -c*self%amplitude*self%forced**3*(cosine*sine_over(difference, time) + sine/total*cos(difference*time/2))
      end do
   end subroutine move_to

   ! sin(d t/2)/d
   elemental real(dp) function sine_over(d, time)
      real(dp), intent(in) :: d, time

      if (abs(d*time) > 1.0e-6_dp) then
         sine_over = sin(d*time/2)/d
      else
         sine_over = time/2
      end if
   end function sine_over

   !> k_n [1/m].
   elemental real(dp) function wave_number(self, n)
      class(sloshing_t), intent(in) :: self
      integer, intent(in) :: n

      wave_number = n*pi/self%width
   end function wave_number

   !> w_n of the free wave [1/s].
   elemental real(dp) function frequency(self, n)
      class(sloshing_t), intent(in) :: self
      integer, intent(in) :: n

      frequency = sqrt(self%gravity*self%wave_number(n)*tanh(self%wave_number(n)*self%depth))
   end function frequency

   ! cos(k_n x) + i sin(k_n x) times exp(k_n (y - h)) and exp(-k_n (y + h)), both over 1 + exp(-2 k_n h), for all modes: their sum
   ! and difference are cosh and sinh(k_n y)/cosh(k_n h), which do not overflow. Above the still surface modes are as at it.
   pure subroutine shapes(self, x, y, n_shapes, rising, falling)
      type(sloshing_t), intent(in) :: self
      real(dp), intent(in) :: x, y
      integer, intent(in) :: n_shapes
      complex(dp), intent(out) :: rising(n_shapes), falling(n_shapes)
      complex(dp) :: up, down
      real(dp) :: k, height
      integer :: n

      k = self%wave_number(1)
      height = min(y, self%depth)
      up = exp(cmplx(k*(height - self%depth), k*x, dp))
      down = exp(cmplx(-k*(height + self%depth), k*x, dp))
      rising(1) = up
      falling(1) = down
      do n = 2, n_shapes
         rising(n) = rising(n - 1)*up**2
         falling(n) = falling(n - 1)*down**2
      end do
      do n = 1, n_shapes
         rising(n) = rising(n)/(1 + exp(-2*(2*n - 1)*k*self%depth))
         falling(n) = falling(n)/(1 + exp(-2*(2*n - 1)*k*self%depth))
      end do
   end subroutine shapes

   !> Velocity at a place, as the tank sees it [m/s].
   pure function velocity(self, x, y) result(u)
      class(sloshing_t), intent(in) :: self
      real(dp), intent(in) :: x, y   !! from the left wall, from the floor [m]
      real(dp) :: u(2)
      complex(dp) :: rising(n_modes), falling(n_modes)
      integer :: n

      call shapes(self, x, y, n_modes, rising, falling)
      u = 0
      do n = 1, n_modes
         u = u + self%phi(n)*self%wave_number(2*n - 1)*[-aimag(rising(n) + falling(n)), real(rising(n) - falling(n), dp)]
      end do
   end function velocity

   !> (p - rho g (h - y))/rho at a place [m2/s2].
   pure real(dp) function dynamic_pressure(self, x, y) result(p)
      class(sloshing_t), intent(in) :: self
      real(dp), intent(in) :: x, y   !! from the left wall, from the floor [m]
      complex(dp) :: rising(n_modes), falling(n_modes)

      call shapes(self, x, y, n_modes, rising, falling)
      p = self%force*(x - self%width/2) - sum(self%rate*real(rising + falling, dp))
   end function dynamic_pressure

   !> E_K/rho [m4/s2].
   pure real(dp) function kinetic_energy(self) result(energy)
      class(sloshing_t), intent(in) :: self
      real(dp) :: k(n_modes)
      integer :: n

      k = [(self%wave_number(2*n - 1), n=1, n_modes)]
      energy = sum(self%phi**2*k*tanh(k*self%depth))*self%width/4
   end function kinetic_energy

   !> Largest speed of the first mode over a beat [m/s]; near resonance that of a beat at `nearest`.
   pure real(dp) function largest_speed(self)
      class(sloshing_t), intent(in) :: self
      real(dp) :: free2

      free2 = self%frequency(1)**2
      largest_speed = 8/pi*abs(self%amplitude)*self%forced**3/max(abs(free2 - self%forced**2), nearest*free2)
   end function largest_speed

   subroutine add_needs(self, scene, needs)
      class(sloshing_solution_t), intent(in) :: self
      type(settings_t), intent(in) :: scene
      type(needs_t), intent(inout) :: needs
      character(choice_length) :: kinds_there(4)
      integer :: i

      call needs%unless(scene%fluid%gravity > 0.0_dp, 'gravity above 0', 'fluid', 'gravity')
      kinds_there = scene%side_kinds()
      do i = 1, 3
         call needs%unless(kinds_there(i) == 'free_slip', trim(side_names(i))//" = 'free_slip'", 'domain', trim(side_names(i)))
      end do
      associate (tank => scene%tank)
         call needs%unless(tank%motion == 'oscillation', "a tank that sways: motion = 'oscillation'", 'tank', 'motion')
         if (tank%motion == 'oscillation') then
            call needs%unless(abs(tank%amplitude(1)) > 0 .and. .not. abs(tank%amplitude(2)) > 0, &
                              'a tank that sways along x: amplitude = 0.002, 0', 'tank', 'amplitude')
            call needs%unless(.not. abs(tank%swing) > 0, 'a tank that does not turn: swing = 0', 'tank', 'swing')
            call needs%unless(.not. abs(tank%phase) > 0, 'phase = 0', 'tank', 'phase')
            call needs%unless(.not. tank%ramp > 0, 'ramp = 0', 'tank', 'ramp')
         end if
      end associate
      call need_rest(scene, needs)
      call need_water_on_floor(scene, needs)
   end subroutine add_needs

   subroutine set_up(self, scene, model)
      class(sloshing_solution_t), intent(inout) :: self
      type(settings_t), intent(in) :: scene
      type(model_t), intent(in) :: model

      self%extent(2) = scene%bodies(1)%upper(2) - self%origin(2)
      self%flow = new_sloshing(self%extent(1), self%extent(2), self%gravity, scene%tank%amplitude(1), scene%tank%period)
      self%pressure_scale = self%rho0*self%gravity*self%extent(2)
      self%speed_scale = self%flow%largest_speed()
   end subroutine set_up

   pure subroutine move_solution_to(self, time)
      class(sloshing_solution_t), intent(inout) :: self
      real(dp), intent(in) :: time

      self%time = time
      call self%flow%move_to(time)
   end subroutine move_solution_to

   pure function velocity_in_tank(self, position) result(u)
      class(sloshing_solution_t), intent(in) :: self
      real(dp), intent(in) :: position(2)
      real(dp) :: u(2)

      associate (r => position - self%origin)
         u = self%flow%velocity(r(1), r(2))
      end associate
   end function velocity_in_tank

   pure real(dp) function pressure(self, position) result(p)
      class(sloshing_solution_t), intent(in) :: self
      real(dp), intent(in) :: position(2)

      associate (r => position - self%origin)
         p = hydrostatic_pressure(self%extent(2) - r(2), self%rho0, self%c0, self%gravity) &
             + self%rho0*self%flow%dynamic_pressure(r(1), r(2))
      end associate
   end function pressure

   ! Projection on the first mode, which has speed 1 in the middle of the surface, and kinetic energy.
   pure function terms(self, r, u, s, w, m)
      class(sloshing_solution_t), intent(in) :: self
      real(dp), intent(in) :: r(2), u(2), s, w, m
      real(dp) :: terms(n_sums), mode(2)
      complex(dp) :: rising(1), falling(1)

      call shapes(self%flow, r(1), r(2), 1, rising, falling)
      mode = [aimag(rising(1) + falling(1)), -real(rising(1) - falling(1), dp)]
      terms = 0
      terms(1:3) = [w*dot_product(u, mode), w*dot_product(mode, mode), m*dot_product(u, u)/2]
   end function terms

   subroutine add_columns(self, now, first, fastest, row)
      class(sloshing_solution_t), intent(in) :: self
      real(dp), intent(in) :: now(n_sums), first(n_sums), fastest
      type(columns_t), intent(inout) :: row

      call row%add('mode', 'speed', now(1)/now(2))
      call row%add('mode_exact', 'speed', -self%flow%wave_number(1)*self%flow%phi(1))
      call row%add('E_K', 'energy/width', now(3))
      call row%add('E_K_exact', 'energy/width', self%rho0*self%flow%kinetic_energy())
   end subroutine add_columns

   ! Frequency and decay of the free wave. With the mode of half the tank's period later added, what the tank drives cancels; a
   ! free wave is left with a share of 2 |cos(w_1 T/4)|.
   function results(self, history)
      class(sloshing_solution_t), intent(in) :: self
      type(history_t), intent(in) :: history
      type(result_t), allocatable :: results(:)
      real(dp), allocatable :: times(:), values(:)
      type(oscillation_t) :: fit
      real(dp) :: exact, half
      logical :: found

      exact = self%flow%frequency(1)
      half = pi/self%flow%forced
      call without_period(history%times, history%column('mode'), half, times, values)
      call fit_oscillation(times, values, exact, fit, found)
      found = found .and. 2*abs(cos(exact*half/2)) > least_left
      results = [result_t('sloshing_frequency', fit%frequency, found), &
                 result_t('sloshing_frequency_error', fit%frequency/exact - 1, found), &
                 result_t('sloshing_decay_rate', fit%decay, found)]
   end function results

   !> y(t) + y(t + half) of samples: without the oscillation of period 2 half.
   pure subroutine without_period(t, y, half, times, values)
      real(dp), intent(in) :: t(:), y(:)                        !! (samples), t rising [s]
      real(dp), intent(in) :: half                              !! > 0 [s]
      real(dp), allocatable, intent(out) :: times(:), values(:) !! at those samples that have one half a period later
      integer :: i, n, next

      n = count(t + half <= t(size(t)))
      allocate (times(n), values(n))
      next = 2
      do i = 1, n
         do while (t(next) < t(i) + half)
            next = next + 1
         end do
         times(i) = t(i)
         values(i) = y(i) + y(next) + (y(next - 1) - y(next))*(t(next) - (t(i) + half))/(t(next) - t(next - 1))
      end do
   end subroutine without_period

end module sloshing
