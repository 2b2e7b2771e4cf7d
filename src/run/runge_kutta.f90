!> Runge-Kutta for one block: from a stage's rates to the next stage's state, or to the end of the step.
!!
!! Source: sec. 2 of the paper; the works are summed with the stage states and the weights of the scheme (docs/equations.md).
module runge_kutta
   use candidates, only: block_slots
   use crossing, only: outside, reflect, wrap
   use flow, only: rates_t
   use integrators, only: most_stages
   use kinds, only: dp, sp
   use model, only: model_t
   use particles, only: particles_t, state_t
   implicit none
   private

   public :: block_t, update_block

   integer, parameter, public :: stage_state(most_stages) = [0, 1, 2, 1]   !! which of p%stage holds a stage's state; 0: base

   real(dp), parameter, public :: fastest = 10   !! in c0; a particle that is faster has left the range

   !> A block's part of a stage's state.
   type :: stage_t
      real(dp), dimension(block_slots) :: x, y, u, v, s, w, m
   end type stage_t

   !> Sums and extremes of a block.
   type :: block_t
      real(dp) :: work(4) = 0        !! alpha, delta, walls, uniform force
      real(dp) :: wall_power = 0     !! of no-slip walls that move
      real(dp) :: speed_2 = 0        !! max |u|**2
      real(dp) :: pressure = 0       !! max p/rho
      real(dp) :: largest_s = 0
      real(dp) :: largest_pi = 0
      real(dp) :: largest_alpha = 0  !! alpha_i of the dynamic model
      real(dp) :: largest_delta = 0  !! delta_i, or delta, times crowding
      integer :: crossings = 0
      integer :: singular = 0
      integer :: lost_slot = 0
      real(dp) :: change(most_stages) = 0   !! of each stage max |u - u when sorted|
      real(dp) :: jump = 0           !! largest way that a wall has put a particle back
      logical :: wrapped = .false.   !! a particle went through a periodic side
   end type block_t

