!> The exact solution that a scene follows: its velocity and pressure at a time, by the solution's name.
!!
!! One object is made from the scene; it answers for initial fields and for errors alike. Where each solution lives
!! in the scene (box, body, force) is said in docs/scenes.md. The formulas are in the modules of floor math.
module exact_solution
   use acoustic_wave, only: continuum_damping, sound_wave_t
   use channel_flow, only: channel_t
   use hydrostatics, only: hydrostatic_pressure
   use kinds, only: dp
   use model, only: model_t
   use oscillating_drop, only: drop_t, new_drop
   use rectangle_impact, only: lost_share
   use rotating_square, only: rigid_velocity, square_pressure
   use settings, only: choice_length, settings_t
   use square_lattice, only: lattice_sound, shear_coefficient, sound_t
   use standing_wave, only: new_standing_wave, standing_wave_t
   use taylor_green, only: vortices_t
   implicit none
   private

   public :: exact_solution_t, new_exact_solution

   real(dp), parameter, public :: continuum_shear = 1.0_dp/8   !! nu/(alpha h c0) by eq. 16
   real(dp), parameter :: pi = acos(-1.0_dp)

   !> A solution at a time. Components that are not the named solution's keep their initial values.
   type :: exact_solution_t
      character(choice_length) :: name = 'none'
      logical :: has_velocity = .false.     !! at t = 0
      logical :: has_pressure = .false.     !! at t = 0
      logical :: lasts = .false.            !! has them at later times too
      logical :: by_lattice = .false.       !! viscosity or sound speed differ on a lattice
      logical :: turned = .false.           !! the lattice is not along the axes
      real(dp) :: time = 0
      real(dp) :: origin(2) = 0             !! where the solution has x = y = 0
      real(dp) :: extent(2) = 1             !! of the box or body that it fills
      real(dp) :: amplitude = 0             !! of &exact
      real(dp) :: viscosity = 0             !! kinematic, nu
      real(dp) :: speed_scale = 1           !! that errors of the velocity are shares of
      real(dp) :: pressure_scale = 1        !! that errors of the pressure are shares of
      real(dp) :: rho0 = 1, c0 = 1, gravity = 0
      type(standing_wave_t) :: wave
      type(drop_t) :: drop
      type(vortices_t) :: vortices
      type(sound_wave_t) :: sound
      type(channel_t) :: channel
      real(dp) :: lost_share = 0            !! of an impact
   contains
      procedure :: move_to
      procedure :: velocity
      procedure :: pressure
   end type exact_solution_t

