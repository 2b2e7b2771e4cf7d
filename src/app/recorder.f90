!> Measures and writes what is due: energies, probes, errors, forces and snapshots.
module recorder
   use archive, only: archive_t
   use budget, only: add_rotation, budget_t, start_budget, update_budget, works_of
   use build_info, only: git_id, version
   use cadence, only: cadence_t
   use columns, only: columns_t
   use communication, only: is_first, largest_of_all
   use energy_columns, only: energy_row
   use error_table, only: error_table_t
   use errors, only: failure
   use file_system, only: secure_path
   use gauges, only: gauge_t, measure_gauge, new_gauge
   use gradient_fields, only: gradient_fields_t, gradient_numbers_t, measure_gradients, sum_up
   use box, only: bottom_wall, left_wall, right_wall
   use kinds, only: dp
   use model, only: model_t
   use neighbours, only: neighbours_t
   use number_order, only: find_order, number_order_t
   use particles, only: particles_t
   use probes, only: measure_sensors, new_sensor, sensor_t
   use result_directory, only: energy_name, errors_name, probes_name, result_directory_t, series_name, solids_name, walls_name
   use series, only: series_t
   use settings, only: settings_t
   use snapshot, only: snapshot_field, snapshot_head, snapshot_outline, write_snapshot
   use snapshot_fields, only: fill_fields
   use solid_table, only: solid_table_t
   use solids, only: new_obstacle, obstacle_t
   use step_state, only: step_t
   use table, only: table_t
   use time_scale, only: new_time_scale, time_scale_t
   use wall_table, only: wall_table_t
   implicit none
   private

   public :: recorder_t

   !> Open tables, cadences and what has been measured.
   type :: recorder_t
      type(budget_t) :: budget
      type(series_t) :: series
      type(cadence_t) :: when_energy, when_probes, when_snapshot   !! (not kept: of the scene)
      type(table_t) :: energy_table, probe_table
      type(error_table_t) :: errors
      type(solid_table_t) :: solids
      type(wall_table_t) :: walls
      type(sensor_t), allocatable :: sensors(:)   !! (not kept: of the scene)
      type(gauge_t), allocatable :: gauges(:)     !! (not kept: of the scene)
      type(snapshot_head) :: head                 !! (not kept: of the scene)
      type(time_scale_t) :: scale                 !! (not kept: of the scene)
      real(dp) :: probe_box(2) = 0     !! width of the box and height of the fluid at t = 0, for spectra (not kept: of the scene)
      type(gradient_numbers_t) :: gradients   !! as often as energies, where the scene asks (not kept: measured before each use)
      logical :: forks = .false.       !! it begins its tables anew from what is kept of another run (not kept: of the process)
      integer :: secured = 0           !! snapshots that are on the disk (not kept: of the process)
      real(dp) :: times(2) = 0         !! of the step before and of the last one recorded,
      integer :: step = -1             !! and its number
   contains
      procedure :: start
      procedure :: open => open_tables
      procedure :: begin_anew
      procedure :: record
      procedure :: save_snapshot
      procedure :: secure
      procedure :: finish
      procedure :: archive => archive_recorder
   end type recorder_t

