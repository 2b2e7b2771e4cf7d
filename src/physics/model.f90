!> The constants of the model in paper symbols, worked out once from the input.
module model
   use box, only: box_t, is_wall, no_slip_wall, periodic_side
   use integrators, only: integrator_t
   use kernel, only: kernel_t
   use kinds, only: dp
   use linear_stability, only: stability_t
   use motions, only: motion_t, pose_t, turn
   use solids, only: solid_t
   use sponges, only: sponge_t
   implicit none
   private

   public :: model_t, terms_t

   !> Which terms act in a scene: what is computed and kept, what the energy budget consists of, what is reported.
   type :: terms_t
      logical :: gravity = .false.
      logical :: force = .false.         !! a uniform force besides gravity, or the box is moved; W_f
      logical :: tank = .false.          !! the box is moved
      logical :: central = .false.       !! a central force
      logical :: potential = .false.     !! gravity or a central force; E_P
      logical :: walls = .false.         !! W_s
      logical :: solids = .false.        !! bodies in the fluid; W_solid, W_stat, W_pen
      logical :: sponges = .false.       !! layers that slow the fluid down; Q_sponge
      logical :: rubbing_solids = .false.   !! with viscous forces,
      logical :: friction_works = .false.   !! and some of them move
      logical :: free_bodies = .false.   !! some that forces move; E_body, Q_damper
      logical :: no_slip = .false.       !! walls that the fluid sticks to
      logical :: periodic = .false.      !! sides
      logical :: viscosity = .false.     !! Q_alpha
      logical :: diffusion = .false.     !! of the density; Q_delta
      logical :: eddies = .false.        !! alpha_i and delta_i of the dynamic model
      logical :: rotation = .false.      !! a real viscosity; Q_omega
   end type terms_t

   !> Everything the right-hand sides need besides the state.
   type :: model_t
      type(kernel_t) :: kernel        !! W and its gradient
      type(box_t) :: box              !! its sides at time 0
      type(solid_t), allocatable :: solids(:)   !! as drawn
      type(sponge_t), allocatable :: sponges(:)   !! allocated where there are any
      real(dp) :: dx = 0              !! [m] initial particle spacing
      real(dp) :: c0 = 0              !! [m/s] sound speed
      real(dp) :: rho0 = 0            !! [kg/m3] density at p = 0
      real(dp) :: gravity = 0         !! [m/s2] along -y
      real(dp) :: acceleration(2) = 0 !! [m/s2] of a uniform force besides gravity
      type(motion_t) :: tank          !! how the box is moved
      real(dp) :: tank_pivot(2) = 0   !! [m] that it turns about
      real(dp) :: held_axes(2) = 1    !! 1 for axes along which pressure holds the fluid, else 0
      real(dp) :: central_rate = 0    !! [1/s] w of a central force -w**2 (r - centre)
      real(dp) :: centre(2) = 0
      logical :: dynamic = .false.    !! alpha_i and delta_i from the rate of strain
      real(dp) :: alpha = 0           !! [1] viscous coefficient that acts everywhere, real viscosity included
      real(dp) :: delta = 0           !! [1] density-diffusion coefficient of the constant model
      real(dp) :: alpha_per_strain = 0   !! [s] alpha_i/||D||, eq. 25
      real(dp) :: delta_per_strain = 0   !! [s] delta_i/||D||, eq. 21
      real(dp) :: limit = 0           !! [1] of alpha_i and delta_i
      real(dp) :: largest_strain = huge(1.0_dp)   !! [1/s] ||D|| is clipped here
      real(dp) :: viscosity = 0       !! [Pa s] real dynamic viscosity, for Q_omega (eq. 29)
      type(integrator_t) :: integrator
      logical :: frozen = .true.      !! diffusive terms are held over the step
      type(stability_t) :: stability  !! what the step may be with it
      real(dp) :: cfl = 0             !! [1] Courant number of eq. 8
      real(dp) :: lattice_crowd = 0   !! [m2] sum_j t**3 V_j over the others on a square lattice, F = gradient_factor t**3
   contains
      procedure :: step_limit
      procedure :: advective_limit
      procedure :: longest_step
      procedure :: terms
      procedure :: box_at
      procedure :: has_solids
      procedure :: has_free_bodies
      procedure :: poses_at
      procedure :: has_force
      procedure :: force_at
      procedure :: energy_at
   end type model_t