contains

   !> The scene's solution at t = 0.
   !!
   !! With `on_lattice` the viscosity, and the speed and damping of sound, are those that the kernel sums have on a square
   !! lattice (module square_lattice) instead of the continuum's.
   pure type(exact_solution_t) function new_exact_solution(scene, model, on_lattice) result(self)
      type(settings_t), intent(in) :: scene
      type(model_t), intent(in) :: model
      logical, intent(in) :: on_lattice
      real(dp) :: k

      self%name = scene%exact%solution
      self%amplitude = scene%exact%amplitude
      self%turned = scene%bodies(1)%lattice == 'turned'
      self%rho0 = model%rho0
      self%c0 = model%c0
      self%gravity = model%gravity
      self%origin = scene%domain%lower
      self%extent = scene%domain%upper - scene%domain%lower
      ! Tanks are filled from the floor to the upper edge of the first body.
      if (self%name == 'hydrostatic' .or. self%name == 'standing_wave') self%extent(2) = scene%bodies(1)%upper(2) - self%origin(2)
      k = 2*pi*scene%exact%waves/self%extent(1)
      self%viscosity = shear_on_continuum(model)
      if (on_lattice) self%viscosity = model%alpha*model%kernel%h*model%c0*shear_on_lattice(self, model, k)
      self%has_velocity = self%name /= 'none' .and. self%name /= 'impact'
      self%has_pressure = self%has_velocity
      self%lasts = self%has_velocity .and. self%name /= 'rotating_square'
      select case (self%name)
      case ('hydrostatic', 'standing_wave')
         call set_up_tank(self, k)
      case ('oscillating_drop', 'rotating_square', 'impact')
         call set_up_body(self, scene)
      case ('taylor_green', 'acoustic_wave')
         call set_up_periodic(self, model, k, on_lattice)
      case ('couette', 'poiseuille')
         call set_up_channel(self, scene)
      end select
   end function new_exact_solution

   ! nu = alpha h c0/8.
   pure real(dp) function shear_on_continuum(model) result(viscosity)
      type(model_t), intent(in) :: model

      viscosity = continuum_shear*model%alpha*model%kernel%h*model%c0
   end function shear_on_continuum

   !> nu/(alpha h c0) that a solution meets on a lattice.
   !!
   !! Taylor-Green vortices are shear waves along both diagonals. A standing wave strains along the axes (as a wave on the
   !! diagonal does) with cosh(ky)**2 and shears with sinh(ky)**2; both dissipate in proportion to their integrals over depth.
   pure real(dp) function shear_on_lattice(self, model, k) result(coefficient)
      type(exact_solution_t), intent(in) :: self
      type(model_t), intent(in) :: model
      real(dp), intent(in) :: k   !! wave number
      real(dp), parameter :: axis(2) = [1.0_dp, 0.0_dp], diagonal(2) = [1.0_dp, 1.0_dp]
      real(dp) :: ratio, strain, shear, depth

      ratio = model%kernel%h/model%dx
      depth = self%extent(2)
      select case (self%name)
      case ('taylor_green')
         coefficient = shear_coefficient(ratio, in_lattice(self, diagonal), sqrt(2.0_dp)*k*model%dx)
      case ('standing_wave')
         ! Both divided by cosh(2 k depth)/(2 k); of deep water both are the same.
         strain = tanh(2*k*depth) + 2*k*depth/cosh(min(2*k*depth, 300.0_dp))
         shear = tanh(2*k*depth) - 2*k*depth/cosh(min(2*k*depth, 300.0_dp))
         coefficient = (strain*shear_coefficient(ratio, in_lattice(self, diagonal), sqrt(2.0_dp)*k*model%dx) &
                        + shear*shear_coefficient(ratio, in_lattice(self, axis), k*model%dx))/(strain + shear)
      case ('couette', 'poiseuille')
         coefficient = shear_coefficient(ratio, in_lattice(self, axis), pi*model%dx/depth)
      case default
         coefficient = shear_coefficient(ratio, in_lattice(self, axis))
      end select
   end function shear_on_lattice

   ! A direction as the lattice sees it: one of vectors (5, 3) and (-3, 5) if it is turned.
   pure function in_lattice(self, direction) result(seen)
      type(exact_solution_t), intent(in) :: self
      real(dp), intent(in) :: direction(2)
      real(dp) :: seen(2)

      seen = direction
      if (self%turned) seen = [5*direction(1) + 3*direction(2), 5*direction(2) - 3*direction(1)]
   end function in_lattice

   ! Fluid on the floor of the box.
   pure subroutine set_up_tank(self, k)
      type(exact_solution_t), intent(inout) :: self
      real(dp), intent(in) :: k

      self%pressure_scale = self%rho0*self%gravity*self%extent(2)
      self%speed_scale = sqrt(self%gravity*self%extent(2))
      if (self%name == 'standing_wave') then
         self%wave = new_standing_wave(k, self%extent(2), self%gravity, self%amplitude, self%viscosity)
         associate (w => self%wave)
            self%speed_scale = abs(w%height)*w%gravity*w%depth*k/(2*w%frequency)
         end associate
      end if
   end subroutine set_up_tank

   ! What the first body is.
   pure subroutine set_up_body(self, scene)
      type(exact_solution_t), intent(inout) :: self
      type(settings_t), intent(in) :: scene
      real(dp) :: approach(2)

      associate (body => scene%bodies(1))
         self%extent = body%upper - body%lower
         select case (self%name)
         case ('oscillating_drop')
            self%origin = scene%force%centre
            self%drop = new_drop(body%radius, scene%force%central_rate, self%amplitude)
            self%speed_scale = abs(self%amplitude)*body%radius
            self%pressure_scale = self%rho0*(self%amplitude**2 + scene%force%central_rate**2)*body%radius**2/2
         case ('rotating_square')
            self%origin = (body%lower + body%upper)/2
            self%speed_scale = abs(self%amplitude)*norm2(self%extent)/2
            self%pressure_scale = self%rho0*self%speed_scale**2
         case ('impact')
            approach = body%velocity - scene%bodies(size(scene%bodies))%velocity
            self%speed_scale = norm2(approach)/2
            ! H/L with H along the motion
            if (abs(approach(1)) > abs(approach(2))) self%extent = self%extent([2, 1])
            self%lost_share = lost_share(self%extent(2)/self%extent(1))
         end select
      end associate
   end subroutine set_up_body

   ! Waves that fill a periodic box.
   pure subroutine set_up_periodic(self, model, k, on_lattice)
      type(exact_solution_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      real(dp), intent(in) :: k
      logical, intent(in) :: on_lattice
      type(sound_t) :: sound

      self%by_lattice = .true.
      if (self%name == 'taylor_green') then
         self%vortices = vortices_t(k=k, speed=self%amplitude, decay=2*self%viscosity*k**2)
         self%speed_scale = abs(self%amplitude)
         self%pressure_scale = self%rho0*self%amplitude**2/2
      else
         self%sound = sound_wave_t(k=k, compression=self%amplitude, c0=model%c0, speed=model%c0, &
                                   damping=continuum_damping(model%alpha, model%kernel%h, model%c0, k))
         if (on_lattice) then
            sound = lattice_sound(model%kernel%h/model%dx, k*model%dx)
            self%sound%speed = sound%speed*model%c0
            self%sound%damping = (model%delta*sound%s_delta + model%alpha*sound%s_alpha)*model%c0/model%dx
         end if
         self%speed_scale = model%c0*abs(self%amplitude)
         self%pressure_scale = model%c0**2*model%rho0*abs(self%amplitude)
      end if
   end subroutine set_up_periodic

   ! Between the lower and the upper side of the box.
   pure subroutine set_up_channel(self, scene)
      type(exact_solution_t), intent(inout) :: self
      type(settings_t), intent(in) :: scene

      self%by_lattice = .true.
      self%channel = channel_t(height=self%extent(2), bottom_speed=scene%domain%wall_speeds(3), &
                               top_speed=scene%domain%wall_speeds(4), acceleration=scene%force%acceleration(1), &
                               viscosity=max(self%viscosity, 1.0e-30_dp))
      self%speed_scale = self%channel%fastest()
      self%pressure_scale = self%rho0*self%speed_scale**2
   end subroutine set_up_channel

   !> Moves to a time.
   pure subroutine move_to(self, time)
      class(exact_solution_t), intent(inout) :: self
      real(dp), intent(in) :: time

      self%time = time
      if (self%name == 'oscillating_drop') call self%drop%move_to(time)
   end subroutine move_to

   !> Velocity at a position, where the solution has one.
   pure function velocity(self, position) result(u)
      class(exact_solution_t), intent(in) :: self
      real(dp), intent(in) :: position(2)
      real(dp) :: u(2)

      u = 0
      associate (r => position - self%origin)
         select case (self%name)
         case ('standing_wave')
            u = self%wave%velocity(r(1), r(2), self%time)
         case ('oscillating_drop')
            u = self%drop%velocity(r(1), r(2))
         case ('taylor_green')
            u = self%vortices%velocity(r(1), r(2), self%time)
         case ('acoustic_wave')
            u(1) = self%sound%velocity(r(1), self%time)
         case ('couette', 'poiseuille')
            u(1) = self%channel%velocity(r(2), self%time)
         case ('rotating_square')
            u = rigid_velocity(r(1), r(2), self%amplitude)
         end select
      end associate
   end function velocity

   !> Pressure at a position, where the solution has one.
   pure real(dp) function pressure(self, position) result(p)
      class(exact_solution_t), intent(in) :: self
      real(dp), intent(in) :: position(2)

      p = 0
      associate (r => position - self%origin)
         select case (self%name)
         case ('hydrostatic', 'standing_wave')
            p = hydrostatic_pressure(self%extent(2) - r(2), self%rho0, self%c0, self%gravity)
            if (self%name == 'standing_wave') p = p + self%rho0*self%wave%dynamic_pressure(r(1), r(2), self%time)
         case ('oscillating_drop')
            p = self%rho0*self%drop%pressure(r(1), r(2))
         case ('taylor_green')
            p = self%rho0*self%vortices%pressure(r(1), r(2), self%time)
         case ('acoustic_wave')
            p = self%c0**2*self%rho0*self%sound%density(r(1), self%time)
         case ('rotating_square')
            p = self%rho0*self%amplitude**2*square_pressure(r(1), r(2), self%extent(1), self%extent(2))
         end select
      end associate
   end function pressure

end module exact_solution
