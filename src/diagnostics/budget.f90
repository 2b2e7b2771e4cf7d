!> The energy budget over a run: normaliser, balance error and milestones.
!!
!! Source: sec. 5 of the paper. Energies are normalised by Delta E_Mtot, what the fluid can lose until it rests;
!! Q_alpha and Q_delta are the energies that the diffusive terms have taken, W_s what the walls gave, W_f what
!! the uniform force gave, W_solid, W_stat and W_pen what solids gave: by -F.U, by the hydrostatic parts of their ghosts' pressure,
!! and by putting back particles that got into them; Q_sponge is what sponge layers have taken. Free solids are part of it: what
!! they and the fluid give each other is no work; E_body is their energy, Q_damper what their dampers have taken.
module budget
   use archive, only: archive_t
   use box, only: bottom_wall, is_wall, left_wall, right_wall
   use communication, only: largest_of_all
   use energy, only: energies_t, measure_energies
   use exact_sum, only: exact_totals
   use kinds, only: dp
   use model, only: model_t, terms_t
   use motions, only: pose_t
   use particles, only: particles_t
   use rest_state, only: rest_energies, rest_energies_around
   use solids, only: obstacles_in
   use step_state, only: step_t
   implicit none
   private

   public :: budget_t, works_t, works_of, start_budget, update_budget, add_rotation, imbalance, begin_balance_anew

   !> Energies given to the fluid since t = 0.
   type :: works_t
      real(dp) :: alpha = 0, delta = 0, walls = 0, force = 0
      real(dp) :: solids = 0, still = 0, pushed = 0   !! W_solid, W_stat, W_pen
      real(dp) :: sponges = 0
      real(dp) :: bodies = 0, dampers = 0             !! energy of free solids, now; given by dampers
   contains
      procedure :: turned_over
   end type works_t

   !> Where the energy is and has gone. Not kept is what `start_budget` finds again.
   type :: budget_t
      type(terms_t) :: has                   !! what it consists of besides kinetic and elastic energy (not kept: of the scene)
      type(energies_t) :: initial            !! (not kept: of the scene)
      type(energies_t) :: rest               !! 0 where the scene has no tank that it could rest in (not kept: of the scene)
      logical :: has_rest = .false.          !! (not kept: of the scene)
      real(dp) :: normaliser = 1             !! Delta E_Mtot, or another scale: start_budget (not kept: of the scene)
      character(:), allocatable :: scale     !! what the normaliser is, in words (not kept: of the scene)
      real(dp) :: at_start = 0               !! the normaliser, 0 where there is no energy at the start (not kept: of the scene)
      type(energies_t) :: now                !! (not kept: measured with each update)
      real(dp) :: q_alpha = 0, q_delta = 0   !! dissipated, > 0
      real(dp) :: w_s = 0                    !! work of the walls: of their images, and of those that move
      real(dp) :: w_f = 0                    !! work of the uniform force
      real(dp) :: w_solid = 0, w_stat = 0, w_pen = 0   !! work of solids (not kept: of the steps)
      real(dp) :: q_sponge = 0               !! taken by sponge layers, > 0 (not kept: of the steps)
      real(dp) :: e_body = 0                 !! energy of free solids (not kept: of the steps)
      real(dp) :: e_body_at_start = 0        !! (not kept: of the scene)
      real(dp) :: q_damper = 0               !! taken by their dampers, > 0 (not kept: of the steps)
      real(dp) :: q_omega = 0                !! mu int int vorticity**2 dA dt with the real viscosity mu
      real(dp) :: balance_error = 0          !! of the last update, share of the normaliser
      real(dp) :: largest_error = 0          !! largest |balance_error| so far
      real(dp) :: peak_time(4) = -1          !! first kinetic, potential, second kinetic, elastic maximum; -1: not yet
      real(dp), private :: peak = -huge(1.0_dp), candidate = 0
      integer, private :: sought = 1         !! which of the maxima comes next
      real(dp), private :: rotation_time = -1, enstrophy = 0   !! when Q_omega was last added to; -1: never
   contains
      procedure :: archive => archive_budget
   end type budget_t

