!> A run from its start to its end: refresh neighbours, measure and write what is due, advance.
module simulation
   use balance_watch, only: watch_balance
   use box, only: box_t, is_wall
   use budget, only: begin_balance_anew, works_of
   use checkpoint_file, only: checkpoint_file_t
   use checkpoints, only: checkpoints_t
   use communication, only: is_first
   use contact_watch, only: watch_contacts
   use cost, only: cost_t, estimate_cost
   use errors, only: exit_files, exit_input, exit_numerics, exit_stopped, failure
   use file_system, only: delete_file, file_bytes, path_exists, write_whole_file
   use kinds, only: dp, i8
   use limits, only: report_limits, watch_limits
   use model, only: model_t
   use particles, only: particles_t, swap_states
   use progress, only: progress_t
   use report, only: closing_table, start_box, write_summary_file
   use result_directory, only: input_name, log_name, outlines_name, result_directory_t, series_name, summary_name
   use room, only: check_room
   use run_log, only: log_t
   use run_state, only: run_state_t
   use scene_setup, only: count_particles, set_up_particles
   use settings, only: settings_t
   use solid_contacts, only: contacts_t
   use step_check, only: check_step
   use step_state, only: start_extremes, step_t
   use stopping, only: stopping_t
   use text, only: for_shell, short, to_text
   use threads, only: limit_threads
   use time_step, only: advance, go_on, plan_next, refresh, sorts_next
   use timers, only: timers_t, wall_seconds
   implicit none
   private

   public :: simulate, beginning_t

   !> Where a run begins.
   type :: beginning_t
      character(:), allocatable :: input    !! complete input, for the checkpoints; '' where there shall be none
      character(:), allocatable :: origin   !! where it was forked from; '' if it was not
      integer :: turn = 0                   !! which checkpoint of the directory it goes on from; 0: it begins there
      logical :: forked = .false.           !! it goes on from another directory
      logical :: changed = .false.          !! the input is not that of the checkpoint
      type(checkpoint_file_t) :: file       !! open, where it does not begin at t = 0
   end type beginning_t

   integer, parameter :: phase_output = 5
   real(dp), parameter :: poor_balance = 5.0e-3_dp   !! error of the energy balance that is worth a warning
   character(*), parameter :: phases(5) = [character(32) :: 'sort, images, neighbours', 'gradients, viscosity', &
                                           'density diffusion, stage 1', 'later stages', 'energies, probes, files']

