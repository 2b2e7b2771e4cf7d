!> A drop that oscillates in a central field of force.
!!
!! Source: Monaghan & Rafiee, Int. J. Numer. Methods Fluids 71 (2013); Antuono et al., CMAME 289 (2015). The field -w**2 r acts
!! on an incompressible ellipse with semi-axes a, b and the velocity A (x, -y). It stays an ellipse:
!!
!!     dA/dt = (A**2 + w**2) (b**2 - a**2)/(b**2 + a**2),   da/dt = A a,   db/dt = -A b,   a b = R**2
!!     p = rho (A**2 + w**2) a**2 b**2/(a**2 + b**2) (1 - x**2/a**2 - y**2/b**2)
!!
!! Energy keeps (A**2 + w**2) (a**2 + b**2) constant; hence a + b of the turning point, where A = 0.
module oscillating_drop
   use columns, only: columns_t
   use derived_settings, only: reach
   use fitting, only: first_maximum, zero_crossings
   use kinds, only: dp
   use model, only: model_t
   use scene_needs, only: need_no_weight, need_one_body, needs_t, same
   use settings, only: body_settings, choice_length, settings_t, side_names
   use solution, only: n_sums, solution_t
   use solution_results, only: history_t, result_t
   use text, only: short, to_text
   implicit none
   private

   public :: drop_t, new_drop, drop_solution_t, drop_solution

   real(dp), parameter :: longest_step = 2.0e-3_dp   ! times the fastest rate; RK4 is then good for 1e-10

   !> A drop and where it is in its oscillation.
   type :: drop_t
      real(dp) :: radius = 1          !! R of the disc at t = 0
      real(dp) :: rate = 1            !! w of the field
      real(dp) :: first_stretch = 0   !! A0
      real(dp) :: time = 0            !! that the three below belong to
      real(dp) :: a = 1, b = 1        !! semi-axes along x and y
      real(dp) :: stretch = 0         !! A
   contains
      procedure :: move_to
      procedure :: velocity
      procedure :: pressure
      procedure :: kinetic_energy
      procedure :: largest_axis
      procedure :: period
   end type drop_t

   !> The drop that the scene's disc is, around the centre of the field.
   type, extends(solution_t) :: drop_solution_t
      type(drop_t) :: drop
   contains
      procedure :: add_needs
      procedure :: set_up
      procedure :: start_speed
      procedure :: move_to => move_drop_to
      procedure :: velocity => velocity_in_field
      procedure :: pressure => pressure_in_field
      procedure :: terms
      procedure :: add_columns
      procedure :: results
   end type drop_solution_t

