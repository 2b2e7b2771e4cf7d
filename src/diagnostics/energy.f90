!> Energies of the particles and their budget.
!!
!! Source: eqs. 10-13. E_K + E_P + E_C + Q_alpha + Q_delta - W_s - W_f stays what it was at t = 0 in the semi-discrete
!! system; what is left is the error of the time integration.
module energy
   use exact_sum, only: add_over_processes, exact_sum_t
   use kinds, only: dp
   use model, only: model_t
   use particles, only: particles_t
   use strips, only: group_slots
   implicit none
   private

   public :: energies_t, measure_energies, elastic_energy

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
   !!
   !! Exact sums over groups of slots, which are parts of a strip: nothing but the particles matters.
   subroutine measure_energies(model, p, energies)
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      type(energies_t), intent(out) :: energies
      type(exact_sum_t) :: sums(3), mine(3)   ! kinetic, potential, elastic/c0**2
      real(dp) :: part(3)
      integer :: g, i, k

      !$omp parallel default(none) shared(model, p, sums) private(mine, part, i, k)
      mine = exact_sum_t()
      !$omp do
      do g = 1, p%n_own/group_slots
         part = 0
         do i = (g - 1)*group_slots + 1, g*group_slots
            if (p%id(i) == 0) cycle
            part = part + p%m(i)*[(p%base%u(i)**2 + p%base%v(i)**2)/2, potential_of(model, p%base%x(i), p%base%y(i)), &
                                  elastic_energy(p%base%s(i)/model%rho0)]
         end do
         do k = 1, 3
            call mine(k)%add(part(k))
         end do
      end do
      !$omp end do nowait
      !$omp critical
      do k = 1, 3
         call sums(k)%add_sum(mine(k))
      end do
      !$omp end critical
      !$omp end parallel
      call add_over_processes(sums)
      energies%kinetic = sums(1)%value()
      energies%potential = sums(2)%value()
      energies%elastic = model%c0**2*sums(3)%value()
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
