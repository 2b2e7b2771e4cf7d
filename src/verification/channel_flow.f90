!> Start-up of plane flow between two walls that the fluid sticks to: Couette and Poiseuille flow.
!!
!! Source: Morris, Fox & Zhu, J. Comput. Phys. 136 (1997), eqs. 21 and 23; Fourier series of du/dt = f + nu d2u/dy2, u = 0 at t = 0,
!! with the walls' speeds U_b at y = 0 and U_t at y = H:
!!
!!     u = U_b + (U_t - U_b) y/H + f y (H - y)/(2 nu) - sum_n b_n sin(n pi y/H) exp(-nu (n pi/H)**2 t)
!!     b_n = 2/(n pi) (U_b - (-1)**n U_t) + 4 f H**2/(nu (n pi)**3) for odd n, without the second part for even n
module channel_flow
   use columns, only: columns_t
   use fitting, only: fit_approach
   use kinds, only: dp
   use model, only: model_t
   use scene_needs, only: need_full_box, need_one_body, need_rest, needs_t
   use settings, only: settings_t
   use solution, only: n_sums, solution_t
   use solution_results, only: history_t, result_t, share
   implicit none
   private

   public :: channel_t, channel_solution_t, couette_solution, poiseuille_solution

   real(dp), parameter :: pi = acos(-1.0_dp)

   !> A channel along x, from y = 0 to its height.
   type :: channel_t
      real(dp) :: height = 1                     !! H
      real(dp) :: bottom_speed = 0, top_speed = 0
      real(dp) :: acceleration = 0               !! f, along the channel
      real(dp) :: viscosity = 1                  !! kinematic, nu > 0
   contains
      procedure :: velocity
      procedure :: steady_velocity
      procedure :: steady_mode
      procedure :: mode
      procedure :: rate
      procedure :: fastest
   end type channel_t

   !> Flow between the lower and the upper side of the scene's box.
   type, extends(solution_t) :: channel_solution_t
      type(channel_t) :: channel   !! of the continuum
      type(channel_t) :: lattice   !! with the lattice's viscosity
   contains
      procedure :: add_needs
      procedure :: set_up
      procedure :: velocity => velocity_in_box
      procedure :: lattice_velocity
      procedure :: terms
      procedure :: add_columns
      procedure :: results
   end type channel_solution_t

