!> Decaying Taylor-Green vortices in a periodic square.
!!
!! Source: Taylor & Green, Proc. R. Soc. A 158 (1937); an exact solution of the incompressible Navier-Stokes equations,
!!
!!     u = -U cos(kx) sin(ky) e,   v = U sin(kx) cos(ky) e,   e = exp(-2 nu k**2 t)
!!     p = -rho U**2/4 (cos(2kx) + cos(2ky)) e**2
!!
!! With k = 2 pi and Re = 1/nu the rate is -8 pi**2/Re. Its rate of strain is D_xx = -D_yy = U k sin(kx) sin(ky) e, D_xy = 0.
module taylor_green
   use columns, only: columns_t
   use kinds, only: dp
   use model, only: model_t
   use scene_needs, only: need_full_box, need_no_weight, need_one_body, needs_t, same
   use settings, only: body_settings, settings_t
   use solution, only: n_sums, solution_t
   use solution_results, only: history_t, log_fit, result_t, share
   use text, only: to_text
   implicit none
   private

   public :: vortices_t, taylor_green_solution_t, taylor_green_solution

   real(dp), parameter :: pi = acos(-1.0_dp)

   !> Vortices of given strength.
   type :: vortices_t
      real(dp) :: k = 1       !! wave number
      real(dp) :: speed = 1   !! U
      real(dp) :: decay = 0   !! 2 nu k**2
   contains
      procedure :: velocity
      procedure :: pressure
      procedure :: strain_norm
      procedure :: amplitude
   end type vortices_t

   !> Vortices that fill the scene's box.
   type, extends(solution_t) :: taylor_green_solution_t
      type(vortices_t) :: vortices   !! of the continuum
      type(vortices_t) :: lattice    !! with the lattice's viscosity
   contains
      procedure :: add_needs
      procedure :: set_up
      procedure :: start_speed
      procedure :: velocity => velocity_in_box
      procedure :: lattice_velocity
      procedure :: pressure => pressure_in_box
      procedure :: terms
      procedure :: add_columns
      procedure :: results
   end type taylor_green_solution_t

