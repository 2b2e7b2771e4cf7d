!> The limits of the weakly-compressible model, eq. 4 and sec. 2 of the paper: Ma <= 0.1 and |rho - rho0|/rho0 <= 1 %.
module limits
   use kinds, only: dp
   use run_log, only: log_t
   use text, only: short
   use time_step, only: step_t
   implicit none
   private

   public :: watch_limits, report_limits, sound_speed_for_mach, sound_speed_for_density

   real(dp), parameter :: mach_limit = 0.1_dp, variation_limit = 0.01_dp
   character(*), parameter :: mach_key = 'Mach number', density_key = 'density'

contains

   !> Warns when a limit is passed for the first time.
   subroutine watch_limits(log, run)
      type(log_t), intent(inout) :: log
      type(step_t), intent(in) :: run

      if (run%mach > mach_limit .and. log%warning_count(mach_key) == 0) call log%warn(mach_key, &
         'Mach number above 0.1 from t = '//short(run%time)//' on; a larger sound_speed would hold it')
      if (run%variation > variation_limit .and. log%warning_count(density_key) == 0) call log%warn(density_key, &
         'density varies by more than 1 % from t = '//short(run%time)//' on')
   end subroutine watch_limits

   !> Says at the end of the run how far the limits were passed, and which sound speeds would have held them.
   !!
   !! Both maxima are of single particles: one that a collapsing cavity throws out may ask for ten times what the
   !! flow as a whole needs.
   subroutine report_limits(log, c0, run)
      type(log_t), intent(inout) :: log
      real(dp), intent(in) :: c0
      type(step_t), intent(in) :: run

      if (run%largest_mach > mach_limit) call log%warn(mach_key, 'largest Mach number '//short(run%largest_mach) &
         //', of a single particle (a collapsing cavity makes some very fast); c0 = ' &
         //short(sound_speed_for_mach(c0, run))//' instead of '//short(c0)//' would have held 0.1 at this speed')
      if (run%largest_variation > variation_limit) call log%warn(density_key, 'largest density variation ' &
         //short(100*run%largest_variation)//' %, of a single particle; c0 = '//short(sound_speed_for_density(c0, run)) &
         //' instead of '//short(c0)//' would have held 1 % at this pressure')
   end subroutine report_limits

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
