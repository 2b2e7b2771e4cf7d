!> One time step: a Runge-Kutta scheme, as in the paper of fourth order with the diffusive terms frozen at the first stage.
!!
!! Source: eqs. 5-8 and 10-13 of the paper; the energies that the diffusive terms and the walls take are summed
!! with the stage states and the Runge-Kutta weights, so that the budget closes to the order of the scheme
!! (docs/equations.md).
module time_step
   use blocks, only: block_t, moment_t
   use dissipation_sums, only: sum_dissipation
   use flow, only: flow_rates, rates_t
   use flow_sums, only: flow_sums_t, sum_flow
   use frozen_terms, only: begin_frozen_terms, complete_frozen_terms
   use halo, only: let_messages_go_on
   use integrators, only: most_stages
   use images, only: begin_fill, fill_ghosts, fill_slip, finish_fill
   use kinds, only: dp, i8
   use lanes, only: nl
   use model, only: model_t, terms_t
   use neighbours, only: keep_order, list_neighbours, neighbours_t, sort_particles
   use particles, only: particles_t, state_t, swap_states
   use runge_kutta, only: stage_state, update_block, watch_changes
   use solid_ghosts, only: move_ghosts
   use solid_motion, only: meet_at_base, new_solid_motion, solid_motion_t
   use solid_terms, only: add_solids, meet_solids, rub_solids, take_solid_work
   use search_margins, only: overreach, plan_t, planned, watch_margins, widen_margins
   use step_outcome, only: add_up, collect, look_ahead, outcome_t
   use step_state, only: step_t
   use timers, only: timers_t, wall_seconds
   implicit none
   private

   public :: refresh, go_on, sorts_next, plan_next, advance

   real(dp), parameter :: foresight = 1.25_dp  !! times the step for which lists are looked at before it; too short ones cost a step
   real(dp), parameter :: grown = 1.01_dp      !! times its limit: a step that the margins of the limits still cover
   integer, parameter, public :: phase_sort = 1, phase_gradients = 2, phase_diffusion = 3, phase_stages = 4

