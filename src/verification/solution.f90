!> What an exact solution is: the type that every one of them extends.
!!
!! A solution is one module: its formulas, what it needs of a scene, where it lives there, its columns of errors.dat and its lines
!! of the summary; and one line in module `solution_register`. What it leaves out has the default below. docs/scenes.md says what
!! each solution is in a scene.
module solution
   use columns, only: columns_t
   use kernel, only: k_2d
   use kinds, only: dp
   use model, only: model_t
   use scene_needs, only: needs_t
   use settings, only: body_settings, choice_length, settings_t
   use solution_results, only: history_t, result_t
   use square_lattice, only: shear_coefficient
   implicit none
   private

   public :: solution_t

   real(dp), parameter, public :: continuum_shear = 1/k_2d   !! nu/(alpha h c0) by eq. 16
   integer, parameter, public :: n_sums = 5                    !! sums over particles that a solution can ask for

   !> An exact solution in a scene, at a time.
   type, abstract :: solution_t
      character(choice_length) :: name = ''      !! of &exact solution; the register gives it
      ! What it is, as its constructor says:
      logical :: has_amplitude = .false.         !! it moves at the start, as fast as &exact amplitude says
      logical :: has_waves = .false.             !! &exact waves of them in the box
      logical :: has_fields = .true.             !! velocity and pressure at t = 0
      logical :: lasts = .true.                  !! and at later times
      logical :: starts_with_pressure = .false.  !! worth a warning where a body starts without
      logical :: by_lattice = .false.            !! viscosity or sound speed differ on a lattice, so there is `lattice_velocity`
      logical :: in_central_field = .false.      !! the other solutions need that there is none
      logical :: by_acceleration = .false.       !! the other solutions need that there is none
      ! Where it is in the scene, from `place` and `set_up`:
      real(dp) :: origin(2) = 0                  !! where the solution has x = y = 0 [m]
      real(dp) :: extent(2) = 1                  !! of the box or body that it fills [m]
      real(dp) :: amplitude = 0                  !! of &exact
      real(dp) :: speed_scale = 1                !! that errors of the velocity are shares of [m/s]
      real(dp) :: pressure_scale = 1             !! that errors of the pressure are shares of [Pa]
      real(dp) :: rho0 = 1, c0 = 1, gravity = 0  !! [kg/m3], [m/s], [m/s2]
      logical :: turned = .false.                !! the particles' lattice is not along the axes
      real(dp) :: time = 0                       !! [s]
   contains
      procedure(needs_of), deferred :: add_needs
      procedure(set_up_in), deferred :: set_up
      procedure :: start_speed
      procedure :: move_to
      procedure :: velocity
      procedure :: lattice_velocity
      procedure :: pressure
      procedure :: terms
      procedure :: add_columns
      procedure :: results
      procedure, non_overridable :: place
      procedure, non_overridable :: viscosity
      procedure, non_overridable :: lattice_shear
   end type solution_t

   abstract interface
      !> What the scene lacks, beyond what the components say.
      subroutine needs_of(self, scene, needs)
         import :: solution_t, settings_t, needs_t
         class(solution_t), intent(in) :: self
         type(settings_t), intent(in) :: scene
         type(needs_t), intent(inout) :: needs
      end subroutine needs_of

      !> Finds its place and its constants in the scene; `place` has been there.
      subroutine set_up_in(self, scene, model)
         import :: solution_t, settings_t, model_t
         class(solution_t), intent(inout) :: self
         type(settings_t), intent(in) :: scene
         type(model_t), intent(in) :: model
      end subroutine set_up_in
   end interface

