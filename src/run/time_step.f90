!> One time step: fourth-order Runge-Kutta with the diffusive terms frozen at the first stage.
!!
!! Source: eqs. 5-8 and 10-13 of the paper; the energies that the diffusive terms and the walls take are summed
!! with the stage states and the Runge-Kutta weights, so that the budget closes to the order of the scheme
!! (docs/equations.md).
module time_step
   use diffusion, only: freeze_density_diffusion, freeze_gradient, freeze_viscosity
   use diffusion_sums, only: sum_diffusion
   use dissipation_sums, only: sum_dissipation
   use eddy, only: freeze_coefficients, freeze_eddy_terms
   use eddy_sums, only: eddy_sums_t, sum_eddy
   use flow, only: as_flow_sums, flow_rates, rates_t
   use flow_sums, only: flow_sums_t, sum_flow
   use gradient_sums, only: gradient_sums_t, sum_gradients
   use images, only: fill_image_copies, fill_image_gradients, fill_images, fill_no_slip, outside, reflect, wrap
   use kinds, only: dp, i8
   use lanes, only: nl
   use model, only: model_t
   use neighbours, only: list_ranges, neighbours_t, sort_particles
   use no_slip, only: add_friction, add_wall_shear
   use particles, only: particles_t, state_t
   use strain_sums, only: strain_sums_t, sum_strain
   use timers, only: timers_t
   implicit none
   private

   public :: step_t, refresh, advance

   integer, parameter :: block_clusters = 64   !! clusters that a thread takes at a time, and that sums go over
   real(dp), parameter :: stage_ahead(4) = [0.5_dp, 0.5_dp, 1.0_dp, 0.0_dp]
   integer, parameter :: stage_state(4) = [0, 1, 2, 1]   !! which of p%stage holds a stage's state; 0: base
   real(dp), parameter :: stage_weight(4) = [1.0_dp, 2.0_dp, 2.0_dp, 1.0_dp]/6

   integer, parameter, public :: phase_sort = 1, phase_gradients = 2, phase_diffusion = 3, phase_stages = 4

   !> What steps leave behind: time, counts, sums and extremes.
   type :: step_t
      real(dp) :: time = 0
      real(dp) :: dt = 0                    !! last step
      integer :: step = 0                   !! steps done
      integer(i8) :: crossings = 0          !! particles put back behind a wall
      integer(i8) :: singular = 0           !! particle-steps without a density gradient
      integer(i8) :: limited = 0            !! steps shorter than eq. 8, for the diffusive terms' stability
      integer(i8) :: repeated = 0           !! steps repeated with a larger search margin
      real(dp) :: work_alpha = 0            !! energy given by viscosity, <= 0
      real(dp) :: work_delta = 0            !! energy given by density diffusion
      real(dp) :: work_walls = 0            !! energy given by the walls' images, and by moving no-slip walls
      real(dp) :: work_force = 0            !! energy given by the uniform force
      real(dp) :: mach = 0                  !! eq. 4: max of |u| and sqrt(p/rho) over c0, at the end of the last step
      real(dp) :: speed = 0                 !! max |u| at the end of the last step
      real(dp) :: variation = 0             !! max |rho - rho0|/rho0 at the end of the last step
      real(dp) :: largest_mach = 0          !! over all steps
      real(dp) :: largest_variation = 0     !! over all steps
      integer :: lost_slot = 0              !! slot of a particle whose state left its range; 0 if none
      logical :: scattered = .false.        !! some particle is too far away for the neighbour search
   end type step_t

   !> A cluster's velocity, density and volume at a stage.
   type :: lanes_t
      real(dp) :: u(nl), v(nl), s(nl), w(nl)
   end type lanes_t

   !> Sums and extremes of a block of clusters.
   type :: block_t
      real(dp) :: work(4) = 0        !! alpha, delta, walls, uniform force
      real(dp) :: wall_power = 0     !! of no-slip walls that move
      real(dp) :: speed_2 = 0        !! max |u|**2
      real(dp) :: pressure = 0       !! max p/rho
      real(dp) :: largest_s = 0
      real(dp) :: largest_pi = 0
      real(dp) :: largest_alpha = 0  !! alpha_i and delta_i of the dynamic model
      real(dp) :: largest_delta = 0
      integer :: crossings = 0
      integer :: singular = 0
      integer :: lost_slot = 0
      real(dp) :: stray = 0          !! largest way that accelerations led a particle
   end type block_t

