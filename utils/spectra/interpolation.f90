!> Values of a snapshot's particles at any place, exact for what is linear in x and y.
!!
!! The particles are sorted as the solver sorts them, without walls or images, so that its own neighbours, kernel sums and
!! vorticity serve here too. Interpolation: moving least squares (Belytschko et al. 1996) with the basis
!! p = (1, x - x_j, y - y_j), f(x) = sum_j f_j W_j V_j p_j.c with (sum_j W_j V_j p_j p_j^T) c = (1, 0, 0).
module interpolation
   use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
   use errors, only: exit_files, failure
   use kernel, only: kernel_t, kernel_value, new_kernel
   use kinds, only: dp
   use model, only: model_t
   use neighbours, only: list_neighbours, neighbours_t, ranges_around, sort_particles
   use particle_snapshot, only: particle_snapshot_t
   use particles, only: allocate_particles, particles_t
   use point_sums, only: sum_at
   use strips, only: ranges_t
   implicit none
   private

   public :: fluid_t, grid_t, sort_fluid, covering_grid, filling, grid_values

   real(dp), parameter, public :: scheme_h = 2.0_dp   !! h/dx of the scheme
   real(dp), parameter :: singular = 1.0e-3_dp   !! of a determinant over its trace squared: all in a line, or nearly

   !> The particles of a snapshot, sorted.
   type :: fluid_t
      type(model_t) :: model
      type(particles_t) :: p
      type(neighbours_t) :: near
   end type fluid_t

   !> A regular grid of points.
   type :: grid_t
      real(dp) :: lower(2) = 0       !! its first point
      real(dp) :: spacing = 1
      integer :: n(2) = 0            !! points in x and y
   end type grid_t

