!> How far the particles are from the scene's exact solution, and what characterises the solution itself.
!!
!! Errors are taken at the particles' places. Their norms are volume-weighted: with the volumes V_i and the errors e_i,
!! L1 = sum V |e|/sum V, L2 = sqrt(sum V e**2/sum V), max = largest |e|, each divided by the solution's scale of speed or pressure
!! (exact_solution: `speed_scale`, `pressure_scale`), which does not pass through zero as an oscillation does.
module solution_errors
   use energy, only: elastic_energy
   use exact_solution, only: exact_solution_t, new_exact_solution
   use kinds, only: dp
   use model, only: model_t
   use particles, only: particles_t
   use settings, only: settings_t
   implicit none
   private

   public :: solution_errors_t, start_errors, measure_errors

   integer, parameter, public :: name_length = 32
   integer, parameter :: block_slots = 512   !! slots that a partial sum goes over, so that threads don't matter
   integer, parameter :: n_norms = 6         !! sums of the norms, before those that the solution asks for
   integer, parameter :: n_own = 5           !! sums that a solution can ask for
   real(dp), parameter :: pi = acos(-1.0_dp)

   character(name_length), parameter :: norm_names(6) = [character(name_length) :: 'velocity_L1', 'velocity_L2', 'velocity_max', &
                                                         'pressure_L1', 'pressure_L2', 'pressure_max']

   !> The solution and the columns that are measured.
   type :: solution_errors_t
      type(exact_solution_t) :: solution   !! of the continuum
      type(exact_solution_t) :: lattice    !! with the lattice's viscosity or sound speed
      character(name_length), allocatable :: names(:), units(:)   !! (columns)
      real(dp), private :: first(n_own) = 0   !! the solution's own sums at t = 0
   end type solution_errors_t

   !> Sums over the particles.
   type :: sums_t
      real(dp) :: norms(n_norms) = 0   !! V, V|e_u|, V e_u**2, V|e_p|, V e_p**2, V e_u**2 from the lattice's solution
      real(dp) :: own(n_own) = 0
      real(dp) :: largest(3) = 0       !! |e_u|, |e_p|, |u|
   end type sums_t

