!> The table of forces on the walls of the box, walls.dat.
module wall_table
   use archive, only: archive_t
   use box, only: is_wall, no_slip_wall
   use cadence, only: cadence_t
   use columns, only: columns_t
   use errors, only: failure
   use kinds, only: dp
   use model, only: model_t, terms_t
   use neighbours, only: neighbours_t
   use particles, only: particles_t
   use settings, only: settings_t, side_names
   use table, only: table_t
   use time_scale, only: time_scale_t
   use wall_forces, only: measure_walls, wall_forces_t
   implicit none
   private

   public :: wall_table_t

   !> The open table; nothing where it is not asked for.
   type :: wall_table_t
      type(cadence_t) :: when                !! (not kept: of the scene)
      type(table_t), private :: table
      type(time_scale_t), private :: scale   !! (not kept: of the scene)
      logical, private :: in_use = .false.   !! (not kept: of the scene)
   contains
      procedure :: start
      procedure :: open => open_table
      procedure :: is_open
      procedure :: begin_anew
      procedure :: record
      procedure :: secure
      procedure :: finish
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

   !> Forgets which file there was.
   subroutine begin_anew(self)
      class(wall_table_t), intent(inout) :: self

      call self%table%begin_anew()
   end subroutine begin_anew

   !> Takes what the scene says.
   subroutine start(self, scene, model, scale)
      class(wall_table_t), intent(inout) :: self
      type(settings_t), intent(in) :: scene
      type(model_t), intent(in) :: model
      type(time_scale_t), intent(in) :: scale
      character(:), allocatable :: message

      call self%when%parse(trim(scene%output%walls), message)
      self%scale = scale
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
      if (self%table%was_begun()) then
         call self%table%go_on(path, size(row%names), only_check, problem)
         return
      end if
      if (only_check) return
      lines(1) = 'title: '//scene%scene%title
      lines(2) = 'forces of the fluid on each wall, per unit width: force is of pressure and across it, friction along it'
      call self%table%create(path, lines, row%names, row%units, problem)
   end subroutine open_table

   pure logical function is_open(self)
      class(wall_table_t), intent(in) :: self

      is_open = self%table%is_open()
   end function is_open

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

   !> All rows so far are on the disk.
   subroutine secure(self, problem)
      class(wall_table_t), intent(inout) :: self
      type(failure), intent(inout) :: problem   !! exit_files

      call self%table%secure(problem)
   end subroutine secure

   !> Closes the table.
   subroutine finish(self, problem)
      class(wall_table_t), intent(inout) :: self
      type(failure), intent(inout) :: problem

      call self%table%close(problem)
   end subroutine finish

end module wall_table
