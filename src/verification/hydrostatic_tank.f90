!> Weakly-compressible water at rest in a tank: p = rho0 c0**2 (exp(g depth/c0**2) - 1) (module hydrostatics), no motion.
!!
!! The floor is the lower side of the box, the surface the upper edge of the first body.
module hydrostatic_tank
   use columns, only: columns_t
   use hydrostatics, only: hydrostatic_pressure
   use kinds, only: dp
   use model, only: model_t
   use scene_needs, only: need_rest, need_water_on_floor, needs_t
   use settings, only: choice_length, settings_t, side_names
   use solution, only: n_sums, solution_t
   use solution_results, only: history_t, known, result_t
   implicit none
   private

   public :: hydrostatic_solution_t

   type, extends(solution_t) :: hydrostatic_solution_t
   contains
      procedure :: add_needs
      procedure :: set_up
      procedure :: pressure
      procedure :: add_columns
      procedure :: results
   end type hydrostatic_solution_t

contains

   subroutine add_needs(self, scene, needs)
      class(hydrostatic_solution_t), intent(in) :: self
      type(settings_t), intent(in) :: scene
      type(needs_t), intent(inout) :: needs
      character(choice_length) :: kinds_there(4)
      integer :: i

      call needs%unless(scene%fluid%gravity > 0.0_dp, 'gravity above 0', 'fluid', 'gravity')
      kinds_there = scene%side_kinds()
      do i = 1, 3
         call needs%unless(kinds_there(i) /= 'open', 'a wall at the '//trim(side_names(i)), 'domain', trim(side_names(i)))
      end do
      call need_rest(scene, needs)
      call need_water_on_floor(scene, needs)
   end subroutine add_needs

   subroutine set_up(self, scene, model)
      class(hydrostatic_solution_t), intent(inout) :: self
      type(settings_t), intent(in) :: scene
      type(model_t), intent(in) :: model

      self%extent(2) = scene%bodies(1)%upper(2) - self%origin(2)
      self%pressure_scale = self%rho0*self%gravity*self%extent(2)
      self%speed_scale = sqrt(self%gravity*self%extent(2))
   end subroutine set_up

   pure real(dp) function pressure(self, position) result(p)
      class(hydrostatic_solution_t), intent(in) :: self
      real(dp), intent(in) :: position(2)

      p = hydrostatic_pressure(self%extent(2) - (position(2) - self%origin(2)), self%rho0, self%c0, self%gravity)
   end function pressure

   subroutine add_columns(self, now, first, fastest, row)
      class(hydrostatic_solution_t), intent(in) :: self
      real(dp), intent(in) :: now(n_sums), first(n_sums), fastest
      type(columns_t), intent(inout) :: row

      call row%add('max_speed', 'share of sqrt(g H)', fastest/self%speed_scale)
   end subroutine add_columns

   function results(self, history)
      class(hydrostatic_solution_t), intent(in) :: self
      type(history_t), intent(in) :: history
      type(result_t), allocatable :: results(:)

      results = [known('hydrostatic_max_speed', maxval(history%column('max_speed')))]
   end function results

end module hydrostatic_tank
