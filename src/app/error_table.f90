!> The table of errors against the scene's exact solution, and what it comes to in the end.
module error_table
   use archive, only: archive_t
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

   !> The open table and its rows so far; nothing without an exact solution. Not kept is what `start` finds again.
   type :: error_table_t
      private
      type(solution_errors_t) :: errors        !! (not kept: of the scene)
      type(table_t) :: table
      type(cadence_t) :: when                  !! (not kept: of the scene)
      type(time_scale_t) :: scale              !! (not kept: of the scene)
      type(columns_t) :: heads                 !! names and units (not kept: of the scene)
      type(history_t) :: history               !! with room for more rows
      integer :: rows = 0
      logical :: in_use = .false.              !! (not kept: of the scene)
   contains
      procedure :: start
      procedure :: open => open_table
      procedure :: begin_anew
      procedure :: record
      procedure :: secure
      procedure :: add_to
      procedure :: finish
      procedure :: archive => archive_errors
   end type error_table_t

contains

   subroutine archive_errors(self, file)
      class(error_table_t), intent(inout) :: self
      class(archive_t), intent(inout) :: file
      integer :: k

      if (.not. self%in_use) return
      call file%part('errors')
      call self%table%archive(file)
      call file%keep('rows', self%rows)
      if (file%reading) call make_room(self, self%rows)
      if (self%rows == 0) return
      call file%keep('times', self%history%times(:self%rows))
      do k = 1, size(self%history%names)
         call keep_column(trim(self%history%names(k)), self%history%values(k, :self%rows))
      end do
      if (.not. file%reading) return
      ! A solution that is integrated depends in its last bits on where it made a halt.
      do k = 1, self%rows
         call self%errors%solution%move_to(self%history%times(k))
      end do

   contains

      subroutine keep_column(name, values)
         character(*), intent(in) :: name
         real(dp), intent(inout) :: values(:)   !! (rows)
         real(dp), allocatable :: column(:)

         allocate (column(size(values)))
         column(:) = values
         call file%keep(name, column)
         if (file%reading) values = column
      end subroutine keep_column

   end subroutine archive_errors

   !> Forgets what was kept: the table begins in another directory, and maybe with another solution.
   subroutine begin_anew(self)
      class(error_table_t), intent(inout) :: self

      self%rows = 0
      call self%table%begin_anew()
   end subroutine begin_anew

   !> Takes the first sums if the scene has an exact solution.
   subroutine start(self, scene, model, p, scale)
      class(error_table_t), intent(inout) :: self
      type(settings_t), intent(in) :: scene
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p           !! base state at t = 0
      type(time_scale_t), intent(in) :: scale
      character(:), allocatable :: message

      if (scene%exact%solution == 'none') return
      call self%when%parse(trim(scene%output%errors), message)
      if (self%when%is_never()) return
      self%in_use = .true.
      self%scale = scale
      call start_errors(self%errors, scene, model, p)
      call self%heads%add('time', 'time', 0.0_dp)
      call self%heads%add('time_scaled', scale%name, 0.0_dp)
      call measure_errors(self%errors, model, p, 0.0_dp, self%heads)
      self%history%names = self%heads%names(3:)
      call make_room(self, 64)
   end subroutine start

   !> Opens the table, or looks whether one that was begun can go on.
   subroutine open_table(self, scene, path, only_check, problem)
      class(error_table_t), intent(inout) :: self
      type(settings_t), intent(in) :: scene
      character(*), intent(in) :: path
      logical, intent(in) :: only_check
      type(failure), intent(inout) :: problem      !! exit_files
      character(200) :: lines(4)

      if (.not. self%in_use) return
      if (self%table%was_begun()) then
         call self%table%go_on(path, size(self%heads%names), only_check, problem)
         return
      end if
      if (only_check) return
      lines(1) = 'title: '//scene%scene%title
      lines(2) = 'solution: '//scene%exact%solution
      lines(3) = 'errors of velocity and pressure, weighted by volume and divided by a scale of the solution: docs/scenes.md'
      lines(4) = '_exact: of the continuum; _lattice: with the viscosity or sound speed of particles on a square lattice'
      call self%table%create(path, lines, self%heads%names, self%heads%units, problem)
   end subroutine open_table

   ! For at least so many rows; those there are stay.
   subroutine make_room(self, rows)
      class(error_table_t), intent(inout) :: self
      integer, intent(in) :: rows
      real(dp), allocatable :: times(:), values(:, :)

      associate (history => self%history)
         if (allocated(history%times)) then
            if (size(history%times) >= rows) return
         end if
         allocate (times(rows), values(size(history%names), rows))
         if (allocated(history%times)) then
            times(:size(history%times)) = history%times
            values(:, :size(history%times)) = history%values
         end if
         call move_alloc(times, history%times)
         call move_alloc(values, history%values)
      end associate
   end subroutine make_room

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

      if (.not. self%in_use) return
      if (.not. (last .or. self%when%is_due(step, time, time_before))) return
      if (self%rows > 0) then
         if (time <= self%history%times(self%rows)) return   ! recorded before it turned out to be the last
      end if
      call measure_errors(self%errors, model, p, time, row)
      call self%table%row([time, time/self%scale%unit, row%values], problem)
      if (self%rows == size(self%history%times)) call make_room(self, 2*self%rows)
      self%rows = self%rows + 1
      self%history%times(self%rows) = time
      self%history%values(:, self%rows) = row%values
   end subroutine record

   !> All rows so far are on the disk.
   subroutine secure(self, problem)
      class(error_table_t), intent(inout) :: self
      type(failure), intent(inout) :: problem   !! exit_files

      call self%table%secure(problem)
   end subroutine secure

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
