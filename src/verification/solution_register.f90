!> The exact solutions that there are. A new one is a module of its own and a line in `go_through`.
module solution_register
   use acoustic_wave, only: acoustic_wave_solution
   use channel_flow, only: couette_solution, poiseuille_solution
   use exact_check, only: check_exact
   use document, only: document_t
   use findings, only: findings_t
   use hydrostatic_tank, only: hydrostatic_solution_t
   use kinds, only: dp
   use known_solutions, only: known_solutions_t
   use model, only: model_t
   use oscillating_drop, only: drop_solution
   use rectangle_impact, only: impact_solution
   use rotating_square, only: rotating_square_solution
   use settings, only: body_settings, choice_length, settings_t
   use sloshing, only: sloshing_solution_t
   use solution, only: solution_t
   use standing_wave, only: standing_wave_solution
   use taylor_green, only: taylor_green_solution
   use water_hammer, only: water_hammer_solution_t
   implicit none
   private

   public :: solutions_t, new_solution

   !> The solutions, as reading a scene asks for them.
   type, extends(known_solutions_t) :: solutions_t
   contains
      procedure :: list
      procedure :: start_speed
      procedure :: check
   end type solutions_t

   !> What going through all of them finds.
   type :: register_t
      character(choice_length) :: wanted = 'none'   !! the solution that is looked for
      class(solution_t), allocatable :: found       !! not yet in a scene
      character(choice_length) :: names(0:32) = 'none'
      logical :: has_amplitude(0:32) = .false., has_waves(0:32) = .false.
      integer :: n = 0                              !! last of the names
   contains
      procedure :: add
   end type register_t

contains

   !> All of them: the name for &exact solution and what makes it.
   subroutine go_through(all)
      type(register_t), intent(inout) :: all

      call all%add('hydrostatic', hydrostatic_solution_t())
      call all%add('standing_wave', standing_wave_solution())
      call all%add('oscillating_drop', drop_solution())
      call all%add('impact', impact_solution())
      call all%add('taylor_green', taylor_green_solution())
      call all%add('acoustic_wave', acoustic_wave_solution())
      call all%add('couette', couette_solution())
      call all%add('poiseuille', poiseuille_solution())
      call all%add('rotating_square', rotating_square_solution())
      call all%add('water_hammer', water_hammer_solution_t())
      call all%add('sloshing', sloshing_solution_t())
   end subroutine go_through

   subroutine add(self, name, solution)
      class(register_t), intent(inout) :: self
      character(*), intent(in) :: name
      class(solution_t), intent(in) :: solution

      self%n = self%n + 1
      self%names(self%n) = name
      self%has_amplitude(self%n) = solution%has_amplitude
      self%has_waves(self%n) = solution%has_waves
      if (name /= self%wanted) return
      allocate (self%found, source=solution)
      self%found%name = name
   end subroutine add

   !> The scene's solution in its place at t = 0; not allocated if it has none.
   subroutine new_solution(scene, model, solution)
      type(settings_t), intent(in) :: scene
      type(model_t), intent(in) :: model
      class(solution_t), allocatable, intent(out) :: solution

      call find(scene%exact%solution, solution)
      if (allocated(solution)) call solution%place(scene, model)
   end subroutine new_solution

   !> The solution of a name, not in a scene yet; not allocated if there is none.
   subroutine find(name, solution)
      character(*), intent(in) :: name
      class(solution_t), allocatable, intent(out) :: solution
      type(register_t) :: all

      all%wanted = name
      call go_through(all)
      if (allocated(all%found)) call move_alloc(all%found, solution)
   end subroutine find

   subroutine list(self, names, has_amplitude, has_waves)
      class(solutions_t), intent(in) :: self
      character(choice_length), allocatable, intent(out) :: names(:)
      logical, allocatable, intent(out) :: has_amplitude(:), has_waves(:)
      type(register_t) :: all

      call go_through(all)
      names = all%names(:all%n)
      has_amplitude = all%has_amplitude(:all%n)
      has_waves = all%has_waves(:all%n)
   end subroutine list

   real(dp) function start_speed(self, scene, body) result(speed)
      class(solutions_t), intent(in) :: self
      type(settings_t), intent(in) :: scene
      type(body_settings), intent(in) :: body
      class(solution_t), allocatable :: solution

      speed = 0
      call find(scene%exact%solution, solution)
      if (allocated(solution)) speed = solution%start_speed(scene, body)
   end function start_speed

   subroutine check(self, document, scene, notes)
      class(solutions_t), intent(in) :: self
      type(document_t), intent(in) :: document
      type(settings_t), intent(in) :: scene
      type(findings_t), intent(inout) :: notes
      class(solution_t), allocatable :: solution

      call find(scene%exact%solution, solution)
      call check_exact(solution, document, scene, notes)
   end subroutine check

end module solution_register
