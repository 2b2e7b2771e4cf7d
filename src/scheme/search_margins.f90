!> For how many steps the order of the particles and the lists of their neighbours are kept, and with which margins.
!!
!! Source: ours (docs/architecture.md). While lists are kept, a particle may go straight on with the velocity that it had when it
!! was sorted, and accelerations may lead it away from there by the slack of its block. Both are looked at in every stage; nothing
!! that a step computes depends on how long lists are kept but the order in which its sums are taken.
module search_margins
   use archive, only: archive_t
   use integrators, only: integrator_t
   use kinds, only: dp
   use neighbours, only: margin_t, neighbours_t
   implicit none
   private

   public :: plan_t, planned, overreach, widen_margins, watch_margins, lists_hold

   integer, parameter :: most_steps = 8           !! that lists are kept for
   real(dp), parameter :: least_slack = 0.02_dp   !! in dx
   real(dp), parameter :: safety = 1.5_dp         !! times the way that the accelerations of the lists before would lead
   real(dp), parameter :: spread = 0.1_dp         !! of the largest acceleration, which may come to every block
   ! Sorting and listing take a third of the time of a step's pair loops, and a slack of 0.01 dx makes these 1 % longer (measured).
   ! So n steps from one list cost 1/(3 n) + safety a (n dt)**2/(2 dx) of them each: least for this times (dx/(a dt**2))**(1/3).
   real(dp), parameter :: cheapest = 0.65_dp

   !> What of the lists before matters for those that are made next; besides it, only the particles do.
   type :: plan_t
      real(dp) :: age = 0            !! [s] time of the base state since the particles were sorted last
      real(dp) :: span = 0           !! [s] time that the lists shall last
      real(dp) :: slack = 0          !! [m] that every block has at least
      real(dp) :: slack_time_2 = 0   !! [s2] slack of a block for its acceleration
   contains
      procedure :: archive => archive_plan
   end type plan_t

contains

   subroutine archive_plan(self, file)
      class(plan_t), intent(inout) :: self
      class(archive_t), intent(inout) :: file

      call file%part('order')
      call file%keep('age', self%age)
      call file%keep('span', self%span)
      call file%keep('slack', self%slack)
      call file%keep('slack_time_2', self%slack_time_2)
   end subroutine archive_plan

   !> Slack for lists that are made now, and the time that they shall last.
   !!
   !! The cost of slack is that of its mean over all blocks, so a few fast ones do not set the time for all.
   type(plan_t) function planned(near, dx, dt) result(plan)
      type(neighbours_t), intent(in) :: near
      real(dp), intent(in) :: dx           !! particle spacing
      real(dp), intent(in) :: dt           !! expected step
      real(dp) :: steps

      steps = 1
      associate (mean => near%mean_acceleration + spread*near%largest_acceleration)
         if (mean > 0) steps = max(1.0_dp, anint(min(cheapest*(dx/(mean*dt**2))**(1/3.0_dp), real(most_steps, dp))))
      end associate
      plan%age = near%age
      plan%span = steps*dt
      plan%slack_time_2 = safety*plan%span**2/2
      plan%slack = max(least_slack*dx, plan%slack_time_2*spread*near%largest_acceleration)
   end function planned

   !> How far the state that a stage leads to is from where the lists were made for, where they do not hold for it; else 0.
   pure real(dp) function overreach(near, time, changes) result(farthest)
      type(neighbours_t), intent(in) :: near
      real(dp), intent(in) :: time         !! from the base state
      real(dp), intent(in) :: changes(:)   !! (blocks) max |u - u when sorted| that leads there
      integer :: b

      farthest = 0
      do b = 1, near%n_blocks
         associate (margin => near%margins(b))
            if (margin%stray + time*changes(b) > margin%slack) farthest = max(farthest, margin%stray + time*changes(b))
         end associate
      end do
   end function overreach

   !> More slack for blocks that go farther in a stage than the lists allow, for lists that are made anew of the base state.
   pure subroutine widen_margins(near, time, changes, base_changes)
      type(neighbours_t), intent(inout) :: near
      real(dp), intent(in) :: time              !! as above
      real(dp), intent(in) :: changes(:)
      real(dp), intent(in) :: base_changes(:)   !! (blocks) max |u - u when sorted| of the base state
      real(dp), parameter :: more = 3           ! the last stage may go twice as far, and the step after this one farther
      integer :: b

      do b = 1, near%n_blocks
         associate (margin => near%margins(b))
            margin%unsure = margin%stray + (abs(near%tau - near%age) + near%travel)*base_changes(b)
            if (margin%stray + time*changes(b) > margin%slack) &
               margin%slack = max(margin%slack, min(more*(margin%stray + time*changes(b)), near%image_slack))
         end associate
      end do
   end subroutine widen_margins

   !> Where a step leads the particles.
   pure subroutine watch_margins(near, integrator, dt, changes, jumps)
      type(neighbours_t), intent(inout) :: near
      type(integrator_t), intent(in) :: integrator
      real(dp), intent(in) :: dt
      real(dp), intent(in) :: changes(:, :)   !! (blocks, stages) max |u - u when sorted|
      real(dp), intent(in) :: jumps(:)        !! (blocks) largest way that a wall has put a particle back
      integer :: b, n

      n = integrator%stages
      do b = 1, near%n_blocks
         associate (margin => near%margins(b), change => changes(b, :n))
            margin%next_acceleration = max(margin%acceleration, maxval(change)/(near%age + dt))
            margin%drift = sum(integrator%weight(:n)*change)
            margin%next_stray = margin%stray + dt*margin%drift + jumps(b)
         end associate
      end do
   end subroutine watch_margins

   !> Whether lists can serve for one more step of about the last one's length.
   pure logical function lists_hold(near, dt)
      type(neighbours_t), intent(in) :: near
      real(dp), intent(in) :: dt   !! last step, which led from base to next
      real(dp), parameter :: longer = 1.02_dp

      lists_hold = .not. near%jumped .and. near%age + (1 + longer)*dt <= near%tau + near%travel
      if (near%n_blocks == 0 .or. .not. lists_hold) return
      associate (margins => near%margins(:near%n_blocks))
         lists_hold = all(margins%next_stray + dt*(margins%drift + margins%next_acceleration*dt) <= margins%slack)
      end associate
   end function lists_hold

end module search_margins
