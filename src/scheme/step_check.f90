!> Whether a run can go on from the result of a step.
module step_check
   use communication, only: this_process
   use errors, only: exit_numerics, failure, text_of_largest
   use box, only: bottom_wall, left_wall, right_wall, top_wall
   use kinds, only: dp
   use model, only: model_t
   use particles, only: particles_t
   use runge_kutta, only: fastest
   use step_state, only: step_t
   use text, only: short, to_text
   implicit none
   private

   public :: check_step

   real(dp), parameter :: least_step_share = 1.0e-6_dp   !! of the longest step; a run with smaller steps would not end

contains

   !> Looks at the state in `next` before it is taken over. A message says what, which particle, where and when.
   subroutine check_step(model, p, run, end_time, problem)
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      type(step_t), intent(in) :: run
      real(dp), intent(in) :: end_time
      type(failure), intent(inout) :: problem   !! exit_numerics

      character(:), allocatable :: who, words

      associate (n => p%n_own, next => p%next, left => model%box%at(left_wall))
         if (run%scattered) then
            call find_largest(p, abs(next%x(1:n) - left), who)
            call problem%raise(exit_numerics, 'the fluid is more than 4 million strips of width h long after step ' &
                               //moment(run)//': '//who//'; close the open side it left by')
            return
         end if
         if (run%lost_solid > 0) call problem%raise(exit_numerics, '&solid number '//to_text(run%lost_solid)//', a free body, ' &
            //'left its range in step '//moment(run)//': it is faster than '//short(fastest)//' c0; a smaller cfl, or a larger ' &
            //'mass or moment of inertia may help')
         if (run%lost .and. run%lost_solid == 0) then
            ! Slots ascend with x: the last of all is that of the last process that has one.
            words = ''
            if (run%lost_slot > 0) words = loss_text(model, p, run)
            call text_of_largest(merge(real(this_process(), dp), -1.0_dp, run%lost_slot > 0), words)
            call problem%raise(exit_numerics, words)
         end if
         ! Written so that NaN fails too.
         if (run%dt > least_step_share*model%longest_step() .or. .not. run%time < end_time) return
         call find_largest(p, next%u(1:n)**2 + next%v(1:n)**2, who)
         call problem%raise(exit_numerics, 'the time step is only '//short(run%dt)//' long in step '//moment(run) &
                            //'; fastest: '//who//'; a smaller limit of &model may help')
      end associate
   end subroutine check_step

   ! Words on the particle that has most of something.
   subroutine find_largest(p, values, words)
      type(particles_t), intent(in) :: p
      real(dp), intent(in) :: values(:)   !! (n_own)
      character(:), allocatable, intent(out) :: words
      integer :: i

      words = ''
      i = maxloc(values, 1, p%id(1:p%n_own) > 0)
      if (i > 0) words = particle(p, i)
      if (i > 0) call text_of_largest(values(i), words)
      if (i == 0) call text_of_largest(-huge(1.0_dp), words)
   end subroutine find_largest

   function loss_text(model, p, run) result(words)
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      type(step_t), intent(in) :: run
      character(:), allocatable :: words
      character(7) :: what

      associate (i => run%lost_slot, next => p%next)
         what = 'density'
         if (.not. norm2([next%u(i), next%v(i)]) < fastest*model%c0) what = 'speed'
         words = 'the '//trim(what)//' left its range in step '//moment(run)//': '//particle(p, i)//', has speed/c0 ' &
                 //to_text(norm2([next%u(i), next%v(i)])/model%c0)//' and (rho - rho0)/rho0 '//to_text(next%s(i)/model%rho0) &
                 //remedy(model, p%base%x(i), p%base%y(i))
      end associate
   end function loss_text

   ! What may help; nothing that a smaller step could do helps where fluid falls out of the box.
   pure function remedy(model, x, y) result(words)
      type(model_t), intent(in) :: model
      real(dp), intent(in) :: x, y   !! where the particle was
      character(:), allocatable :: words

      words = '; a smaller cfl or a larger sound_speed may help'
      associate (at => model%box%at)
         if (x < at(left_wall) .or. x > at(right_wall) .or. y < at(bottom_wall) .or. y > at(top_wall)) &
            words = ', outside of &domain; close the open side it left by, or end the run before'
      end associate
   end function remedy

   ! 'N at t = T', for messages.
   pure function moment(run) result(words)
      type(step_t), intent(in) :: run
      character(:), allocatable :: words

      words = to_text(run%step)//' at t = '//to_text(run%time)
   end function moment

   ! 'particle N, before the step at (X, Y)'.
   pure function particle(p, i) result(words)
      type(particles_t), intent(in) :: p
      integer, intent(in) :: i   !! slot
      character(:), allocatable :: words

      words = 'particle '//to_text(p%id(i))//', before the step at ('//to_text(p%base%x(i))//', '//to_text(p%base%y(i))//')'
   end function particle

end module step_check
