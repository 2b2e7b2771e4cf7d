!> Runge-Kutta for one block: from a stage's rates to the next stage's state, or to the end of the step.
!!
!! Source: sec. 2 of the paper; the works are summed with the stage states and the weights of the scheme (docs/equations.md).
module runge_kutta
   use box, only: box_t
   use blocks, only: block_t, moment_t
   use candidates, only: block_groups, block_slots
   use crossings, only: cross_sides, leave_solids
   use equation_of_state, only: specific_pressure
   use flow, only: rates_t
   use integrators, only: most_stages
   use kinds, only: dp, sp
   use model, only: model_t
   use particles, only: particles_t, state_t
   use sponges, only: sponge_t
   use strips, only: group_slots
   implicit none
   private

   public :: update_block, watch_changes

   ! The state of stage 1 is `base`; those of stages 2 and 3 are in p%stage(1) and (2). That of stage 4 is formed in `next` and
   ! changes places with stage 3's before it is used, so that the end of the step can always be written to `next`, block by block.
   integer, parameter, public :: stage_state(2:most_stages) = [1, 2, 2]   !! which of p%stage holds a stage's state

   real(dp), parameter, public :: fastest = 10   !! in c0; a particle that is faster has left the range

   !> A block's part of a stage's state.
   type :: stage_t
      real(dp), dimension(block_slots) :: x, y, u, v, s, volume, m
   end type stage_t