contains

   !> Sorts the particles, mirrors them and lists neighbours: `base` is then the state at `time`.
   subroutine refresh(model, p, near, run, timers)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      type(neighbours_t), intent(inout) :: near
      type(step_t), intent(inout) :: run
      type(timers_t), intent(inout) :: timers
      real(dp) :: expected

      call timers%start(phase_sort)
      near%slack = max(0.02_dp*model%dx, 2*near%stray)
      expected = run%dt
      if (run%step == 0) expected = model%longest_step()
      call find_neighbours(model, p, near, run, expected)
      call timers%stop(phase_sort)
   end subroutine refresh

   subroutine find_neighbours(model, p, near, run, expected)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      type(neighbours_t), intent(inout) :: near
      type(step_t), intent(inout) :: run
      real(dp), intent(in) :: expected

      call sort_particles(near, p, model%kernel, model%walls, model%dx, expected, run%scattered)
      if (run%scattered) return
      if (p%features%no_slip) call fill_no_slip(near%images, model%walls, p)
      call list_ranges(near, p, model%kernel, 2*near%tau)
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
      logical :: strayed

      do
         allocate (blocks((near%n_clusters + block_clusters - 1)/block_clusters))
         call first_sums(model, p, near, blocks, timers)
         run%dt = min(stable_step(model, blocks), last_time - run%time)
         if (run%dt - near%tau <= near%image_travel) then
            call stages(model, p, near, run%dt, blocks, timers, strayed)
            if (.not. strayed) exit
            run%repeated = run%repeated + 1
            near%slack = 2*near%stray
         end if
         ! The step is much longer than expected, or accelerations led some particle too far: with better margins again.
         deallocate (blocks)
         call sort_again(model, p, near, run, timers)
         if (run%scattered) return
      end do
      call collect(model, run, last_time, blocks)
      if (p%features%dissipation) &
         p%dissipated(1:p%n_own) = p%dissipated(1:p%n_own) + run%dt*p%dissipating(1:p%n_own)
      run%step = run%step + 1
      run%time = run%time + run%dt
   end subroutine advance

   ! The step of eq. 8 and the diffusive limits.
   pure real(dp) function stable_step(model, blocks)
      type(model_t), intent(in) :: model
      type(block_t), intent(in) :: blocks(:)

      stable_step = model%step_limit(maxval(blocks%largest_pi), model%alpha + maxval(blocks%largest_alpha), &
                                     max(model%delta, maxval(blocks%largest_delta)))
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
      call find_neighbours(model, p, near, run, run%dt)
      call timers%stop(phase_sort)
   end subroutine sort_again

   ! L, grad rho and the first stage's rates, which `next` keeps until they are used; of the frozen terms what needs no
   ! gradient and no coefficient of a neighbour.
   subroutine first_sums(model, p, near, blocks, timers)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      type(neighbours_t), intent(in) :: near
      type(block_t), intent(inout) :: blocks(:)
      type(timers_t), intent(inout) :: timers
      integer :: b, c

      call timers%start(phase_gradients)
      !$omp parallel do default(none) shared(model, p, near, blocks) private(c) schedule(dynamic)
      do b = 1, size(blocks)
         do c = (b - 1)*block_clusters + 1, min(b*block_clusters, near%n_clusters)
            if (model%dynamic) then
               call first_sums_dynamic(model, p, near, c, blocks(b))
            else
               call first_sums_constant(model, p, near, c, blocks(b))
            end if
         end do
      end do
      !$omp end parallel do
      if (model%dynamic .or. model%delta > 0) &
         call fill_image_gradients(near%images, model%walls, p%n_own, p%grad_x, p%grad_y)
      if (model%dynamic) call fill_image_copies(near%images, p%n_own, p%alpha, p%delta)
      call timers%stop(phase_gradients)
   end subroutine first_sums

   ! Of a cluster, with constant coefficients.
   subroutine first_sums_constant(model, p, near, c, block)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      type(neighbours_t), intent(in) :: near
      integer, intent(in) :: c
      type(block_t), intent(inout) :: block
      type(gradient_sums_t) :: sums
      type(rates_t) :: rates
      integer :: i0, singular

      i0 = (c - 1)*nl
      call sum_gradients(model%kernel, near%ranges(c), p%base, p%owner, i0, sums)
      call flow_rates(model, p%base, i0, as_flow_sums(sums, p%base, i0), rates)
      call keep_rates(p, i0, rates)
      call freeze_viscosity(model, sums, p, i0)
      if (model%delta > 0) then
         call freeze_gradient(model, sums, p, i0, singular)
         block%singular = block%singular + singular
      end if
      block%largest_pi = max(block%largest_pi, maxval(sums%largest_pi))
   end subroutine first_sums_constant

   ! Of a cluster, with the dynamic model.
   subroutine first_sums_dynamic(model, p, near, c, block)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      type(neighbours_t), intent(in) :: near
      integer, intent(in) :: c
      type(block_t), intent(inout) :: block
      type(strain_sums_t) :: sums
      type(rates_t) :: rates
      integer :: i0, singular

      i0 = (c - 1)*nl
      call sum_strain(model%kernel, near%ranges(c), p%base, p%owner, i0, sums)
      call flow_rates(model, p%base, i0, as_flow_sums(sums, p%base, i0), rates)
      call keep_rates(p, i0, rates)
      if (p%features%no_slip) call add_wall_shear(model, near%ranges(c), p, i0, sums)
      call freeze_coefficients(model, sums, p, i0, singular)
      block%singular = block%singular + singular
      block%largest_pi = max(block%largest_pi, maxval(sums%largest_pi))
      block%largest_alpha = max(block%largest_alpha, maxval(p%alpha(i0 + 1:i0 + nl)))
      block%largest_delta = max(block%largest_delta, maxval(p%delta(i0 + 1:i0 + nl)))
   end subroutine first_sums_dynamic

   pure subroutine keep_rates(p, i0, rates)
      type(particles_t), intent(inout) :: p
      integer, intent(in) :: i0
      type(rates_t), intent(in) :: rates

      p%next%u(i0 + 1:i0 + nl) = rates%u
      p%next%v(i0 + 1:i0 + nl) = rates%v
      p%next%s(i0 + 1:i0 + nl) = rates%s
   end subroutine keep_rates

   ! The four stages; `strayed` if the neighbour ranges turned out too small and the result is void.
   subroutine stages(model, p, near, dt, blocks, timers, strayed)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      type(neighbours_t), intent(inout) :: near
      real(dp), intent(in) :: dt
      type(block_t), intent(inout) :: blocks(:)
      type(timers_t), intent(inout) :: timers
      logical, intent(out) :: strayed
      integer :: stage

      ! The ranges hold from tau before to `travel` after the time that particles were sorted for.
      if (dt - near%tau > near%travel) then
         call timers%start(phase_sort)
         call list_ranges(near, p, model%kernel, 1.1_dp*(dt - near%tau))
         call timers%stop(phase_sort)
      end if
      call timers%start(phase_diffusion)
      call first_stage(model, p, near, dt, blocks)
      call timers%stop(phase_diffusion)
      call timers%start(phase_stages)
      do stage = 2, 4
         call later_stage(model, p, near, stage, dt, blocks)
      end do
      call timers%stop(phase_stages)
      near%stray = maxval(blocks%stray)
      strayed = near%stray > near%slack
      ! A solution that has left its range by so much is no better the second time.
      if (any(blocks%lost_slot > 0) .and. near%stray > model%kernel%support) strayed = .false.
   end subroutine stages

   ! Completes the frozen terms and goes from `base` to the second stage's state.
   subroutine first_stage(model, p, near, dt, blocks)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      type(neighbours_t), intent(in) :: near
      real(dp), intent(in) :: dt
      type(block_t), intent(inout) :: blocks(:)
      type(rates_t) :: rates
      integer :: b, c, i0

      !$omp parallel do default(none) shared(model, p, near, dt, blocks) private(c, i0, rates) schedule(dynamic)
      do b = 1, size(blocks)
         do c = (b - 1)*block_clusters + 1, min(b*block_clusters, near%n_clusters)
            i0 = (c - 1)*nl
            call complete_frozen_terms(model, p, near, c, blocks(b))
            rates = rates_t(p%next%u(i0 + 1:i0 + nl), p%next%v(i0 + 1:i0 + nl), p%next%s(i0 + 1:i0 + nl))
            call update_cluster(model, p, i0, 1, dt, rates, blocks(b))
         end do
      end do
      !$omp end parallel do
   end subroutine first_stage

   ! What the frozen terms need of the neighbours' gradients and coefficients.
   subroutine complete_frozen_terms(model, p, near, c, block)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      type(neighbours_t), intent(in) :: near
      integer, intent(in) :: c
      type(block_t), intent(inout) :: block
      real(dp) :: neighbour_gradient(nl)
      type(eddy_sums_t) :: eddy
      integer :: i0

      i0 = (c - 1)*nl
      if (model%dynamic) then
         call sum_eddy(model%kernel, near%ranges(c), p, model%alpha, i0, eddy)
         call freeze_eddy_terms(model, eddy, p, i0)
      else if (model%delta > 0) then
         call sum_diffusion(model%kernel, near%ranges(c), p, i0, neighbour_gradient)
         call freeze_density_diffusion(model, neighbour_gradient, p, i0)
      end if
      if (p%features%no_slip) call add_friction(model, near%ranges(c), p, i0, block%wall_power)
      if (p%features%dissipation) call sum_dissipation(model, near%ranges(c), p, i0, p%dissipating(i0 + 1:i0 + nl))
   end subroutine complete_frozen_terms

   ! Evaluates the rates at a stage's state and forms the next stage's, or the end of the step.
   subroutine later_stage(model, p, near, stage, dt, blocks)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      type(neighbours_t), intent(in) :: near
      integer, intent(in) :: stage     !! 2 to 4
      real(dp), intent(in) :: dt
      type(block_t), intent(inout) :: blocks(:)
      type(flow_sums_t) :: sums
      type(rates_t) :: rates
      integer :: b, c, i0, now

      now = stage_state(stage)
      call fill_images(near%images, model%walls, p%n_own, p%stage(now))
      !$omp parallel do default(none) shared(model, p, near, stage, now, dt, blocks) &
      !$omp private(c, i0, sums, rates) schedule(dynamic)
      do b = 1, size(blocks)
         do c = (b - 1)*block_clusters + 1, min(b*block_clusters, near%n_clusters)
            i0 = (c - 1)*nl
            call sum_flow(model%kernel, near%ranges(c), p%stage(now), i0, sums)
            call flow_rates(model, p%stage(now), i0, sums, rates)
            call update_cluster(model, p, i0, stage, dt, rates, blocks(b))
         end do
      end do
      !$omp end parallel do
   end subroutine later_stage

   ! Adds the frozen terms and gravity, takes the works, and moves the cluster on.
   subroutine update_cluster(model, p, i0, stage, dt, rates, sums)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      integer, intent(in) :: i0             !! slot before the cluster's first
      integer, intent(in) :: stage          !! 1 to 4
      real(dp), intent(in) :: dt
      type(rates_t), intent(in) :: rates    !! inviscid, at the stage's state
      type(block_t), intent(inout) :: sums
      type(rates_t) :: full
      type(lanes_t) :: now
      real(dp), dimension(nl) :: pressure
      real(dp) :: weight

      weight = stage_weight(stage)*dt
      if (stage == 1) then
         now = lanes_of(p%base, i0)
      else
         now = lanes_of(p%stage(stage_state(stage)), i0)
      end if
      associate (m => p%m(i0 + 1:i0 + nl), visc_x => p%visc_x(i0 + 1:i0 + nl), visc_y => p%visc_y(i0 + 1:i0 + nl), &
                 diff_s => p%diff_s(i0 + 1:i0 + nl))
         full%u = rates%u + visc_x
         full%v = rates%v + visc_y - model%gravity
         full%s = rates%s + diff_s
         if (model%central_rate > 0) call add_central_force(model, p, i0, stage, full)
         if (model%has_force()) then
            full%u = full%u + model%acceleration(1)
            full%v = full%v + model%acceleration(2)
            sums%work(4) = sums%work(4) + weight*sum(m*(now%u*model%acceleration(1) + now%v*model%acceleration(2)))
         end if
         ! p V/rho = m p/rho**2 is the derivative of the elastic energy by rho, eq. 11
         pressure = model%c0**2*now%s/(model%rho0 + now%s)*now%w
         sums%work(1) = sums%work(1) + weight*sum(m*(now%u*visc_x + now%v*visc_y))
         sums%work(2) = sums%work(2) + weight*sum(pressure*diff_s)
         sums%work(3) = sums%work(3) + weight*sum(m*(now%u*rates%u + now%v*rates%v) + pressure*rates%s)
      end associate
      call add_to_next(p, i0, stage, weight, now, full)
      if (stage == 4) then
         call finish_cluster(model, p, i0, sums)
      else
         call form_stage(model, p, i0, stage + 1, stage_ahead(stage)*dt, now, full)
         associate (u => p%base%u(i0 + 1:i0 + nl), v => p%base%v(i0 + 1:i0 + nl))
            sums%stray = max(sums%stray, stage_ahead(stage)*dt*sqrt(maxval((now%u - u)**2 + (now%v - v)**2)))
         end associate
      end if
   end subroutine update_cluster

   ! -w**2 (r - centre); nothing for dummies, which are far away.
   pure subroutine add_central_force(model, p, i0, stage, rates)
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      integer, intent(in) :: i0, stage
      type(rates_t), intent(inout) :: rates
      real(dp), dimension(nl) :: x, y

      if (stage == 1) then
         x = p%base%x(i0 + 1:i0 + nl)
         y = p%base%y(i0 + 1:i0 + nl)
      else
         x = p%stage(stage_state(stage))%x(i0 + 1:i0 + nl)
         y = p%stage(stage_state(stage))%y(i0 + 1:i0 + nl)
      end if
      associate (m => p%m(i0 + 1:i0 + nl))
         rates%u = rates%u - model%central_rate**2*merge(x - model%centre(1), 0.0_dp, m > 0)
         rates%v = rates%v - model%central_rate**2*merge(y - model%centre(2), 0.0_dp, m > 0)
      end associate
   end subroutine add_central_force

   ! A cluster's part of a state that the rates were taken at.
   pure type(lanes_t) function lanes_of(state, i0) result(lanes)
      type(state_t), intent(in) :: state
      integer, intent(in) :: i0

      lanes = lanes_t(u=state%u(i0 + 1:i0 + nl), v=state%v(i0 + 1:i0 + nl), &
                      s=state%s(i0 + 1:i0 + nl), w=state%w(i0 + 1:i0 + nl))
   end function lanes_of

   ! Sums up the end of the step: base + dt sum_k b_k rates_k.
   pure subroutine add_to_next(p, i0, stage, weight, now, rates)
      type(particles_t), intent(inout) :: p
      integer, intent(in) :: i0, stage
      real(dp), intent(in) :: weight   !! dt b_k
      type(lanes_t), intent(in) :: now
      type(rates_t), intent(in) :: rates

      associate (x => p%next%x(i0 + 1:i0 + nl), y => p%next%y(i0 + 1:i0 + nl), u => p%next%u(i0 + 1:i0 + nl), &
                 v => p%next%v(i0 + 1:i0 + nl), s => p%next%s(i0 + 1:i0 + nl))
         if (stage == 1) then
            x = p%base%x(i0 + 1:i0 + nl)
            y = p%base%y(i0 + 1:i0 + nl)
            u = now%u
            v = now%v
            s = now%s
         end if
         x = x + weight*now%u
         y = y + weight*now%v
         u = u + weight*rates%u
         v = v + weight*rates%v
         s = s + weight*rates%s
      end associate
   end subroutine add_to_next

   ! The state of a stage: base + dt a_k rates_(k-1).
   pure subroutine form_stage(model, p, i0, stage, ahead, now, rates)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      integer, intent(in) :: i0, stage
      real(dp), intent(in) :: ahead   !! dt a_k
      type(lanes_t), intent(in) :: now
      type(rates_t), intent(in) :: rates

      associate (then => p%stage(stage_state(stage)), base => p%base)
         then%x(i0 + 1:i0 + nl) = base%x(i0 + 1:i0 + nl) + ahead*now%u
         then%y(i0 + 1:i0 + nl) = base%y(i0 + 1:i0 + nl) + ahead*now%v
         then%u(i0 + 1:i0 + nl) = base%u(i0 + 1:i0 + nl) + ahead*rates%u
         then%v(i0 + 1:i0 + nl) = base%v(i0 + 1:i0 + nl) + ahead*rates%v
         then%s(i0 + 1:i0 + nl) = base%s(i0 + 1:i0 + nl) + ahead*rates%s
         then%w(i0 + 1:i0 + nl) = p%m(i0 + 1:i0 + nl)/(model%rho0 + then%s(i0 + 1:i0 + nl))
      end associate
   end subroutine form_stage

   ! Walls, volume, extremes and range checks of a cluster's new state.
   subroutine finish_cluster(model, p, i0, sums)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      integer, intent(in) :: i0
      type(block_t), intent(inout) :: sums
      real(dp) :: speed_2(nl), pressure(nl)
      logical :: crossed, out_of_range(nl)
      integer :: i

      associate (x => p%next%x(i0 + 1:i0 + nl), y => p%next%y(i0 + 1:i0 + nl), u => p%next%u(i0 + 1:i0 + nl), &
                 v => p%next%v(i0 + 1:i0 + nl), s => p%next%s(i0 + 1:i0 + nl), m => p%m(i0 + 1:i0 + nl))
         if (any(outside(model%walls, x, y) .and. m > 0)) then
            do i = i0 + 1, i0 + nl
               if (p%id(i) == 0) cycle
               call reflect(model%walls, model%gravity, p%next%x(i), p%next%y(i), p%next%u(i), p%next%v(i), crossed)
               if (crossed) sums%crossings = sums%crossings + 1
               if (any(model%walls%periodic)) call wrap(model%walls, p%next%x(i), p%next%y(i))
            end do
         end if
         p%next%w(i0 + 1:i0 + nl) = m/(model%rho0 + s)
         speed_2 = merge(u**2 + v**2, 0.0_dp, m > 0)
         pressure = model%c0**2*s/(model%rho0 + s)
         sums%speed_2 = max(sums%speed_2, maxval(speed_2))
         sums%pressure = max(sums%pressure, maxval(pressure))
         sums%largest_s = max(sums%largest_s, maxval(abs(s)))
         ! Written so that NaN fails too. Collapsing cavities reach half the sound speed and density for a moment.
         out_of_range = .not. (speed_2 < 100*model%c0**2 .and. s > -0.9_dp*model%rho0 .and. s < 4*model%rho0)
         if (any(out_of_range)) sums%lost_slot = i0 + findloc(out_of_range, .true., dim=1)
      end associate
   end subroutine finish_cluster

   ! Sums over the blocks in their order, so that the result does not depend on the number of threads.
   subroutine collect(model, run, last_time, blocks)
      type(model_t), intent(in) :: model
      type(step_t), intent(inout) :: run
      real(dp), intent(in) :: last_time
      type(block_t), intent(in) :: blocks(:)
      real(dp) :: moving_walls

      if (run%dt < model%advective_limit(maxval(blocks%largest_pi)) .and. run%time + run%dt < last_time) &
         run%limited = run%limited + 1
      moving_walls = run%dt*sum(blocks%wall_power)
      run%work_alpha = run%work_alpha + sum(blocks%work(1)) - moving_walls
      run%work_delta = run%work_delta + sum(blocks%work(2))
      run%work_walls = run%work_walls + sum(blocks%work(3)) + moving_walls
      run%work_force = run%work_force + sum(blocks%work(4))
      run%crossings = run%crossings + sum(blocks%crossings)
      run%singular = run%singular + sum(blocks%singular)
      run%speed = sqrt(maxval(blocks%speed_2))
      run%mach = sqrt(max(maxval(blocks%speed_2), maxval(blocks%pressure)))/model%c0
      run%variation = maxval(blocks%largest_s)/model%rho0
      run%largest_mach = max(run%largest_mach, run%mach)
      run%largest_variation = max(run%largest_variation, run%variation)
      run%lost_slot = maxval(blocks%lost_slot)
   end subroutine collect

end module time_step
