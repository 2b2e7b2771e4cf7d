!> Energies of the particles and their budget.
!!
!! Source: eqs. 10-13. E_K + E_P + E_C + Q_alpha + Q_delta - W_s - W_f stays what it was at t = 0 in the semi-discrete
!! system; what is left is the error of the time integration.
module energy
   use kinds, only: dp
   use model, only: model_t
   use particles, only: particles_t
   implicit none
   private

   public :: energies_t, measure_energies, elastic_energy

   integer, parameter :: block_slots = 512   !! slots that a partial sum goes over, so that threads don't matter

   !> Energies per unit of the third dimension.
   type :: energies_t
      real(dp) :: kinetic = 0     !! E_K = sum m u**2/2
      real(dp) :: potential = 0   !! E_P = sum m (g y + w**2 |r - centre|**2/2)
      real(dp) :: elastic = 0     !! E_C, eq. 11
   contains
      procedure :: total
   end type energies_t

contains

   !> E_M = E_K + E_P + E_C.
   pure real(dp) function total(self)
      class(energies_t), intent(in) :: self

      total = self%kinetic + self%potential + self%elastic
   end function total

   !> Energies of the base state.
   subroutine measure_energies(model, p, energies)
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      type(energies_t), intent(out) :: energies
      real(dp), allocatable :: partial(:, :)
      integer :: b, i, n_blocks

      n_blocks = (p%n_own + block_slots - 1)/block_slots
      allocate (partial(3, n_blocks))
      !$omp parallel do default(none) shared(model, p, partial, n_blocks) private(i)
      do b = 1, n_blocks
         partial(:, b) = 0
         do i = (b - 1)*block_slots + 1, min(b*block_slots, p%n_own)
            if (p%id(i) == 0) cycle
            partial(1, b) = partial(1, b) + p%m(i)*(p%base%u(i)**2 + p%base%v(i)**2)/2
            partial(2, b) = partial(2, b) + p%m(i)*potential_of(model, p%base%x(i), p%base%y(i))
            partial(3, b) = partial(3, b) + p%m(i)*elastic_energy(p%base%s(i)/model%rho0)
         end do
      end do
      !$omp end parallel do
      energies%kinetic = sum(partial(1, :))
      energies%potential = sum(partial(2, :))
      energies%elastic = model%c0**2*sum(partial(3, :))
   end subroutine measure_energies

   ! Of a unit of mass: of gravity from y = 0, of the central force from its centre.
   pure real(dp) function potential_of(model, x, y)
      type(model_t), intent(in) :: model
      real(dp), intent(in) :: x, y

      potential_of = model%gravity*y &
                     + model%central_rate**2*((x - model%centre(1))**2 + (y - model%centre(2))**2)/2
   end function potential_of

   !> ln(rho/rho0) + rho0/rho - 1 with rho/rho0 = 1 + e, eq. 11, without cancellation for small e.
   elemental real(dp) function elastic_energy(e) result(energy)
      real(dp), intent(in) :: e   !! (rho - rho0)/rho0
      real(dp) :: term
      integer :: n

      if (abs(e) > 0.03_dp) then
         energy = log(1 + e) - e/(1 + e)
         return
      end if
      ! sum_{n>=2} (-1)**n (n-1)/n e**n
      energy = 0
      term = -e
      do n = 2, 10
         term = -term*e
         energy = energy + term*real(n - 1, dp)/n
      end do
   end function elastic_energy

end module energy
