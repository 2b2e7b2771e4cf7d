!> A watch on the energy balance: a flow that makes energy out of nothing, or loses it, is no flow any more.
module balance_watch
   use budget, only: imbalance, works_of
   use errors, only: exit_numerics, failure, text_of_largest
   use kinds, only: dp
   use model, only: model_t
   use run_state, only: run_state_t
   use text, only: short, to_text
   implicit none
   private

   public :: watch_balance

   !> Steps between two looks: one costs as much as a fiftieth of a step.
   integer, parameter, public :: balance_interval = 10

contains

   !> Raises exit_numerics if the balance of the base state is beyond the limit.
   !!
   !! In runs that go well it misses up to 0.02, in the impact of rectangles, which is over in few steps, 2.5/(d/dx); so 0.5, the
   !! default, is passed only by what goes wrong (docs/reliability.md).
   subroutine watch_balance(limit, model, state, problem)
      real(dp), intent(in) :: limit             !! share; 0: none
      type(model_t), intent(in) :: model
      type(run_state_t), intent(in) :: state    !! base state
      type(failure), intent(inout) :: problem
      real(dp) :: share
      character(:), allocatable :: fastest, densest
      integer :: i

      if (.not. limit > 0 .or. mod(state%step%step, balance_interval) /= 0) return
      associate (step => state%step, p => state%p)
         share = imbalance(state%recorder%budget, model, p, works_of(model, step))
         if (share <= limit) return   ! NaN is beyond it
         associate (own => p%id(:p%n_own) > 0, base => p%base)
            fastest = ''
            i = maxloc(base%u(:p%n_own)**2 + base%v(:p%n_own)**2, 1, own)
            if (i > 0) fastest = 'particle '//to_text(p%id(i))//' at ('//to_text(base%x(i))//', '//to_text(base%y(i)) &
                                 //') with speed/c0 '//short(norm2([base%u(i), base%v(i)])/model%c0)
            call text_of_largest(largest_of(base%u(:p%n_own)**2 + base%v(:p%n_own)**2, i), fastest)
            densest = ''
            i = maxloc(abs(base%s(:p%n_own)), 1, own)
            if (i > 0) densest = 'particle '//to_text(p%id(i))//' at ('//to_text(base%x(i))//', '//to_text(base%y(i)) &
                                 //') with (rho - rho0)/rho0 '//short(base%s(i)/model%rho0)
            call text_of_largest(largest_of(abs(base%s(:p%n_own)), i), densest)
            call problem%raise(exit_numerics, 'the energy balance misses '//short(share)//' of the energy after step ' &
               //to_text(step%step)//' at t = '//to_text(step%time)//', more than &time balance_limit = '//short(limit) &
               //'; fastest: '//fastest//', densest or thinnest: '//densest &
               //'; a smaller cfl, more viscosity or a larger sound_speed may help')
         end associate
      end associate
   end subroutine watch_balance

   ! The value in a slot; less than any other where there is none.
   pure real(dp) function largest_of(values, slot) result(value)
      real(dp), intent(in) :: values(:)
      integer, intent(in) :: slot

      value = -huge(1.0_dp)
      if (slot > 0) value = values(slot)
   end function largest_of

end module balance_watch
