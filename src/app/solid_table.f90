!> The table of forces on solids, solids.dat.
module solid_table
   use archive, only: archive_t
   use columns, only: columns_t
   use errors, only: failure
   use force_table, only: force_table_t
   use kinds, only: dp
   use model, only: model_t, terms_t
   use motions, only: pose_t
   use neighbours, only: neighbours_t
   use particles, only: particles_t
   use settings, only: name_length, settings_t, solid_settings
   use solid_forces, only: measure_solids, solid_force_t
   use step_state, only: n_of_solid, step_t
   use time_scale, only: time_scale_t
   implicit none
   private

   public :: solid_table_t, solid_columns

   real(dp), parameter :: degree = acos(-1.0_dp)/180

   !> The open table and what its last row was of; nothing without solids.
   type, extends(force_table_t) :: solid_table_t
      character(name_length), allocatable, private :: names(:) !! (solids) (not kept: of the scene)
      real(dp), private :: time = -1                           !! [s] of the last row; before the first: < 0
      real(dp), allocatable, private :: impulses(:)            !! (3 solids) [N s/m] then, of particles that were put back; [N s]
   contains
      procedure :: start
      procedure :: open => open_table
      procedure :: record
      procedure :: archive => archive_solids
   end type solid_table_t

contains

   subroutine archive_solids(self, file)
      class(solid_table_t), intent(inout) :: self
      class(archive_t), intent(inout) :: file

      if (.not. allocated(self%impulses)) return
      call file%part('solids')
      call self%table%archive(file)
      call file%keep('time', self%time)
      call file%keep('impulses', self%impulses)
   end subroutine archive_solids

   !> Takes what the scene says.
   subroutine start(self, scene, scale)
      class(solid_table_t), intent(inout) :: self
      type(settings_t), intent(in) :: scene
      type(time_scale_t), intent(in) :: scale

      call self%prepare(scene%output%solids, scale)
      if (size(scene%solids) == 0) return
      allocate (self%names(size(scene%solids)))
      self%names(:) = scene%solids%name
      allocate (self%impulses(3*size(scene%solids)), source=0.0_dp)
   end subroutine start

   !> Opens the table, or looks whether one that was begun can go on.
   subroutine open_table(self, scene, model, path, only_check, problem)
      class(solid_table_t), intent(inout) :: self
      type(settings_t), intent(in) :: scene
      type(model_t), intent(in) :: model
      character(*), intent(in) :: path
      logical, intent(in) :: only_check
      type(failure), intent(inout) :: problem      !! exit_files
      type(solid_force_t) :: forces(size(scene%solids))
      type(step_t) :: run
      type(columns_t) :: row
      character(200) :: lines(3)

      if (size(scene%solids) == 0 .or. self%when%is_never()) return
      allocate (run%solids(n_of_solid, size(scene%solids)), source=0.0_dp)
      row = row_of(self, model, run, forces)
      lines(1) = 'title: '//scene%scene%title
      lines(2) = 'forces of the fluid on each solid, per unit width; moments about its pivot, counter-clockwise'
      lines(3) = 'penetration: of particles that were put back, mean since the row before'
      call self%open_file(path, lines, row, only_check, problem)
   end subroutine open_table

   !> Measures and writes a row.
   subroutine record(self, model, near, p, run, problem)
      class(solid_table_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      type(neighbours_t), intent(inout) :: near   !! of the base state
      type(particles_t), intent(inout) :: p
      type(step_t), intent(in) :: run
      type(failure), intent(inout) :: problem     !! exit_files
      type(solid_force_t) :: forces(size(model%solids))
      type(columns_t) :: row

      call measure_solids(model, model%box%after(run%time), near, p, forces)
      row = row_of(self, model, run, forces)
      call self%table%row(row%values, problem)
      self%time = run%time
      self%impulses(:) = reshape(run%solids(3:5, :), shape(self%impulses))
   end subroutine record

   ! Names, units and values.
   pure type(columns_t) function row_of(self, model, run, forces) result(row)
      type(solid_table_t), intent(in) :: self
      type(model_t), intent(in) :: model
      type(step_t), intent(in) :: run
      type(solid_force_t), intent(in) :: forces(:)
      type(pose_t) :: poses(size(forces))
      type(terms_t) :: has
      real(dp) :: pushed(3)
      integer :: k

      has = model%terms()
      poses = model%poses_at(run%time, run%poses)
      call row%add('time', 'time', run%time)
      call row%add('time_scaled', self%scale%name, run%time/self%scale%unit)
      do k = 1, size(forces)
         pushed = 0
         if (.not. self%time < 0 .and. run%time > self%time) &
            pushed = (run%solids(3:5, k) - self%impulses(3*k - 2:3*k))/(run%time - self%time)
         associate (solid => model%solids(k))
            if (solid%motion%moves()) call add_pose(trim(self%names(k)), poses(k), solid%pivot, row)
            call add_forces(trim(self%names(k)), forces(k), pushed, has%viscosity, row)
            if (solid%motion%moves()) then
               call row%add(trim(self%names(k))//'.power', 'power/width', forces(k)%power)
               call row%add(trim(self%names(k))//'.work', 'energy/width', run%solids(1, k) + run%solids(6, k))
            end if
            if (solid%body%is_free()) call row%add(trim(self%names(k))//'.energy', 'energy/width', &
                                                   solid%body%energy(poses(k), solid%pivot, model%gravity))
         end associate
      end do
   end function row_of

   pure subroutine add_pose(name, pose, pivot, row)
      character(*), intent(in) :: name
      type(pose_t), intent(in) :: pose
      real(dp), intent(in) :: pivot(2)   ! as drawn
      type(columns_t), intent(inout) :: row

      call row%add(name//'.x', 'length', pivot(1) + pose%shift(1))
      call row%add(name//'.y', 'length', pivot(2) + pose%shift(2))
      call row%add(name//'.angle', 'degrees', pose%angle/degree)
      call row%add(name//'.velocity_x', 'length/time', pose%velocity(1))
      call row%add(name//'.velocity_y', 'length/time', pose%velocity(2))
      call row%add(name//'.spin', 'degrees/time', pose%spin/degree)
   end subroutine add_pose

   pure subroutine add_forces(name, force, pushed, rubs, row)
      character(*), intent(in) :: name
      type(solid_force_t), intent(in) :: force
      real(dp), intent(in) :: pushed(3)   ! mean force and moment of particles that were put back
      logical, intent(in) :: rubs         ! there is friction
      type(columns_t), intent(inout) :: row
      character(*), parameter :: unit = 'force/width'
      real(dp) :: total(2)

      total = force%pressure + force%friction + pushed(1:2)
      call row%add(name//'.force_x', unit, total(1))
      call row%add(name//'.force_y', unit, total(2))
      call row%add(name//'.pressure_x', unit, force%pressure(1))
      call row%add(name//'.pressure_y', unit, force%pressure(2))
      if (rubs) then
         call row%add(name//'.friction_x', unit, force%friction(1))
         call row%add(name//'.friction_y', unit, force%friction(2))
      end if
      call row%add(name//'.penetration_x', unit, pushed(1))
      call row%add(name//'.penetration_y', unit, pushed(2))
      call row%add(name//'.moment', 'moment/width', force%moment + pushed(3))
   end subroutine add_forces

   !> How many columns the table has, about.
   pure integer function solid_columns(solids) result(n)
      type(solid_settings), intent(in) :: solids(:)

      n = 2 + 9*size(solids) + 8*count(solids%motion /= 'none')
   end function solid_columns

end module solid_table
