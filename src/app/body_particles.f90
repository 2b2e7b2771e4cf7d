!> Where the particles of a body stand at t = 0, and the area that each has.
!!
!! The areas of a body's particles add up to the body's area exactly.
!!
!! A rectangle's square lattice is aligned with its sides or turned by atan(3/5) = 31.0 degrees. Strain along its axes
!! squeezes an aligned lattice into strings of particles that break up later. A square lattice at 31.7 degrees to the
!! strain becomes itself again and again, its spacing never much smaller: Kraynik & Reinelt, Int. J. Multiphase Flow 18
!! (1992) 1045-1059. At atan(3/5) it also fits a periodic box.
module body_particles
   use kinds, only: dp
   use settings, only: body_settings
   implicit none
   private

   public :: sites_t, count_sites, place_sites

   real(dp), parameter :: pi = acos(-1.0_dp)

   ! The lattice of the vectors (5, 3) and (-3, 5) repeats itself after 34 = 5**2 + 3**2 rows; each row is shifted by 13
   ! against the row below.
   integer, parameter :: turned_rows = 34, turned_shift = 13

   !> Places of particles and the areas that they stand for.
   type :: sites_t
      real(dp), allocatable :: x(:), y(:)   !! (first:last) of the body's particles
      real(dp), allocatable :: area(:)      !! (first:last)
   end type sites_t