contains

   !> Runs a checked scene and writes its results.
   subroutine simulate(scene, model, input_text, beginning, stop, directory, log, began, problem)
      type(settings_t), intent(in) :: scene
      type(model_t), intent(in) :: model       !! of the scene
      character(*), intent(in) :: input_text   !! complete input, for the snapshots
      type(beginning_t), intent(inout) :: beginning
      type(stopping_t), intent(inout) :: stop   !! begun
      type(result_directory_t), intent(inout) :: directory
      type(log_t), intent(inout) :: log
      logical, intent(out) :: began             !! there are results to keep
      type(failure), intent(inout) :: problem   !! exit_numerics, exit_files; exit_stopped: it can go on
      type(cost_t) :: costs
      type(run_state_t) :: state
      type(checkpoints_t) :: saving
      type(timers_t) :: timers
      type(failure) :: closing
      character(:), allocatable :: status, reason
      real(dp) :: started, seconds

      began = .false.
      call limit_threads(count_particles(scene))
      costs = estimate_cost(scene, model, count_particles(scene))
      call start_box(log, scene, model, costs)
      call check_room(scene, costs, directory%path, log, problem)
      call problem%tell()
      if (problem%raised()) return
      started = wall_seconds()
      call timers%initialise(phases)
      call set_up(scene, model, input_text, beginning, state, timers, problem)
      if (problem%raised()) return
      call saving%start(scene, beginning%input, beginning%origin, merge(1, 3 - beginning%turn, beginning%turn == 0), &
                        merge(beginning%file%number + 1, 0_i8, beginning%turn > 0))
      call open_files(scene, model, input_text, beginning, state, saving, directory, log, problem)
      if (.not. problem%raised() .and. goes_on(beginning)) call sort_first(scene, model, beginning, state, timers, problem)
      if (problem%raised()) then
         call state%recorder%finish(directory, closing)
         return
      end if
      began = .true.
      call main_loop(scene, model, state, saving, stop, directory, log, timers, status, problem)
      call stop%agree()
      ! A failed run keeps all that it has measured.
      call state%recorder%finish(directory, closing)
      reason = ''
      if (problem%raised()) reason = problem%message
      seconds = wall_seconds() - started
      call write_summary_file(directory%file(summary_name), status, reason, beginning%origin, state, seconds, closing)
      if (closing%raised()) call problem%raise(closing%code, closing%message)
      if (state%recorder%budget%largest_error > poor_balance) call log%warn('energy balance', 'the energy budget closes only to ' &
         //short(state%recorder%budget%largest_error)//' of its scale; a smaller cfl makes it close better')
      call report_limits(state%extremes, log, model%c0, state%p%n, state%step)
      if (.not. problem%raised() .and. state%step%time < scene%time%end_time) &
         call say_that_it_ended_early(scene, state%step, stop%reason, saving%any_written(), directory%path, log, problem)
      if (reason /= '') call log%keep(reason)
      call log%report_warnings()
      call closing_table(log, timers, seconds, state%recorder%budget, state%step, directory%path)
   end subroutine simulate

   pure logical function goes_on(beginning)
      type(beginning_t), intent(in) :: beginning

      goes_on = beginning%turn > 0 .or. beginning%forked
   end function goes_on

   ! The state that the run begins with: sorted at t = 0; where it goes on, as it was kept. What is measured at t = 0 is measured
   ! again then.
   subroutine set_up(scene, model, input_text, beginning, state, timers, problem)
      type(settings_t), intent(in) :: scene
      type(model_t), intent(in) :: model
      character(*), intent(in) :: input_text
      type(beginning_t), intent(inout) :: beginning
      type(run_state_t), intent(inout) :: state
      type(timers_t), intent(inout) :: timers
      type(failure), intent(inout) :: problem
      character(:), allocatable :: reason

      call set_up_particles(scene, model, state%p)
      call refresh(model, state%p, state%near, state%step, timers)
      if (.not. state%step%scattered) then
         call start_extremes(model, state%p, state%step)
         call state%recorder%start(scene, input_text, model, state%p)
         if (goes_on(beginning)) then
            state%recorder%forks = beginning%forked
            if (beginning%file%particles == state%p%n) call state%archive(beginning%file)
            reason = beginning%file%missing()
            if (beginning%file%particles /= state%p%n) reason = 'it has another number of particles than the scene'
            call beginning%file%close()
            if (reason /= '') call problem%raise(exit_files, "cannot go on from '"//beginning%file%path//"': "//reason)
            if (problem%raised()) return
            state%first_step = state%step%step
            if (.not. beginning%forked) return
            call state%recorder%begin_anew()
            call check_box(model%box_at(state%step%time), state%p, problem)
         end if
      end if
      if (state%step%scattered) call problem%raise(exit_numerics, &
         'the fluid is more than 4 million strips of width h long: move the bodies closer in x')
   end subroutine set_up

   ! The first sort of a run that goes on. A state that has failed is no better the second time.
   subroutine sort_first(scene, model, beginning, state, timers, problem)
      type(settings_t), intent(in) :: scene
      type(model_t), intent(in) :: model
      type(beginning_t), intent(in) :: beginning
      type(run_state_t), intent(inout) :: state
      type(timers_t), intent(inout) :: timers
      type(failure), intent(inout) :: problem   !! exit_numerics

      call go_on(model, state%p, state%near, state%step, state%plan, timers)
      if (state%step%scattered) call problem%raise(exit_numerics, 'the fluid is more than 4 million strips of width h long')
      if (problem%raised()) return
      associate (step => state%step)
         if (beginning%forked) call begin_balance_anew(state%recorder%budget, model, state%p, works_of(model, step))
      end associate
      call watch_balance(scene%time%balance_limit, model, state, problem)
   end subroutine sort_first

   ! Particles of a fork whose box is another: all must be in it.
   subroutine check_box(box, p, problem)
      type(box_t), intent(in) :: box
      type(particles_t), intent(in) :: p        !! `next` in the order of numbers
      type(failure), intent(inout) :: problem   !! exit_input
      integer :: i

      do i = 1, p%n_own
         if (.not. any(is_wall(box%kind) .and. [p%next%x(i) < box%at(1), p%next%x(i) > box%at(2), p%next%y(i) < box%at(3), &
                                                p%next%y(i) > box%at(4)])) cycle
         call problem%raise(exit_input, 'particle '//to_text(p%id(i))//' of the checkpoint, at ('//to_text(p%next%x(i))//', ' &
                            //to_text(p%next%y(i))//'), is outside of &domain: a fork must have all of the fluid in its box')
         exit
      end do
      call problem%tell()
   end subroutine check_box

   ! From here on files change: an earlier result is deleted; where the run goes on, what was written behind the checkpoint, which
   ! comes again. A changed input is kept in a checkpoint first: a kill must not undo it.
   subroutine open_files(scene, model, input_text, beginning, state, saving, directory, log, problem)
      type(settings_t), intent(in) :: scene
      type(model_t), intent(in) :: model
      character(*), intent(in) :: input_text
      type(beginning_t), intent(in) :: beginning
      type(run_state_t), intent(inout) :: state
      type(checkpoints_t), intent(inout) :: saving
      type(result_directory_t), intent(inout) :: directory
      type(log_t), intent(inout) :: log
      type(failure), intent(inout) :: problem   !! exit_files
      character(:), allocatable :: ignored
      logical :: here   ! it goes on in its own directory

      here = beginning%turn > 0
      if (here) call state%recorder%open(scene, model, directory, only_check=.true., problem=problem)
      if (here .and. .not. problem%raised()) call directory%look_for_foreign(problem)
      if (.not. (here .or. problem%raised())) call directory%clear(problem)
      if (.not. problem%raised() .and. (beginning%changed .or. beginning%forked)) call saving%write(state, directory, problem)
      if (is_first() .and. .not. problem%raised()) call write_whole_file(directory%file(input_name), input_text, problem)
      call problem%tell()
      if (.not. problem%raised()) call state%recorder%open(scene, model, directory, only_check=.false., problem=problem)
      if (.not. problem%raised()) call log%open_file(directory%file(log_name), here, problem)
      if (problem%raised() .or. .not. here) return
      if (is_first()) call say_which_snapshots_lack(state%recorder%series%count(), directory, log)
      if (is_first()) call delete_file(directory%file(summary_name), ignored)
      call directory%delete_later_snapshots(state%recorder%series%count(), problem)
      if (problem%raised()) return
      if (.not. is_first()) then
         continue
      else if (state%recorder%series%count() > 0) then
         call state%recorder%series%write(directory%file(series_name), problem)
      else
         if (path_exists(directory%file(series_name))) call delete_file(directory%file(series_name), ignored)
         if (path_exists(directory%file(outlines_name))) call delete_file(directory%file(outlines_name), ignored)
      end if
      call problem%tell()
   end subroutine open_files

   subroutine say_which_snapshots_lack(n, directory, log)
      integer, intent(in) :: n   !! that the checkpoint knows of
      type(result_directory_t), intent(in) :: directory
      type(log_t), intent(inout) :: log
      integer :: k

      do k = 0, n - 1
         if (file_bytes(directory%snapshot_path(k)) <= 0) call log%warn('snapshot', "'"//directory%snapshot_path(k) &
            //"' is not there, or empty, and does not come again")
      end do
   end subroutine say_which_snapshots_lack

   subroutine main_loop(scene, model, state, saving, stop, directory, log, timers, status, problem)
      type(settings_t), intent(in) :: scene
      type(model_t), intent(in) :: model
      type(run_state_t), intent(inout) :: state
      type(checkpoints_t), intent(inout) :: saving
      type(stopping_t), intent(inout) :: stop
      type(result_directory_t), intent(inout) :: directory
      type(log_t), intent(inout) :: log
      type(timers_t), intent(inout) :: timers
      character(:), allocatable, intent(out) :: status
      type(failure), intent(inout) :: problem
      type(progress_t) :: progress
      type(contacts_t) :: contacts
      type(step_t) :: before
      integer, parameter :: cannot_write = 1, shall_stop = 2, checkpoint_due = 3
      logical :: notes(3)   ! of what single processes know
      logical :: saved   ! this state, because the run shall stop

      call watch_contacts(contacts, log, scene, model, state%step, problem)
      call progress%start(state%step%time, scene%time%end_time, state%step%step, state%p%n)
      call progress%limit(scene%time%max_steps, scene%time%max_wall_time)
      saved = .false.
      do
         status = reason_to_end(scene, state%step)
         if (status == '' .and. saved) status = 'stopped: '//stop%reason
         call timers%start(phase_output)
         call state%recorder%record(scene, model, state%p, state%near, state%step, directory, status /= '', problem)
         call timers%stop(phase_output)
         if (status /= '') then
            call problem%tell()
            if (problem%raised()) status = 'failed: output'
            exit
         end if
         before = state%step
         call stop%watch(directory)
         notes = [problem%raised(), stop%reason /= '', saving%is_due_by_clock()]
         call advance(model, state%p, state%near, state%step, scene%time%end_time, timers, notes)
         if (notes(cannot_write) .or. state%step%scattered) call problem%tell()
         if (problem%raised()) then
            status = 'failed: output'
            state%step = before   ! the last one that was recorded
            exit
         end if
         call check_step(model, state%p, state%step, scene%time%end_time, problem)
         if (.not. problem%raised()) then
            call saving%watch(state%step%step, state%step%time, before%time, notes(checkpoint_due))
            call timers%start(phase_output)
            if (sorts_next(state%near, state%step)) then
               if (notes(shall_stop)) call stop%agree()
               call save_if_wanted(scene, model, state, saving, stop, directory, saved, problem)
            end if
            call timers%stop(phase_output)
            if (problem%raised() .and. problem%code == exit_files) then
               status = 'failed: output'
               state%step = before   ! the last one that was recorded
               exit
            end if
         end if
         if (.not. problem%raised()) then
            call refresh(model, state%p, state%near, state%step, timers)
            if (state%step%scattered) call check_step(model, state%p, state%step, scene%time%end_time, problem)
         end if
         if (problem%raised()) then
            status = 'failed: numerics'
            ! The state before the step is still there.
            state%step = before
            call record_failure(scene, model, state, directory, 'The state before the step', problem)
            exit
         end if
         call watch_contacts(contacts, log, scene, model, state%step, problem)
         if (.not. problem%raised()) call watch_balance(scene%time%balance_limit, model, state, problem)
         if (problem%raised()) then
            status = 'failed: numerics'
            call record_failure(scene, model, state, directory, 'The state', problem)
            exit
         end if
         call watch_limits(state%extremes, log, model, state%p, state%step)
         call progress%update(log, state%step%time, state%step%dt, state%step%step)
      end do
   end subroutine main_loop

   ! A checkpoint of the state `next`, which is about to be sorted, if there is to be one; none of a state that has failed.
   subroutine save_if_wanted(scene, model, state, saving, stop, directory, saved, problem)
      type(settings_t), intent(in) :: scene
      type(model_t), intent(in) :: model
      type(run_state_t), intent(inout) :: state
      type(checkpoints_t), intent(inout) :: saving
      type(stopping_t), intent(inout) :: stop
      type(result_directory_t), intent(in) :: directory
      logical, intent(inout) :: saved         !! the run shall stop, and now it can
      type(failure), intent(inout) :: problem
      logical :: wanted

      wanted = saving%wanted(scene, model, state, stop%reason /= '')
      if (.not. wanted) return
      call swap_states(state%p%base, state%p%next)
      call watch_balance(scene%time%balance_limit, model, state, problem)
      call swap_states(state%p%base, state%p%next)
      if (problem%raised()) return
      state%plan = plan_next(model, state%near, state%step)
      if (saving%input /= '') call saving%write(state, directory, problem)
      saved = stop%reason /= ''
   end subroutine save_if_wanted

   ! All that is known of the last good state. A second failure would hide the first.
   subroutine record_failure(scene, model, state, directory, what, problem)
      type(settings_t), intent(in) :: scene
      type(model_t), intent(in) :: model
      type(run_state_t), intent(inout) :: state   !! before the step that failed, or at which it is seen
      type(result_directory_t), intent(in) :: directory
      character(*), intent(in) :: what            !! is recorded
      type(failure), intent(inout) :: problem
      type(failure) :: ignored

      problem%message = problem%message//'. '//what//' is in the last snapshot.'
      associate (recorder => state%recorder)
         if (recorder%when_snapshot%is_never()) call recorder%save_snapshot(scene, model, state%p, state%near, state%step, &
                                                                            directory, ignored)
         call recorder%record(scene, model, state%p, state%near, state%step, directory, .true., ignored)
      end associate
   end subroutine record_failure

   ! Why the run ends at this state; '' if it goes on.
   function reason_to_end(scene, run) result(status)
      type(settings_t), intent(in) :: scene
      type(step_t), intent(in) :: run
      character(:), allocatable :: status

      status = ''
      if (run%time >= scene%time%end_time) then
         status = 'finished'
      else if (scene%time%max_steps > 0 .and. run%step >= scene%time%max_steps) then
         status = 'stopped: max_steps'
      end if
   end function reason_to_end

   ! How it goes on; a run that was stopped from outside has an exit code of its own.
   subroutine say_that_it_ended_early(scene, run, reason, resumable, path, log, problem)
      type(settings_t), intent(in) :: scene
      type(step_t), intent(in) :: run
      character(*), intent(in) :: reason   !! to stop; '' for max_steps
      logical, intent(in) :: resumable     !! there is a checkpoint
      character(*), intent(in) :: path     !! of the results
      type(log_t), intent(inout) :: log
      type(failure), intent(inout) :: problem
      character(:), allocatable :: words, why

      why = reason
      if (why == '') why = '&time max_steps = '//to_text(scene%time%max_steps)
      if (why == 'max_wall_time') why = '&time max_wall_time = '//short(scene%time%max_wall_time)//' s'
      words = 'the run ended at t = '//short(run%time)//' of end_time = '//short(scene%time%end_time)//': '//why
      if (resumable) words = words//'. It goes on with: dynsph --resume '//for_shell(path)
      if (reason == '') then
         if (resumable) words = words//' --set time.max_steps=0'
         call log%warn('ended early', words)
      else
         call log%keep(words)
         call problem%raise(exit_stopped, words)
      end if
   end subroutine say_that_it_ended_early

end module simulation
