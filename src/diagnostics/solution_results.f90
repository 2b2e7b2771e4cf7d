!> What a run says about its exact solution in the end: frequencies, rates, losses, from the columns over time.
module solution_results
   use exact_solution, only: exact_solution_t
   use fitting, only: first_maximum, fit_approach, fit_oscillation, line_fit, oscillation_t, unwrapped, zero_crossings
   use kinds, only: dp
   use solution_errors, only: name_length, solution_errors_t
   implicit none
   private

   public :: result_t, results_of

   !> A line of the summary.
   type :: result_t
      character(48) :: key = ''
      real(dp) :: value = 0
      logical :: known = .false.   !! false where the run is too short to tell
   end type result_t

   !> Times over which the loss of an impact is averaged, in c0 t/H with H along the motion; why these: docs/scenes.md.
   real(dp), parameter, public :: impact_window(2) = [10.0_dp, 20.0_dp]

contains

   !> All results of a solution.
   function results_of(errors, times, history) result(results)
      type(solution_errors_t), intent(in) :: errors
      real(dp), intent(in) :: times(:)        !! (rows)
      real(dp), intent(in) :: history(:, :)   !! (columns, rows)
      type(result_t), allocatable :: results(:)

      allocate (results(0))
      if (size(times) == 0) return
      select case (errors%solution%name)
      case ('hydrostatic')
         results = [known('hydrostatic_max_speed', maxval(column(errors, history, 'max_speed')))]
      case ('standing_wave')
         results = wave_results(errors, times, column(errors, history, 'mode'))
      case ('oscillating_drop')
         results = drop_results(errors%solution, times, column(errors, history, 'a'), column(errors, history, 'b'))
      case ('impact')
         results = impact_results(errors%solution, times, column(errors, history, 'lost_flow'), &
                                  column(errors, history, 'lost_mechanical'))
      case ('taylor_green')
         results = vortex_results(errors, times, column(errors, history, 'mode'))
      case ('acoustic_wave')
         results = sound_results(errors, times, column(errors, history, 'mode'), column(errors, history, 'phase'))
      case ('couette', 'poiseuille')
         results = channel_results(errors, times, column(errors, history, 'mode'))
      case ('rotating_square')
         results = [known('rotating_square_kinetic_energy', last(column(errors, history, 'E_K'))), &
                    known('rotating_square_angular_momentum', last(column(errors, history, 'angular_momentum')))]
      end select
      if (errors%solution%lasts) results = [results, norm_results(errors, times, history)]
   end function results_of

   ! Norms at the end and averaged over time.
   function norm_results(errors, times, history) result(results)
      type(solution_errors_t), intent(in) :: errors
      real(dp), intent(in) :: times(:), history(:, :)
      type(result_t), allocatable :: results(:)
      integer :: k

      allocate (results(0))
      do k = 1, size(errors%names)
         if (index(errors%names(k), 'velocity_') /= 1 .and. index(errors%names(k), 'pressure_') /= 1) cycle
         results = [results, known('error_'//errors%names(k), last(history(k, :))), &
                    known('error_'//trim(errors%names(k))//'_mean', time_mean(times, history(k, :)))]
      end do
   end function norm_results

   ! Frequency and decay of the oscillation.
   function wave_results(errors, times, mode) result(results)
      type(solution_errors_t), intent(in) :: errors
      real(dp), intent(in) :: times(:), mode(:)
      type(result_t) :: results(6)
      type(oscillation_t) :: fit
      logical :: found

      associate (exact => errors%solution%wave)
         call fit_oscillation(times, mode, exact%frequency, fit, found)
         results = [result_t('standing_wave_frequency', fit%frequency, found), &
                    result_t('standing_wave_frequency_error', fit%frequency/exact%frequency - 1, found), &
                    result_t('standing_wave_decay_rate', fit%decay, found), &
                    share('standing_wave_decay_over_first_order', fit%decay, exact%first_order_decay, found), &
                    share('standing_wave_decay_over_exact', fit%decay, exact%decay, found), &
                    share('standing_wave_decay_over_lattice', fit%decay, errors%lattice%wave%decay, found)]
      end associate
   end function wave_results

   ! The first period ends at the second time that the axes are equal again; the longest axis is a's first maximum.
   function drop_results(exact, times, a, b) result(results)
      type(exact_solution_t), intent(in) :: exact
      real(dp), intent(in) :: times(:), a(:), b(:)
      type(result_t) :: results(4)
      real(dp), allocatable :: equal(:)
      real(dp) :: period, time, axis
      logical :: found

      ! At t = 0 they are equal to the last digit or nearly.
      allocate (equal, source=zero_crossings(times(2:), a(2:) - b(2:)))
      period = 0
      if (size(equal) >= 2) period = equal(2)
      results(1) = result_t('drop_period', period, size(equal) >= 2)
      results(2) = result_t('drop_period_error', period/exact%drop%period() - 1, size(equal) >= 2)
      call first_maximum(times, a, time, axis, found)
      results(3) = result_t('drop_a_max', axis, found)
      results(4) = result_t('drop_a_max_error', axis/exact%drop%largest_axis() - 1, found)
   end function drop_results

   ! The loss right after the impact: averages over the window, while the flow is still that of the impact.
   function impact_results(exact, times, flow, mechanical) result(results)
      type(exact_solution_t), intent(in) :: exact
      real(dp), intent(in) :: times(:), flow(:), mechanical(:)
      type(result_t) :: results(4)
      logical :: inside(size(times)), found
      real(dp) :: scaled(size(times)), loss(2)

      scaled = times*exact%c0/exact%extent(2)
      inside = scaled >= impact_window(1) .and. scaled <= impact_window(2)
      ! The window counts when the run goes through all of it.
      found = count(inside) >= 2 .and. last(scaled) >= impact_window(2)*(1 - 1.0e-9_dp)
      loss = 0
      if (found) loss = [time_mean(pack(times, inside), pack(flow, inside)), &
                         time_mean(pack(times, inside), pack(mechanical, inside))]
      results = [result_t('impact_loss', loss(1), found), &
                 result_t('impact_loss_error', loss(1) - exact%lost_share, found), &
                 result_t('impact_loss_mechanical', loss(2), found), &
                 known('impact_loss_exact', exact%lost_share)]
   end function impact_results

   ! Slope of the mode's logarithm.
   function vortex_results(errors, times, mode) result(results)
      type(solution_errors_t), intent(in) :: errors
      real(dp), intent(in) :: times(:), mode(:)
      type(result_t) :: results(3)
      real(dp) :: offset, slope
      logical :: found

      call log_fit(times, mode, offset, slope, found)
      results = [result_t('taylor_green_decay_rate', -slope, found), &
                 share('taylor_green_decay_over_exact', -slope, errors%solution%vortices%decay, found), &
                 share('taylor_green_decay_over_lattice', -slope, errors%lattice%vortices%decay, found)]
   end function vortex_results

   ! Slopes of the phase and of the mode's logarithm, over at least a period.
   function sound_results(errors, times, mode, phase) result(results)
      type(solution_errors_t), intent(in) :: errors
      real(dp), intent(in) :: times(:), mode(:), phase(:)
      type(result_t) :: results(5)
      real(dp), parameter :: turn = 2*acos(-1.0_dp)
      real(dp) :: offset, rate, slope
      logical :: found, long

      associate (exact => errors%solution%sound, on => errors%lattice%sound)
         call line_fit(times, unwrapped(phase), offset, rate, found)
         long = (last(times) - times(1))*exact%k*exact%speed >= turn
         results(1) = result_t('acoustic_speed', rate/exact%k, found .and. long)
         results(2) = share('acoustic_speed_over_c0', rate/exact%k, exact%speed, found .and. long)
         results(3) = share('acoustic_speed_over_lattice', rate/exact%k, on%speed, found .and. long)
         call log_fit(times, mode, offset, slope, found)
         results(4) = result_t('acoustic_damping', -slope, found .and. long)
         results(5) = share('acoustic_damping_over_lattice', -slope, on%damping, found .and. long)
      end associate
   end function sound_results

   ! The viscosity by the approach of the slowest mode to its steady value.
   function channel_results(errors, times, mode) result(results)
      type(solution_errors_t), intent(in) :: errors
      real(dp), intent(in) :: times(:), mode(:)
      type(result_t) :: results(3)
      character(:), allocatable :: name
      real(dp) :: rate
      logical :: found

      name = trim(errors%solution%name)
      associate (exact => errors%solution%channel)
         if (errors%solution%name == 'couette') then
            call fit_approach(times, mode, exact%rate(1), rate, found, limit=exact%steady_mode(1))
         else
            call fit_approach(times, mode, exact%rate(1), rate, found, source=exact%steady_mode(1)*exact%rate(1))
         end if
         results = [result_t(name//'_viscosity', exact%viscosity*rate/exact%rate(1), found), &
                    share(name//'_viscosity_over_exact', rate, exact%rate(1), found), &
                    share(name//'_viscosity_over_lattice', rate, errors%lattice%channel%rate(1), found)]
      end associate
   end function channel_results

   ! A straight line through the logarithms of positive samples.
   subroutine log_fit(times, values, offset, slope, found)
      real(dp), intent(in) :: times(:), values(:)
      real(dp), intent(out) :: offset, slope
      logical, intent(out) :: found

      call line_fit(times, log(max(values, tiny(1.0_dp))), offset, slope, found)
      found = found .and. all(values > 0)
   end subroutine log_fit

   pure type(result_t) function known(key, value)
      character(*), intent(in) :: key
      real(dp), intent(in) :: value

      known = result_t(key, value, .true.)
   end function known

   ! A ratio, which is not known where the reference is zero.
   pure type(result_t) function share(key, value, reference, found)
      character(*), intent(in) :: key
      real(dp), intent(in) :: value, reference
      logical, intent(in) :: found

      share = result_t(key, 0.0_dp, .false.)
      if (found .and. abs(reference) > 0) share = result_t(key, value/reference, .true.)
   end function share

   pure function column(errors, history, name) result(values)
      type(solution_errors_t), intent(in) :: errors
      real(dp), intent(in) :: history(:, :)
      character(*), intent(in) :: name
      real(dp) :: values(size(history, 2))
      character(name_length) :: padded

      padded = name
      values = history(findloc(errors%names, padded, 1), :)
   end function column

   pure real(dp) function last(values)
      real(dp), intent(in) :: values(:)

      last = values(size(values))
   end function last

   ! Mean over time by the trapezoidal rule.
   pure real(dp) function time_mean(times, values) result(mean)
      real(dp), intent(in) :: times(:), values(:)
      integer :: n

      n = size(times)
      mean = values(n)
      if (times(n) > times(1)) mean = sum((values(2:) + values(:n - 1))*(times(2:) - times(:n - 1)))/(2*(times(n) - times(1)))
   end function time_mean

end module solution_results