contains

   !> Number of particles in a body.
   pure integer function count_sites(body, dx) result(n)
      type(body_settings), intent(in) :: body
      real(dp), intent(in) :: dx
      integer :: j, k

      if (body%shape == 'disc' .and. body%packing == 'lattice') then
         associate (r => rings(body, dx))
            n = 0
            do j = -r, r - 1
               n = n + count([(covered(k, j, r), k=-r, r - 1)])
            end do
         end associate
      else if (body%shape == 'disc') then
         n = sum([(on_ring(k), k=1, rings(body, dx))])
      else if (body%lattice == 'turned') then
         n = turned_rows*product(turned_cells(body, dx))
      else
         n = product(lattice(body, dx))
      end if
   end function count_sites

   !> Places the particles of a body, or some of them.
   pure subroutine place_sites(body, dx, sites, first, last)
      type(body_settings), intent(in) :: body
      real(dp), intent(in) :: dx
      type(sites_t), intent(out) :: sites
      integer, intent(in), optional :: first, last   !! of them, from 1; all if left out
      integer :: n, from, to

      n = count_sites(body, dx)
      from = 1
      to = n
      if (present(first)) from = first
      if (present(last)) to = last
      allocate (sites%x(from:to), sites%y(from:to), sites%area(from:to))
      if (body%shape == 'disc' .and. body%packing == 'lattice') then
         call place_on_cut_lattice(body, rings(body, dx), sites)
         sites%area = pi*body%radius**2/n
      else if (body%shape == 'disc') then
         call place_on_rings(body, rings(body, dx), sites)
      else if (body%lattice == 'turned') then
         call place_on_turned_lattice(body, turned_cells(body, dx), sites)
      else
         call place_on_lattice(body, lattice(body, dx), sites)
      end if
   end subroutine place_sites

   ! Columns and rows of a rectangle: spacing is dx, stretched to fill the body exactly.
   pure function lattice(body, dx) result(n)
      type(body_settings), intent(in) :: body
      real(dp), intent(in) :: dx
      integer :: n(2)

      n = max(1, nint((body%upper - body%lower)/dx))
   end function lattice

   ! Half a spacing from the rectangle's edges.
   pure subroutine place_on_lattice(body, n, sites)
      type(body_settings), intent(in) :: body
      integer, intent(in) :: n(2)
      type(sites_t), intent(inout) :: sites
      real(dp) :: cell(2)
      integer :: i, j, k

      cell = (body%upper - body%lower)/n
      do k = lbound(sites%x, 1), ubound(sites%x, 1)
         j = (k - 1)/n(1) + 1
         i = k - (j - 1)*n(1)
         sites%x(k) = body%lower(1) + cell(1)*(i - 0.5_dp)
         sites%y(k) = body%lower(2) + cell(2)*(j - 0.5_dp)
      end do
      sites%area = product(cell)
   end subroutine place_on_lattice

   ! Cells of the turned lattice across and up: each is sqrt(34) dx wide and high, stretched to fill the body exactly.
   pure function turned_cells(body, dx) result(n)
      type(body_settings), intent(in) :: body
      real(dp), intent(in) :: dx
      integer :: n(2)

      n = max(1, nint((body%upper - body%lower)/(sqrt(real(turned_rows, dp))*dx)))
   end function turned_cells

   ! 34 rows in a cell, with one particle in each.
   pure subroutine place_on_turned_lattice(body, n, sites)
      type(body_settings), intent(in) :: body
      integer, intent(in) :: n(2)
      type(sites_t), intent(inout) :: sites
      real(dp) :: unit(2)
      integer :: i, j, k

      unit = (body%upper - body%lower)/(turned_rows*n)
      do k = lbound(sites%x, 1), ubound(sites%x, 1)
         j = (k - 1)/n(1)
         i = k - 1 - j*n(1)
         sites%x(k) = body%lower(1) + unit(1)*(turned_rows*i + mod(turned_shift*j, turned_rows) + 0.5_dp)
         sites%y(k) = body%lower(2) + unit(2)*(j + 0.5_dp)
      end do
      sites%area = turned_rows*product(unit)
   end subroutine place_on_turned_lattice

   ! Rings of a disc, each dx wide, stretched to fill the disc exactly.
   pure integer function rings(body, dx)
      type(body_settings), intent(in) :: body
      real(dp), intent(in) :: dx

      rings = max(1, nint(body%radius/dx))
   end function rings

   ! Whether a disc of radius r covers the middle of cell (i, j) of the lattice of unit cells.
   pure logical function covered(i, j, r)
      integer, intent(in) :: i, j, r

      covered = (i + 0.5_dp)**2 + (j + 0.5_dp)**2 <= r**2
   end function covered

   ! What the disc covers of a square lattice.
   pure subroutine place_on_cut_lattice(body, r, sites)
      type(body_settings), intent(in) :: body
      integer, intent(in) :: r   ! radius in cells
      type(sites_t), intent(inout) :: sites
      integer :: i, j, slot

      slot = 0
      do j = -r, r - 1
         do i = -r, r - 1
            if (.not. covered(i, j, r)) cycle
            slot = slot + 1
            if (slot < lbound(sites%x, 1) .or. slot > ubound(sites%x, 1)) cycle
            sites%x(slot) = body%centre(1) + body%radius/r*(i + 0.5_dp)
            sites%y(slot) = body%centre(2) + body%radius/r*(j + 0.5_dp)
         end do
      end do
   end subroutine place_on_cut_lattice

   ! Particles on ring k: its area pi (2k - 1) dx**2 in parts of about dx**2.
   pure integer function on_ring(k)
      integer, intent(in) :: k

      on_ring = nint(pi*(2*k - 1))
   end function on_ring

   ! Evenly spaced on concentric rings, at the radius that gives each ring its second moment. Successive rings are turned
   ! by the golden section of the spacing between particles, so that they do not line up into spokes.
   pure subroutine place_on_rings(body, n_rings, sites)
      type(body_settings), intent(in) :: body
      integer, intent(in) :: n_rings
      type(sites_t), intent(inout) :: sites
      real(dp), parameter :: golden = (sqrt(5.0_dp) - 1)/2
      real(dp) :: width, radius, angle
      integer :: i, k, n, slot

      width = body%radius/n_rings
      slot = 0
      do k = 1, n_rings
         n = on_ring(k)
         radius = width*sqrt((real(k, dp)**2 + real(k - 1, dp)**2)/2)
         do i = 1, n
            slot = slot + 1
            if (slot < lbound(sites%x, 1) .or. slot > ubound(sites%x, 1)) cycle
            angle = 2*pi*(i + modulo(k*golden, 1.0_dp))/n
            sites%x(slot) = body%centre(1) + radius*cos(angle)
            sites%y(slot) = body%centre(2) + radius*sin(angle)
            sites%area(slot) = pi*(2*k - 1)*width**2/n
         end do
      end do
   end subroutine place_on_rings

end module body_particles