contains

   !> Makes `next` the state at `time`, `base`, with its images and neighbours; sorts the particles if need be.
   subroutine refresh(model, p, near, run, timers)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      type(neighbours_t), intent(inout) :: near
      type(step_t), intent(inout) :: run
      type(timers_t), intent(inout) :: timers

      call timers%start(phase_sort)
      if (sorts_next(near, run)) then
         call find_neighbours(model, p, near, run, plan_next(model, near, run))
      else
         call keep_order(near, p, model%box_at(run%time), run%dt)
         if (p%features%no_slip) call fill_slip(near%images, model%box_at(run%time), p)
         call run%set_poses(model)
         call meet_at_base(model, p, near, run)
      end if
      call timers%stop(phase_sort)
   end subroutine refresh

   !> The same for a state in `next` that was kept when the particles were about to be sorted, in any order of them.
   subroutine go_on(model, p, near, run, plan, timers)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      type(neighbours_t), intent(inout) :: near
      type(step_t), intent(inout) :: run
      type(plan_t), intent(in) :: plan   !! `plan_next` of then
      type(timers_t), intent(inout) :: timers

      call timers%start(phase_sort)
      call find_neighbours(model, p, near, run, plan)
      call timers%stop(phase_sort)
   end subroutine go_on

   !> Whether the next `refresh` sorts the particles: then nothing but `next`, `step_t`, the plan and `particles_t%sorted_u`,
   !! `sorted_v` matters for what comes.
   pure logical function sorts_next(near, run)
      type(neighbours_t), intent(in) :: near
      type(step_t), intent(in) :: run

      sorts_next = run%step == 0 .or. .not. near%lasts
   end function sorts_next

   !> What it sorts them for.
   type(plan_t) function plan_next(model, near, run) result(plan)
      type(model_t), intent(in) :: model
      type(neighbours_t), intent(in) :: near
      type(step_t), intent(in) :: run

      if (run%step == 0) then
         plan = planned(near, model%dx, model%longest_step())
      else
         plan = planned(near, model%dx, run%dt)
      end if
   end function plan_next

   subroutine find_neighbours(model, p, near, run, plan)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      type(neighbours_t), intent(inout) :: near
      type(step_t), intent(inout) :: run
      type(plan_t), intent(in) :: plan

      near%age = plan%age
      near%slack = plan%slack
      near%slack_time_2 = plan%slack_time_2
      call run%set_poses(model)
      call sort_particles(near, p, model%kernel, model%box_at(run%time), model%dx, plan%span, run%scattered, &
                          model%solids, run%poses)
      if (run%scattered) return
      run%sorted = run%sorted + 1
      if (p%features%no_slip) call fill_slip(near%images, model%box_at(run%time), p)
      call list_neighbours(near, p, model%kernel, 1.3_dp*near%tau)
      call meet_at_base(model, p, near, run)
   end subroutine find_neighbours

   !> Advances from `base` to `next` by one step, not beyond `last_time`. With the step's sums goes what processes want each
   !! other to know: a note that is true in some process is so in all then; where nothing is told they are false.
   subroutine advance(model, p, near, run, last_time, timers, notes)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      type(neighbours_t), intent(inout) :: near
      type(step_t), intent(inout) :: run
      real(dp), intent(in) :: last_time
      type(timers_t), intent(inout) :: timers
      logical, intent(inout), optional :: notes(:)
      type(block_t), allocatable :: blocks(:)
      logical, allocatable :: told(:)
      type(outcome_t) :: all
      real(dp) :: at_most, expected, farthest
      logical :: enough

      expected = run%dt   ! as long as the last one
      at_most = last_time - run%time
      if (.not. present(notes)) allocate (told(0))
      if (present(notes)) then
         told = notes
         notes = .false.
      end if
      do
         allocate (blocks(near%n_blocks))
         call timers%start(phase_gradients)
         call first_sums(model, p, near, foresight*expected/2, blocks)
         call timers%stop(phase_gradients)
         call look_ahead(model, near, expected, blocks, run%dt, farthest)
         run%dt = min(run%dt, at_most)
         enough = in_reach(near, run%dt)
         if (enough) then
            if (farthest > 0) call widen_margins(near, expected, blocks%ahead, blocks%behind)
            call reach_out(model, p, near, run, farthest > 0, timers)
            call stages(model, p, near, run, blocks, timers, all, told)
            if (.not. all%first_overreach() > 0) then
               ! Terms that are not frozen: the coefficients of the later stages are known now.
               at_most = min(at_most, all%limit)
               if (.not. run%dt > grown*at_most) exit
            else if (all%lost .and. all%first_overreach() > model%kernel%support) then
               exit   ! a solution that has left its range by so much is no better the second time
            end if
         end if
         ! Lists do not reach as far as some stage has led, the step is much longer than expected, or alpha_i and delta_i grew:
         ! again, with better margins.
         run%repeated = run%repeated + 1
         call make_room(model, p, near, run, blocks, enough, all, timers)
         deallocate (blocks)
         if (run%scattered) return
         call meet_at_base(model, p, near, run)
      end do
      if (present(notes)) notes = told
      call collect(model, near, run, last_time, all, blocks)
      if (p%features%dissipation) call add_dissipated(p, run%dt)
      run%step = run%step + 1
      run%time = run%time + run%dt
   end subroutine advance

   ! What each particle has dissipated in a step.
   subroutine add_dissipated(p, dt)
      type(particles_t), intent(inout) :: p
      real(dp), intent(in) :: dt
      integer :: i

      !$omp parallel do default(none) shared(p, dt)
      do i = 1, p%n_own
         p%dissipated(i) = p%dissipated(i) + dt*p%dissipating(i)
      end do
      !$omp end parallel do
   end subroutine add_dissipated

   ! Whether the lists, or lists that can be made anew of the images that there are, serve for a step.
   pure logical function in_reach(near, dt)
      type(neighbours_t), intent(in) :: near
      real(dp), intent(in) :: dt

      in_reach = near%age + dt - near%tau <= near%travel
      if (.not. near%age > 0) in_reach = dt - near%tau <= near%image_travel
   end function in_reach

   ! Lists for a longer step than expected, or of wider margins.
   subroutine reach_out(model, p, near, run, wider, timers)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      type(neighbours_t), intent(inout) :: near
      type(step_t), intent(in) :: run
      logical, intent(in) :: wider
      type(timers_t), intent(inout) :: timers
      real(dp) :: travel

      travel = merge(1.1_dp*(run%dt - near%tau), near%travel, near%age + run%dt - near%tau > near%travel)
      if (.not. (wider .or. travel > near%travel)) return
      call timers%start(phase_sort)
      call list_neighbours(near, p, model%kernel, travel)
      if (near%ghosts%shared) call meet_at_base(model, p, near, run)
      call timers%stop(phase_sort)
   end subroutine reach_out

   ! Lists for the unchanged base state that reach farther: of the order that there is, where there are images for as much;
   ! else the particles are sorted again, for the step that is known now.
   subroutine make_room(model, p, near, run, blocks, enough, all, timers)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      type(neighbours_t), intent(inout) :: near
      type(step_t), intent(inout) :: run
      type(block_t), intent(in) :: blocks(:)
      logical, intent(in) :: enough          !! the stages were tried,
      type(outcome_t), intent(in) :: all     !! with this
      type(timers_t), intent(inout) :: timers
      real(dp) :: farthest
      integer :: stage

      farthest = 0
      if (enough) farthest = all%first_overreach()
      if (farthest > near%image_slack) near%slack = 2*farthest
      if (farthest > 0 .and. .not. farthest > near%image_slack) then
         call timers%start(phase_sort)
         stage = findloc(all%overreach > 0, .true., 1)
         call widen_margins(near, model%integrator%ahead(stage)*run%dt, blocks%change(stage), blocks%change(1))
         if (near%ghosts%exist()) call move_ghosts(near%ghosts, model%solids, run%poses, model%box_at(run%time), p%base)
         call list_neighbours(near, p, model%kernel, near%travel)
         ! Terms that are not frozen have left those of the last stage.
         if (p%features%no_slip .and. .not. model%frozen) call fill_slip(near%images, model%box_at(run%time), p)
         call timers%stop(phase_sort)
      else
         call sort_again(model, p, near, run, timers)
      end if
   end subroutine make_room

   ! Sorts the unchanged base state again, for the step that is known now.
   subroutine sort_again(model, p, near, run, timers)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      type(neighbours_t), intent(inout) :: near
      type(step_t), intent(inout) :: run
      type(timers_t), intent(inout) :: timers

      call timers%start(phase_sort)
      p%next = p%base
      call find_neighbours(model, p, near, run, plan_t(near%age, run%dt, near%slack, near%slack_time_2))
      call timers%stop(phase_sort)
   end subroutine sort_again

   ! L, grad rho and the first stage's rates, which `next` keeps until they are used; of the frozen terms what needs no
   ! gradient and no coefficient of a neighbour.
   subroutine first_sums(model, p, near, ahead, blocks)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      type(neighbours_t), intent(inout) :: near
      real(dp), intent(in) :: ahead   !! time for which the change of velocities is looked at
      type(block_t), intent(inout) :: blocks(:)
      real(dp) :: started
      integer :: b, i0, n

      started = wall_seconds()
      !$omp parallel do default(none) shared(model, p, near, ahead, blocks) private(i0, n) schedule(dynamic)
      do b = 1, near%n_blocks
         call begin_frozen_terms(model, p, near, b, blocks(b))
         i0 = near%blocks(b)%before
         n = nl*near%blocks(b)%n_clusters
         call watch_changes(model, p, i0, n, ahead, blocks(b))
      end do
      !$omp end parallel do
      near%division%busy = near%division%busy + wall_seconds() - started
   end subroutine first_sums

   ! The stages, and what they have come to.
   subroutine stages(model, p, near, run, blocks, timers, all, notes)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      type(neighbours_t), intent(inout) :: near
      type(step_t), intent(inout) :: run
      type(block_t), intent(inout) :: blocks(:)
      type(timers_t), intent(inout) :: timers
      type(outcome_t), intent(out) :: all
      logical, intent(inout) :: notes(:)
      real(dp) :: changes(near%n_blocks, most_stages), jumps(near%n_blocks)
      type(moment_t) :: moment
      type(solid_motion_t) :: solids
      integer :: stage

      solids = new_solid_motion(model%poses_at(run%time, run%poses))
      do stage = 1, model%integrator%stages
         moment = moment_t(stage, run%dt, model%box_at(run%time + model%integrator%time_of(stage)*run%dt), &
                           model%box_at(run%time + run%dt))
         if (stage == model%integrator%stages .and. model%has_solids()) &
            call solids%find_obstacles(model, moment%last_box, moment%obstacles)
         if (stage == 1) then
            call timers%start(phase_diffusion)
            call first_stage(model, p, near, moment, solids, blocks)
            if (.not. model%frozen) call scale_wall_power(model%integrator%weight(1), blocks)
            call timers%stop(phase_diffusion)
         else
            call timers%start(phase_stages)
            if (stage == 4) call swap_states(p%next, p%stage(2))   ! see module runge_kutta
            if (model%frozen) then
               call later_stage(model, p, near, moment, solids, blocks)
            else
               call whole_stage(model, p, near, moment, solids, blocks)
            end if
            call timers%stop(phase_stages)
         end if
         changes(:, stage) = blocks%change(stage)
         if (stage == model%integrator%stages) exit
         all%overreach(stage) = overreach(near, model%integrator%ahead(stage)*run%dt, changes(:, stage))
         call solids%lead_on(model, near, moment, run%time + model%integrator%time_of(stage + 1)*run%dt, all%overreach(stage))
      end do
      near%jumped = any(blocks%wrapped)
      jumps = blocks%jump
      call watch_margins(near, model%integrator, run%dt, changes, jumps)
      all%motion = solids
      call add_up(model, near, run%dt, blocks, all, notes)
   end subroutine stages

   ! The power of walls that move, as a stage's part of the step's.
   subroutine scale_wall_power(weight, blocks)
      real(dp), intent(in) :: weight
      type(block_t), intent(inout) :: blocks(:)
      integer :: b

      !$omp parallel do default(none) shared(weight, blocks)
      do b = 1, size(blocks)
         blocks(b)%wall_power = weight*blocks(b)%wall_power
      end do
      !$omp end parallel do
   end subroutine scale_wall_power

   ! Ghosts have their pressure of all fluid near them: they come when copies are there.
   pure logical function solids_are_due(near, part)
      type(neighbours_t), intent(in) :: near
      integer, intent(in) :: part   ! of the blocks, before which this is

      solids_are_due = near%ghosts%exist() .and. part == merge(2, 1, near%images%halo%exists)
   end function solids_are_due

   ! Completes the frozen terms and goes from `base` to the second stage's state.
   subroutine first_stage(model, p, near, moment, solids, blocks)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      type(neighbours_t), intent(inout) :: near
      type(moment_t), intent(inout) :: moment
      type(solid_motion_t), intent(inout) :: solids
      type(block_t), intent(inout) :: blocks(:)
      type(rates_t) :: rates
      type(terms_t) :: has
      real(dp) :: started
      integer :: b, i0, k, n, part, span(2)

      has = model%terms()
      call begin_fill(near%images, model%box, p)
      do part = 1, 2
         if (part == 2) then
            started = wall_seconds()
            call finish_fill(near%images, model%box, p)
            near%division%waiting = near%division%waiting + wall_seconds() - started
         end if
         if (solids_are_due(near, part)) then
            if (has%friction_works) call rub_solids(model, moment%box, near, p)
            call take_solid_work(near, p%base, model%integrator%weight(1)*moment%dt, begins=.true.)
            call solids%take_forces(model, near, moment)
         end if
         span = near%part(part)
         started = wall_seconds()
         !$omp parallel do default(none) shared(model, p, near, moment, blocks, span) private(b, i0, n, rates) schedule(dynamic)
         do k = span(1), span(2)
            b = near%order(k)
            i0 = near%blocks(b)%before
            n = nl*near%blocks(b)%n_clusters
            call let_messages_go_on(near%images%halo, k)
            call complete_frozen_terms(model, p, near, b, blocks(b))
            if (p%features%dissipation) call sum_dissipation(model, near%blocks(b), p, i0)
            call take_kept(p%next, i0, n, rates)
            call update_block(model, p, i0, n, moment, rates, blocks(b))
         end do
         !$omp end parallel do
         near%division%busy = near%division%busy + wall_seconds() - started
      end do
   end subroutine first_stage

   ! Rates of a block that a state's velocity and density have kept.
   pure subroutine take_kept(state, i0, n, rates)
      type(state_t), intent(in) :: state
      integer, intent(in) :: i0, n
      type(rates_t), intent(inout) :: rates

      rates%u(:n) = state%u(i0 + 1:i0 + n)
      rates%v(:n) = state%v(i0 + 1:i0 + n)
      rates%s(:n) = state%s(i0 + 1:i0 + n)
   end subroutine take_kept

   ! Evaluates the rates at a stage's state and forms the next stage's, or the end of the step.
   subroutine later_stage(model, p, near, moment, solids, blocks)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      type(neighbours_t), intent(inout) :: near
      type(moment_t), intent(inout) :: moment   !! of stage 2 or later
      type(solid_motion_t), intent(inout) :: solids
      type(block_t), intent(inout) :: blocks(:)
      type(flow_sums_t) :: sums
      type(rates_t) :: rates
      real(dp) :: started
      integer :: b, i0, k, n, now, part, span(2)

      now = stage_state(moment%stage)
      call begin_fill(near%images, moment%box, p%stage(now))
      do part = 1, 2
         if (part == 2) then
            started = wall_seconds()
            call finish_fill(near%images, moment%box, p%stage(now))
            near%division%waiting = near%division%waiting + wall_seconds() - started
         end if
         if (solids_are_due(near, part)) then
            call meet_solids(model, moment%box, solids%poses, near, p%stage(now), later=.true.)
            call take_solid_work(near, p%stage(now), model%integrator%weight(moment%stage)*moment%dt, begins=.false.)
            call solids%take_forces(model, near, moment)
         end if
         span = near%part(part)
         started = wall_seconds()
         !$omp parallel do default(none) shared(model, p, near, moment, now, blocks, span) &
         !$omp private(b, i0, n, sums, rates) schedule(dynamic)
         do k = span(1), span(2)
            b = near%order(k)
            i0 = near%blocks(b)%before
            n = nl*near%blocks(b)%n_clusters
            call let_messages_go_on(near%images%halo, k)
            call sum_flow(model%kernel, near%blocks(b), p%stage(now), i0, sums)
            if (near%ghosts%exist()) call add_solids(model, near, p%stage(now), b, sums, blocks(b)%solid_power)
            call flow_rates(model, p%stage(now), i0, n, sums, rates)
            call update_block(model, p, i0, n, moment, rates, blocks(b))
         end do
         !$omp end parallel do
         near%division%busy = near%division%busy + wall_seconds() - started
      end do
   end subroutine later_stage

   ! The same with the diffusive terms of the stage's own state, which takes the place of `base` for them.
   subroutine whole_stage(model, p, near, moment, solids, blocks)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      type(neighbours_t), intent(inout) :: near
      type(moment_t), intent(inout) :: moment   !! of stage 2 or later
      type(solid_motion_t), intent(inout) :: solids
      type(block_t), intent(inout) :: blocks(:)
      type(block_t) :: of_stage(size(blocks))
      type(rates_t) :: rates
      type(terms_t) :: has
      type(state_t) :: kept                  ! rates of velocity and density: `next` may hold a stage's state
      integer :: b, i0, n, now

      now = stage_state(moment%stage)
      allocate (kept%u(p%capacity), kept%v(p%capacity), kept%s(p%capacity))
      call fill_ghosts(near%images, moment%box, p%stage(now))
      call meet_solids(model, moment%box, solids%poses, near, p%stage(now), later=.true.)
      call swap_states(p%base, p%stage(now))
      call swap_states(p%next, kept)
      if (p%features%no_slip) call fill_slip(near%images, moment%box, p)
      call first_sums(model, p, near, 0.0_dp, of_stage)
      call begin_fill(near%images, model%box, p)
      call finish_fill(near%images, model%box, p)
      has = model%terms()
      if (has%friction_works) call rub_solids(model, moment%box, near, p)
      call take_solid_work(near, p%base, model%integrator%weight(moment%stage)*moment%dt, begins=.false.)
      call solids%take_forces(model, near, moment)
      !$omp parallel do default(none) shared(model, p, near, of_stage) schedule(dynamic)
      do b = 1, near%n_blocks
         call complete_frozen_terms(model, p, near, b, of_stage(b))
      end do
      !$omp end parallel do
      call swap_states(p%base, p%stage(now))
      call swap_states(p%next, kept)
      !$omp parallel do default(none) shared(model, p, near, moment, kept, blocks, of_stage) private(i0, n, rates) &
      !$omp schedule(dynamic)
      do b = 1, near%n_blocks
         blocks(b)%wall_power = blocks(b)%wall_power + model%integrator%weight(moment%stage)*of_stage(b)%wall_power
         blocks(b)%largest_alpha = max(blocks(b)%largest_alpha, of_stage(b)%largest_alpha)
         blocks(b)%largest_delta = max(blocks(b)%largest_delta, of_stage(b)%largest_delta)
         blocks(b)%solid_power = of_stage(b)%solid_power
         i0 = near%blocks(b)%before
         n = nl*near%blocks(b)%n_clusters
         call take_kept(kept, i0, n, rates)
         call update_block(model, p, i0, n, moment, rates, blocks(b))
      end do
      !$omp end parallel do
   end subroutine whole_stage

end module time_step
