!> The table of errors against the scene's exact solution, and what it comes to in the end.
module error_table
   use cadence, only: cadence_t
   use columns, only: columns_t
   use errors, only: failure
   use kinds, only: dp
   use model, only: model_t
   use particles, only: particles_t
   use settings, only: settings_t
   use solution_errors, only: measure_errors, results_of, solution_errors_t, start_errors
   use solution_results, only: history_t, result_t
   use summary, only: summary_t
   use table, only: table_t
   use time_scale, only: time_scale_t
   implicit none
   private

   public :: error_table_t

   !> The open table and its rows so far; nothing without an exact solution.
   type :: error_table_t
      private
      type(solution_errors_t) :: errors
      type(table_t) :: table
      type(cadence_t) :: when
      type(time_scale_t) :: scale
      type(history_t) :: history               !! with room for more rows
      integer :: rows = 0
      logical :: in_use = .false.
   contains
      procedure :: start
      procedure :: record
      procedure :: add_to
      procedure :: finish
   end type error_table_t

contains

   !> Opens the table if the scene has an exact solution.
   subroutine start(self, scene, model, p, path, scale, problem)
      class(error_table_t), intent(inout) :: self
      type(settings_t), intent(in) :: scene
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p           !! base state at t = 0
      character(*), intent(in) :: path
      type(time_scale_t), intent(in) :: scale
      type(failure), intent(inout) :: problem      !! exit_files
      character(200) :: lines(4)
      character(:), allocatable :: message
      type(columns_t) :: row

      if (scene%exact%solution == 'none') return
      call self%when%parse(trim(scene%output%errors), message)
      if (self%when%is_never()) return
      self%in_use = .true.
      self%scale = scale
      call start_errors(self%errors, scene, model, p)
      call row%add('time', 'time', 0.0_dp)
      call row%add('time_scaled', scale%name, 0.0_dp)
      call measure_errors(self%errors, model, p, 0.0_dp, row)
      self%history%names = row%names(3:)
      allocate (self%history%times(64), self%history%values(size(self%history%names), 64))
      lines(1) = 'title: '//scene%scene%title
      lines(2) = 'solution: '//scene%exact%solution
      lines(3) = 'errors of velocity and pressure, weighted by volume and divided by a scale of the solution: docs/scenes.md'
      lines(4) = '_exact: of the continuum; _lattice: with the viscosity or sound speed of particles on a square lattice'
      call self%table%create(path, lines, row%names, row%units, problem)
   end subroutine start

   !> Measures and writes a row if it is due.
   subroutine record(self, model, p, step, time, time_before, last, problem)
      class(error_table_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      integer, intent(in) :: step
      real(dp), intent(in) :: time, time_before   !! of this step and the step before
      logical, intent(in) :: last                 !! the run ends here
      type(failure), intent(inout) :: problem     !! exit_files
      type(columns_t) :: row
      real(dp), allocatable :: more(:, :)

      if (.not. self%in_use) return
      if (.not. (last .or. self%when%is_due(step, time, time_before))) return
      if (self%rows > 0) then
         if (time <= self%history%times(self%rows)) return   ! recorded before it turned out to be the last
      end if
      call measure_errors(self%errors, model, p, time, row)
      call self%table%row([time, time/self%scale%unit, row%values], problem)
      associate (history => self%history)
         if (self%rows == size(history%times)) then
            history%times = [history%times, history%times]
            allocate (more(size(row%values), 2*self%rows))
            more(:, :self%rows) = history%values
            call move_alloc(more, history%values)
         end if
         self%rows = self%rows + 1
         history%times(self%rows) = time
         history%values(:, self%rows) = row%values
      end associate
   end subroutine record

   !> Adds the results to the summary; what the run was too short for is 'none'.
   subroutine add_to(self, file)
      class(error_table_t), intent(in) :: self
      type(summary_t), intent(inout) :: file
      type(result_t), allocatable :: results(:)
      integer :: k

      if (.not. self%in_use) return
      associate (h => self%history, n => self%rows)
         results = results_of(self%errors%solution, history_t(h%names, h%times(:n), h%values(:, :n)))
      end associate
      do k = 1, size(results)
         if (results(k)%known) call file%add(trim(results(k)%key), results(k)%value)
         if (.not. results(k)%known) call file%add(trim(results(k)%key), 'none')
      end do
   end subroutine add_to

   !> Closes the table.
   subroutine finish(self, problem)
      class(error_table_t), intent(inout) :: self
      type(failure), intent(inout) :: problem

      call self%table%close(problem)
   end subroutine finish

end module error_table
