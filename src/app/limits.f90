!> The limits of the weakly-compressible model, eq. 4 and sec. 2 of the paper: Ma <= 0.1 and |rho - rho0|/rho0 <= 1 %.
module limits
   use archive, only: archive_t
   use communication, only: sums_of_all
   use equation_of_state, only: specific_pressure
   use kinds, only: dp, i8
   use model, only: model_t
   use particles, only: particles_t
   use run_log, only: log_t
   use step_state, only: step_t
   use text, only: short, to_text
   implicit none
   private

   public :: extremes_t, watch_limits, report_limits, sound_speed_for_mach, sound_speed_for_density

   real(dp), parameter :: mach_limit = 0.1_dp, variation_limit = 0.01_dp
   character(*), parameter :: mach_key = 'Mach number', density_key = 'density'

   !> How many particles shared in the largest values, at the time of these or shortly before.
   type :: extremes_t
      real(dp) :: mach = 0, variation = 0   !! that they were counted at
      integer :: fast = 0, dense = 0        !! particles with more than half of that
   contains
      procedure :: archive => archive_extremes
   end type extremes_t

   real(dp), parameter :: grown = 1.05_dp         !! since the last count: worth another
   real(dp), parameter :: few_share = 0.01_dp     !! of all particles

contains

   subroutine archive_extremes(self, file)
      class(extremes_t), intent(inout) :: self
      class(archive_t), intent(inout) :: file

      call file%part('extremes')
      call file%keep('mach', self%mach)
      call file%keep('variation', self%variation)
      call file%keep('fast', self%fast)
      call file%keep('dense', self%dense)
   end subroutine archive_extremes

   !> Warns when a limit is passed for the first time, and counts the particles that did it.
   subroutine watch_limits(extremes, log, model, p, run)
      type(extremes_t), intent(inout) :: extremes
      type(log_t), intent(inout) :: log
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p   !! base state
      type(step_t), intent(in) :: run

      associate (own => p%id(:p%n_own) > 0, u => p%base%u(:p%n_own), v => p%base%v(:p%n_own), s => p%base%s(:p%n_own))
         if (run%mach > max(mach_limit, grown*extremes%mach)) then
            if (.not. extremes%mach > 0) call log%warn(mach_key, 'Mach number above 0.1 from t = '//short(run%time) &
                                                       //' on; a larger sound_speed would hold it')
            extremes%mach = run%mach
            extremes%fast = in_all(count(own .and. max(u**2 + v**2, specific_pressure(model%c0, model%rho0, s)) &
                                         > (run%mach*model%c0/2)**2))
         end if
         if (run%variation > max(variation_limit, grown*extremes%variation)) then
            if (.not. extremes%variation > 0) call log%warn(density_key, 'density varies by more than 1 % from t = ' &
                                                            //short(run%time)//' on')
            extremes%variation = run%variation
            extremes%dense = in_all(count(own .and. abs(s) > run%variation*model%rho0/2))
         end if
      end associate
   end subroutine watch_limits

   ! Of all processes.
   integer function in_all(number)
      integer, intent(in) :: number
      integer(i8) :: total(1)

      total = number
      call sums_of_all(1, total)
      in_all = int(total(1))
   end function in_all

   !> Says at the end of the run how far the limits were passed, and which sound speeds would have held them.
   !!
   !! Both maxima may be of single particles: one that a collapsing cavity throws out may ask for ten times what the
   !! flow as a whole needs. No sound speed would have held what is not finite.
   subroutine report_limits(extremes, log, c0, n, run)
      type(extremes_t), intent(in) :: extremes
      type(log_t), intent(inout) :: log
      real(dp), intent(in) :: c0
      integer, intent(in) :: n   !! particles
      type(step_t), intent(in) :: run

      if (is_beyond(run%largest_mach, mach_limit)) call log%warn(mach_key, 'largest Mach number '//short(run%largest_mach) &
         //sharers(extremes%fast, n, 'a collapsing cavity makes some very fast')//'; c0 = ' &
         //short(sound_speed_for_mach(c0, run))//' instead of '//short(c0)//' would have held 0.1 at this speed')
      if (is_beyond(run%largest_variation, variation_limit)) call log%warn(density_key, 'largest density variation ' &
         //short(100*run%largest_variation)//' %'//sharers(extremes%dense, n, 'a collapsing cavity squeezes some') &
         //'; c0 = '//short(sound_speed_for_density(c0, run))//' instead of '//short(c0)//' would have held 1 % at this pressure')
   end subroutine report_limits

   pure logical function is_beyond(value, limit)
      real(dp), intent(in) :: value, limit

      is_beyond = value > limit .and. value <= huge(value)
   end function is_beyond

   ! Whose a maximum was.
   pure function sharers(number, n, why) result(words)
      integer, intent(in) :: number, n   !! particles with more than half of it; all
      character(*), intent(in) :: why    !! it may be of few only
      character(:), allocatable :: words

      words = ''
      if (number == 0) return   ! the run ended before anything was counted
      words = ', more than half of that in '//to_text(number)//' of '//to_text(n)//' particles'
      if (number <= max(1, int(few_share*n))) words = words//' ('//why//')'
   end function sharers

   !> Sound speed at which the largest speed would have been Ma = 0.1.
   pure real(dp) function sound_speed_for_mach(c0, run) result(needed)
      real(dp), intent(in) :: c0
      type(step_t), intent(in) :: run

      needed = c0*run%largest_mach/mach_limit
   end function sound_speed_for_mach

   !> Sound speed at which the largest pressure would have changed the density by 1 %: p = c0**2 (rho - rho0).
   pure real(dp) function sound_speed_for_density(c0, run) result(needed)
      real(dp), intent(in) :: c0
      type(step_t), intent(in) :: run

      needed = c0*sqrt(run%largest_variation/variation_limit)
   end function sound_speed_for_density

end module limits
