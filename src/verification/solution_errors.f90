!> How far the particles are from the scene's exact solution, and what characterises the solution itself.
!!
!! Errors are taken at the particles' places. Their norms are volume-weighted: with the volumes V_i and the errors e_i,
!! L1 = sum V |e|/sum V, L2 = sqrt(sum V e**2/sum V), max = largest |e|, each divided by the solution's scale of speed or pressure
!! (`speed_scale`, `pressure_scale`), which does not pass through zero as an oscillation does.
module solution_errors
   use columns, only: columns_t
   use equation_of_state, only: pressure_of
   use communication, only: largest_of_all
   use exact_sum, only: exact_totals
   use kinds, only: dp
   use model, only: model_t
   use particles, only: particles_t
   use settings, only: settings_t
   use solution, only: n_sums, solution_t
   use solution_register, only: new_solution
   use solution_results, only: history_t, known, last, result_t, time_mean
   use strips, only: group_slots
   implicit none
   private

   public :: solution_errors_t, start_errors, measure_errors, results_of

   integer, parameter :: n_norms = 6   !! sums of the norms

   !> The solution and its own sums at t = 0.
   type :: solution_errors_t
      class(solution_t), allocatable :: solution
      real(dp), private :: first(n_sums) = 0
   end type solution_errors_t

   !> Sums over the particles.
   type :: sums_t
      real(dp) :: norms(n_norms) = 0   !! V, V|e_u|, V e_u**2, V|e_p|, V e_p**2, V e_u**2 from the lattice's solution
      real(dp) :: own(n_sums) = 0      !! `terms` of the solution
      real(dp) :: largest(3) = 0       !! |e_u|, |e_p|, |u|
   end type sums_t

contains

   !> Takes the first sums.
   subroutine start_errors(self, scene, model, p)
      type(solution_errors_t), intent(out) :: self
      type(settings_t), intent(in) :: scene   !! with an exact solution
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p      !! base state at t = 0
      type(sums_t) :: sums

      call new_solution(scene, model, self%solution)
      call sum_up(self%solution, model, p, sums)
      self%first = sums%own
   end subroutine start_errors

   !> The columns at the base state: the norms of a solution that lasts, then its own.
   subroutine measure_errors(self, model, p, time, row)
      type(solution_errors_t), intent(inout) :: self   !! its solution moves to the time
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      real(dp), intent(in) :: time                     !! [s]
      type(columns_t), intent(inout) :: row
      type(sums_t) :: sums

      call self%solution%move_to(time)
      call sum_up(self%solution, model, p, sums)
      if (self%solution%lasts) call add_norms(self%solution, sums, row)
      call self%solution%add_columns(sums%own, self%first, sums%largest(3), row)
   end subroutine measure_errors

   subroutine add_norms(solution, sums, row)
      class(solution_t), intent(in) :: solution
      type(sums_t), intent(in) :: sums
      type(columns_t), intent(inout) :: row
      character(:), allocatable :: share

      associate (s => sums%norms, u => solution%speed_scale, stress => solution%pressure_scale)
         share = 'share of '//short_number(u)
         call row%add('velocity_L1', share, s(2)/(s(1)*u))
         call row%add('velocity_L2', share, sqrt(s(3)/s(1))/u)
         call row%add('velocity_max', share, sums%largest(1)/u)
         if (solution%by_lattice) call row%add('velocity_L2_lattice', share, sqrt(s(6)/s(1))/u)
         share = 'share of '//short_number(stress)
         call row%add('pressure_L1', share, s(4)/(s(1)*stress))
         call row%add('pressure_L2', share, sqrt(s(5)/s(1))/stress)
         call row%add('pressure_max', share, sums%largest(2)/stress)
      end associate
   end subroutine add_norms

   function short_number(number) result(words)
      real(dp), intent(in) :: number
      character(:), allocatable :: words
      character(16) :: buffer

      write (buffer, '(es13.6)') number
      words = trim(adjustl(buffer))
   end function short_number

   ! All sums over the particles: exact over groups of slots, so that nothing but the particles matters.
   subroutine sum_up(solution, model, p, sums)
      class(solution_t), intent(in) :: solution
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      type(sums_t), intent(out) :: sums
      type(sums_t) :: group
      real(dp), allocatable :: table(:, :)
      real(dp) :: totals(n_norms + n_sums), largest(3)
      integer :: g, i, n_groups

      n_groups = p%n_own/group_slots
      allocate (table(n_norms + n_sums, n_groups))
      largest = 0
      !$omp parallel do default(none) shared(solution, model, p, table, n_groups) private(group, i) reduction(max:largest)
      do g = 1, n_groups
         group = sums_t()
         do i = (g - 1)*group_slots + 1, g*group_slots
            if (p%id(i) > 0) call add_particle(solution, model, p, i, group)
         end do
         table(:, g) = [group%norms, group%own]
         largest = max(largest, group%largest)
      end do
      !$omp end parallel do
      totals = exact_totals(table)
      call largest_of_all(3, largest)
      sums = sums_t(norms=totals(:n_norms), own=totals(n_norms + 1:), largest=largest)
   end subroutine sum_up

   pure subroutine add_particle(solution, model, p, i, sums)
      class(solution_t), intent(in) :: solution
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      integer, intent(in) :: i   !! slot
      type(sums_t), intent(inout) :: sums
      real(dp) :: r(2), u(2), error(2), on_lattice

      r = [p%base%x(i), p%base%y(i)]
      u = [p%base%u(i), p%base%v(i)]
      associate (w => p%base%volume(i))
         if (solution%lasts) then
            error(1) = norm2(u - solution%velocity(r))
            error(2) = abs(pressure_of(model%c0, p%base%s(i)) - solution%pressure(r))
            on_lattice = 0
            if (solution%by_lattice) on_lattice = norm2(u - solution%lattice_velocity(r))
            sums%norms = sums%norms + w*[1.0_dp, error(1), error(1)**2, error(2), error(2)**2, on_lattice**2]
            sums%largest = max(sums%largest, [error, norm2(u)])
         end if
         sums%own = sums%own + solution%terms(r - solution%origin, u, p%base%s(i), w, p%m(i))
      end associate
   end subroutine add_particle

   !> What the columns over time say in the end: the solution's own results, then norms.
   function results_of(solution, history) result(results)
      class(solution_t), intent(in) :: solution
      type(history_t), intent(in) :: history
      type(result_t), allocatable :: results(:)

      allocate (results(0))
      if (size(history%times) == 0) return
      results = solution%results(history)
      if (solution%lasts) results = [results, norm_results(history)]
   end function results_of

   ! Norms at the end and averaged over time.
   function norm_results(history) result(results)
      type(history_t), intent(in) :: history
      type(result_t), allocatable :: results(:)
      integer :: k

      allocate (results(0))
      do k = 1, size(history%names)
         if (index(history%names(k), 'velocity_') /= 1 .and. index(history%names(k), 'pressure_') /= 1) cycle
         results = [results, known('error_'//history%names(k), last(history%values(k, :))), &
                    known('error_'//trim(history%names(k))//'_mean', time_mean(history%times, history%values(k, :)))]
      end do
   end function norm_results

end module solution_errors
