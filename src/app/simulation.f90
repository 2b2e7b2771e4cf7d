!> A run from its start to its end: refresh neighbours, measure and write what is due, advance.
module simulation
   use cost, only: cost_t, estimate_cost
   use errors, only: exit_numerics, failure
   use kinds, only: dp
   use limits, only: extremes_t, report_limits, watch_limits
   use model, only: model_t
   use neighbours, only: neighbours_t
   use particles, only: particles_t
   use progress, only: progress_t
   use recorder, only: recorder_t
   use report, only: closing_table, start_box, write_summary_file
   use result_directory, only: result_directory_t, summary_name
   use room, only: check_room
   use run_log, only: log_t
   use scene_setup, only: count_particles, set_up_particles
   use settings, only: settings_t
   use step_check, only: check_step
   use text, only: short, to_text
   use threads, only: limit_threads
   use time_step, only: advance, refresh, start_extremes, step_t
   use timers, only: timers_t, wall_seconds
   implicit none
   private

   public :: simulate

   integer, parameter :: phase_output = 5
   real(dp), parameter :: poor_balance = 5.0e-3_dp   !! error of the energy balance that is worth a warning
   character(*), parameter :: phases(5) = [character(32) :: 'sort, images, neighbours', 'gradients, viscosity', &
                                           'density diffusion, stage 1', 'later stages', 'energies, probes, snapshots']

contains

   !> Runs a checked scene and writes its results.
   subroutine simulate(scene, model, input_text, directory, log, began, problem)
      type(settings_t), intent(in) :: scene
      type(model_t), intent(in) :: model       !! of the scene
      character(*), intent(in) :: input_text   !! complete input
      type(result_directory_t), intent(in) :: directory
      type(log_t), intent(inout) :: log
      logical, intent(out) :: began             !! there are results to keep
      type(failure), intent(inout) :: problem   !! exit_numerics, exit_files
      type(cost_t) :: costs
      type(particles_t) :: p
      type(neighbours_t) :: near
      type(step_t) :: run
      type(recorder_t) :: recorder
      type(timers_t) :: timers
      type(extremes_t) :: extremes
      type(failure) :: closing
      character(:), allocatable :: status, reason
      real(dp) :: started, seconds

      began = .false.
      call limit_threads(count_particles(scene))
      costs = estimate_cost(scene, model, count_particles(scene))
      call start_box(log, scene, model, costs)
      call check_room(scene, costs, directory%path, log, problem)
      if (problem%raised()) return
      started = wall_seconds()
      call timers%initialise(phases)
      call set_up_particles(scene, model, p)
      call refresh(model, p, near, run, timers)
      if (run%scattered) then
         call problem%raise(exit_numerics, 'the fluid is more than 4 million strips of width h long: move the bodies closer in x')
         return
      end if
      call start_extremes(model, p, run)
      call recorder%start(scene, input_text, model, p, directory, problem)
      if (problem%raised()) then
         call recorder%finish(closing)
         return
      end if
      began = .true.
      call main_loop(scene, model, p, near, run, recorder, directory, log, timers, extremes, status, problem)
      ! A failed run keeps all that it has measured.
      call recorder%finish(closing)
      reason = ''
      if (problem%raised()) reason = problem%message
      seconds = wall_seconds() - started
      call write_summary_file(directory%file(summary_name), status, reason, p, near, run, seconds, recorder, closing)
      if (closing%raised()) call problem%raise(closing%code, closing%message)
      if (recorder%budget%largest_error > poor_balance) call log%warn('energy balance', 'the energy budget closes only to ' &
         //short(recorder%budget%largest_error)//' of its scale; a smaller cfl makes it close better')
      call report_limits(extremes, log, model%c0, p%n, run)
      if (.not. problem%raised() .and. run%time < scene%time%end_time) call log%warn('ended early', 'the run ended at t = ' &
         //short(run%time)//' of end_time = '//short(scene%time%end_time)//': '//limit_reached(scene, status))
      if (reason /= '') call log%keep(reason)
      call log%report_warnings()
      call closing_table(log, timers, seconds, recorder%budget, run, directory%path)
   end subroutine simulate

   subroutine main_loop(scene, model, p, near, run, recorder, directory, log, timers, extremes, status, problem)
      type(settings_t), intent(in) :: scene
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      type(neighbours_t), intent(inout) :: near
      type(step_t), intent(inout) :: run
      type(recorder_t), intent(inout) :: recorder
      type(result_directory_t), intent(in) :: directory
      type(log_t), intent(inout) :: log
      type(timers_t), intent(inout) :: timers
      type(extremes_t), intent(inout) :: extremes
      character(:), allocatable, intent(out) :: status
      type(failure), intent(inout) :: problem
      type(progress_t) :: progress
      type(step_t) :: before
      type(failure) :: ignored
      real(dp) :: started

      started = wall_seconds()
      call progress%start(0.0_dp, scene%time%end_time, 0, p%n)
      call progress%limit(scene%time%max_steps, scene%time%max_wall_time)
      do
         status = reason_to_end(scene, run, wall_seconds() - started)
         call timers%start(phase_output)
         call recorder%record(scene, model, p, near, run, directory, status /= '', problem)
         call timers%stop(phase_output)
         if (problem%raised()) status = 'failed: output'
         if (status /= '') exit
         before = run
         call advance(model, p, near, run, scene%time%end_time, timers)
         call check_step(model, p, run, scene%time%end_time, problem)
         if (.not. problem%raised()) then
            call refresh(model, p, near, run, timers)
            if (run%scattered) call check_step(model, p, run, scene%time%end_time, problem)
         end if
         if (problem%raised()) then
            status = 'failed: numerics'
            problem%message = problem%message//'. The state before the step is in the last snapshot.'
            ! The state before the step is still there. A second failure would hide the first.
            run = before
            if (recorder%when_snapshot%is_never()) call recorder%save_snapshot(scene, model, p, near, run, directory, &
                                                                                          ignored)
            call recorder%record(scene, model, p, near, run, directory, .true., ignored)
            exit
         end if
         call watch_limits(extremes, log, model, p, run)
         call progress%update(log, run%time, run%dt, run%step)
      end do
   end subroutine main_loop

   ! Why the run ends at this state; '' if it goes on.
   function reason_to_end(scene, run, seconds) result(status)
      type(settings_t), intent(in) :: scene
      type(step_t), intent(in) :: run
      real(dp), intent(in) :: seconds   !! of wall time so far
      character(:), allocatable :: status

      status = ''
      if (run%time >= scene%time%end_time) then
         status = 'finished'
      else if (scene%time%max_steps > 0 .and. run%step >= scene%time%max_steps) then
         status = 'stopped: max_steps'
      else if (scene%time%max_wall_time > 0 .and. seconds > scene%time%max_wall_time) then
         status = 'stopped: max_wall_time'
      end if
   end function reason_to_end

   ! The key, with its value, that a status names.
   function limit_reached(scene, status) result(words)
      type(settings_t), intent(in) :: scene
      character(*), intent(in) :: status
      character(:), allocatable :: words

      words = '&time max_wall_time = '//short(scene%time%max_wall_time)//' s'
      if (index(status, 'max_steps') > 0) words = '&time max_steps = '//to_text(scene%time%max_steps)
   end function limit_reached

end module simulation