contains

   !> dt = CFL h/(c0 + h max|pi_ij|), eq. 8, and no more than is linearly stable with the diffusive coefficients.
   !!
   !! The paper leaves out the second limit; for viscosity it is dt <= 0.0625 h**2/nu (module linear_stability).
   pure real(dp) function step_limit(self, largest_pi, largest_alpha, largest_delta)
      class(model_t), intent(in) :: self
      real(dp), intent(in) :: largest_pi      !! [1/s] over all pairs
      real(dp), intent(in) :: largest_alpha   !! [1] largest alpha_i + alpha
      real(dp), intent(in) :: largest_delta   !! [1] largest delta_i, or delta, times crowding

      step_limit = min(self%advective_limit(largest_pi), &
                       self%stability%largest_cfl(largest_delta, largest_alpha)*self%kernel%h/self%c0)
   end function step_limit

   !> dt = CFL h/(c0 + h max|pi_ij|), eq. 8.
   pure real(dp) function advective_limit(self, largest_pi)
      class(model_t), intent(in) :: self
      real(dp), intent(in) :: largest_pi   !! [1/s] max |pi_ij|

      advective_limit = self%cfl*self%kernel%h/(self%c0 + self%kernel%h*largest_pi)
   end function advective_limit

   !> The longest step that the scene can take: without velocities.
   pure real(dp) function longest_step(self)
      class(model_t), intent(in) :: self

      longest_step = self%step_limit(0.0_dp, self%alpha, self%delta)
   end function longest_step

   !> Which terms act.
   pure type(terms_t) function terms(self)
      class(model_t), intent(in) :: self
      integer :: k

      terms%gravity = self%gravity > 0
      terms%force = self%has_force() .or. self%tank%moves()
      terms%tank = self%tank%moves()
      terms%central = self%central_rate > 0
      terms%potential = terms%gravity .or. terms%central
      terms%walls = any(is_wall(self%box%kind))
      terms%solids = self%has_solids()
      terms%sponges = allocated(self%sponges)
      terms%free_bodies = self%has_free_bodies()
      terms%no_slip = any(self%box%kind == no_slip_wall)
      terms%periodic = any(self%box%kind == periodic_side)
      terms%viscosity = self%alpha > 0 .or. self%dynamic
      terms%rubbing_solids = terms%solids .and. terms%viscosity
      if (terms%rubbing_solids) then
         terms%friction_works = any([(self%solids(k)%motion%moves(), k=1, size(self%solids))])
      end if
      terms%diffusion = self%delta > 0 .or. self%dynamic
      terms%eddies = self%dynamic
      terms%rotation = self%viscosity > 0
   end function terms

   !> The box at a time, and what acts in it because it is moved: gravity as it sees it, less gravity along -y, and inertia.
   pure type(box_t) function box_at(self, time) result(box)
      class(model_t), intent(in) :: self
      real(dp), intent(in) :: time   !! [s]
      type(pose_t) :: pose

      box = self%box%after(time)
      if (.not. self%tank%moves()) return
      pose = self%tank%at(time)
      associate (inertia => box%inertia, weight => [0.0_dp, -self%gravity])
         inertia%spin = pose%spin
         inertia%spin_rate = pose%spin_rate
         inertia%centre = self%tank_pivot
         inertia%pull = turn(-pose%angle, weight - pose%acceleration) - weight
         ! Images are far less from a wall than the pivot is: the slope is that in the middle of the box.
         if (any(abs(box%density_slope) > 0)) box%density_slope = box%density_slope + self%rho0/self%c0**2*self%held_axes &
            *inertia%at([box%at(1) + box%at(2), box%at(3) + box%at(4)]/2, [0.0_dp, 0.0_dp])
      end associate
   end function box_at

   !> Whether there are bodies in the fluid.
   pure logical function has_solids(self)
      class(model_t), intent(in) :: self

      has_solids = .false.
      if (allocated(self%solids)) has_solids = size(self%solids) > 0
   end function has_solids

   !> Whether forces move some of them.
   pure logical function has_free_bodies(self)
      class(model_t), intent(in) :: self

      has_free_bodies = .false.
      if (self%has_solids()) has_free_bodies = any(self%solids%body%is_free())
   end function has_free_bodies

   !> Poses of all solids at a time: of free ones as they are given, or as they start.
   pure function poses_at(self, time, free) result(poses)
      class(model_t), intent(in) :: self
      real(dp), intent(in) :: time                      !! [s]
      type(pose_t), intent(in), optional :: free(:)     !! (solids)
      type(pose_t), allocatable :: poses(:)             !! (solids)
      integer :: k, n

      n = 0
      if (self%has_solids()) n = size(self%solids)
      allocate (poses(n))
      do k = 1, n
         if (present(free) .and. self%solids(k)%body%is_free()) then
            poses(k) = free(k)
         else
            poses(k) = self%solids(k)%motion%at(time)
         end if
      end do
   end function poses_at

   !> Whether a uniform force acts besides gravity.
   pure logical function has_force(self)
      class(model_t), intent(in) :: self

      has_force = any(abs(self%acceleration) > 0)
   end function has_force

   !> Gravity, uniform and central force at a place [m/s2].
   pure function force_at(self, place) result(force)
      class(model_t), intent(in) :: self
      real(dp), intent(in) :: place(2)   !! [m]
      real(dp) :: force(2)

      force = self%acceleration - [0.0_dp, self%gravity]
      if (self%central_rate > 0) force = force - self%central_rate**2*(place - self%centre)
   end function force_at

   !> Kinetic energy of a particle at a place, and its potential energy in gravity and the central force [J/kg].
   pure real(dp) function energy_at(self, place, velocity)
      class(model_t), intent(in) :: self
      real(dp), intent(in) :: place(2), velocity(2)   !! [m], [m/s]

      energy_at = (velocity(1)**2 + velocity(2)**2)/2 + self%gravity*place(2)
      if (self%central_rate > 0) energy_at = energy_at + self%central_rate**2*sum((place - self%centre)**2)/2
   end function energy_at

end module model