contains

   subroutine archive_recorder(self, file)
      class(recorder_t), intent(inout) :: self
      class(archive_t), intent(inout) :: file

      call self%budget%archive(file)
      call self%series%archive(file)
      call self%errors%archive(file)
      call self%solids%archive(file)
      ! A fork may have this table where the run that it is from has none.
      if (.not. (file%reading .and. self%forks)) call self%walls%archive(file)
      call file%part('energy')
      call self%energy_table%archive(file)
      call file%part('probes')
      call self%probe_table%archive(file)
      call file%part('recorded')
      call file%keep('times', self%times)
      call file%keep('step', self%step)
      if (file%reading) self%secured = self%series%count()
   end subroutine archive_recorder

   !> Forgets which files there were: the run goes on in another directory.
   subroutine begin_anew(self)
      class(recorder_t), intent(inout) :: self

      call self%series%begin_anew()
      call self%errors%begin_anew()
      call self%solids%begin_anew()
      call self%walls%begin_anew()
      call self%energy_table%begin_anew()
      call self%probe_table%begin_anew()
   end subroutine begin_anew

   !> Takes the initial energies, and what else is measured at the start.
   subroutine start(self, scene, input_text, model, p)
      class(recorder_t), intent(inout) :: self
      type(settings_t), intent(in) :: scene
      character(*), intent(in) :: input_text   !! complete input, kept in the snapshots
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p       !! base state at t = 0
      character(:), allocatable :: message
      real(dp) :: top(1)   ! of the fluid
      integer :: k

      ! The cadences' texts were checked with the input.
      call self%when_energy%parse(trim(scene%output%energy), message)
      call self%when_probes%parse(trim(scene%output%probes), message)
      call self%when_snapshot%parse(trim(scene%output%snapshots), message)
      self%scale = new_time_scale(scene)
      call start_budget(self%budget, model, p, scene%domain%upper(1) - scene%domain%lower(1))
      if (self%when_energy%is_never()) self%budget%has%rotation = .false.   ! no integral over time without its values
      self%head = snapshot_head(version=version, git_id=git_id, input_text=input_text, &
                                reference_length=scene%scene%reference_length, spacing=model%dx, sound_speed=model%c0, &
                                density=model%rho0, gravity=model%gravity)
      ! Within the constructor gfortran 12 takes the length before trimming, and what is in memory after the title.
      self%head%title = trim(scene%scene%title)
      if (size(scene%solids) > 0) call self%series%name_solids(scene%solids%name, &
                                                               [(size(model%solids(k)%outline, 2), k=1, size(scene%solids))])
      allocate (self%sensors(size(scene%probes)), self%gauges(size(scene%gauges)))
      do k = 1, size(scene%probes)
         self%sensors(k) = new_sensor(model, scene%probes(k))
      end do
      do k = 1, size(scene%gauges)
         self%gauges(k) = new_gauge(scene%gauges(k), scene%domain%lower, scene%domain%upper)
      end do
      ! For the acoustic modes of the box in spectra; 0 where there are no walls for them.
      if (all(model%box%has_wall([left_wall, right_wall]))) self%probe_box(1) = scene%domain%upper(1) - scene%domain%lower(1)
      top = maxval(p%base%y(:p%n_own), p%id(:p%n_own) > 0)
      call largest_of_all(1, top)
      if (model%box%has_wall(bottom_wall)) self%probe_box(2) = top(1) + model%dx/2 - scene%domain%lower(2)
      call self%errors%start(scene, model, p, self%scale)
      call self%solids%start(scene, self%scale)
      call self%walls%start(scene, model, self%scale)
   end subroutine start

   !> Opens the tables that the scene asks for, or looks whether those that were begun can go on.
   subroutine open_tables(self, scene, model, directory, only_check, problem)
      class(recorder_t), intent(inout) :: self
      type(settings_t), intent(in) :: scene
      type(model_t), intent(in) :: model
      type(result_directory_t), intent(in) :: directory
      logical, intent(in) :: only_check
      type(failure), intent(inout) :: problem   !! exit_files

      if (.not. self%when_energy%is_never()) call open_energies(self, scene, directory, only_check, problem)
      if (size(scene%probes) + size(scene%gauges) > 0 .and. .not. self%when_probes%is_never()) &
         call open_probes(self, scene, directory, only_check, problem)
      call self%errors%open(scene, directory%file(errors_name), only_check, problem)
      call self%solids%open(scene, model, directory%file(solids_name), only_check, problem)
      call self%walls%open(scene, model, directory%file(walls_name), only_check, problem)
   end subroutine open_tables

   subroutine open_energies(self, scene, directory, only_check, problem)
      class(recorder_t), intent(inout) :: self
      type(settings_t), intent(in) :: scene
      type(result_directory_t), intent(in) :: directory
      logical, intent(in) :: only_check
      type(failure), intent(inout) :: problem
      type(columns_t) :: row
      type(step_t) :: at_start
      character(200) :: lines(3)

      row = energy_row(self%budget, self%gradients, at_start, self%scale)
      if (self%energy_table%was_begun()) then
         call self%energy_table%go_on(directory%file(energy_name), size(row%names), only_check, problem)
         return
      end if
      if (only_check) return
      lines(1) = 'title: '//scene%scene%title
      write (lines(2), '(a, es23.16)') 'dE_Mtot: ', self%budget%normaliser
      lines(3) = 'normalised by dE_Mtot = '//self%budget%scale
      call self%energy_table%create(directory%file(energy_name), lines, row%names, row%units, problem)
   end subroutine open_energies

   subroutine open_probes(self, scene, directory, only_check, problem)
      class(recorder_t), intent(inout) :: self
      type(settings_t), intent(in) :: scene
      type(result_directory_t), intent(in) :: directory
      logical, intent(in) :: only_check
      type(failure), intent(inout) :: problem
      character(200) :: head(6 + size(scene%probes) + size(scene%gauges))
      integer :: k, n

      n = size(scene%probes)
      if (self%probe_table%was_begun()) then
         call self%probe_table%go_on(directory%file(probes_name), 2 + n + size(scene%gauges), only_check, problem)
         return
      end if
      if (only_check) return
      head(1) = 'title: '//scene%scene%title
      head(2) = 'sampled every: '//scene%output%probes
      write (head(3), '(a, es23.16)') 'sound_speed: ', self%head%sound_speed
      write (head(4), '(a, es23.16)') 'domain_width: ', self%probe_box(1)
      write (head(5), '(a, es23.16)') 'fluid_height: ', self%probe_box(2)
      head(6) = 'A pressure is the mean over a disc or segment on a wall or solid; what is dry counts as 0.'
      do k = 1, n
         associate (probe => scene%probes(k))
            write (head(k + 6), '(3a, 2(es14.7, 1x), 2(a, es14.7))') 'probe ', trim(probe%name), ' at ', probe%position, &
               'diameter', probe%diameter, ' length', probe%length
         end associate
      end do
      do k = 1, size(scene%gauges)
         associate (gauge => scene%gauges(k))
            write (head(k + n + 6), '(5a, es14.7, 2a)') 'gauge ', trim(gauge%name), ' along ', trim(gauge%along), ' at', gauge%at, &
               ' measures ', gauge%measure
         end associate
      end do
      call self%probe_table%create(directory%file(probes_name), head, &
                                   [character(32) :: 'time', 'time_scaled', scene%probes%name, scene%gauges%name], &
                                   [character(32) :: 'time', self%scale%name, spread('pressure', 1, n), &
                                    spread('length', 1, size(scene%gauges))], problem)
   end subroutine open_probes

   !> Measures and writes what is due at the base state, or everything at the end of the run. The budget is taken
   !! as often as energies are written, and at the end in any case.
   subroutine record(self, scene, model, p, near, run, directory, last, problem)
      class(recorder_t), intent(inout) :: self
      type(settings_t), intent(in) :: scene
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p      !! coefficients of the dynamic model may be set,
      type(neighbours_t), intent(inout) :: near  !! and friction of solids: both are, at each step, before they are used
      type(step_t), intent(in) :: run
      type(result_directory_t), intent(in) :: directory
      logical, intent(in) :: last            !! the run ends here
      type(failure), intent(inout) :: problem
      logical :: again   ! a state that was recorded before it turned out to be the last

      again = run%step == self%step
      if (.not. again) self%times = [self%times(2), run%time]
      self%step = run%step
      if (due(self%when_energy) .or. (last .and. self%when_energy%is_never())) &
         call record_energies(self, model, p, near, run, problem)
      if (self%probe_table%is_open()) then
         if (due(self%when_probes)) call self%probe_table%row(probe_row(self, model, p, near, run%time), problem)
      end if
      if (self%solids%is_open()) then
         if (due(self%solids%when)) call self%solids%record(model, near, p, run, problem)
      end if
      if (self%walls%is_open()) then
         if (due(self%walls%when)) call self%walls%record(model, near, p, run%time, problem)
      end if
      call self%errors%record(model, p, run%step, run%time, self%times(1), last, problem)
      if (due(self%when_snapshot)) call self%save_snapshot(scene, model, p, near, run, directory, problem)

   contains

      logical function due(when)
         type(cadence_t), intent(in) :: when

         due = when%is_due(run%step, run%time, self%times(1))
         if (last) due = .not. (when%is_never() .or. (again .and. due))
      end function due

   end subroutine record

   subroutine record_energies(self, model, p, near, run, problem)
      class(recorder_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      type(neighbours_t), intent(in) :: near
      type(step_t), intent(in) :: run
      type(failure), intent(inout) :: problem
      type(gradient_fields_t) :: fields
      type(columns_t) :: row

      call update_budget(self%budget, model, p, run%time, works_of(model, run))
      if (.not. self%energy_table%is_open()) return
      if (self%budget%has%rotation .or. self%budget%has%eddies) then
         call measure_gradients(model, p, near, fields)
         call sum_up(model, p, fields, self%gradients)
         call add_rotation(self%budget, model, run%time, self%gradients%enstrophy)
      end if
      row = energy_row(self%budget, self%gradients, run, self%scale)
      call self%energy_table%row(row%values, problem)
   end subroutine record_energies

   function probe_row(self, model, p, near, time) result(row)
      class(recorder_t), intent(in) :: self
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      type(neighbours_t), intent(in) :: near
      real(dp), intent(in) :: time
      real(dp) :: row(2 + size(self%sensors) + size(self%gauges))
      integer :: k

      row(1) = time
      row(2) = time/self%scale%unit
      row(3:2 + size(self%sensors)) = measure_sensors(model, p, near, self%sensors)
      do k = 1, size(self%gauges)
         row(k + 2 + size(self%sensors)) = measure_gauge(model, p, near, self%gauges(k))
      end do
   end function probe_row

   !> Writes the base state as the next snapshot, particles in the order of their numbers.
   subroutine save_snapshot(self, scene, model, p, near, run, directory, problem)
      class(recorder_t), intent(inout) :: self
      type(settings_t), intent(in) :: scene
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      type(neighbours_t), intent(in) :: near
      type(step_t), intent(in) :: run
      type(result_directory_t), intent(in) :: directory
      type(failure), intent(inout) :: problem
      type(snapshot_field), allocatable :: fields(:)
      character(:), allocatable :: path
      type(number_order_t) :: order
      integer :: i

      call find_order(p, order)
      call fill_fields(scene%output%fields(:scene%output%n_fields), model, p, near, order, fields)
      self%head%time = run%time
      self%head%step = run%step
      path = directory%snapshot_path(self%series%count())
      call write_snapshot(path, self%head, [(i, i=order%first, order%last)], order%sorted(p%base%x), order%sorted(p%base%y), &
                          fields, scene%output%precision, problem, outlines_of(scene, model, run))
      if (problem%raised()) return
      call self%series%add(directory%file(series_name), run%time, problem)
   end subroutine save_snapshot

   ! Where solids are.
   function outlines_of(scene, model, run) result(outlines)
      type(settings_t), intent(in) :: scene
      type(model_t), intent(in) :: model
      type(step_t), intent(in) :: run
      type(snapshot_outline) :: outlines(size(scene%solids))
      type(obstacle_t) :: obstacle
      integer :: k

      do k = 1, size(outlines)
         obstacle = new_obstacle(model%solids(k), run%poses(k), model%box_at(run%time))
         outlines(k)%name = trim(scene%solids(k)%name)
         outlines(k)%corners = obstacle%outline
      end do
   end function outlines_of

   !> All rows and snapshots so far are on the disk.
   subroutine secure(self, directory, problem)
      class(recorder_t), intent(inout) :: self
      type(result_directory_t), intent(in) :: directory
      type(failure), intent(inout) :: problem   !! exit_files
      character(:), allocatable :: ignored
      integer :: k

      ! One that the user has taken away is no failure.
      do k = self%secured, self%series%count() - 1
         if (is_first()) call secure_path(directory%snapshot_path(k), ignored)
      end do
      self%secured = self%series%count()
      call self%energy_table%secure(problem)
      call self%probe_table%secure(problem)
      call self%errors%secure(problem)
      call self%solids%secure(problem)
      call self%walls%secure(problem)
   end subroutine secure

   !> Closes the tables.
   subroutine finish(self, directory, problem)
      class(recorder_t), intent(inout) :: self
      type(result_directory_t), intent(in) :: directory
      type(failure), intent(inout) :: problem

      call self%series%finish(directory%file(series_name), problem)
      call self%energy_table%close(problem)
      call self%probe_table%close(problem)
      call self%errors%finish(problem)
      call self%solids%finish(problem)
      call self%walls%finish(problem)
   end subroutine finish

end module recorder
