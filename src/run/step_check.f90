!> Whether a run can go on from the result of a step.
module step_check
   use errors, only: exit_numerics, failure
   use kinds, only: dp
   use model, only: model_t
   use particles, only: particles_t
   use text, only: short, to_text
   use time_step, only: step_t
   implicit none
   private

   public :: check_step

   real(dp), parameter :: least_step_share = 1.0e-6_dp   !! of the longest step; a run with smaller steps would not end

contains

   !> Looks at the state in `next` before it is taken over.
   subroutine check_step(model, p, run, end_time, problem)
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      type(step_t), intent(in) :: run
      real(dp), intent(in) :: end_time
      type(failure), intent(inout) :: problem   !! exit_numerics

      if (run%scattered) then
         call problem%raise(exit_numerics, 'a particle is further than 4 million strips from its tank after step ' &
                            //to_text(run%step)//': close the open side it left by')
         return
      end if
      if (run%lost_slot > 0) call explain_loss(model, p, run, problem)
      if (run%dt < least_step_share*model%longest_step() .and. run%time < end_time) &
         call problem%raise(exit_numerics, 'step '//to_text(run%step)//' at t = '//short(run%time)//' is only '//short(run%dt) &
                            //' long: two particles close on each other too fast; a smaller cfl may help')
   end subroutine check_step

   subroutine explain_loss(model, p, run, problem)
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      type(step_t), intent(in) :: run
      type(failure), intent(inout) :: problem

      associate (i => run%lost_slot)
         call problem%raise(exit_numerics, &
            'the solution left its range in step '//to_text(run%step)//' at t = '//to_text(run%time)//': particle ' &
            //to_text(p%id(i))//', before the step at ('//to_text(p%base%x(i))//', '//to_text(p%base%y(i))//'), has speed/c0 ' &
            //to_text(norm2([p%next%u(i), p%next%v(i)])/model%c0)//' and (rho - rho0)/rho0 '//to_text(p%next%s(i)/model%rho0) &
            //'; a smaller cfl or a larger sound_speed may help')
      end associate
   end subroutine explain_loss

end module step_check