contains

   !> Sorts the particles into strips. Raises exit_files if they are too far from each other for that.
   subroutine sort_fluid(snapshot, fluid, problem)
      type(particle_snapshot_t), intent(in) :: snapshot
      type(fluid_t), intent(out) :: fluid
      type(failure), intent(inout) :: problem
      logical :: scattered
      integer :: i, n

      n = size(snapshot%x)
      fluid%model%dx = snapshot%spacing
      fluid%model%kernel = new_kernel(scheme_h*snapshot%spacing)
      fluid%model%c0 = 1
      fluid%model%rho0 = 1
      call allocate_particles(fluid%p, n)
      fluid%p%n_own = n
      fluid%p%id(1:n) = [(i, i=1, n)]
      fluid%p%m(1:n) = snapshot%volume
      fluid%p%next%x(1:n) = snapshot%x
      fluid%p%next%y(1:n) = snapshot%y
      fluid%p%next%u(1:n) = snapshot%u
      fluid%p%next%v(1:n) = snapshot%v
      fluid%p%next%s(1:n) = 0
      fluid%p%next%volume(1:n) = snapshot%volume
      associate (model => fluid%model, near => fluid%near)
         near%slack = 0
         call sort_particles(near, fluid%p, model%kernel, model%box, model%dx, 0.0_dp, scattered)
         if (scattered) then
            call problem%raise(exit_files, 'some particles are too far from the others to be sorted')
            return
         end if
         call list_neighbours(near, fluid%p, model%kernel, 0.0_dp)
      end associate
   end subroutine sort_fluid

   !> Points at spacing dx over all particles.
   pure type(grid_t) function covering_grid(snapshot) result(grid)
      type(particle_snapshot_t), intent(in) :: snapshot

      grid%spacing = snapshot%spacing
      grid%lower = [minval(snapshot%x), minval(snapshot%y)]
      grid%n = 1 + nint(min(([maxval(snapshot%x), maxval(snapshot%y)] - grid%lower)/grid%spacing, 1.0e8_dp))
   end function covering_grid

   !> sum_j W V_j at every point of a grid, with the scheme's kernel: 1 inside the fluid, 0 outside, 1/2 at its edges.
   subroutine filling(fluid, grid, share)
      type(fluid_t), intent(in) :: fluid
      type(grid_t), intent(in) :: grid
      real(dp), allocatable, intent(out) :: share(:, :)   !! (nx, ny)
      real(dp) :: place(2), ignored
      integer :: i, j

      allocate (share(grid%n(1), grid%n(2)))
      !$omp parallel do default(none) shared(fluid, grid, share) private(i, place, ignored) schedule(dynamic, 4)
      do j = 1, grid%n(2)
         do i = 1, grid%n(1)
            place = grid%lower + grid%spacing*[i - 1, j - 1]
            call sum_at(fluid%model, fluid%p, fluid%near, place(1), place(2), share(i, j), ignored)
         end do
      end do
      !$omp end parallel do
   end subroutine filling

   !> Fields of the particles at the points of a grid; NaN where too few particles are near for a linear field.
   subroutine grid_values(fluid, h, grid, fields, values)
      type(fluid_t), intent(in) :: fluid
      real(dp), intent(in) :: h                               !! smoothing length of the interpolation
      type(grid_t), intent(in) :: grid
      real(dp), intent(in) :: fields(:, :)                    !! (slots, fields)
      real(dp), allocatable, intent(out) :: values(:, :, :)   !! (nx, ny, fields)
      type(kernel_t) :: kernel
      integer :: i, j

      kernel = new_kernel(h)
      allocate (values(grid%n(1), grid%n(2), size(fields, 2)))
      !$omp parallel do default(none) shared(fluid, grid, kernel, fields, values) private(i) schedule(dynamic, 4)
      do j = 1, grid%n(2)
         do i = 1, grid%n(1)
            call value_at(fluid, kernel, grid%lower + grid%spacing*[i - 1, j - 1], fields, values(i, j, :))
         end do
      end do
      !$omp end parallel do
   end subroutine grid_values

   subroutine value_at(fluid, kernel, place, fields, value)
      type(fluid_t), intent(in) :: fluid
      type(kernel_t), intent(in) :: kernel
      real(dp), intent(in) :: place(2)
      real(dp), intent(in) :: fields(:, :)
      real(dp), intent(out) :: value(:)                      !! (fields)
      type(ranges_t) :: ranges
      real(dp), allocatable :: dx(:), dy(:), weight(:)
      integer, allocatable :: slots(:)
      real(dp) :: c(3)
      logical :: solved
      integer :: j, k, n

      call ranges_around(fluid%near, place(1), place(2), kernel%support, ranges)
      allocate (slots(sum(ranges%last(:ranges%n) - ranges%first(:ranges%n) + 1)))
      n = 0
      do k = 1, ranges%n
         do j = ranges%first(k), ranges%last(k)
            if (hypot(fluid%p%base%x(j) - place(1), fluid%p%base%y(j) - place(2)) >= kernel%support) cycle
            n = n + 1
            slots(n) = j
         end do
      end do
      slots = slots(:n)
      dx = (fluid%p%base%x(slots) - place(1))/kernel%h
      dy = (fluid%p%base%y(slots) - place(2))/kernel%h
      weight = kernel_value(kernel, kernel%h*hypot(dx, dy))*fluid%p%base%volume(slots)
      call least_squares(dx, dy, weight, c, solved)
      if (solved) then
         weight = weight*(c(1) + c(2)*dx + c(3)*dy)
         value = [(sum(weight*fields(slots, k)), k=1, size(value))]
      else
         value = ieee_value(value(1), ieee_quiet_nan)
      end if
   end subroutine value_at

   !> Solves (sum_j w_j p_j p_j^T) c = (1, 0, 0) by cofactors.
   pure subroutine least_squares(dx, dy, w, c, solved)
      real(dp), intent(in) :: dx(:), dy(:), w(:)
      real(dp), intent(out) :: c(3)
      logical, intent(out) :: solved
      real(dp) :: xx, xy, yy, x, y, all_of, determinant

      all_of = sum(w)
      x = sum(w*dx)
      y = sum(w*dy)
      xx = sum(w*dx**2)
      xy = sum(w*dx*dy)
      yy = sum(w*dy**2)
      c = [xx*yy - xy**2, xy*y - x*yy, x*xy - xx*y]
      determinant = all_of*c(1) + x*c(2) + y*c(3)
      solved = determinant > singular*all_of*(xx + yy)**2
      if (solved) c = c/determinant
   end subroutine least_squares

end module interpolation