contains

   !> Adds the frozen terms and forces, takes the works, and moves the block on.
   subroutine update_block(model, p, i0, n, stage, dt, rates, sums)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      integer, intent(in) :: i0, n          !! slot before the block's first; slots
      integer, intent(in) :: stage          !! of the model's integrator
      real(dp), intent(in) :: dt
      type(rates_t), intent(inout) :: rates !! inviscid, at the stage's state; on return with all terms
      type(block_t), intent(inout) :: sums
      type(stage_t) :: now
      real(dp) :: weight, ahead

      if (stage == 1) then
         call take_stage(p%base, p%m, i0, n, now)
      else
         call take_stage(p%stage(stage_state(stage)), p%m, i0, n, now)
      end if
      weight = model%integrator%weight(stage)*dt
      sums%change(stage) = largest_change(n, now, p%sorted_u(i0 + 1:i0 + n), p%sorted_v(i0 + 1:i0 + n))
      call add_terms(model, p, i0, n, weight, now, rates, sums%work)
      call add_to_next(p, i0, n, stage, weight, now, rates)
      if (stage == model%integrator%stages) then
         call finish_block(model, p, i0, n, sums)
      else
         ahead = model%integrator%ahead(stage)*dt
         associate (then => p%stage(stage_state(stage + 1)), base => p%base, i1 => i0 + 1, i2 => i0 + n)
            call go_on(base, i0, n, ahead, now, rates, then)
            call set_volumes(n, model%rho0, now%m, then%s(i1:i2), then%w(i1:i2))
         end associate
      end if
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
         now%w(k) = state%w(i0 + k)
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
      real(dp), intent(inout) :: work(4)
      real(dp) :: pressure(block_slots)     ! p V/rho = m p/rho**2: the derivative of the elastic energy by rho, eq. 11

      call take_pressure(n, model%c0, model%rho0, now, pressure)
      work(3) = work(3) + weight*(force_power(n, now, rates%u, rates%v) + density_power(n, pressure, rates%s))
      if (p%features%viscosity) then
         associate (x => p%visc_x(i0 + 1:i0 + n), y => p%visc_y(i0 + 1:i0 + n))
            work(1) = work(1) + weight*force_power(n, now, x, y)
            call add(n, 1.0_dp, x, rates%u)
            call add(n, 1.0_dp, y, rates%v)
         end associate
      end if
      if (p%features%diffusion) then
         associate (s => p%diff_s(i0 + 1:i0 + n))
            work(2) = work(2) + weight*density_power(n, pressure, s)
            call add(n, 1.0_dp, s, rates%s)
         end associate
      end if
      rates%v(:n) = rates%v(:n) - model%gravity
      if (model%has_force()) then
         associate (a => spread(model%acceleration, 2, n))
            work(4) = work(4) + weight*force_power(n, now, a(1, :), a(2, :))
            call add(n, 1.0_dp, a(1, :), rates%u)
            call add(n, 1.0_dp, a(2, :), rates%v)
         end associate
      end if
      if (model%central_rate > 0) call add_central_force(model, now, n, rates)
   end subroutine add_terms

   pure subroutine take_pressure(n, c0, rho0, now, pressure)
      integer, intent(in) :: n
      real(dp), intent(in) :: c0, rho0
      type(stage_t), intent(in) :: now
      real(dp), intent(out) :: pressure(n)
      integer :: k

      !$omp simd
      do k = 1, n
         pressure(k) = c0**2*now%s(k)/(rho0 + now%s(k))*now%w(k)
      end do
   end subroutine take_pressure

   ! sum m u.a
   pure real(dp) function force_power(n, now, x, y) result(power)
      integer, intent(in) :: n
      type(stage_t), intent(in) :: now
      real(dp), intent(in) :: x(n), y(n)   !! acceleration
      integer :: k

      power = 0
      !$omp simd reduction(+:power)
      do k = 1, n
         power = power + now%m(k)*(now%u(k)*x(k) + now%v(k)*y(k))
      end do
   end function force_power

   ! sum (m p/rho**2) drho/dt
   pure real(dp) function density_power(n, pressure, s) result(power)
      integer, intent(in) :: n
      real(dp), intent(in) :: pressure(n), s(n)   !! m p/rho**2; rate of rho
      integer :: k

      power = 0
      !$omp simd reduction(+:power)
      do k = 1, n
         power = power + pressure(k)*s(k)
      end do
   end function density_power

   pure subroutine add(n, factor, term, total)
      integer, intent(in) :: n
      real(dp), intent(in) :: factor, term(n)
      real(dp), intent(inout) :: total(n)
      integer :: k

      !$omp simd
      do k = 1, n
         total(k) = total(k) + factor*term(k)
      end do
   end subroutine add

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

   ! Sums up the end of the step: base + dt sum_k b_k rates_k.
   pure subroutine add_to_next(p, i0, n, stage, weight, now, rates)
      type(particles_t), intent(inout) :: p
      integer, intent(in) :: i0, n, stage
      real(dp), intent(in) :: weight   !! dt b_k
      type(stage_t), intent(in) :: now
      type(rates_t), intent(in) :: rates

      if (stage == 1) then
         call go_on(p%base, i0, n, weight, now, rates, p%next)
      else
         associate (next => p%next, i1 => i0 + 1, i2 => i0 + n)
            call add(n, weight, now%u, next%x(i1:i2))
            call add(n, weight, now%v, next%y(i1:i2))
            call add(n, weight, rates%u, next%u(i1:i2))
            call add(n, weight, rates%v, next%v(i1:i2))
            call add(n, weight, rates%s, next%s(i1:i2))
         end associate
      end if
   end subroutine add_to_next

   ! `to` = `from` + time*rates; not the volumes.
   pure subroutine go_on(from, i0, n, time, now, rates, to)
      type(state_t), intent(in) :: from
      integer, intent(in) :: i0, n
      real(dp), intent(in) :: time
      type(stage_t), intent(in) :: now
      type(rates_t), intent(in) :: rates
      type(state_t), intent(inout) :: to

      associate (i1 => i0 + 1, i2 => i0 + n)
         call set_sum(n, from%x(i1:i2), time, now%u, to%x(i1:i2))
         call set_sum(n, from%y(i1:i2), time, now%v, to%y(i1:i2))
         call set_sum(n, from%u(i1:i2), time, rates%u, to%u(i1:i2))
         call set_sum(n, from%v(i1:i2), time, rates%v, to%v(i1:i2))
         call set_sum(n, from%s(i1:i2), time, rates%s, to%s(i1:i2))
      end associate
   end subroutine go_on

   ! to = from + factor*rate
   pure subroutine set_sum(n, from, factor, rate, to)
      integer, intent(in) :: n
      real(dp), intent(in) :: from(n), factor, rate(n)
      real(dp), intent(out) :: to(n)
      integer :: k

      !$omp simd
      do k = 1, n
         to(k) = from(k) + factor*rate(k)
      end do
   end subroutine set_sum

   pure subroutine set_volumes(n, rho0, m, s, w)
      integer, intent(in) :: n
      real(dp), intent(in) :: rho0, m(n), s(n)
      real(dp), intent(out) :: w(n)
      integer :: k

      !$omp simd
      do k = 1, n
         w(k) = m(k)/(rho0 + s(k))
      end do
   end subroutine set_volumes

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
   subroutine finish_block(model, p, i0, n, sums)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      integer, intent(in) :: i0, n
      type(block_t), intent(inout) :: sums
      integer :: i
      logical :: lost

      call cross_sides(model, p, i0, n, sums)
      associate (next => p%next, i1 => i0 + 1, i2 => i0 + n)
         call set_volumes(n, model%rho0, p%m(i1:i2), next%s(i1:i2), next%w(i1:i2))
         call take_extremes(n, model%c0, model%rho0, p%m(i1:i2), next%u(i1:i2), next%v(i1:i2), next%s(i1:i2), sums, lost)
         if (.not. lost) return
         do i = i1, i2
            if (p%id(i) > 0 .and. .not. within_range(model%c0, model%rho0, next%u(i)**2 + next%v(i)**2, next%s(i))) &
               sums%lost_slot = i
         end do
      end associate
   end subroutine finish_block

   ! Extremes, and whether some particle has left the range of what can be computed.
   pure subroutine take_extremes(n, c0, rho0, m, u, v, s, sums, lost)
      integer, intent(in) :: n
      real(dp), intent(in) :: c0, rho0, m(n), u(n), v(n), s(n)
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
         pressure = max(pressure, c0**2*s(k)/(rho0 + s(k)))
         largest_s = max(largest_s, abs(s(k)))
         out = max(out, merge(0.0_dp, 1.0_dp, within_range(c0, rho0, speed_2, s(k))))
      end do
      sums%speed_2 = max(sums%speed_2, fastest_2)
      sums%pressure = max(sums%pressure, pressure)
      sums%largest_s = max(sums%largest_s, largest_s)
      lost = out > 0
   end subroutine take_extremes

   ! Written so that NaN is out of range too. Collapsing cavities reach half the sound speed and density for a moment.
   elemental logical function within_range(c0, rho0, speed_2, s)
      real(dp), intent(in) :: c0, rho0, speed_2, s

      within_range = speed_2 < (fastest*c0)**2 .and. s > -0.9_dp*rho0 .and. s < 4*rho0
   end function within_range

   ! Puts back what left the box.
   pure subroutine cross_sides(model, p, i0, n, sums)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      integer, intent(in) :: i0, n
      type(block_t), intent(inout) :: sums
      real(dp) :: x, y
      logical :: crossed
      integer :: i

      do i = i0 + 1, i0 + n
         if (.not. outside(model%walls, p%next%x(i), p%next%y(i))) cycle
         if (p%id(i) == 0) cycle
         x = p%next%x(i)
         y = p%next%y(i)
         call reflect(model%walls, model%gravity, p%next%x(i), p%next%y(i), p%next%u(i), p%next%v(i), crossed)
         if (crossed) then
            sums%crossings = sums%crossings + 1
            sums%jump = max(sums%jump, hypot(p%next%x(i) - x, p%next%y(i) - y))
         end if
         if (any(model%walls%periodic)) then
            call wrap(model%walls, p%next%x(i), p%next%y(i))
            sums%wrapped = .true.
         end if
      end do
   end subroutine cross_sides

end module runge_kutta
