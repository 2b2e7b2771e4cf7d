!> Runge-Kutta for one cluster: from a stage's rates to the next stage's state, or to the end of the step.
!!
!! Source: sec. 2 of the paper; the works are summed with the stage states and the weights of the scheme (docs/equations.md).
module runge_kutta
   use crossing, only: outside, reflect, wrap
   use flow, only: rates_t
   use integrators, only: most_stages
   use kinds, only: dp
   use lanes, only: nl
   use model, only: model_t
   use particles, only: particles_t, state_t
   implicit none
   private

   public :: block_t, update_cluster

   integer, parameter, public :: stage_state(most_stages) = [0, 1, 2, 1]   !! which of p%stage holds a stage's state; 0: base

   real(dp), parameter, public :: fastest = 10   !! in c0; a particle that is faster has left the range

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
      real(dp) :: largest_alpha = 0  !! alpha_i of the dynamic model
      real(dp) :: largest_delta = 0  !! delta_i, or delta, times crowding
      integer :: crossings = 0
      integer :: singular = 0
      integer :: lost_slot = 0
      real(dp) :: stray = 0          !! largest way that accelerations led a particle
   end type block_t

contains

   !> Adds the frozen terms and forces, takes the works, and moves the cluster on.
   subroutine update_cluster(model, p, i0, stage, dt, rates, sums)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      integer, intent(in) :: i0             !! slot before the cluster's first
      integer, intent(in) :: stage          !! of the model's integrator
      real(dp), intent(in) :: dt
      type(rates_t), intent(in) :: rates    !! inviscid, at the stage's state
      type(block_t), intent(inout) :: sums
      type(rates_t) :: full
      type(lanes_t) :: now
      real(dp), dimension(nl) :: pressure
      real(dp) :: weight, ahead

      weight = model%integrator%weight(stage)*dt
      if (stage == 1) then
         now = lanes_of(p%base, i0)
      else
         now = lanes_of(p%stage(stage_state(stage)), i0)
      end if
      full = rates
      ! p V/rho = m p/rho**2 is the derivative of the elastic energy by rho, eq. 11
      pressure = model%c0**2*now%s/(model%rho0 + now%s)*now%w
      associate (m => p%m(i0 + 1:i0 + nl))
         if (p%features%viscosity) call add_viscosity(p, i0, weight, now, full, sums%work(1))
         if (p%features%diffusion) call add_diffusion(p, i0, weight, pressure, full, sums%work(2))
         full%v = full%v - model%gravity
         if (model%central_rate > 0) call add_central_force(model, p, i0, stage, full)
         if (model%has_force()) then
            full%u = full%u + model%acceleration(1)
            full%v = full%v + model%acceleration(2)
            sums%work(4) = sums%work(4) + weight*sum(m*(now%u*model%acceleration(1) + now%v*model%acceleration(2)))
         end if
         sums%work(3) = sums%work(3) + weight*sum(m*(now%u*rates%u + now%v*rates%v) + pressure*rates%s)
      end associate
      call add_to_next(p, i0, stage, weight, now, full)
      if (stage == model%integrator%stages) then
         call finish_cluster(model, p, i0, sums)
      else
         ahead = model%integrator%ahead(stage)*dt
         call form_stage(model, p, i0, stage + 1, ahead, now, full)
         associate (u => p%base%u(i0 + 1:i0 + nl), v => p%base%v(i0 + 1:i0 + nl))
            sums%stray = max(sums%stray, ahead*sqrt(maxval((now%u - u)**2 + (now%v - v)**2)))
         end associate
      end if
   end subroutine update_cluster

   ! The frozen viscous acceleration, and its work.
   pure subroutine add_viscosity(p, i0, weight, now, rates, work)
      type(particles_t), intent(in) :: p
      integer, intent(in) :: i0
      real(dp), intent(in) :: weight        !! dt b_k
      type(lanes_t), intent(in) :: now
      type(rates_t), intent(inout) :: rates
      real(dp), intent(inout) :: work

      associate (x => p%visc_x(i0 + 1:i0 + nl), y => p%visc_y(i0 + 1:i0 + nl))
         rates%u = rates%u + x
         rates%v = rates%v + y
         work = work + weight*sum(p%m(i0 + 1:i0 + nl)*(now%u*x + now%v*y))
      end associate
   end subroutine add_viscosity

   ! The frozen density-diffusion rate, and its work.
   pure subroutine add_diffusion(p, i0, weight, pressure, rates, work)
      type(particles_t), intent(in) :: p
      integer, intent(in) :: i0
      real(dp), intent(in) :: weight        !! dt b_k
      real(dp), intent(in) :: pressure(nl)  !! p V/rho
      type(rates_t), intent(inout) :: rates
      real(dp), intent(inout) :: work

      associate (s => p%diff_s(i0 + 1:i0 + nl))
         rates%s = rates%s + s
         work = work + weight*sum(pressure*s)
      end associate
   end subroutine add_diffusion

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
         out_of_range = .not. (speed_2 < (fastest*model%c0)**2 .and. s > -0.9_dp*model%rho0 .and. s < 4*model%rho0)
         if (any(out_of_range)) sums%lost_slot = i0 + findloc(out_of_range, .true., dim=1)
      end associate
   end subroutine finish_cluster

end module runge_kutta