contains

   !> The disc at t = 0 with velocity A0 (x, -y).
   pure type(drop_t) function new_drop(radius, rate, stretch) result(self)
      real(dp), intent(in) :: radius    !! R
      real(dp), intent(in) :: rate      !! w
      real(dp), intent(in) :: stretch   !! A0

      self = drop_t(radius=radius, rate=rate, first_stretch=stretch, a=radius, b=radius, stretch=stretch)
   end function new_drop

   !> Integrates to a time, to 1e-10; from the start if that is past.
   pure subroutine move_to(self, time)
      class(drop_t), intent(inout) :: self
      real(dp), intent(in) :: time   !! >= 0
      integer :: n, k
      real(dp) :: dt

      if (time < self%time) then
         self%time = 0
         self%a = self%radius
         self%stretch = self%first_stretch
      end if
      n = ceiling((time - self%time)*fastest(self)/longest_step)
      if (n > 0) then
         dt = (time - self%time)/n
         do k = 1, n
            call step(self, dt)
         end do
      end if
      self%time = time
      self%b = self%radius**2/self%a
   end subroutine move_to

   ! Largest |A| and w.
   pure real(dp) function fastest(self)
      class(drop_t), intent(in) :: self

      fastest = max(self%rate, abs(self%first_stretch))
   end function fastest

   ! One step of RK4.
   pure subroutine step(self, dt)
      class(drop_t), intent(inout) :: self
      real(dp), intent(in) :: dt
      real(dp) :: state(2), k(2, 4)

      state = [self%a, self%stretch]
      k(:, 1) = rates(self, state)
      k(:, 2) = rates(self, state + dt/2*k(:, 1))
      k(:, 3) = rates(self, state + dt/2*k(:, 2))
      k(:, 4) = rates(self, state + dt*k(:, 3))
      state = state + dt/6*(k(:, 1) + 2*k(:, 2) + 2*k(:, 3) + k(:, 4))
      self%a = state(1)
      self%stretch = state(2)
   end subroutine step

   ! da/dt, dA/dt with b = R**2/a.
   pure function rates(self, state) result(rate)
      class(drop_t), intent(in) :: self
      real(dp), intent(in) :: state(2)   ! a, A
      real(dp) :: rate(2), squares(2)

      squares = [state(1)**2, (self%radius**2/state(1))**2]
      rate(1) = state(2)*state(1)
      rate(2) = (state(2)**2 + self%rate**2)*(squares(2) - squares(1))/(squares(2) + squares(1))
   end function rates

   !> Velocity at a place relative to the centre, at the drop's time.
   pure function velocity(self, x, y) result(u)
      class(drop_t), intent(in) :: self
      real(dp), intent(in) :: x, y
      real(dp) :: u(2)

      u = self%stretch*[x, -y]
   end function velocity

   !> p/rho at a place relative to the centre, at the drop's time.
   elemental real(dp) function pressure(self, x, y) result(p)
      class(drop_t), intent(in) :: self
      real(dp), intent(in) :: x, y

      associate (aa => self%a**2, bb => self%b**2)
         p = (self%stretch**2 + self%rate**2)*aa*bb/(aa + bb)*(1 - x**2/aa - y**2/bb)
      end associate
   end function pressure

   !> E_K/rho = pi R**2 A**2 (a**2 + b**2)/8 at the drop's time.
   pure real(dp) function kinetic_energy(self) result(energy)
      class(drop_t), intent(in) :: self
      real(dp), parameter :: pi = acos(-1.0_dp)

      energy = pi*self%radius**2*self%stretch**2*(self%a**2 + self%b**2)/8
   end function kinetic_energy

   !> Longer semi-axis at the turning point: a**2 + b**2 = 2 R**2 (1 + (A0/w)**2) there, a b = R**2.
   pure real(dp) function largest_axis(self) result(axis)
      class(drop_t), intent(in) :: self

      associate (half => 1 + (self%first_stretch/self%rate)**2)
         axis = self%radius*sqrt(half + sqrt(half**2 - 1))
      end associate
   end function largest_axis

   !> Time until everything repeats: four times from the disc to the turning point, where A = 0.
   pure real(dp) function period(self)
      class(drop_t), intent(in) :: self
      type(drop_t) :: drop
      real(dp) :: rate(2), dt
      integer :: k

      drop = new_drop(self%radius, self%rate, abs(self%first_stretch))
      dt = longest_step/fastest(self)
      do while (drop%stretch > 0)
         call step(drop, dt)
         drop%time = drop%time + dt
      end do
      ! Newton's method for the moment that A = 0
      do k = 1, 4
         rate = rates(drop, [drop%a, drop%stretch])
         dt = -drop%stretch/rate(2)
         call step(drop, dt)
         drop%time = drop%time + dt
      end do
      period = 4*drop%time
   end function period

   pure type(drop_solution_t) function drop_solution() result(self)
      self%has_amplitude = .true.
      self%starts_with_pressure = .true.
      self%in_central_field = .true.
   end function drop_solution

   ! A disc around the centre of the field, and room for it to stretch.
   subroutine add_needs(self, scene, needs)
      class(drop_solution_t), intent(in) :: self
      type(settings_t), intent(in) :: scene
      type(needs_t), intent(inout) :: needs
      character(choice_length) :: kinds_there(4)
      type(drop_t) :: drop
      real(dp) :: distance(4), room
      integer :: i

      call need_no_weight(scene, needs)
      call needs%unless(scene%force%central_rate > 0.0_dp, 'a central field: &force central_rate above 0', &
                        'force', 'central_rate')
      call need_one_body(scene, 'disc', needs)
      if (size(scene%bodies) /= 1 .or. .not. scene%force%central_rate > 0.0_dp) return
      associate (body => scene%bodies(1), domain => scene%domain)
         if (body%shape /= 'disc') return
         call needs%unless(all(same(scene, body%centre, scene%force%centre)), 'a disc in the centre of the field: centre = ' &
                           //to_text(scene%force%centre), 'body', 'centre')
         drop = new_drop(body%radius, scene%force%central_rate, scene%exact%amplitude)
         room = drop%largest_axis() + 2.0_dp*scene%smoothing_length()
         kinds_there = scene%side_kinds()
         distance = [body%centre(1) - domain%lower(1), domain%upper(1) - body%centre(1), &
                     body%centre(2) - domain%lower(2), domain%upper(2) - body%centre(2)]
         do i = 1, 4
            call needs%unless(kinds_there(i) == 'open' .or. distance(i) >= room, trim(side_names(i))//" = 'open', or that side " &
                              //short(room)//' from the centre: the drop stretches so far', 'domain', trim(side_names(i)))
         end do
      end associate
   end subroutine add_needs

   subroutine set_up(self, scene, model)
      class(drop_solution_t), intent(inout) :: self
      type(settings_t), intent(in) :: scene
      type(model_t), intent(in) :: model

      associate (body => scene%bodies(1), rate => scene%force%central_rate)
         self%extent = body%upper - body%lower
         self%origin = scene%force%centre
         self%drop = new_drop(body%radius, rate, self%amplitude)
         self%speed_scale = abs(self%amplitude)*body%radius
         self%pressure_scale = self%rho0*(self%amplitude**2 + rate**2)*body%radius**2/2
      end associate
   end subroutine set_up

   pure real(dp) function start_speed(self, scene, body) result(speed)
      class(drop_solution_t), intent(in) :: self
      type(settings_t), intent(in) :: scene
      type(body_settings), intent(in) :: body

      speed = abs(scene%exact%amplitude)*reach(body, (body%lower + body%upper)/2)
   end function start_speed

   pure subroutine move_drop_to(self, time)
      class(drop_solution_t), intent(inout) :: self
      real(dp), intent(in) :: time

      self%time = time
      call self%drop%move_to(time)
   end subroutine move_drop_to

   pure function velocity_in_field(self, position) result(u)
      class(drop_solution_t), intent(in) :: self
      real(dp), intent(in) :: position(2)
      real(dp) :: u(2)

      associate (r => position - self%origin)
         u = self%drop%velocity(r(1), r(2))
      end associate
   end function velocity_in_field

   pure real(dp) function pressure_in_field(self, position) result(p)
      class(drop_solution_t), intent(in) :: self
      real(dp), intent(in) :: position(2)

      associate (r => position - self%origin)
         p = self%rho0*self%drop%pressure(r(1), r(2))
      end associate
   end function pressure_in_field

   ! Moments of the mass, of which a**2/4 = <x**2>; stretching, kinetic energy.
   pure function terms(self, r, u, s, w, m)
      class(drop_solution_t), intent(in) :: self
      real(dp), intent(in) :: r(2), u(2), s, w, m
      real(dp) :: terms(n_sums)

      terms = m*[1.0_dp, r(1)**2, r(2)**2, r(1)*u(1) - r(2)*u(2), dot_product(u, u)/2]
   end function terms

   subroutine add_columns(self, now, first, fastest, row)
      class(drop_solution_t), intent(in) :: self
      real(dp), intent(in) :: now(n_sums), first(n_sums), fastest
      type(columns_t), intent(inout) :: row

      call row%add('a', 'length', 2*sqrt(now(2)/now(1)))
      call row%add('b', 'length', 2*sqrt(now(3)/now(1)))
      call row%add('a_exact', 'length', self%drop%a)
      call row%add('b_exact', 'length', self%drop%b)
      call row%add('A', '1/time', now(4)/(now(2) + now(3)))
      call row%add('A_exact', '1/time', self%drop%stretch)
      call row%add('E_K', 'energy/width', now(5))
      call row%add('E_K_exact', 'energy/width', self%rho0*self%drop%kinetic_energy())
   end subroutine add_columns

   ! The first period ends at the second time that the axes are equal again; the longest axis is a's first maximum.
   function results(self, history)
      class(drop_solution_t), intent(in) :: self
      type(history_t), intent(in) :: history
      type(result_t), allocatable :: results(:)
      real(dp) :: a(size(history%times)), b(size(history%times))
      real(dp), allocatable :: equal(:)
      real(dp) :: period, time, axis
      logical :: found

      a = history%column('a')
      b = history%column('b')
      ! At t = 0 they are equal to the last digit or nearly.
      allocate (equal, source=zero_crossings(history%times(2:), a(2:) - b(2:)))
      period = 0
      if (size(equal) >= 2) period = equal(2)
      call first_maximum(history%times, a, time, axis, found)
      results = [result_t('drop_period', period, size(equal) >= 2), &
                 result_t('drop_period_error', period/self%drop%period() - 1, size(equal) >= 2), &
                 result_t('drop_a_max', axis, found), &
                 result_t('drop_a_max_error', axis/self%drop%largest_axis() - 1, found)]
   end function results

end module oscillating_drop
