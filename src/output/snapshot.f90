!> Particles at one time, in HDF5 after VTK's own layout (VTKHDF 1.0): ParaView 5.10
!! and later open it without a plug-in, h5py users find named arrays with units.
module snapshot
   use, intrinsic :: iso_fortran_env, only: int8
   use communication, only: is_first, largest_of_all, n_processes, this_process
   use errors, only: failure
   use hdf5_writer, only: hdf5_writer_t
   use kinds, only: dp, i8, sp
   use row_parts, only: rows_before
   implicit none
   private

   public :: snapshot_field, snapshot_head, snapshot_outline, write_snapshot

   character(*), parameter :: grid = '/VTKHDF'
   character(*), parameter :: points = grid//'/PointData/'
   character(*), parameter, public :: outlines_group = '/outlines'   !! a group in it for each solid, by its name
   integer(int8), parameter :: vtk_vertex = 1_int8   !! VTK's number of the cell that is one point

   !> One quantity on all particles: a scalar or a plane vector.
   type :: snapshot_field
      character(:), allocatable :: name        !! of the array, e.g. 'velocity'
      character(:), allocatable :: unit        !! e.g. 'length/time'
      character(:), allocatable :: long_name   !! e.g. 'velocity of the particle'
      real(dp), allocatable :: values(:)       !! (n), or
      real(dp), allocatable :: vectors(:, :)   !! (n, 2)
   end type snapshot_field

   !> A solid at the snapshot's time; all processes have it.
   type :: snapshot_outline
      character(:), allocatable :: name         !! letters, digits, _ and -
      real(dp), allocatable :: corners(:, :)    !! (2, n) of a polygon [length]
   end type snapshot_outline

   !> What a snapshot says about the run it comes from.
   type :: snapshot_head
      character(:), allocatable :: title        !! of the scene
      character(:), allocatable :: version      !! of dynsph
      character(:), allocatable :: git_id       !! commit it was built from
      character(:), allocatable :: input_text   !! the complete namelist
      real(dp) :: time = 0.0_dp                 !! [time]
      integer :: step = 0
      real(dp) :: reference_length = 0.0_dp     !! d [length]
      real(dp) :: spacing = 0.0_dp              !! dx [length]
      real(dp) :: sound_speed = 0.0_dp          !! c0 [length/time]
      real(dp) :: density = 0.0_dp              !! rho0 [mass/length^3]
      real(dp) :: gravity = 0.0_dp              !! g, downwards [length/time^2]
   end type snapshot_head

