!> A standing gravity wave of small height over a flat floor.
!!
!! Source: Antuono & Colagrossi, Int. J. Numer. Methods Fluids 72 (2013): potential flow of a wave with a flat surface at
!! t = 0, whose amplitude decays as exp(-b t). With w**2 = g k tanh(kH) and B = eps g H/(2 w),
!!
!!     u =  B k cosh(ky)/cosh(kH) sin(kx) cos(wt) exp(-b t)
!!     v = -B k sinh(ky)/cosh(kH) cos(kx) cos(wt) exp(-b t)
!!
!! b = 2 nu k**2 is the decay to first order in nu. The next order, the vortical layer under the surface, takes
!! 1/sqrt(2) sqrt(nu k**2/w) of it: 11 % at nu k**2/w = 0.022. So b is taken from Lamb's linear theory of viscous waves
!! (Hydrodynamics, art. 349), with s = (-b + i w')/w and d = nu k**2/w:
!!
!!     (s + 2d)**2 + 1 = 4 d**2 sqrt(1 + s/d)
!!
!! It is for deep water; the layer is thin, and with w of finite depth it holds as long as tanh(kH) is near 1.
!! y from the floor, x from a side wall. To first order in eps the pressure is rho g (H - y) - rho B w cosh(ky)/cosh(kH)
!! cos(kx) sin(wt) exp(..): hydrostatic at t = 0, where all the energy is kinetic.
module standing_wave
   use columns, only: columns_t
   use fitting, only: fit_oscillation, oscillation_t
   use hydrostatics, only: hydrostatic_pressure
   use kinds, only: dp
   use model, only: model_t
   use scene_needs, only: need_water_on_floor, needs_t
   use settings, only: choice_length, settings_t, side_names
   use solution, only: n_sums, solution_t
   use solution_results, only: history_t, mean_between, result_t, share, time_mean
   implicit none
   private

   public :: standing_wave_t, new_standing_wave, viscous_root
   public :: standing_wave_solution_t, standing_wave_solution

   real(dp), parameter :: pi = acos(-1.0_dp)
   real(dp), parameter :: largest_shift = 0.1_dp   ! of the frequency, to which second order may say something

   !> A wave of given geometry.
   type :: standing_wave_t
      real(dp) :: k = 1           !! wave number
      real(dp) :: depth = 1       !! H
      real(dp) :: gravity = 1
      real(dp) :: height = 0      !! eps = wave height/H
      real(dp) :: frequency = 1   !! w
      real(dp) :: first_order_decay = 0   !! 2 nu k**2
      real(dp) :: decay = 0       !! b, of the amplitude
   contains
      procedure :: velocity
      procedure :: dynamic_pressure
      procedure :: kinetic_energy
      procedure :: amplitude
      procedure :: frequency_shift
   end type standing_wave_t

   !> The wave of a tank: on the floor of the box, from side to side, the surface at the upper edge of the body.
   type, extends(solution_t) :: standing_wave_solution_t
      type(standing_wave_t) :: wave      !! of the continuum
      type(standing_wave_t) :: lattice   !! with the lattice's viscosity
   contains
      procedure :: add_needs
      procedure :: set_up
      procedure :: velocity => velocity_in_tank
      procedure :: pressure
      procedure :: terms
      procedure :: add_columns
      procedure :: results
   end type standing_wave_solution_t

contains

   !> The wave over a floor `depth` below the surface.
   pure type(standing_wave_t) function new_standing_wave(k, depth, gravity, height, viscosity) result(self)
      real(dp), intent(in) :: k, depth, gravity
      real(dp), intent(in) :: height      !! eps, wave height/depth
      real(dp), intent(in) :: viscosity   !! kinematic, nu

      self = standing_wave_t(k=k, depth=depth, gravity=gravity, height=height, frequency=sqrt(gravity*k*tanh(k*depth)), &
                             first_order_decay=2*viscosity*k**2)
      if (viscosity > 0) self%decay = -self%frequency*real(viscous_root(viscosity*k**2/self%frequency), dp)
   end function new_standing_wave

   !> Root s of (s + 2d)**2 + 1 = 4 d**2 sqrt(1 + s/d) that tends to i - 2d for small d > 0, by Newton's method.
   elemental complex(dp) function viscous_root(d) result(s)
      real(dp), intent(in) :: d   !! nu k**2/w; beyond about 0.5 waves don't oscillate any more
      complex(dp) :: root, change
      integer :: n

      s = cmplx(-2*d, 1.0_dp, dp)
      do n = 1, 50
         root = sqrt(1 + s/d)
         change = ((s + 2*d)**2 + 1 - 4*d**2*root)/(2*(s + 2*d) - 2*d/root)
         s = s - change
         if (abs(change) < 1.0e-14_dp) exit
      end do
   end function viscous_root

   !> Velocity as a share of its first value: cos(wt) exp(-b t).
   elemental real(dp) function amplitude(self, time)
      class(standing_wave_t), intent(in) :: self
      real(dp), intent(in) :: time

      amplitude = cos(self%frequency*time)*exp(-self%decay*time)
   end function amplitude

   !> Velocity at a place.
   pure function velocity(self, x, y, time) result(u)
      class(standing_wave_t), intent(in) :: self
      real(dp), intent(in) :: x, y   !! from a side wall, from the floor
      real(dp), intent(in) :: time
      real(dp) :: u(2)

      u = self%height*self%gravity*self%depth*self%k/(2*self%frequency)*self%amplitude(time) &
          *[cosh(self%k*y)*sin(self%k*x), -sinh(self%k*y)*cos(self%k*x)]/cosh(self%k*self%depth)
   end function velocity

   !> (p - rho g (H - y))/rho at a place.
   elemental real(dp) function dynamic_pressure(self, x, y, time) result(p)
      class(standing_wave_t), intent(in) :: self
      real(dp), intent(in) :: x, y   !! from a side wall, from the floor
      real(dp), intent(in) :: time

      p = -self%height*self%gravity*self%depth/2*cosh(self%k*y)/cosh(self%k*self%depth)*cos(self%k*x) &
          *sin(self%frequency*time)*exp(-self%decay*time)
   end function dynamic_pressure

   !> E_K/rho = eps**2 g L H**2/32 exp(-2 b t) (1 + cos 2wt) of a tank L wide.
   elemental real(dp) function kinetic_energy(self, width, time) result(energy)
      class(standing_wave_t), intent(in) :: self
      real(dp), intent(in) :: width   !! L, a multiple of half a wavelength
      real(dp), intent(in) :: time

      energy = self%height**2*self%gravity*width*self%depth**2/16*self%amplitude(time)**2
   end function kinetic_energy

   !> Share by which the wave's height shifts its frequency, to second order in ka = eps kH/2. With T = tanh(kH)
   !!
   !!     w/sqrt(g k T) - 1 = (ka)**2 (9/T**4 - 12/T**2 - 3 - 2 T**2)/64
   !!
   !! Source: Tadjbakhsh & Keller, J. Fluid Mech. 8 (1960) 442-451. In deep water it is -(ka)**2/8 (Rayleigh 1915), 0 at kH = 1.06.
   elemental real(dp) function frequency_shift(self) result(shift)
      class(standing_wave_t), intent(in) :: self
      real(dp) :: t2

      t2 = tanh(self%k*self%depth)**2
      shift = (self%height*self%k*self%depth/2)**2*(9/t2**2 - 12/t2 - 3 - 2*t2)/64
   end function frequency_shift

   pure type(standing_wave_solution_t) function standing_wave_solution() result(self)
      self%has_amplitude = .true.
      self%has_waves = .true.
   end function standing_wave_solution

   subroutine add_needs(self, scene, needs)
      class(standing_wave_solution_t), intent(in) :: self
      type(settings_t), intent(in) :: scene
      type(needs_t), intent(inout) :: needs
      character(choice_length) :: kinds_there(4)
      integer :: i

      call needs%unless(scene%fluid%gravity > 0.0_dp, 'gravity above 0', 'fluid', 'gravity')
      kinds_there = scene%side_kinds()
      call needs%unless(abs(scene%exact%amplitude) < 1.0_dp, 'an amplitude between -1 and 1: it is wave height/depth', &
                        'exact', 'amplitude')
      do i = 1, 3
         call needs%unless(kinds_there(i) == 'free_slip' .or. (kinds_there(i) == 'periodic' .and. i < 3), &
                           trim(side_names(i))//" = 'free_slip'", 'domain', trim(side_names(i)))
      end do
      call need_water_on_floor(scene, needs)
   end subroutine add_needs

   subroutine set_up(self, scene, model)
      class(standing_wave_solution_t), intent(inout) :: self
      type(settings_t), intent(in) :: scene
      type(model_t), intent(in) :: model
      real(dp) :: k, lattice_viscosity

      self%extent(2) = scene%bodies(1)%upper(2) - self%origin(2)
      k = 2*pi*scene%exact%waves/self%extent(1)
      lattice_viscosity = self%viscosity(model, share_on_lattice(self, model, k))
      self%wave = new_standing_wave(k, self%extent(2), self%gravity, self%amplitude, self%viscosity(model))
      self%lattice = new_standing_wave(k, self%extent(2), self%gravity, self%amplitude, lattice_viscosity)
      self%pressure_scale = self%rho0*self%gravity*self%extent(2)
      associate (w => self%wave)
         self%speed_scale = abs(w%height)*w%gravity*w%depth*k/(2*w%frequency)
      end associate
   end subroutine set_up

   !> nu/(alpha h c0) on a lattice: the wave strains along the axes (as a wave on the diagonal does) with cosh(ky)**2 and shears
   !! with sinh(ky)**2; both dissipate in proportion to their integrals over depth.
   pure real(dp) function share_on_lattice(self, model, k) result(coefficient)
      type(standing_wave_solution_t), intent(in) :: self
      type(model_t), intent(in) :: model
      real(dp), intent(in) :: k
      real(dp) :: strain, shear

      associate (depth => self%extent(2))
         ! Both divided by cosh(2 k depth)/(2 k); of deep water both are the same.
         strain = tanh(2*k*depth) + 2*k*depth/cosh(min(2*k*depth, 300.0_dp))
         shear = tanh(2*k*depth) - 2*k*depth/cosh(min(2*k*depth, 300.0_dp))
      end associate
      coefficient = (strain*self%lattice_shear(model, [1.0_dp, 1.0_dp], sqrt(2.0_dp)*k*model%dx) &
                     + shear*self%lattice_shear(model, [1.0_dp, 0.0_dp], k*model%dx))/(strain + shear)
   end function share_on_lattice

   pure function velocity_in_tank(self, position) result(u)
      class(standing_wave_solution_t), intent(in) :: self
      real(dp), intent(in) :: position(2)
      real(dp) :: u(2)

      associate (r => position - self%origin)
         u = self%wave%velocity(r(1), r(2), self%time)
      end associate
   end function velocity_in_tank

   pure real(dp) function pressure(self, position) result(p)
      class(standing_wave_solution_t), intent(in) :: self
      real(dp), intent(in) :: position(2)

      associate (r => position - self%origin)
         p = hydrostatic_pressure(self%extent(2) - r(2), self%rho0, self%c0, self%gravity) &
             + self%rho0*self%wave%dynamic_pressure(r(1), r(2), self%time)
      end associate
   end function pressure

   ! Projection on the velocity of t = 0, and kinetic energy.
   pure function terms(self, r, u, s, w, m)
      class(standing_wave_solution_t), intent(in) :: self
      real(dp), intent(in) :: r(2), u(2), s, w, m
      real(dp) :: terms(n_sums), mode(2)

      mode = self%wave%velocity(r(1), r(2), 0.0_dp)
      terms = 0
      terms(1:3) = [w*dot_product(u, mode), w*dot_product(mode, mode), m*dot_product(u, u)/2]
   end function terms

   subroutine add_columns(self, now, first, fastest, row)
      class(standing_wave_solution_t), intent(in) :: self
      real(dp), intent(in) :: now(n_sums), first(n_sums), fastest
      type(columns_t), intent(inout) :: row

      call row%add('mode', 'share of mode at t = 0', now(1)/now(2))
      call row%add('mode_exact', 'share of mode at t = 0', self%wave%amplitude(self%time))
      call row%add('E_K', 'energy/width', now(3))
      call row%add('E_K_exact', 'energy/width', self%rho0*self%wave%kinetic_energy(self%extent(1), self%time))
   end subroutine add_columns

   ! Frequency and decay of the oscillation. Of second order the frequency goes with the energy, here its mean over the run.
   function results(self, history)
      class(standing_wave_solution_t), intent(in) :: self
      type(history_t), intent(in) :: history
      type(result_t), allocatable :: results(:)
      type(oscillation_t) :: fit
      logical :: found
      real(dp) :: shift

      associate (exact => self%wave)
         call fit_oscillation(history%times, history%column('mode'), exact%frequency, fit, found)
         shift = exact%frequency_shift()*time_mean(history%times, exp(-2*fit%decay*history%times))
         results = [result_t('standing_wave_frequency', fit%frequency, found), &
                    result_t('standing_wave_frequency_error', fit%frequency/exact%frequency - 1, found), &
                    result_t('standing_wave_frequency_error_2nd_order', fit%frequency/(exact%frequency*(1 + shift)) - 1, &
                             found .and. abs(shift) < largest_shift), &
                    result_t('standing_wave_decay_rate', fit%decay, found), &
                    share('standing_wave_decay_over_first_order', fit%decay, exact%first_order_decay, found), &
                    share('standing_wave_decay_over_exact', fit%decay, exact%decay, found), &
                    share('standing_wave_decay_over_lattice', fit%decay, self%lattice%decay, found), &
                    loss_a_period(history, fit%frequency, found)]
      end associate
   end function results

   ! Share of the energy that is lost in a period, between the first and the last whole one of the run: of the energy E_K has one
   ! half on average.
   type(result_t) function loss_a_period(history, frequency, found) result(loss)
      type(history_t), intent(in) :: history
      real(dp), intent(in) :: frequency
      logical, intent(in) :: found   ! the frequency is known
      real(dp) :: first, last, period
      integer :: n

      loss = result_t('standing_wave_loss_a_period', 0.0_dp, .false.)
      if (.not. found) return
      period = 2*pi/frequency
      n = int(history%times(size(history%times))/period)
      if (n < 2) return
      first = mean_between(history%times, history%column('E_K'), 0.0_dp, period)
      last = mean_between(history%times, history%column('E_K'), (n - 1)*period, n*period)
      loss%known = min(first, last) > 0
      if (loss%known) loss%value = 1 - (last/first)**(1.0_dp/(n - 1))
   end function loss_a_period

end module standing_wave