contains

   !> Adds the frozen terms and forces, takes the works, and moves the block on.
   subroutine update_block(model, p, i0, n, moment, rates, sums)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      integer, intent(in) :: i0, n          !! slot before the block's first; slots
      type(moment_t), intent(in) :: moment
      type(rates_t), intent(inout) :: rates !! inviscid, at the stage's state; on return with all terms
      type(block_t), intent(inout) :: sums
      type(stage_t) :: now
      real(dp) :: weight, ahead

      associate (stage => moment%stage, scheme => model%integrator)
         if (stage == 1) then
            call take_stage(p%base, p%m, i0, n, now)
         else
            call take_stage(p%stage(stage_state(stage)), p%m, i0, n, now)
         end if
         weight = scheme%weight(stage)*moment%dt
         ahead = scheme%ahead(stage)*moment%dt
         sums%change(stage) = largest_change(n, now, p%sorted_u(i0 + 1:i0 + n), p%sorted_v(i0 + 1:i0 + n))
         call add_terms(model, p, i0, n, weight, now, rates, sums%work)
         if (moment%box%inertia%acts()) call add_inertia(moment%box, n, weight, now, rates, sums%work(:, 4))
         if (allocated(model%sponges)) call add_sponges(model%sponges, n, weight, now, rates, sums%sponge_work)
         if (model%has_solids()) sums%solid_work = sums%solid_work + weight*sums%solid_power
         if (stage == scheme%stages) then
            call end_step(scheme%share, weight, p, i0, n, now, rates)
            if (allocated(moment%obstacles)) call leave_solids(model, moment%last_box, moment%obstacles, p, i0, n, sums)
            call finish_block(model, moment%last_box, p, i0, n, sums)
         else if (stage < 3) then
            call go_on(p%base, i0, n, ahead, model%rho0, now, rates, p%stage(stage))
         else
            call go_on(p%base, i0, n, ahead, model%rho0, now, rates, p%next)
         end if
      end associate
   end subroutine update_block

   ! A block's part of a state.
   pure subroutine take_stage(state, m, i0, n, now)
      type(state_t), intent(in) :: state
      real(dp), intent(in) :: m(:)
      integer, intent(in) :: i0, n
      type(stage_t), intent(inout) :: now
      integer :: k

      !$omp simd
      do k = 1, n
         now%x(k) = state%x(i0 + k)
         now%y(k) = state%y(i0 + k)
         now%u(k) = state%u(i0 + k)
         now%v(k) = state%v(i0 + k)
         now%s(k) = state%s(i0 + k)
         now%volume(k) = state%volume(i0 + k)
         now%m(k) = m(i0 + k)
      end do
   end subroutine take_stage

   ! The frozen diffusive terms and the forces, and the work of each.
   pure subroutine add_terms(model, p, i0, n, weight, now, rates, work)
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      integer, intent(in) :: i0, n
      real(dp), intent(in) :: weight        !! dt b_k
      type(stage_t), intent(in) :: now      !! that the rates were taken at
      type(rates_t), intent(inout) :: rates
      real(dp), intent(inout) :: work(block_groups, 4)
      real(dp) :: pressure(block_slots)     ! p V/rho = m p/rho**2: the derivative of the elastic energy by rho, eq. 11

      call take_power(n, model%c0, model%rho0, weight, now, rates, pressure, work(:, 3))
      if (p%features%viscosity) &
         call add_force(n, weight, now, p%visc_x(i0 + 1:i0 + n), p%visc_y(i0 + 1:i0 + n), rates, work(:, 1))
      if (p%features%diffusion) call add_density_rate(n, weight, pressure, p%diff_s(i0 + 1:i0 + n), rates, work(:, 2))
      rates%v(:n) = rates%v(:n) - model%gravity
      if (model%has_force()) then
         associate (a => spread(model%acceleration, 2, n))
            call add_force(n, weight, now, a(1, :), a(2, :), rates, work(:, 4))
         end associate
      end if
      if (model%central_rate > 0) call add_central_force(model, now, n, rates)
   end subroutine add_terms

   ! The work of the rates that there are, by sum m u.a + (m p/rho**2) drho/dt: without diffusion and forces it is the walls'.
   pure subroutine take_power(n, c0, rho0, weight, now, rates, pressure, work)
      integer, intent(in) :: n
      real(dp), intent(in) :: c0, rho0
      real(dp), intent(in) :: weight         !! dt b_k
      type(stage_t), intent(in) :: now
      type(rates_t), intent(in) :: rates
      real(dp), intent(out) :: pressure(n)   !! m p/rho**2
      real(dp), intent(inout) :: work(n/group_slots)
      real(dp) :: power(n)
      integer :: k

      !$omp simd
      do k = 1, n
         pressure(k) = specific_pressure(c0, rho0, now%s(k))*now%volume(k)
         power(k) = now%m(k)*(now%u(k)*rates%u(k) + now%v(k)*rates%v(k)) + pressure(k)*rates%s(k)
      end do
      call add_groups(n/group_slots, weight, power, work)
   end subroutine take_power

   ! Its work is by sum m u.a.
   pure subroutine add_force(n, weight, now, x, y, rates, work)
      integer, intent(in) :: n
      real(dp), intent(in) :: weight         !! dt b_k
      type(stage_t), intent(in) :: now
      real(dp), intent(in) :: x(n), y(n)     !! acceleration
      type(rates_t), intent(inout) :: rates
      real(dp), intent(inout) :: work(n/group_slots)
      real(dp) :: power(n)
      integer :: k

      !$omp simd
      do k = 1, n
         power(k) = now%m(k)*(now%u(k)*x(k) + now%v(k)*y(k))
         rates%u(k) = rates%u(k) + x(k)
         rates%v(k) = rates%v(k) + y(k)
      end do
      call add_groups(n/group_slots, weight, power, work)
   end subroutine add_force

   ! Its work is by sum (m p/rho**2) drho/dt.
   pure subroutine add_density_rate(n, weight, pressure, s, rates, work)
      integer, intent(in) :: n
      real(dp), intent(in) :: weight             !! dt b_k
      real(dp), intent(in) :: pressure(n), s(n)  !! m p/rho**2; rate of rho
      type(rates_t), intent(inout) :: rates
      real(dp), intent(inout) :: work(n/group_slots)
      real(dp) :: power(n)
      integer :: k

      !$omp simd
      do k = 1, n
         power(k) = pressure(k)*s(k)
         rates%s(k) = rates%s(k) + s(k)
      end do
      call add_groups(n/group_slots, weight, power, work)
   end subroutine add_density_rate

   ! The sum of each group: by halves, because a reduction over so few adds lane after lane.
   pure subroutine add_groups(n, weight, power, work)
      integer, intent(in) :: n   !! groups
      real(dp), intent(in) :: weight, power(group_slots/4, 4, n)
      real(dp), intent(inout) :: work(n)
      real(dp) :: quarter(group_slots/4)
      integer :: g

      do g = 1, n
         quarter = (power(:, 1, g) + power(:, 3, g)) + (power(:, 2, g) + power(:, 4, g))
         work(g) = work(g) + weight*sum(quarter)
      end do
   end subroutine add_groups

   ! What acts because the box is moved.
   pure subroutine add_inertia(box, n, weight, now, rates, work)
      type(box_t), intent(in) :: box
      integer, intent(in) :: n
      real(dp), intent(in) :: weight         !! dt b_k
      type(stage_t), intent(in) :: now
      type(rates_t), intent(inout) :: rates
      real(dp), intent(inout) :: work(n/group_slots)
      real(dp) :: force(2), x(n), y(n)
      integer :: k

      do k = 1, n
         force = 0
         if (now%m(k) > 0) force = box%inertia%at([now%x(k), now%y(k)], [now%u(k), now%v(k)])
         x(k) = force(1)
         y(k) = force(2)
      end do
      call add_force(n, weight, now, x, y, rates, work)
   end subroutine add_inertia

   ! What sponge layers take.
   pure subroutine add_sponges(sponges, n, weight, now, rates, work)
      type(sponge_t), intent(in) :: sponges(:)
      integer, intent(in) :: n
      real(dp), intent(in) :: weight         !! dt b_k
      type(stage_t), intent(in) :: now
      type(rates_t), intent(inout) :: rates
      real(dp), intent(inout) :: work(n/group_slots)
      real(dp) :: rate, x(n), y(n)
      integer :: k

      do k = 1, n
         rate = 0
         if (now%m(k) > 0) rate = sum(sponges%rate_at(now%x(k), now%y(k)))
         x(k) = -rate*now%u(k)
         y(k) = -rate*now%v(k)
      end do
      call add_force(n, weight, now, x, y, rates, work)
   end subroutine add_sponges

   ! -w**2 (r - centre); nothing for dummies, which are far away.
   pure subroutine add_central_force(model, now, n, rates)
      type(model_t), intent(in) :: model
      type(stage_t), intent(in) :: now
      integer, intent(in) :: n
      type(rates_t), intent(inout) :: rates
      integer :: k

      do k = 1, n
         if (.not. now%m(k) > 0) cycle
         rates%u(k) = rates%u(k) - model%central_rate**2*(now%x(k) - model%centre(1))
         rates%v(k) = rates%v(k) - model%central_rate**2*(now%y(k) - model%centre(2))
      end do
   end subroutine add_central_force

   ! The state of the next stage: `base` + time*rates.
   pure subroutine go_on(base, i0, n, time, rho0, now, rates, then)
      type(state_t), intent(in) :: base
      integer, intent(in) :: i0, n
      real(dp), intent(in) :: time   !! dt a_k
      real(dp), intent(in) :: rho0
      type(stage_t), intent(in) :: now
      type(rates_t), intent(in) :: rates
      type(state_t), intent(inout) :: then

      associate (i1 => i0 + 1, i2 => i0 + n)
         call set_sum(n, base%x(i1:i2), time, now%u, then%x(i1:i2))
         call set_sum(n, base%y(i1:i2), time, now%v, then%y(i1:i2))
         call set_sum(n, base%u(i1:i2), time, rates%u, then%u(i1:i2))
         call set_sum(n, base%v(i1:i2), time, rates%v, then%v(i1:i2))
         call set_sum(n, base%s(i1:i2), time, rates%s, then%s(i1:i2))
         call set_volumes(n, rho0, now%m, then%s(i1:i2), then%volume(i1:i2))
      end associate
   end subroutine go_on

   ! The end of the step: base + dt sum_k b_k rates_k, from the stages' states; not the volumes.
   pure subroutine end_step(share, weight, p, i0, n, now, rates)
      real(dp), intent(in) :: share(:)   !! b_k/a_k
      real(dp), intent(in) :: weight     !! dt b_n
      type(particles_t), intent(inout) :: p
      integer, intent(in) :: i0, n
      type(stage_t), intent(in) :: now
      type(rates_t), intent(in) :: rates

      associate (base => p%base, second => p%stage(1), next => p%next, i1 => i0 + 1, i2 => i0 + n)
         call sum_stages(n, share, base%x(i1:i2), second%x(i1:i2), now%x, weight, now%u, next%x(i1:i2))
         call sum_stages(n, share, base%y(i1:i2), second%y(i1:i2), now%y, weight, now%v, next%y(i1:i2))
         call sum_stages(n, share, base%u(i1:i2), second%u(i1:i2), now%u, weight, rates%u, next%u(i1:i2))
         call sum_stages(n, share, base%v(i1:i2), second%v(i1:i2), now%v, weight, rates%v, next%v(i1:i2))
         call sum_stages(n, share, base%s(i1:i2), second%s(i1:i2), now%s, weight, rates%s, next%s(i1:i2))
      end associate
   end subroutine end_step

   ! Of schemes with fewer than four stages, share(2) and (3) are 0.
   pure subroutine sum_stages(n, share, base, second, fourth, weight, rate, next)
      integer, intent(in) :: n
      real(dp), intent(in) :: share(3), base(n), second(n), fourth(n), weight, rate(n)
      real(dp), intent(inout) :: next(n)   !! third stage's; the end of the step
      integer :: k

      !$omp simd
      do k = 1, n
         next(k) = base(k) + share(1)*(second(k) - base(k)) + share(2)*(next(k) - base(k)) + share(3)*(fourth(k) - base(k)) &
                   + weight*rate(k)
      end do
   end subroutine sum_stages

   ! then = base + time*rate
   pure subroutine set_sum(n, base, time, rate, then)
      integer, intent(in) :: n
      real(dp), intent(in) :: base(n), time, rate(n)
      real(dp), intent(out) :: then(n)
      integer :: k

      !$omp simd
      do k = 1, n
         then(k) = base(k) + time*rate(k)
      end do
   end subroutine set_sum

   pure subroutine set_volumes(n, rho0, m, s, volume)
      integer, intent(in) :: n
      real(dp), intent(in) :: rho0, m(n), s(n)
      real(dp), intent(out) :: volume(n)
      integer :: k

      !$omp simd
      do k = 1, n
         volume(k) = m(k)/(rho0 + s(k))
      end do
   end subroutine set_volumes

   !> How far velocities are, and soon will be, from those that the lists were made for.
   pure subroutine watch_changes(model, p, i0, n, ahead, sums)
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p     !! `next` keeps the base state's rates, without forces
      integer, intent(in) :: i0, n           !! slot before the block's first; slots
      real(dp), intent(in) :: ahead          !! time from the base state on
      type(block_t), intent(inout) :: sums
      real(dp) :: u, v, now_2, soon_2, force(2)
      integer :: i

      force = model%acceleration - [0.0_dp, model%gravity]
      now_2 = 0
      soon_2 = 0
      associate (base => p%base, rates => p%next)
         !$omp simd private(u, v) reduction(max:now_2, soon_2)
         do i = i0 + 1, i0 + n
            u = base%u(i) - p%sorted_u(i)
            v = base%v(i) - p%sorted_v(i)
            now_2 = max(now_2, u**2 + v**2)
            u = u + ahead*(rates%u(i) + force(1))
            v = v + ahead*(rates%v(i) + force(2))
            soon_2 = max(soon_2, u**2 + v**2)
         end do
      end associate
      sums%behind = sqrt(now_2)
      sums%ahead = sqrt(soon_2)
   end subroutine watch_changes

   ! max |u - u when sorted|
   pure real(dp) function largest_change(n, now, u, v)
      integer, intent(in) :: n
      type(stage_t), intent(in) :: now
      real(sp), intent(in) :: u(n), v(n)
      real(dp) :: change_2
      integer :: k

      change_2 = 0
      !$omp simd reduction(max:change_2)
      do k = 1, n
         change_2 = max(change_2, (now%u(k) - u(k))**2 + (now%v(k) - v(k))**2)
      end do
      largest_change = sqrt(change_2)
   end function largest_change

   ! Walls, volume, extremes and range checks of a block's new state.
   subroutine finish_block(model, box, p, i0, n, sums)
      type(model_t), intent(in) :: model
      type(box_t), intent(in) :: box   ! at the end of the step
      type(particles_t), intent(inout) :: p
      integer, intent(in) :: i0, n
      type(block_t), intent(inout) :: sums
      integer :: i
      logical :: lost

      call cross_sides(model, box, p, i0, n, sums)
      associate (next => p%next, i1 => i0 + 1, i2 => i0 + n)
         call set_volumes(n, model%rho0, p%m(i1:i2), next%s(i1:i2), next%volume(i1:i2))
         call take_extremes(n, model%c0, model%rho0, p%m(i1:i2), next%x(i1:i2), next%u(i1:i2), next%v(i1:i2), next%s(i1:i2), &
                            sums, lost)
         if (.not. lost) return
         do i = i1, i2
            if (p%id(i) > 0 .and. .not. within_range(model%c0, model%rho0, next%u(i)**2 + next%v(i)**2, next%s(i))) &
               sums%lost_slot = i
         end do
      end associate
   end subroutine finish_block

   ! Extremes, and whether some particle has left the range of what can be computed.
   pure subroutine take_extremes(n, c0, rho0, m, x, u, v, s, sums, lost)
      integer, intent(in) :: n
      real(dp), intent(in) :: c0, rho0, m(n), x(n), u(n), v(n), s(n)
      type(block_t), intent(inout) :: sums
      logical, intent(out) :: lost
      real(dp) :: speed_2, fastest_2, pressure, largest_s, out
      integer :: k

      fastest_2 = 0
      pressure = 0
      largest_s = 0
      out = 0
      !$omp simd private(speed_2) reduction(max:fastest_2, pressure, largest_s, out)
      do k = 1, n
         speed_2 = merge(u(k)**2 + v(k)**2, 0.0_dp, m(k) > 0)
         fastest_2 = max(fastest_2, speed_2)
         pressure = max(pressure, specific_pressure(c0, rho0, s(k)))
         largest_s = max(largest_s, abs(s(k)))
         out = max(out, merge(0.0_dp, 1.0_dp, within_range(c0, rho0, speed_2, s(k))))
      end do
      sums%speed_2 = max(sums%speed_2, fastest_2)
      sums%pressure = max(sums%pressure, pressure)
      sums%largest_s = max(sums%largest_s, largest_s)
      associate (extent => sums%extent)
         call span_of(n, m, x, extent%lower(1), extent%upper(1))
         call span_of(n, m, u, extent%slowest(1), extent%fastest(1))
         call span_of(n, m, v, extent%slowest(2), extent%fastest(2))
      end associate
      lost = out > 0
   end subroutine take_extremes

   ! From which value to which, without dummies.
   pure subroutine span_of(n, m, values, least, most)
      integer, intent(in) :: n
      real(dp), intent(in) :: m(n), values(n)
      real(dp), intent(out) :: least, most
      integer :: k

      least = huge(1.0_dp)
      most = -huge(1.0_dp)
      !$omp simd reduction(min:least) reduction(max:most)
      do k = 1, n
         least = min(least, merge(values(k), huge(1.0_dp), m(k) > 0))
         most = max(most, merge(values(k), -huge(1.0_dp), m(k) > 0))
      end do
   end subroutine span_of

   ! Written so that NaN is out of range too. Collapsing cavities reach half the sound speed and density for a moment.
   elemental logical function within_range(c0, rho0, speed_2, s)
      real(dp), intent(in) :: c0, rho0, speed_2, s

      within_range = speed_2 < (fastest*c0)**2 .and. s > -0.9_dp*rho0 .and. s < 4*rho0
   end function within_range

end module runge_kutta