contains

   !> Velocity along x at a distance from the lower wall.
   elemental real(dp) function velocity(self, y, time) result(u)
      class(channel_t), intent(in) :: self
      real(dp), intent(in) :: y, time
      integer, parameter :: most_terms = 20000
      real(dp), parameter :: negligible = 40   ! exp(-40) < 1e-17
      real(dp) :: damping
      integer :: n

      u = 0
      if (.not. time > 0) return
      u = self%steady_velocity(y)
      do n = 1, most_terms
         damping = self%rate(n)*time
         if (damping > negligible) exit
         u = u - self%steady_mode(n)*sin(n*pi*y/self%height)*exp(-damping)
      end do
   end function velocity

   !> Velocity that is left in the end.
   elemental real(dp) function steady_velocity(self, y) result(u)
      class(channel_t), intent(in) :: self
      real(dp), intent(in) :: y

      u = self%bottom_speed + (self%top_speed - self%bottom_speed)*y/self%height &
          + self%acceleration*y*(self%height - y)/(2*self%viscosity)
   end function steady_velocity

   !> b_n, coefficient of sin(n pi y/H) in the steady velocity.
   elemental real(dp) function steady_mode(self, n) result(b)
      class(channel_t), intent(in) :: self
      integer, intent(in) :: n

      b = 2/(n*pi)*(self%bottom_speed - merge(1, -1, mod(n, 2) == 0)*self%top_speed)
      if (mod(n, 2) == 1) b = b + 4*self%acceleration*self%height**2/(self%viscosity*(n*pi)**3)
   end function steady_mode

   !> Coefficient of sin(pi y/H), the slowest mode, at a time.
   elemental real(dp) function mode(self, time) result(b)
      class(channel_t), intent(in) :: self
      real(dp), intent(in) :: time

      b = self%steady_mode(1)*(1 - exp(-self%rate(1)*time))
   end function mode

   !> nu (n pi/H)**2, at which mode n approaches its steady value.
   elemental real(dp) function rate(self, n)
      class(channel_t), intent(in) :: self
      integer, intent(in) :: n

      rate = self%viscosity*(n*pi/self%height)**2
   end function rate

   !> Largest speed of the steady flow, walls included.
   elemental real(dp) function fastest(self) result(speed)
      class(channel_t), intent(in) :: self
      integer, parameter :: n = 200
      integer :: i

      speed = 0
      do i = 0, n
         speed = max(speed, abs(self%steady_velocity(self%height*i/n)))
      end do
   end function fastest

   !> Driven by the walls.
   pure type(channel_solution_t) function couette_solution() result(self)
      self%by_lattice = .true.
   end function couette_solution

   !> Driven by a force.
   pure type(channel_solution_t) function poiseuille_solution() result(self)
      self%by_lattice = .true.
      self%by_acceleration = .true.
   end function poiseuille_solution

   ! Fluid at rest between walls that it sticks to, and what sets it in motion.
   subroutine add_needs(self, scene, needs)
      class(channel_solution_t), intent(in) :: self
      type(settings_t), intent(in) :: scene
      type(needs_t), intent(inout) :: needs

      associate (domain => scene%domain, acceleration => scene%force%acceleration)
         call needs%unless(domain%left == 'periodic', "left = 'periodic' and right = 'periodic'", 'domain', 'left')
         call needs%unless(domain%bottom == 'no_slip', "bottom = 'no_slip'", 'domain', 'bottom')
         call needs%unless(domain%top == 'no_slip', "top = 'no_slip'", 'domain', 'top')
         call needs%unless(scene%alpha_total() > 0.0_dp, 'viscosity above 0', 'fluid', 'viscosity')
         if (self%by_acceleration) then
            call needs%unless(abs(acceleration(1)) > 0.0_dp, 'acceleration along the channel: acceleration = 1, 0', &
                              'force', 'acceleration')
            call needs%unless(.not. abs(acceleration(2)) > 0.0_dp, 'no acceleration across the channel: acceleration(2) = 0', &
                              'force', 'acceleration')
         else
            call needs%unless(any(abs(domain%wall_speeds(3:4)) > 0.0_dp), &
                              'a wall that moves: wall_speeds = 0, 0, 0, 1 for the top', 'domain', 'wall_speeds')
         end if
      end associate
      call need_rest(scene, needs)
      call need_one_body(scene, 'rectangle', needs)
      call need_full_box(scene, needs)
   end subroutine add_needs

   subroutine set_up(self, scene, model)
      class(channel_solution_t), intent(inout) :: self
      type(settings_t), intent(in) :: scene
      type(model_t), intent(in) :: model
      real(dp), parameter :: least = 1.0e-30_dp   ! viscosity, so that nothing is divided by zero
      real(dp) :: share_of_axis

      self%channel = channel_t(height=self%extent(2), bottom_speed=scene%domain%wall_speeds(3), &
                               top_speed=scene%domain%wall_speeds(4), acceleration=scene%force%acceleration(1), &
                               viscosity=max(self%viscosity(model), least))
      ! The slowest mode is a shear wave of length 2 H along an axis.
      share_of_axis = self%lattice_shear(model, [1.0_dp, 0.0_dp], pi*model%dx/self%extent(2))
      self%lattice = self%channel
      self%lattice%viscosity = max(self%viscosity(model, share_of_axis), least)
      self%speed_scale = self%channel%fastest()
      self%pressure_scale = self%rho0*self%speed_scale**2
   end subroutine set_up

   pure function velocity_in_box(self, position) result(u)
      class(channel_solution_t), intent(in) :: self
      real(dp), intent(in) :: position(2)
      real(dp) :: u(2)

      u = [self%channel%velocity(position(2) - self%origin(2), self%time), 0.0_dp]
   end function velocity_in_box

   pure function lattice_velocity(self, position) result(u)
      class(channel_solution_t), intent(in) :: self
      real(dp), intent(in) :: position(2)
      real(dp) :: u(2)

      u = [self%lattice%velocity(position(2) - self%origin(2), self%time), 0.0_dp]
   end function lattice_velocity

   ! Projection on the slowest mode.
   pure function terms(self, r, u, s, w, m)
      class(channel_solution_t), intent(in) :: self
      real(dp), intent(in) :: r(2), u(2), s, w, m
      real(dp) :: terms(n_sums), mode

      mode = sin(pi*r(2)/self%extent(2))
      terms = 0
      terms(1:2) = w*[u(1)*mode, mode**2]
   end function terms

   subroutine add_columns(self, now, first, fastest, row)
      class(channel_solution_t), intent(in) :: self
      real(dp), intent(in) :: now(n_sums), first(n_sums), fastest
      type(columns_t), intent(inout) :: row

      call row%add('mode', 'length/time', now(1)/now(2))
      call row%add('mode_exact', 'length/time', self%channel%mode(self%time))
      call row%add('mode_lattice', 'length/time', self%lattice%mode(self%time))
   end subroutine add_columns

   ! The viscosity by the approach of the slowest mode to its steady value.
   function results(self, history)
      class(channel_solution_t), intent(in) :: self
      type(history_t), intent(in) :: history
      type(result_t), allocatable :: results(:)
      real(dp) :: mode(size(history%times)), rate
      character(:), allocatable :: name
      logical :: found

      name = trim(self%name)
      mode = history%column('mode')
      associate (exact => self%channel)
         if (self%by_acceleration) then
            call fit_approach(history%times, mode, exact%rate(1), rate, found, source=exact%steady_mode(1)*exact%rate(1))
         else
            call fit_approach(history%times, mode, exact%rate(1), rate, found, limit=exact%steady_mode(1))
         end if
         results = [result_t(name//'_viscosity', exact%viscosity*rate/exact%rate(1), found), &
                    share(name//'_viscosity_over_exact', rate, exact%rate(1), found), &
                    share(name//'_viscosity_over_lattice', rate, self%lattice%rate(1), found)]
      end associate
   end function results

end module channel_flow