contains

   !> Writes one snapshot; under its name it is always complete. Particles keep their order.
   subroutine write_snapshot(path, head, id, x, y, fields, precision, problem, outlines)
      character(*), intent(in) :: path
      type(snapshot_head), intent(in) :: head
      integer, intent(in), contiguous :: id(:)       !! (n) lasting number of each particle
      real(dp), intent(in) :: x(:), y(:)             !! (n) positions [length]
      type(snapshot_field), intent(in) :: fields(:)  !! of n particles each
      character(*), intent(in) :: precision          !! 'single' or 'double', of positions and fields
      type(failure), intent(inout) :: problem        !! exit_files: cannot be written
      type(snapshot_outline), intent(in), optional :: outlines(:)   !! of all solids
      type(hdf5_writer_t) :: file
      logical :: single, single_places
      integer :: i

      single_places = .false.
      single = precision /= 'double'
      call file%create(path)
      call write_head(file, head)
      call file%make_group(grid)
      call file%attach(grid, 'Version', [1, 0])
      call file%put_label(grid, 'Type', 'UnstructuredGrid')
      call file%put_label(grid, 'title', text_or_none(head%title))   ! for readers that must not crash on a damaged heap
      call write_cells(file, size(id))
      if (single) single_places = fine_enough(x, y, head%spacing)
      call file%put_vectors(grid//'/Points', x, y, single_places)
      call label(file, grid//'/Points', 'length', 'position (x, y, 0)')
      call file%make_group(grid//'/PointData')
      call file%put_integers(points//'id', id)
      call label(file, points//'id', '-', 'lasting number of the particle')
      do i = 1, size(fields)
         call write_field(file, fields(i), single)
      end do
      call file%make_group(grid//'/CellData')
      call file%make_group(grid//'/FieldData')
      call file%put_reals(grid//'/FieldData/TimeValue', [head%time], single=.false., in_parts=.false.)
      call label(file, grid//'/FieldData/TimeValue', 'time', 'time of the snapshot')
      if (present(outlines)) call write_outlines(file, outlines)
      call file%finish(problem)
   end subroutine write_snapshot

   ! Whether coordinates in single precision tell particles apart: far from the origin they do not.
   logical function fine_enough(x, y, dx)
      real(dp), intent(in) :: x(:), y(:), dx
      real(dp), parameter :: coarsest = 1.0e-2_dp   ! steps of coordinates in units of dx
      real(dp) :: farthest(1)

      farthest = max(0.0_dp, maxval(abs(x)), maxval(abs(y)))
      call largest_of_all(1, farthest)
      fine_enough = farthest(1)*epsilon(1.0_sp) <= coarsest*dx
   end function fine_enough

   !> The run's attributes on the root group.
   subroutine write_head(file, head)
      type(hdf5_writer_t), intent(inout) :: file
      type(snapshot_head), intent(in) :: head

      call file%attach('/', 'title', text_or_none(head%title))
      call file%attach('/', 'software', 'dynsph')
      call file%attach('/', 'version', text_or_none(head%version))
      call file%attach('/', 'git_id', text_or_none(head%git_id))
      call file%attach('/', 'input', text_or_none(head%input_text))
      call file%attach('/', 'time', head%time)
      call file%attach('/', 'step', [head%step])
      call file%attach('/', 'reference_length', head%reference_length)
      call file%attach('/', 'spacing', head%spacing)
      call file%attach('/', 'sound_speed', head%sound_speed)
      call file%attach('/', 'density', head%density)
      call file%attach('/', 'gravity', head%gravity)
   end subroutine write_head

   !> One cell for each particle: without cells ParaView shows nothing.
   subroutine write_cells(file, n_here)
      type(hdf5_writer_t), intent(inout) :: file
      integer, intent(in) :: n_here   !! particles that this process has
      integer(i8), allocatable :: numbers(:)
      integer(int8), allocatable :: types(:)
      integer(i8), allocatable :: before(:)
      integer(i8) :: total(1), i

      allocate (before(0:n_processes()))
      before(:) = rows_before(int(n_here, i8))
      total = before(n_processes())   ! of all
      numbers = [(before(this_process()) + i, i=0, n_here - 1)]
      allocate (types(n_here), source=vtk_vertex)
      call file%put_longs(grid//'/NumberOfPoints', total, in_parts=.false.)
      call file%put_longs(grid//'/NumberOfCells', total, in_parts=.false.)
      call file%put_longs(grid//'/NumberOfConnectivityIds', total, in_parts=.false.)
      call file%put_longs(grid//'/Connectivity', numbers, in_parts=.true.)
      if (this_process() == n_processes() - 1) numbers = [numbers, total]
      call file%put_longs(grid//'/Offsets', numbers, in_parts=.true.)
      call file%put_bytes(grid//'/Types', types)
   end subroutine write_cells

   subroutine write_field(file, field, single)
      type(hdf5_writer_t), intent(inout) :: file
      type(snapshot_field), intent(in) :: field
      logical, intent(in) :: single

      if (allocated(field%vectors)) then
         call file%put_vectors(points//field%name, field%vectors(:, 1), field%vectors(:, 2), single)
      else
         call file%put_reals(points//field%name, field%values, single, in_parts=.true.)
      end if
      call label(file, points//field%name, text_or_none(field%unit), text_or_none(field%long_name))
   end subroutine write_field

   ! Outside of VTK's group, whose reader takes one grid; outlines.xdmf (module outline_series) leads ParaView there.
   subroutine write_outlines(file, outlines)
      type(hdf5_writer_t), intent(inout) :: file
      type(snapshot_outline), intent(in) :: outlines(:)
      integer :: i, k, n, rows

      if (size(outlines) == 0) return
      call file%make_group(outlines_group)
      do i = 1, size(outlines)
         associate (group => outlines_group//'/'//outlines(i)%name, corners => outlines(i)%corners)
            n = size(corners, 2)
            rows = merge(n + 1, 0, is_first())
            call file%make_group(group)
            call file%put_vectors(group//'/points', [(corners(1, mod(k, n) + 1), k=0, rows - 1)], &
                                  [(corners(2, mod(k, n) + 1), k=0, rows - 1)], single=.false.)
            call label(file, group//'/points', 'length', 'corners of the solid, closed (x, y, 0)')
            call file%put_integers(group//'/order', [(k, k=0, rows - 1)])
            call label(file, group//'/order', '-', 'the points along the line, for VTK')
         end associate
      end do
   end subroutine write_outlines

   subroutine label(file, dataset, unit, long_name)
      type(hdf5_writer_t), intent(inout) :: file
      character(*), intent(in) :: dataset, unit, long_name

      call file%attach(dataset, 'units', unit)
      call file%attach(dataset, 'long_name', long_name)
   end subroutine label

   !> A text that its owner may not have set.
   pure function text_or_none(text) result(known)
      character(:), allocatable, intent(in) :: text
      character(:), allocatable :: known

      known = ''
      if (allocated(text)) known = text
   end function text_or_none

end module snapshot