contains

   !> Puts the solution into a scene, at t = 0: into the whole box unless its `set_up` says otherwise.
   subroutine place(self, scene, model)
      class(solution_t), intent(inout) :: self
      type(settings_t), intent(in) :: scene
      type(model_t), intent(in) :: model

      self%amplitude = scene%exact%amplitude
      self%turned = scene%bodies(1)%lattice == 'turned'
      self%rho0 = model%rho0
      self%c0 = model%c0
      self%gravity = model%gravity
      self%origin = scene%domain%lower
      self%extent = scene%domain%upper - scene%domain%lower
      call self%set_up(scene, model)
   end subroutine place

   !> Largest speed that a body with flow = 'exact' starts with [m/s].
   pure real(dp) function start_speed(self, scene, body) result(speed)
      class(solution_t), intent(in) :: self       !! not yet in the scene
      type(settings_t), intent(in) :: scene
      type(body_settings), intent(in) :: body     !! its box is known

      speed = 0
   end function start_speed

   !> Moves to a time.
   pure subroutine move_to(self, time)
      class(solution_t), intent(inout) :: self
      real(dp), intent(in) :: time   !! >= 0 [s]

      self%time = time
   end subroutine move_to

   !> Velocity at a position [m/s], where the solution has one.
   pure function velocity(self, position) result(u)
      class(solution_t), intent(in) :: self
      real(dp), intent(in) :: position(2)   !! [m]
      real(dp) :: u(2)

      u = 0
   end function velocity

   !> The same with the viscosity or sound speed that the kernel sums have on a square lattice [m/s].
   pure function lattice_velocity(self, position) result(u)
      class(solution_t), intent(in) :: self
      real(dp), intent(in) :: position(2)   !! [m]
      real(dp) :: u(2)

      u = self%velocity(position)
   end function lattice_velocity

   !> Pressure at a position [Pa], where the solution has one.
   pure real(dp) function pressure(self, position) result(p)
      class(solution_t), intent(in) :: self
      real(dp), intent(in) :: position(2)   !! [m]

      p = 0
   end function pressure

   !> What a particle adds to the solution's own sums.
   pure function terms(self, r, u, s, w, m)
      class(solution_t), intent(in) :: self
      real(dp), intent(in) :: r(2)      !! from the solution's origin [m]
      real(dp), intent(in) :: u(2), s   !! velocity [m/s], rho - rho0 [kg/m3]
      real(dp), intent(in) :: w, m      !! volume [m2], mass [kg/m]
      real(dp) :: terms(n_sums)

      terms = 0
   end function terms

   !> Its own columns of errors.dat.
   subroutine add_columns(self, now, first, fastest, row)
      class(solution_t), intent(in) :: self
      real(dp), intent(in) :: now(n_sums), first(n_sums)   !! its own sums, and those at t = 0
      real(dp), intent(in) :: fastest                      !! largest speed of a particle [m/s]
      type(columns_t), intent(inout) :: row
   end subroutine add_columns

   !> Its own lines of the summary.
   function results(self, history)
      class(solution_t), intent(in) :: self
      type(history_t), intent(in) :: history   !! at least one row
      type(result_t), allocatable :: results(:)

      allocate (results(0))
   end function results

   !> nu = alpha h c0 times 1/K by eq. 16, or another share [m2/s].
   pure real(dp) function viscosity(self, model, share)
      class(solution_t), intent(in) :: self
      type(model_t), intent(in) :: model
      real(dp), intent(in), optional :: share   !! nu/(alpha h c0) that the solution meets on a lattice

      if (present(share)) then
         viscosity = model%alpha*model%kernel%h*model%c0*share
      else
         viscosity = continuum_shear*model%alpha*model%kernel%h*model%c0
      end if
   end function viscosity

   !> nu/(alpha h c0) that a shear wave along a direction meets on the scene's lattice.
   pure real(dp) function lattice_shear(self, model, direction, phase) result(share)
      class(solution_t), intent(in) :: self
      type(model_t), intent(in) :: model
      real(dp), intent(in) :: direction(2)   !! of any length
      real(dp), intent(in) :: phase          !! wave number times dx
      real(dp) :: seen(2)

      ! As the lattice sees it: it is one of vectors (5, 3) and (-3, 5) if it is turned.
      seen = direction
      if (self%turned) seen = [5*direction(1) + 3*direction(2), 5*direction(2) - 3*direction(1)]
      share = shear_coefficient(model%kernel%h/model%dx, seen, phase)
   end function lattice_shear

end module solution
