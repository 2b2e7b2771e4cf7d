!> Vorticity of particles, and values of particles at any place, both exact for what is linear in x and y.
!!
!! Vorticity: the renormalised gradient of the velocity (eqs. 19-24), du_a/dx_b = sum_j (u_j - u_i)_a (L grad W)_b V_j.
!! Interpolation: moving least squares (Belytschko et al. 1996) with the basis p = (1, x - x_j, y - y_j),
!! f(x) = sum_j f_j W_j V_j p_j.c with (sum_j W_j V_j p_j p_j^T) c = (1, 0, 0).
module interpolation
   use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
   use cells, only: cells_t, find_near, new_cells
   use kernel, only: kernel_gradient, kernel_t, kernel_value, new_kernel
   use kinds, only: dp
   use particle_snapshot, only: particle_snapshot_t
   implicit none
   private

   real(dp), parameter :: singular = 1.0e-3_dp   !! of a determinant over its trace squared: all in a line, or nearly

   public :: particle_vorticity, grid_values, filling

   !> A regular grid of points.
   type, public :: grid_t
      real(dp) :: lower(2) = 0       !! its first point
      real(dp) :: spacing = 1
      integer :: n(2) = 0            !! points in x and y
   end type grid_t

contains

   !> dv/dx - du/dy of every particle; 0 where a particle's neighbours stand in a line.
   subroutine particle_vorticity(snapshot, h, vorticity)
      type(particle_snapshot_t), intent(in) :: snapshot
      real(dp), intent(in) :: h                            !! smoothing length
      real(dp), allocatable, intent(out) :: vorticity(:)   !! (n)
      type(kernel_t) :: kernel
      type(cells_t) :: cells
      real(dp) :: m(2, 2), u(2), v(2), d(2), f, determinant
      integer, allocatable :: near(:)
      integer :: i, k

      kernel = new_kernel(h)
      cells = new_cells(snapshot%x, snapshot%y, kernel%support)
      allocate (vorticity(size(snapshot%x)))
      !$omp parallel do default(none) shared(snapshot, kernel, cells, vorticity) private(m, u, v, d, f, determinant, near, k) &
      !$omp schedule(dynamic, 256)
      do i = 1, size(snapshot%x)
         call find_near(cells, snapshot%x(i), snapshot%y(i), near)
         m = 0
         u = 0
         v = 0
         do k = 1, size(near)
            associate (j => near(k))
               d = [snapshot%x(j) - snapshot%x(i), snapshot%y(j) - snapshot%y(i)]
               f = kernel_gradient(kernel, norm2(d))*snapshot%volume(j)
               m = m + f*spread(d, 2, 2)*spread(d, 1, 2)
               u = u + f*d*(snapshot%u(j) - snapshot%u(i))
               v = v + f*d*(snapshot%v(j) - snapshot%v(i))
            end associate
         end do
         determinant = m(1, 1)*m(2, 2) - m(1, 2)**2
         vorticity(i) = 0
         if (determinant > singular*(m(1, 1) + m(2, 2))**2) &
            vorticity(i) = (m(2, 2)*v(1) - m(1, 2)*v(2) - m(1, 1)*u(2) + m(1, 2)*u(1))/determinant
      end do
      !$omp end parallel do
   end subroutine particle_vorticity

   !> sum_j W V_j at every point of a grid: 1 inside the fluid, 0 outside, 1/2 at its edges.
   subroutine filling(snapshot, h, grid, share)
      type(particle_snapshot_t), intent(in) :: snapshot
      real(dp), intent(in) :: h
      type(grid_t), intent(in) :: grid
      real(dp), allocatable, intent(out) :: share(:, :)   !! (nx, ny)
      type(kernel_t) :: kernel
      type(cells_t) :: cells
      integer, allocatable :: near(:)
      real(dp) :: place(2)
      integer :: i, j

      kernel = new_kernel(h)
      cells = new_cells(snapshot%x, snapshot%y, kernel%support)
      allocate (share(grid%n(1), grid%n(2)))
      !$omp parallel do default(none) shared(snapshot, grid, kernel, cells, share) private(i, near, place) schedule(dynamic, 4)
      do j = 1, grid%n(2)
         do i = 1, grid%n(1)
            place = grid%lower + grid%spacing*[i - 1, j - 1]
            call find_near(cells, place(1), place(2), near)
            share(i, j) = sum(kernel_value(kernel, hypot(snapshot%x(near) - place(1), snapshot%y(near) - place(2))) &
                              *snapshot%volume(near))
         end do
      end do
      !$omp end parallel do
   end subroutine filling

   !> Fields of the particles at the points of a grid; NaN where too few particles are near for a linear field.
   subroutine grid_values(snapshot, h, grid, fields, values)
      type(particle_snapshot_t), intent(in) :: snapshot
      real(dp), intent(in) :: h
      type(grid_t), intent(in) :: grid
      real(dp), intent(in) :: fields(:, :)                    !! (n, fields)
      real(dp), allocatable, intent(out) :: values(:, :, :)   !! (nx, ny, fields)
      type(kernel_t) :: kernel
      type(cells_t) :: cells
      integer :: i, j

      kernel = new_kernel(h)
      cells = new_cells(snapshot%x, snapshot%y, kernel%support)
      allocate (values(grid%n(1), grid%n(2), size(fields, 2)))
      !$omp parallel do default(none) shared(snapshot, grid, kernel, cells, fields, values) private(i) schedule(dynamic, 4)
      do j = 1, grid%n(2)
         do i = 1, grid%n(1)
            call value_at(snapshot, kernel, cells, grid%lower + grid%spacing*[i - 1, j - 1], fields, values(i, j, :))
         end do
      end do
      !$omp end parallel do
   end subroutine grid_values

   subroutine value_at(snapshot, kernel, cells, place, fields, value)
      type(particle_snapshot_t), intent(in) :: snapshot
      type(kernel_t), intent(in) :: kernel
      type(cells_t), intent(in) :: cells
      real(dp), intent(in) :: place(2)
      real(dp), intent(in) :: fields(:, :)
      real(dp), intent(out) :: value(:)                      !! (fields)
      integer, allocatable :: near(:)
      real(dp), allocatable :: dx(:), dy(:), weight(:)
      real(dp) :: c(3)
      logical :: solved
      integer :: k

      call find_near(cells, place(1), place(2), near)
      dx = (snapshot%x(near) - place(1))/kernel%h
      dy = (snapshot%y(near) - place(2))/kernel%h
      weight = kernel_value(kernel, kernel%h*hypot(dx, dy))*snapshot%volume(near)
      call least_squares(dx, dy, weight, c, solved)
      if (solved) then
         weight = weight*(c(1) + c(2)*dx + c(3)*dy)
         value = [(sum(weight*fields(near, k)), k=1, size(value))]
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
