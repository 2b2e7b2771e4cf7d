!> One time step: a Runge-Kutta scheme, as in the paper of fourth order with the diffusive terms frozen at the first stage.
!!
!! Source: eqs. 5-8 and 10-13 of the paper; the energies that the diffusive terms and the walls take are summed
!! with the stage states and the Runge-Kutta weights, so that the budget closes to the order of the scheme
!! (docs/equations.md).
module time_step
   use communication, only: any_process, largest_of_all
   use dissipation_sums, only: sum_dissipation
   use exact_sum, only: exact_totals
   use flow, only: flow_rates, rates_t
   use flow_sums, only: flow_sums_t, sum_flow
   use frozen_terms, only: begin_frozen_terms, complete_frozen_terms
   use integrators, only: most_stages
   use images, only: begin_fill, fill_ghosts, fill_slip, finish_fill
   use kinds, only: dp, i8
   use lanes, only: nl
   use model, only: model_t
   use neighbours, only: keep_order, list_neighbours, neighbours_t, sort_particles
   use particles, only: particles_t, state_t, swap_states
   use runge_kutta, only: block_t, moment_t, stage_state, update_block
   use search_margins, only: lists_hold, lists_reach, plan_t, planned, watch_margins, widen_margins
   use step_state, only: step_t, take_extremes
   use strips, only: group_slots
   use timers, only: timers_t, wall_seconds
   implicit none
   private

   public :: refresh, go_on, sorts_next, plan_next, advance

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
         call keep_order(near, p, model%box%after(run%time), run%dt)
         if (p%features%no_slip) call fill_slip(near%images, model%box%after(run%time), p)
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
      call sort_particles(near, p, model%kernel, model%box%after(run%time), model%dx, plan%span, run%scattered)
      if (run%scattered) return
      run%sorted = run%sorted + 1
      if (p%features%no_slip) call fill_slip(near%images, model%box%after(run%time), p)
      call list_neighbours(near, p, model%kernel, 1.3_dp*near%tau, within_step=.false.)
   end subroutine find_neighbours

   !> Advances from `base` to `next` by one step, not beyond `last_time`.
   subroutine advance(model, p, near, run, last_time, timers)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      type(neighbours_t), intent(inout) :: near
      type(step_t), intent(inout) :: run
      real(dp), intent(in) :: last_time
      type(timers_t), intent(inout) :: timers
      type(block_t), allocatable :: blocks(:)
      real(dp) :: at_most
      logical :: strayed

      at_most = last_time - run%time
      do
         allocate (blocks(near%n_blocks))
         call timers%start(phase_gradients)
         call first_sums(model, p, near, blocks)
         call timers%stop(phase_gradients)
         run%dt = min(stable_step(model, blocks), at_most)
         if (in_reach(near, run%dt)) then
            call stages(model, p, near, run, blocks, timers, strayed)
            if (strayed) then
               near%slack = 2*near%stray
            else
               ! Terms that are not frozen: the coefficients of the later stages are known now.
               at_most = min(at_most, stable_step(model, blocks))
               if (.not. run%dt > grown*at_most) exit
            end if
            run%repeated = run%repeated + 1
         end if
         ! The step is much longer than expected, accelerations led some particle too far, or alpha_i and delta_i grew: again,
         ! with better margins.
         deallocate (blocks)
         call sort_again(model, p, near, run, timers)
         if (run%scattered) return
      end do
      call collect(model, near, run, last_time, blocks)
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

   ! The step of eq. 8 and the diffusive limits.
   real(dp) function stable_step(model, blocks)
      type(model_t), intent(in) :: model
      type(block_t), intent(in) :: blocks(:)
      real(dp) :: largest(3)

      largest = max(0.0_dp, [maxval(blocks%largest_pi), maxval(blocks%largest_alpha), maxval(blocks%largest_delta)])
      call largest_of_all(size(largest), largest)
      stable_step = model%step_limit(largest(1), model%alpha + largest(2), largest(3))
   end function stable_step

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
   subroutine first_sums(model, p, near, blocks)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      type(neighbours_t), intent(inout) :: near
      type(block_t), intent(inout) :: blocks(:)
      real(dp) :: started
      integer :: b

      started = wall_seconds()
      !$omp parallel do default(none) shared(model, p, near, blocks) schedule(dynamic)
      do b = 1, near%n_blocks
         call begin_frozen_terms(model, p, near, b, blocks(b))
      end do
      !$omp end parallel do
      near%division%busy = near%division%busy + wall_seconds() - started
   end subroutine first_sums

   ! The stages; `strayed` if there are no images for where some particle went, and the result is void.
   subroutine stages(model, p, near, run, blocks, timers, strayed)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      type(neighbours_t), intent(inout) :: near
      type(step_t), intent(inout) :: run
      type(block_t), intent(inout) :: blocks(:)
      type(timers_t), intent(inout) :: timers
      logical, intent(out) :: strayed
      real(dp) :: changes(near%n_blocks, most_stages), jumps(near%n_blocks)
      type(moment_t) :: moment
      integer :: stage

      if (near%age + run%dt - near%tau > near%travel) then
         call timers%start(phase_sort)
         call list_neighbours(near, p, model%kernel, 1.1_dp*(run%dt - near%tau), within_step=.false.)
         call timers%stop(phase_sort)
      end if
      strayed = .false.
      do stage = 1, model%integrator%stages
         moment = moment_t(stage, run%dt, model%box%after(run%time + model%integrator%time_of(stage)*run%dt))
         if (stage == 1) then
            call timers%start(phase_diffusion)
            call first_stage(model, p, near, moment, blocks)
            if (.not. model%frozen) call scale_wall_power(model%integrator%weight(1), blocks)
            call timers%stop(phase_diffusion)
         else
            call timers%start(phase_stages)
            if (stage == 4) call swap_states(p%next, p%stage(2))   ! see module runge_kutta
            if (model%frozen) then
               call later_stage(model, p, near, moment, blocks)
            else
               call whole_stage(model, p, near, moment, blocks)
            end if
            call timers%stop(phase_stages)
         end if
         changes(:, stage) = blocks%change(stage)
         if (stage < model%integrator%stages) call follow(model, p, near, run, stage, changes, timers, strayed)
      end do
      near%jumped = any(blocks%wrapped)
      jumps = blocks%jump
      call watch_margins(near, model%integrator, run%dt, changes, jumps)
      ! A solution that has left its range by so much is no better the second time.
      if (near%stray > model%kernel%support) then
         if (any_process(any(blocks%lost_slot > 0))) strayed = .false.
      end if
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

   ! Makes the lists anew if they do not reach as far as the state that a stage leads to.
   subroutine follow(model, p, near, run, stage, changes, timers, strayed)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      type(neighbours_t), intent(inout) :: near
      type(step_t), intent(inout) :: run
      integer, intent(in) :: stage
      real(dp), intent(in) :: changes(:, :)   !! (blocks, stages) until this one
      type(timers_t), intent(inout) :: timers
      logical, intent(inout) :: strayed
      real(dp) :: time
      logical :: enough

      time = model%integrator%ahead(stage)*run%dt
      if (.not. any_process(.not. lists_reach(near, time, changes(:, stage)))) return
      call timers%start(phase_sort)
      call widen_margins(near, time, changes(:, stage), changes(:, 1), enough)
      strayed = strayed .or. .not. enough
      if (enough) then
         call list_neighbours(near, p, model%kernel, near%travel, within_step=.true.)
         run%relisted = run%relisted + 1
      end if
      call timers%stop(phase_sort)
   end subroutine follow

   ! Completes the frozen terms and goes from `base` to the second stage's state.
   subroutine first_stage(model, p, near, moment, blocks)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      type(neighbours_t), intent(inout) :: near
      type(moment_t), intent(in) :: moment
      type(block_t), intent(inout) :: blocks(:)
      type(rates_t) :: rates
      real(dp) :: started
      integer :: b, i0, k, n, part, span(2)

      call begin_fill(near%images, model%box, p)
      do part = 1, 2
         if (part == 2) then
            started = wall_seconds()
            call finish_fill(near%images, model%box, p)
            near%division%waiting = near%division%waiting + wall_seconds() - started
         end if
         span = near%part(part)
         started = wall_seconds()
         !$omp parallel do default(none) shared(model, p, near, moment, blocks, span) private(b, i0, n, rates) schedule(dynamic)
         do k = span(1), span(2)
            b = near%order(k)
            i0 = near%blocks(b)%before
            n = nl*near%blocks(b)%n_clusters
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
   subroutine later_stage(model, p, near, moment, blocks)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      type(neighbours_t), intent(inout) :: near
      type(moment_t), intent(in) :: moment   !! of stage 2 or later
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
         span = near%part(part)
         started = wall_seconds()
         !$omp parallel do default(none) shared(model, p, near, moment, now, blocks, span) &
         !$omp private(b, i0, n, sums, rates) schedule(dynamic)
         do k = span(1), span(2)
            b = near%order(k)
            i0 = near%blocks(b)%before
            n = nl*near%blocks(b)%n_clusters
            call sum_flow(model%kernel, near%blocks(b), p%stage(now), i0, sums)
            call flow_rates(model, p%stage(now), i0, n, sums, rates)
            call update_block(model, p, i0, n, moment, rates, blocks(b))
         end do
         !$omp end parallel do
         near%division%busy = near%division%busy + wall_seconds() - started
      end do
   end subroutine later_stage

   ! The same with the diffusive terms of the stage's own state, which takes the place of `base` for them.
   subroutine whole_stage(model, p, near, moment, blocks)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      type(neighbours_t), intent(inout) :: near
      type(moment_t), intent(in) :: moment   !! of stage 2 or later
      type(block_t), intent(inout) :: blocks(:)
      type(block_t) :: of_stage(size(blocks))
      type(rates_t) :: rates
      type(state_t) :: kept                  ! rates of velocity and density: `next` may hold a stage's state
      integer :: b, i0, n, now

      now = stage_state(moment%stage)
      allocate (kept%u(p%capacity), kept%v(p%capacity), kept%s(p%capacity))
      call fill_ghosts(near%images, moment%box, p%stage(now))
      call swap_states(p%base, p%stage(now))
      call swap_states(p%next, kept)
      if (p%features%no_slip) call fill_slip(near%images, moment%box, p)
      call first_sums(model, p, near, of_stage)
      call begin_fill(near%images, model%box, p)
      call finish_fill(near%images, model%box, p)
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
         i0 = near%blocks(b)%before
         n = nl*near%blocks(b)%n_clusters
         call take_kept(kept, i0, n, rates)
         call update_block(model, p, i0, n, moment, rates, blocks(b))
      end do
      !$omp end parallel do
   end subroutine whole_stage

   ! Sums over each strip, and over these exact: neither threads nor the order of strips matter.
   subroutine collect(model, near, run, last_time, blocks)
      type(model_t), intent(in) :: model
      type(neighbours_t), intent(inout) :: near
      type(step_t), intent(inout) :: run
      real(dp), intent(in) :: last_time
      type(block_t), intent(in) :: blocks(:)
      real(dp), allocatable :: sums(:, :)   ! of each strip
      real(dp) :: totals(7), largest(7), moving_walls
      integer :: k

      allocate (sums(7, size(near%first_block) - 1))
      !$omp parallel do default(none) shared(near, blocks, sums) schedule(dynamic, max(1, size(near%first_block)/256))
      do k = 1, size(sums, 2)
         sums(:5, k) = strip_powers(near, k, blocks)
         associate (here => blocks(near%first_block(k):near%first_block(k + 1) - 1))
            sums(6:, k) = [sum(here%crossings), sum(here%singular)]
         end associate
      end do
      !$omp end parallel do
      totals = exact_totals(sums)
      largest = max(0.0_dp, [maxval(blocks%speed_2), maxval(blocks%pressure), maxval(blocks%largest_s), maxval(blocks%largest_pi), &
                             maxval(near%margins(:near%n_blocks)%next_stray), one_if(any(blocks%lost_slot > 0)), &
                             one_if(.not. lists_hold(near, run%dt))])
      call largest_of_all(size(largest), largest)
      if (run%dt < model%advective_limit(largest(4)) .and. run%time + run%dt < last_time) run%limited = run%limited + 1
      moving_walls = run%dt*totals(5)
      run%work_alpha = run%work_alpha + totals(1) - moving_walls
      run%work_delta = run%work_delta + totals(2)
      run%work_walls = run%work_walls + totals(3) + moving_walls
      run%work_force = run%work_force + totals(4)
      run%crossings = run%crossings + nint(totals(6), i8)
      run%singular = run%singular + nint(totals(7), i8)
      call take_extremes(model, largest(1), largest(2), largest(3), run)
      near%next_stray = largest(5)
      run%lost_slot = max(0, maxval(blocks%lost_slot))
      run%lost = largest(6) > 0
      near%lasts = .not. largest(7) > 0
   end subroutine collect

   pure real(dp) function one_if(statement)
      logical, intent(in) :: statement

      one_if = merge(1.0_dp, 0.0_dp, statement)
   end function one_if

   ! The works and the wall power of a strip, group by group.
   pure function strip_powers(near, strip, blocks) result(powers)
      type(neighbours_t), intent(in) :: near
      integer, intent(in) :: strip   !! counted from the first own one
      type(block_t), intent(in) :: blocks(:)
      real(dp) :: powers(5)
      integer :: b, g

      powers = 0
      do b = near%first_block(strip), near%first_block(strip + 1) - 1
         do g = 1, nl*near%blocks(b)%n_clusters/group_slots
            powers = powers + [blocks(b)%work(g, :), blocks(b)%wall_power(g)]
         end do
      end do
   end function strip_powers

end module time_step