contains

   !> exp(-2 nu k**2 t).
   elemental real(dp) function amplitude(self, time)
      class(vortices_t), intent(in) :: self
      real(dp), intent(in) :: time

      amplitude = exp(-self%decay*time)
   end function amplitude

   !> Velocity at a place.
   pure function velocity(self, x, y, time) result(u)
      class(vortices_t), intent(in) :: self
      real(dp), intent(in) :: x, y   !! from the square's lower left corner
      real(dp), intent(in) :: time
      real(dp) :: u(2)

      u = self%speed*self%amplitude(time)*[-cos(self%k*x)*sin(self%k*y), sin(self%k*x)*cos(self%k*y)]
   end function velocity

   !> p/rho at a place; its mean is 0.
   elemental real(dp) function pressure(self, x, y, time) result(p)
      class(vortices_t), intent(in) :: self
      real(dp), intent(in) :: x, y   !! from the square's lower left corner
      real(dp), intent(in) :: time

      p = -(self%speed*self%amplitude(time))**2/4*(cos(2*self%k*x) + cos(2*self%k*y))
   end function pressure

   !> ||D|| = sqrt(2 D:D) = 2 U k |sin(kx) sin(ky)| exp(-2 nu k**2 t) at a place.
   elemental real(dp) function strain_norm(self, x, y, time) result(norm)
      class(vortices_t), intent(in) :: self
      real(dp), intent(in) :: x, y   !! from the square's lower left corner
      real(dp), intent(in) :: time

      norm = 2*self%k*abs(self%speed*sin(self%k*x)*sin(self%k*y))*self%amplitude(time)
   end function strain_norm

   pure type(taylor_green_solution_t) function taylor_green_solution() result(self)
      self%has_amplitude = .true.
      self%has_waves = .true.
      self%starts_with_pressure = .true.
      self%by_lattice = .true.
   end function taylor_green_solution

   ! A square that is full of fluid and goes on for ever.
   subroutine add_needs(self, scene, needs)
      class(taylor_green_solution_t), intent(in) :: self
      type(settings_t), intent(in) :: scene
      type(needs_t), intent(inout) :: needs

      call need_no_weight(scene, needs)
      associate (domain => scene%domain)
         call needs%unless(domain%left == 'periodic', "left = 'periodic' and right = 'periodic'", 'domain', 'left')
         call needs%unless(domain%bottom == 'periodic', "bottom = 'periodic' and top = 'periodic'", 'domain', 'bottom')
         call needs%unless(same(scene, domain%upper(1) - domain%lower(1), domain%upper(2) - domain%lower(2)), &
                           'a square box; it is '//to_text(domain%upper - domain%lower)//' wide and high', 'domain', 'upper')
      end associate
      call need_one_body(scene, 'rectangle', needs)
      call need_full_box(scene, needs)
   end subroutine add_needs

   subroutine set_up(self, scene, model)
      class(taylor_green_solution_t), intent(inout) :: self
      type(settings_t), intent(in) :: scene
      type(model_t), intent(in) :: model
      real(dp) :: k, on_lattice

      k = 2*pi*scene%exact%waves/self%extent(1)
      ! Shear waves along both diagonals.
      on_lattice = self%viscosity(model, self%lattice_shear(model, [1.0_dp, 1.0_dp], sqrt(2.0_dp)*k*model%dx))
      self%vortices = vortices_t(k=k, speed=self%amplitude, decay=2*self%viscosity(model)*k**2)
      self%lattice = vortices_t(k=k, speed=self%amplitude, decay=2*on_lattice*k**2)
      self%speed_scale = abs(self%amplitude)
      self%pressure_scale = self%rho0*self%amplitude**2/2
   end subroutine set_up

   pure real(dp) function start_speed(self, scene, body) result(speed)
      class(taylor_green_solution_t), intent(in) :: self
      type(settings_t), intent(in) :: scene
      type(body_settings), intent(in) :: body

      speed = abs(scene%exact%amplitude)
   end function start_speed

   pure function velocity_in_box(self, position) result(u)
      class(taylor_green_solution_t), intent(in) :: self
      real(dp), intent(in) :: position(2)
      real(dp) :: u(2)

      associate (r => position - self%origin)
         u = self%vortices%velocity(r(1), r(2), self%time)
      end associate
   end function velocity_in_box

   pure function lattice_velocity(self, position) result(u)
      class(taylor_green_solution_t), intent(in) :: self
      real(dp), intent(in) :: position(2)
      real(dp) :: u(2)

      associate (r => position - self%origin)
         u = self%lattice%velocity(r(1), r(2), self%time)
      end associate
   end function lattice_velocity

   pure real(dp) function pressure_in_box(self, position) result(p)
      class(taylor_green_solution_t), intent(in) :: self
      real(dp), intent(in) :: position(2)

      associate (r => position - self%origin)
         p = self%rho0*self%vortices%pressure(r(1), r(2), self%time)
      end associate
   end function pressure_in_box

   ! Projection on the velocity of t = 0, and kinetic energy.
   pure function terms(self, r, u, s, w, m)
      class(taylor_green_solution_t), intent(in) :: self
      real(dp), intent(in) :: r(2), u(2), s, w, m
      real(dp) :: terms(n_sums), mode(2)

      mode = self%vortices%velocity(r(1), r(2), 0.0_dp)
      terms = 0
      terms(1:3) = [w*dot_product(u, mode), w*dot_product(mode, mode), m*dot_product(u, u)/2]
   end function terms

   subroutine add_columns(self, now, first, fastest, row)
      class(taylor_green_solution_t), intent(in) :: self
      real(dp), intent(in) :: now(n_sums), first(n_sums), fastest
      type(columns_t), intent(inout) :: row

      call row%add('mode', 'share of mode at t = 0', now(1)/now(2))
      call row%add('mode_exact', 'share of mode at t = 0', self%vortices%amplitude(self%time))
      call row%add('mode_lattice', 'share of mode at t = 0', self%lattice%amplitude(self%time))
      call row%add('E_K', 'energy/width', now(3))
   end subroutine add_columns

   ! Slope of the mode's logarithm.
   function results(self, history)
      class(taylor_green_solution_t), intent(in) :: self
      type(history_t), intent(in) :: history
      type(result_t), allocatable :: results(:)
      real(dp) :: offset, slope
      logical :: found

      call log_fit(history%times, history%column('mode'), offset, slope, found)
      results = [result_t('taylor_green_decay_rate', -slope, found), &
                 share('taylor_green_decay_over_exact', -slope, self%vortices%decay, found), &
                 share('taylor_green_decay_over_lattice', -slope, self%lattice%decay, found)]
   end function results

end module taylor_green
