!> For how many steps the order of the particles and the lists of their neighbours are kept, and with which margins.
!!
!! Source: ours (docs/architecture.md). While lists are kept, a particle may go straight on with the velocity that it had when it
!! was sorted, and accelerations may lead it `slack` away from there. Both are looked at in every stage; nothing that a step
!! computes depends on how long lists are kept but the order in which its sums are taken.
module search_margins
   use integrators, only: integrator_t
   use kinds, only: dp
   use neighbours, only: neighbours_t
   implicit none
   private

   public :: plan_margins, watch_margins, lists_hold

   integer, parameter :: most_steps = 8           !! that lists are kept for
   real(dp), parameter :: least_slack = 0.02_dp   !! in dx
   real(dp), parameter :: safety = 2.5_dp         !! times the way that the accelerations of the lists before would lead
   ! Sorting and listing take a third of the time of a step's pair loops, and a slack of 0.01 dx makes these 1 % longer (measured).
   ! So n steps from one list cost 1/(3 n) + safety a (n dt)**2/(2 dx) of them each: least for this times (dx/(a dt**2))**(1/3).
   real(dp), parameter :: cheapest = 0.52_dp

contains

   !> Slack for lists that are made now, and the time that they shall last.
   subroutine plan_margins(near, dx, dt, span)
      type(neighbours_t), intent(inout) :: near
      real(dp), intent(in) :: dx           !! particle spacing
      real(dp), intent(in) :: dt           !! expected step
      real(dp), intent(out) :: span
      real(dp) :: steps

      steps = 1
      if (near%acceleration > 0) &
         steps = max(1.0_dp, anint(min(cheapest*(dx/(near%acceleration*dt**2))**(1/3.0_dp), real(most_steps, dp))))
      span = steps*dt
      near%slack = max(least_slack*dx, safety*near%acceleration*span**2/2)
      near%acceleration = 0
   end subroutine plan_margins

   !> Whether the lists still held in a step from the base state; if so, `near` knows where that has led the particles.
   logical function watch_margins(near, integrator, dt, changes, jump) result(held)
      type(neighbours_t), intent(inout) :: near
      type(integrator_t), intent(in) :: integrator
      real(dp), intent(in) :: dt
      real(dp), intent(in) :: changes(:)   !! (stages) max |u - u when sorted|
      real(dp), intent(in) :: jump         !! largest way that a wall has put a particle back
      real(dp) :: farthest
      integer :: n

      n = size(changes)
      farthest = near%stray + dt*maxval(integrator%ahead(:n - 1)*changes(:n - 1))
      held = farthest <= near%slack
      near%acceleration = max(near%acceleration, maxval(changes)/(near%age + dt))
      if (.not. held) then
         near%stray = farthest
         return
      end if
      near%drift = sum(integrator%weight(:n)*changes)
      near%next_stray = near%stray + dt*near%drift + jump
   end function watch_margins

   !> Whether lists can serve for one more step of about the last one's length.
   pure logical function lists_hold(near, dt)
      type(neighbours_t), intent(in) :: near
      real(dp), intent(in) :: dt   !! last step, which led from base to next
      real(dp), parameter :: longer = 1.02_dp

      lists_hold = near%age + (1 + longer)*dt <= near%tau + near%travel .and. .not. near%jumped &
                   .and. near%next_stray + dt*(near%drift + near%acceleration*dt) <= near%slack
   end function lists_hold

end module search_margins
