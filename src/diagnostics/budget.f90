!> The energy budget over a run: normaliser, balance error and milestones.
!!
!! Source: sec. 5 of the paper. Energies are normalised by Delta E_Mtot, what the fluid can lose until it rests;
!! Q_alpha and Q_delta are the energies that the diffusive terms have taken, W_s what the walls' images gave.
module budget
   use energy, only: energies_t, measure_energies
   use images, only: bottom_wall, left_wall, right_wall
   use kinds, only: dp
   use model, only: model_t
   use particles, only: particles_t
   use rest_state, only: rest_energies
   implicit none
   private

   public :: budget_t, start_budget, update_budget, fluid_mass

   !> Where the energy is and has gone.
   type :: budget_t
      type(energies_t) :: initial
      type(energies_t) :: rest               !! 0 where the scene has no tank that it could rest in
      logical :: has_rest = .false.
      real(dp) :: normaliser = 1             !! Delta E_Mtot, or another scale: start_budget
      type(energies_t) :: now
      real(dp) :: q_alpha = 0, q_delta = 0   !! dissipated, > 0
      real(dp) :: w_s = 0                    !! work of the walls' images
      real(dp) :: balance_error = 0          !! of the last update, share of the normaliser
      real(dp) :: largest_error = 0          !! largest |balance_error| so far
      real(dp) :: peak_time(4) = -1          !! first kinetic, potential, second kinetic, elastic maximum; -1: not yet
      real(dp), private :: peak = -huge(1.0_dp), candidate = 0
      integer, private :: sought = 1         !! which of the maxima comes next
   end type budget_t

contains

   !> Sum of all masses.
   pure real(dp) function fluid_mass(p) result(mass)
      type(particles_t), intent(in) :: p

      mass = sum(p%m(1:p%n_own))
   end function fluid_mass

   !> Takes the initial energies and the rest state's.
   !!
   !! Where there is nothing to lose that could be a measure (no tank, or fluid at rest), energies are normalised by
   !! kinetic and elastic energy at t = 0 and the potential energy of the fluid above its lowest particle.
   subroutine start_budget(self, model, p, width)
      type(budget_t), intent(out) :: self
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      real(dp), intent(in) :: width   !! of the tank
      real(dp), parameter :: least_share = 1.0e-3_dp
      real(dp) :: mass

      call measure_energies(model, p, self%initial)
      self%now = self%initial
      self%has_rest = model%gravity > 0 .and. all(model%walls%present([left_wall, right_wall, bottom_wall]))
      self%normaliser = self%initial%kinetic + self%initial%elastic &
                        + self%initial%potential - fluid_mass(p)*model%gravity*minval(p%base%y(1:p%n_own))
      if (self%has_rest) then
         mass = fluid_mass(p)
         call rest_energies(mass, width, model%rho0, model%c0, model%gravity, self%rest%potential, self%rest%elastic)
         self%rest%potential = self%rest%potential + mass*model%gravity*model%walls%at(bottom_wall)
         if (self%initial%total() - self%rest%total() > least_share*self%normaliser) &
            self%normaliser = self%initial%total() - self%rest%total()
      end if
      if (.not. self%normaliser > 0) self%normaliser = 1
   end subroutine start_budget

   !> Energies and balance of the base state.
   subroutine update_budget(self, model, p, time, work_alpha, work_delta, work_walls)
      type(budget_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      real(dp), intent(in) :: time
      real(dp), intent(in) :: work_alpha, work_delta, work_walls   !! given to the fluid since t = 0

      call measure_energies(model, p, self%now)
      self%q_alpha = 0 - work_alpha   ! 0, not -0, for an inviscid fluid
      self%q_delta = 0 - work_delta
      self%w_s = work_walls
      self%balance_error = (self%now%total() + self%q_alpha + self%q_delta - self%w_s - self%initial%total())/self%normaliser
      self%largest_error = max(self%largest_error, abs(self%balance_error))
      call seek_peak(self, time)
   end subroutine update_budget

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