contains

   subroutine archive_budget(self, file)
      class(budget_t), intent(inout) :: self
      class(archive_t), intent(inout) :: file

      call file%part('budget')
      call file%keep('q_alpha', self%q_alpha)
      call file%keep('q_delta', self%q_delta)
      call file%keep('w_s', self%w_s)
      call file%keep('w_f', self%w_f)
      call file%keep('q_omega', self%q_omega)
      call file%keep('balance_error', self%balance_error)
      call file%keep('largest_error', self%largest_error)
      call file%keep('peak_time', self%peak_time)
      call file%keep('peak', self%peak)
      call file%keep('candidate', self%candidate)
      call file%keep('sought', self%sought)
      call file%keep('rotation_time', self%rotation_time)
      call file%keep('enstrophy', self%enstrophy)
   end subroutine archive_budget

   !> What the steps of a run have given.
   pure type(works_t) function works_of(model, run) result(works)
      type(model_t), intent(in) :: model
      type(step_t), intent(in) :: run
      real(dp) :: solids(2)

      solids = run%work_solids(model)
      works = works_t(run%work_alpha, run%work_delta, run%work_walls, run%work_force, solids(1), run%work_still, solids(2), &
                      run%given_by_sponges(), 0.0_dp, run%work_damper)
      if (model%has_free_bodies()) works%bodies = energy_of_bodies(model, run%poses)
   end function works_of

   ! Kinetic energy of free solids, that in gravity and that of their springs.
   pure real(dp) function energy_of_bodies(model, poses) result(energy)
      type(model_t), intent(in) :: model
      type(pose_t), intent(in) :: poses(:)
      integer :: k

      energy = 0
      do k = 1, size(poses)
         associate (solid => model%solids(k))
            if (solid%body%is_free()) energy = energy + solid%body%energy(poses(k), solid%pivot, model%gravity)
         end associate
      end do
   end function energy_of_bodies

   !> Sum of the works' sizes.
   pure real(dp) function turned_over(self)
      class(works_t), intent(in) :: self

      turned_over = abs(self%alpha) + abs(self%delta) + abs(self%walls) + abs(self%force) + abs(self%solids) &
                    + abs(self%still) + abs(self%pushed) + abs(self%sponges) + abs(self%dampers)
   end function turned_over

   !> Sum of all masses.
   real(dp) function fluid_mass(p) result(mass)
      type(particles_t), intent(in) :: p
      real(dp) :: total(1)

      total = exact_totals(reshape(p%m(1:p%n_own), [1, p%n_own]))
      mass = total(1)
   end function fluid_mass

   !> Takes the initial energies and the rest state's.
   !!
   !! Where there is nothing to lose that could be a measure (no tank, or fluid at rest), energies are normalised by
   !! kinetic and elastic energy at t = 0 and the potential energy: gravity's above the lowest particle,
   !! a central force's from its centre.
   subroutine start_budget(self, model, p, width)
      type(budget_t), intent(out) :: self
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      real(dp), intent(in) :: width   !! of the tank
      real(dp), parameter :: least_share = 1.0e-3_dp
      real(dp) :: mass, depth(1)   ! of the lowest particle, below y = 0

      self%has = model%terms()
      if (self%has%free_bodies) self%e_body_at_start = energy_of_bodies(model, model%poses_at(0.0_dp))
      call measure_energies(model, p, self%initial)
      self%now = self%initial
      self%has_rest = can_rest(model)
      mass = fluid_mass(p)
      self%normaliser = self%initial%total()
      self%scale = other_scale(model)
      depth = maxval(-p%base%y(1:p%n_own), mask=p%id(1:p%n_own) > 0)
      call largest_of_all(1, depth)
      if (model%gravity > 0) self%normaliser = self%normaliser + mass*model%gravity*depth(1)
      if (self%has_rest) then
         if (model%has_solids()) then
            call rest_energies_around(obstacles_in(model%solids, model%poses_at(0.0_dp), model%box), &
                                      model%box%at([left_wall, right_wall, bottom_wall]), mass, &
                                      [model%rho0, model%c0, model%gravity], self%rest%potential, self%rest%elastic)
         else
            call rest_energies(mass, width, model%rho0, model%c0, model%gravity, self%rest%potential, self%rest%elastic)
         end if
         self%rest%potential = self%rest%potential + mass*model%gravity*model%box%at(bottom_wall)
         if (self%initial%total() - self%rest%total() > least_share*self%normaliser) then
            self%normaliser = self%initial%total() - self%rest%total()
            self%scale = 'E_M(0) - E_M(at rest in the tank)'
         end if
      end if
      self%at_start = max(0.0_dp, self%normaliser)
      if (.not. self%normaliser > 0) then
         self%normaliser = 1
         self%scale = '1: there is no energy at the start'
      end if
   end subroutine start_budget

   ! A floor, and walls or a period from left to right, hold the fluid when nothing but gravity acts, and nothing moves in it.
   pure logical function can_rest(model)
      type(model_t), intent(in) :: model
      integer :: k

      can_rest = model%gravity > 0 .and. model%box%has_wall(bottom_wall) &
                 .and. (model%box%is_periodic(1) .or. all(model%box%has_wall([left_wall, right_wall]))) &
                 .and. .not. (model%central_rate > 0 .or. model%has_force() .or. model%tank%moves())
      if (model%has_solids()) can_rest = can_rest .and. .not. any([(model%solids(k)%motion%moves(), k=1, size(model%solids))])
   end function can_rest

   ! What the normaliser is where there is no rest state, or too little to lose until it.
   pure function other_scale(model) result(text)
      type(model_t), intent(in) :: model
      character(:), allocatable :: text

      text = 'E_K(0) + E_C(0)'
      if (model%central_rate > 0) text = text//' + E_P(0) from the centre'
      if (model%gravity > 0) text = text//' + E_P(0) above the lowest particle'
   end function other_scale

   !> Energies and balance of the base state.
   subroutine update_budget(self, model, p, time, works)
      type(budget_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      real(dp), intent(in) :: time
      type(works_t), intent(in) :: works

      call measure_energies(model, p, self%now)
      self%q_alpha = 0 - works%alpha   ! 0, not -0, for an inviscid fluid
      self%q_delta = 0 - works%delta
      self%w_s = works%walls
      self%w_f = works%force
      self%w_solid = works%solids
      self%w_stat = works%still
      self%w_pen = works%pushed
      self%q_sponge = 0 - works%sponges
      self%e_body = works%bodies
      self%q_damper = 0 - works%dampers
      self%balance_error = unexplained(self, self%now%total(), works)/self%normaliser
      self%largest_error = max(self%largest_error, abs(self%balance_error))
      call seek_peak(self, time)
   end subroutine update_budget

   ! What fluid and free solids have gained besides the works.
   pure real(dp) function unexplained(self, energy, works)
      class(budget_t), intent(in) :: self
      real(dp), intent(in) :: energy   ! of the fluid now
      type(works_t), intent(in) :: works

      unexplained = energy - works%alpha - works%delta - works%walls - works%force - works%solids - works%still - works%pushed &
                    - works%sponges - self%initial%total() - works%dampers + works%bodies - self%e_body_at_start
   end function unexplained

   !> What the balance misses at the base state, as a share of the energy at the start or of all that was turned over since,
   !! whichever is larger; for a watch, and no part of the budget.
   real(dp) function imbalance(self, model, p, works)
      type(budget_t), intent(in) :: self
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      type(works_t), intent(in) :: works
      type(energies_t) :: now
      real(dp) :: gained, missing

      call measure_energies(model, p, now)
      gained = now%total() - self%initial%total()
      missing = abs(unexplained(self, now%total(), works))
      imbalance = 0
      if (missing > 0) imbalance = missing/max(self%at_start, abs(gained) + works%turned_over())
   end function imbalance

   !> Where another model takes over at the base state whose energies are not the same, the balance counts from here.
   subroutine begin_balance_anew(self, model, p, works)
      type(budget_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      type(works_t), intent(in) :: works
      real(dp), parameter :: of_the_steps = 0.01_dp   ! share that a balance may miss anyway
      type(energies_t) :: now
      real(dp) :: missing

      call measure_energies(model, p, now)
      missing = unexplained(self, now%total(), works)
      if (abs(missing) > of_the_steps*self%normaliser) self%initial%elastic = self%initial%elastic + missing
   end subroutine begin_balance_anew

   !> Adds to Q_omega what the real viscosity has dissipated since the last call, by the trapezoidal rule.
   !! Source: eq. 29.
   pure subroutine add_rotation(self, model, time, enstrophy)
      type(budget_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      real(dp), intent(in) :: time
      real(dp), intent(in) :: enstrophy   !! int vorticity**2 dA at this time

      if (.not. self%rotation_time < 0) &
         self%q_omega = self%q_omega + model%viscosity*(time - self%rotation_time)*(self%enstrophy + enstrophy)/2
      self%rotation_time = time
      self%enstrophy = enstrophy
   end subroutine add_rotation

   ! A maximum of the energies in turn; the next one is sought once energy has fallen clearly from it.
   subroutine seek_peak(self, time)
      type(budget_t), intent(inout) :: self
      real(dp), intent(in) :: time
      real(dp), parameter :: clear_fall = 0.02_dp   ! share of the normaliser
      real(dp) :: values(4)

      values = [self%now%kinetic, self%now%potential, self%now%kinetic, self%now%elastic]
      associate (value => values(self%sought))
         if (value > self%peak) then
            self%peak = value
            self%candidate = time
         else if (self%sought == 4) then
            ! Elastic energy is spikes: the highest so far, once it has gone by half.
            if (value < self%peak/2) self%peak_time(4) = self%candidate
         else if (value < self%peak - clear_fall*self%normaliser) then
            self%peak_time(self%sought) = self%candidate
            self%sought = self%sought + 1
            self%peak = values(self%sought)
            self%candidate = time
         end if
      end associate
   end subroutine seek_peak

end module budget