contains

   !> Names the columns and takes the first sums.
   subroutine start_errors(self, scene, model, p)
      type(solution_errors_t), intent(out) :: self
      type(settings_t), intent(in) :: scene
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p   !! base state at t = 0
      type(sums_t) :: sums

      self%solution = new_exact_solution(scene, model, on_lattice=.false.)
      self%lattice = new_exact_solution(scene, model, on_lattice=.true.)
      allocate (self%names(0), self%units(0))
      if (self%solution%lasts) then
         call add(self, norm_names(:3), 'share of '//short_number(self%solution%speed_scale))
         if (self%solution%by_lattice) call add(self, ['velocity_L2_lattice'], 'share of '//short_number(self%solution%speed_scale))
         call add(self, norm_names(4:), 'share of '//short_number(self%solution%pressure_scale))
      end if
      call add_own(self)
      call sum_up(self, model, p, sums)
      self%first = sums%own
   end subroutine start_errors

   subroutine add(self, names, unit)
      type(solution_errors_t), intent(inout) :: self
      character(*), intent(in) :: names(:)
      character(*), intent(in) :: unit
      character(name_length) :: more(size(names)), units(size(names))

      more = names
      units = unit
      self%names = [self%names, more]
      self%units = [self%units, units]
   end subroutine add

   function short_number(number) result(words)
      real(dp), intent(in) :: number
      character(:), allocatable :: words
      character(16) :: buffer

      write (buffer, '(es13.6)') number
      words = trim(adjustl(buffer))
   end function short_number

   ! The columns that only this solution has; values: `own_values`.
   subroutine add_own(self)
      type(solution_errors_t), intent(inout) :: self

      select case (self%solution%name)
      case ('hydrostatic')
         call add(self, ['max_speed'], 'share of sqrt(g H)')
      case ('standing_wave')
         call add(self, [character(16) :: 'mode', 'mode_exact'], 'share of mode at t = 0')
         call add(self, [character(16) :: 'E_K', 'E_K_exact'], 'energy/width')
      case ('oscillating_drop')
         call add(self, [character(16) :: 'a', 'b', 'a_exact', 'b_exact'], 'length')
         call add(self, [character(16) :: 'A', 'A_exact'], '1/time')
         call add(self, [character(16) :: 'E_K', 'E_K_exact'], 'energy/width')
      case ('impact')
         call add(self, [character(24) :: 'lost_kinetic', 'lost_flow', 'lost_mechanical', 'lost_exact'], 'share of E_K at t = 0')
      case ('taylor_green')
         call add(self, [character(16) :: 'mode', 'mode_exact', 'mode_lattice'], 'share of mode at t = 0')
         call add(self, ['E_K'], 'energy/width')
      case ('acoustic_wave')
         call add(self, [character(16) :: 'mode', 'mode_exact', 'mode_lattice'], 'share of mode at t = 0')
         call add(self, [character(16) :: 'phase', 'phase_exact', 'phase_lattice'], 'radian, -pi to pi')
      case ('couette', 'poiseuille')
         call add(self, [character(16) :: 'mode', 'mode_exact', 'mode_lattice'], 'length/time')
      case ('rotating_square')
         call add(self, [character(24) :: 'E_K', 'angular_momentum'], 'share of that at t = 0')
      end select
   end subroutine add_own

   !> The columns at the base state.
   subroutine measure_errors(self, model, p, time, values)
      type(solution_errors_t), intent(inout) :: self   !! its solutions move to the time
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      real(dp), intent(in) :: time
      real(dp), allocatable, intent(out) :: values(:)   !! (columns)
      type(sums_t) :: sums

      call self%solution%move_to(time)
      call self%lattice%move_to(time)
      call sum_up(self, model, p, sums)
      allocate (values(0))
      if (self%solution%lasts) then
         associate (s => sums%norms, u => self%solution%speed_scale, stress => self%solution%pressure_scale)
            values = [s(2)/(s(1)*u), sqrt(s(3)/s(1))/u, sums%largest(1)/u]
            if (self%solution%by_lattice) values = [values, sqrt(s(6)/s(1))/u]
            values = [values, s(4)/(s(1)*stress), sqrt(s(5)/s(1))/stress, sums%largest(2)/stress]
         end associate
      end if
      values = [values, own_values(self, sums)]
   end subroutine measure_errors

   ! The columns that only this solution has, from its sums.
   function own_values(self, sums) result(values)
      type(solution_errors_t), intent(in) :: self
      type(sums_t), intent(in) :: sums
      real(dp), allocatable :: values(:)

      associate (own => sums%own, first => self%first, now => self%solution, on => self%lattice, t => self%solution%time)
         select case (now%name)
         case ('hydrostatic')
            values = [sums%largest(3)/now%speed_scale]
         case ('standing_wave')
            values = [own(1)/own(2), now%wave%amplitude(t), own(3), now%rho0*now%wave%kinetic_energy(now%extent(1), t)]
         case ('oscillating_drop')
            values = [2*sqrt(own(2:3)/own(1)), now%drop%a, now%drop%b, own(4)/(own(2) + own(3)), now%drop%stretch, &
                      own(5), now%rho0*now%drop%kinetic_energy()]
         case ('impact')
            values = [1 - own(1)/first(1), 1 - (own(1) - own(2))/first(1), 1 - (own(1) + own(2))/(first(1) + first(2)), &
                      now%lost_share]
         case ('taylor_green')
            values = [own(1)/own(2), now%vortices%amplitude(t), on%vortices%amplitude(t), own(3)]
         case ('acoustic_wave')
            values = [norm2(own(1:2))/norm2(first(1:2)), exp(-now%sound%damping*t), exp(-on%sound%damping*t), &
                      phase(own(1), own(2)), turned(now%sound%k*now%sound%speed*t), turned(on%sound%k*on%sound%speed*t)]
         case ('couette', 'poiseuille')
            values = [own(1)/own(2), now%channel%mode(t), on%channel%mode(t)]
         case ('rotating_square')
            values = own(1:2)/first(1:2)
         case default
            allocate (values(0))
         end select
      end associate
   end function own_values

   ! Angle of a point, 0 for the origin.
   pure real(dp) function phase(x, y)
      real(dp), intent(in) :: x, y

      phase = 0
      if (abs(x) + abs(y) > 0) phase = atan2(y, x)
   end function phase

   ! An angle between -pi and pi.
   pure real(dp) function turned(angle)
      real(dp), intent(in) :: angle

      turned = angle - 2*pi*nint(angle/(2*pi))
   end function turned

   ! All sums over the particles, by blocks.
   subroutine sum_up(self, model, p, sums)
      type(solution_errors_t), intent(in) :: self
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      type(sums_t), intent(out) :: sums
      type(sums_t), allocatable :: partial(:)
      integer :: b, i, n_blocks

      n_blocks = (p%n_own + block_slots - 1)/block_slots
      allocate (partial(n_blocks))
      !$omp parallel do default(none) shared(self, model, p, partial, n_blocks) private(i)
      do b = 1, n_blocks
         do i = (b - 1)*block_slots + 1, min(b*block_slots, p%n_own)
            if (p%id(i) > 0) call add_particle(self, model, p, i, partial(b))
         end do
      end do
      !$omp end parallel do
      do b = 1, n_blocks
         sums%norms = sums%norms + partial(b)%norms
         sums%own = sums%own + partial(b)%own
         sums%largest = max(sums%largest, partial(b)%largest)
      end do
   end subroutine sum_up

   pure subroutine add_particle(self, model, p, i, sums)
      type(solution_errors_t), intent(in) :: self
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      integer, intent(in) :: i   !! slot
      type(sums_t), intent(inout) :: sums
      real(dp) :: r(2), u(2), error(2), on_lattice

      r = [p%base%x(i), p%base%y(i)]
      u = [p%base%u(i), p%base%v(i)]
      associate (w => p%base%w(i))
         if (self%solution%lasts) then
            error(1) = norm2(u - self%solution%velocity(r))
            error(2) = abs(model%c0**2*p%base%s(i) - self%solution%pressure(r))
            on_lattice = 0
            if (self%solution%by_lattice) on_lattice = norm2(u - self%lattice%velocity(r))
            sums%norms = sums%norms + w*[1.0_dp, error(1), error(1)**2, error(2), error(2)**2, on_lattice**2]
            sums%largest = max(sums%largest, [error, norm2(u)])
         end if
         sums%own = sums%own + own_terms(self%solution, r - self%solution%origin, u, p%base%s(i), w, p%m(i))
      end associate
   end subroutine add_particle

   ! What a particle adds to the solution's own sums.
   pure function own_terms(solution, r, u, s, w, m) result(terms)
      type(exact_solution_t), intent(in) :: solution
      real(dp), intent(in) :: r(2)      !! from the solution's origin
      real(dp), intent(in) :: u(2), s   !! velocity, rho - rho0
      real(dp), intent(in) :: w, m      !! volume, mass
      real(dp) :: terms(n_own)
      real(dp) :: mode(2)

      terms = 0
      select case (solution%name)
      case ('standing_wave', 'taylor_green')
         ! Projection on the field of t = 0
         if (solution%name == 'standing_wave') mode = solution%wave%velocity(r(1), r(2), 0.0_dp)
         if (solution%name == 'taylor_green') mode = solution%vortices%velocity(r(1), r(2), 0.0_dp)
         terms(1:3) = [w*dot_product(u, mode), w*dot_product(mode, mode), m*dot_product(u, u)/2]
      case ('oscillating_drop')
         terms(1:5) = m*[1.0_dp, r(1)**2, r(2)**2, r(1)*u(1) - r(2)*u(2), dot_product(u, u)/2]
      case ('impact')
         terms(1:2) = m*[dot_product(u, u)/2, solution%c0**2*elastic_energy(s/solution%rho0)]
      case ('acoustic_wave')
         terms(1:2) = w*s*[cos(solution%sound%k*r(1)), sin(solution%sound%k*r(1))]
      case ('couette', 'poiseuille')
         mode(1) = sin(pi*r(2)/solution%extent(2))
         terms(1:2) = w*[u(1)*mode(1), mode(1)**2]
      case ('rotating_square')
         terms(1:2) = m*[dot_product(u, u)/2, r(1)*u(2) - r(2)*u(1)]
      end select
   end function own_terms

end module solution_errors
