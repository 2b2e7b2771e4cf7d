!> A rectangle of incompressible fluid that starts to rotate as a rigid body, without walls or gravity.
!!
!! Source: Colagrossi, PhD thesis (2005); Le Touze et al., Int. J. Numer. Methods Fluids 73 (2013). With the velocity
!! Omega (-y, x) about the centre, Laplace p = 2 rho Omega**2 and p = 0 on the edges at t = 0: the pressure is negative
!! everywhere inside. Later there is no formula, but energy and angular momentum stay what they are.
module rotating_square
   use columns, only: columns_t
   use derived_settings, only: reach
   use kinds, only: dp
   use model, only: model_t
   use scene_needs, only: need_no_weight, need_one_body, need_open_sides, needs_t
   use settings, only: body_settings, settings_t
   use solution, only: n_sums, solution_t
   use solution_results, only: history_t, known, last, result_t
   implicit none
   private

   public :: rigid_velocity, square_pressure, rotating_square_solution_t, rotating_square_solution

   real(dp), parameter :: pi = acos(-1.0_dp)

   !> The scene's first body, about its centre; `amplitude` is Omega.
   type, extends(solution_t) :: rotating_square_solution_t
   contains
      procedure :: add_needs
      procedure :: set_up
      procedure :: start_speed
      procedure :: velocity
      procedure :: pressure
      procedure :: terms
      procedure :: add_columns
      procedure :: results
   end type rotating_square_solution_t

contains

   !> Velocity at a place relative to the centre.
   pure function rigid_velocity(x, y, rotation) result(u)
      real(dp), intent(in) :: x, y
      real(dp), intent(in) :: rotation   !! Omega, counterclockwise
      real(dp) :: u(2)

      u = rotation*[-y, x]
   end function rigid_velocity

   !> p/(rho Omega**2) at a place relative to the centre of a rectangle W wide and H high.
   !!
   !! -[(W/2)**2 - x**2] + (8 W**2/pi**3) sum_{n odd} (-1)**((n-1)/2)/n**3 cos(n pi x/W) cosh(n pi y/W)/cosh(n pi H/(2W)): the
   !! parabola has the right Laplacian and vanishes at the left and right edge; the series takes it off the other two.
   elemental real(dp) function square_pressure(x, y, width, height) result(p)
      real(dp), intent(in) :: x, y
      real(dp), intent(in) :: width, height   !! W, H
      integer, parameter :: last = 2001
      real(dp) :: k, ratio
      integer :: n, sign_of

      p = x**2 - width**2/4
      sign_of = 1
      do n = 1, last, 2
         k = n*pi/width
         ! cosh(k y)/cosh(k H/2) without overflow
         ratio = exp(-k*(height/2 - abs(y)))*(1 + exp(-2*k*abs(y)))/(1 + exp(-k*height))
         p = p + sign_of*8*width**2/(n*pi)**3*cos(k*x)*ratio
         if (ratio < 1.0e-15_dp) exit
         sign_of = -sign_of
      end do
   end function square_pressure

   pure type(rotating_square_solution_t) function rotating_square_solution() result(self)
      self%has_amplitude = .true.
      self%lasts = .false.
      self%starts_with_pressure = .true.
   end function rotating_square_solution

   subroutine add_needs(self, scene, needs)
      class(rotating_square_solution_t), intent(in) :: self
      type(settings_t), intent(in) :: scene
      type(needs_t), intent(inout) :: needs

      call need_no_weight(scene, needs)
      call need_open_sides(scene, needs)
      call need_one_body(scene, 'rectangle', needs)
   end subroutine add_needs

   subroutine set_up(self, scene, model)
      class(rotating_square_solution_t), intent(inout) :: self
      type(settings_t), intent(in) :: scene
      type(model_t), intent(in) :: model

      associate (body => scene%bodies(1))
         self%extent = body%upper - body%lower
         self%origin = (body%lower + body%upper)/2
      end associate
      self%speed_scale = abs(self%amplitude)*norm2(self%extent)/2
      self%pressure_scale = self%rho0*self%speed_scale**2
   end subroutine set_up

   pure real(dp) function start_speed(self, scene, body) result(speed)
      class(rotating_square_solution_t), intent(in) :: self
      type(settings_t), intent(in) :: scene
      type(body_settings), intent(in) :: body

      speed = abs(scene%exact%amplitude)*reach(body, (body%lower + body%upper)/2)
   end function start_speed

   pure function velocity(self, position) result(u)
      class(rotating_square_solution_t), intent(in) :: self
      real(dp), intent(in) :: position(2)
      real(dp) :: u(2)

      associate (r => position - self%origin)
         u = rigid_velocity(r(1), r(2), self%amplitude)
      end associate
   end function velocity

   pure real(dp) function pressure(self, position) result(p)
      class(rotating_square_solution_t), intent(in) :: self
      real(dp), intent(in) :: position(2)

      associate (r => position - self%origin)
         p = self%rho0*self%amplitude**2*square_pressure(r(1), r(2), self%extent(1), self%extent(2))
      end associate
   end function pressure

   ! Kinetic energy and angular momentum.
   pure function terms(self, r, u, s, w, m)
      class(rotating_square_solution_t), intent(in) :: self
      real(dp), intent(in) :: r(2), u(2), s, w, m
      real(dp) :: terms(n_sums)

      terms = 0
      terms(1:2) = m*[dot_product(u, u)/2, r(1)*u(2) - r(2)*u(1)]
   end function terms

   subroutine add_columns(self, now, first, fastest, row)
      class(rotating_square_solution_t), intent(in) :: self
      real(dp), intent(in) :: now(n_sums), first(n_sums), fastest
      type(columns_t), intent(inout) :: row

      call row%add('E_K', 'share of that at t = 0', now(1)/first(1))
      call row%add('angular_momentum', 'share of that at t = 0', now(2)/first(2))
   end subroutine add_columns

   function results(self, history)
      class(rotating_square_solution_t), intent(in) :: self
      type(history_t), intent(in) :: history
      type(result_t), allocatable :: results(:)

      results = [known('rotating_square_kinetic_energy', last(history%column('E_K'))), &
                 known('rotating_square_angular_momentum', last(history%column('angular_momentum')))]
   end function results

end module rotating_square
