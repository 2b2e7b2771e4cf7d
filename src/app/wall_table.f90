!> The table of forces on the walls of the box, walls.dat.
module wall_table
   use archive, only: archive_t
   use box, only: is_wall, no_slip_wall
   use columns, only: columns_t
   use errors, only: failure
   use force_table, only: force_table_t
   use kinds, only: dp
   use model, only: model_t, terms_t
   use neighbours, only: neighbours_t
   use particles, only: particles_t
   use settings, only: settings_t, side_names
   use time_scale, only: time_scale_t
   use wall_forces, only: measure_walls, wall_forces_t
   implicit none
   private

   public :: wall_table_t

   !> The open table; nothing where it is not asked for.
   type, extends(force_table_t) :: wall_table_t
      logical, private :: in_use = .false.   !! (not kept: of the scene)
   contains
      procedure :: start
      procedure :: open => open_table
      procedure :: record
      procedure :: archive => archive_walls
   end type wall_table_t

contains

   subroutine archive_walls(self, file)
      class(wall_table_t), intent(inout) :: self
      class(archive_t), intent(inout) :: file

      if (.not. self%in_use) return
      call file%part('walls')
      call self%table%archive(file)
   end subroutine archive_walls

   !> Takes what the scene says.
   subroutine start(self, scene, model, scale)
      class(wall_table_t), intent(inout) :: self
      type(settings_t), intent(in) :: scene
      type(model_t), intent(in) :: model
      type(time_scale_t), intent(in) :: scale

      call self%prepare(scene%output%walls, scale)
      self%in_use = any(is_wall(model%box%kind)) .and. .not. self%when%is_never()
   end subroutine start

   !> Opens the table, or looks whether one that was begun can go on.
   subroutine open_table(self, scene, model, path, only_check, problem)
      class(wall_table_t), intent(inout) :: self
      type(settings_t), intent(in) :: scene
      type(model_t), intent(in) :: model
      character(*), intent(in) :: path
      logical, intent(in) :: only_check
      type(failure), intent(inout) :: problem      !! exit_files
      type(columns_t) :: row
      character(200) :: lines(2)

      if (.not. self%in_use) return
      row = row_of(self, model, 0.0_dp, wall_forces_t())
      lines(1) = 'title: '//scene%scene%title
      lines(2) = 'forces of the fluid on each wall, per unit width: force is of pressure and across it, friction along it'
      call self%open_file(path, lines, row, only_check, problem)
   end subroutine open_table

   !> Measures and writes a row.
   subroutine record(self, model, near, p, time, problem)
      class(wall_table_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      type(neighbours_t), intent(inout) :: near   !! of the base state
      type(particles_t), intent(inout) :: p
      real(dp), intent(in) :: time
      type(failure), intent(inout) :: problem     !! exit_files
      type(wall_forces_t) :: forces
      type(columns_t) :: row

      call measure_walls(model, near, p, forces)
      row = row_of(self, model, time, forces)
      call self%table%row(row%values, problem)
   end subroutine record

   ! Names, units and values.
   pure type(columns_t) function row_of(self, model, time, forces) result(row)
      type(wall_table_t), intent(in) :: self
      type(model_t), intent(in) :: model
      real(dp), intent(in) :: time
      type(wall_forces_t), intent(in) :: forces
      type(terms_t) :: has
      integer :: side

      has = model%terms()
      call row%add('time', 'time', time)
      call row%add('time_scaled', self%scale%name, time/self%scale%unit)
      do side = 1, 4
         if (.not. is_wall(model%box%kind(side))) cycle
         call row%add(trim(side_names(side))//'.force', 'force/width', forces%pressure(side))
         if (model%box%kind(side) == no_slip_wall .and. has%viscosity) &
            call row%add(trim(side_names(side))//'.friction', 'force/width', forces%friction(side))
      end do
   end function row_of

end module wall_table
