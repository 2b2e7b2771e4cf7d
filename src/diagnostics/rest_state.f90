!> Energies of the fluid at rest in its tank, which normalise the energy budget.
!!
!! Source: the paper's Delta E_Mtot = E_M(0) - E_M(at rest), with the compressible rest state of the same mass:
!! dp/dy = -rho g with p = c0**2 (rho - rho0) gives rho = rho0 exp(g (H - y)/c0**2).
module rest_state
   use energy, only: elastic_energy
   use kinds, only: dp
   use solids, only: obstacle_t
   use sorting, only: ascending
   implicit none
   private

   public :: rest_energies, rest_energies_around, rest_height

   integer, parameter :: layers = 200   ! of fluid between two heights at which some solid has a corner

contains

   !> Height H of the resting fluid: M/L = rho0 c0**2/g (exp(g H/c0**2) - 1).
   elemental real(dp) function rest_height(mass, width, rho0, c0, gravity) result(height)
      real(dp), intent(in) :: mass      !! per unit of the third dimension
      real(dp), intent(in) :: width     !! L of the tank
      real(dp), intent(in) :: rho0, c0, gravity   !! gravity > 0

      height = c0**2/gravity*log(1 + mass*gravity/(width*rho0*c0**2))
   end function rest_height

   !> Potential energy above the floor and elastic energy of the resting fluid.
   pure subroutine rest_energies(mass, width, rho0, c0, gravity, potential, elastic)
      real(dp), intent(in) :: mass, width, rho0, c0, gravity   !! as for rest_height
      real(dp), intent(out) :: potential   !! int rho g y dA
      real(dp), intent(out) :: elastic     !! eq. 11
      real(dp) :: x

      x = rest_height(mass, width, rho0, c0, gravity)*gravity/c0**2
      potential = width*rho0*c0**4/gravity*series(x, 2)
      elastic = width*rho0*c0**4/gravity*series(x, 3)
   end subroutine rest_energies

   !> The same where solids rest in the tank: the sums over thin layers, of the width that solids leave. Fluid is taken to fill the
   !! tank from below, also what solids enclose.
   pure subroutine rest_energies_around(obstacles, sides, mass, fluid, potential, elastic)
      type(obstacle_t), intent(in) :: obstacles(:)
      real(dp), intent(in) :: sides(3)     !! [m] x of the left and right wall, y of the floor
      real(dp), intent(in) :: mass         !! [kg/m]
      real(dp), intent(in) :: fluid(3)     !! rho0, c0, gravity
      real(dp), intent(out) :: potential   !! [J/m] int rho g (y - floor) dA
      real(dp), intent(out) :: elastic     !! [J/m]
      real(dp) :: lower, upper, sums(3)
      real(dp), allocatable :: heights(:)
      integer :: k

      allocate (heights, source=corner_heights(obstacles, sides(3)))
      ! Solids lift the level by no more than the area of the boxes around them.
      lower = 0
      upper = rest_height(mass, sides(2) - sides(1), fluid(1), fluid(2), fluid(3))
      do k = 1, size(obstacles)
         upper = upper + max(0.0_dp, obstacles(k)%upper(2) - sides(3))
      end do
      do k = 1, 60
         sums = layer_sums(obstacles, sides, heights, (lower + upper)/2, fluid)
         if (sums(1) < mass) lower = (lower + upper)/2
         if (.not. sums(1) < mass) upper = (lower + upper)/2
      end do
      sums = layer_sums(obstacles, sides, heights, upper, fluid)
      potential = sums(2)
      elastic = sums(3)
   end subroutine rest_energies_around

   ! Heights above the floor at which the free width is not smooth, from 0 on.
   pure function corner_heights(obstacles, bottom) result(heights)
      type(obstacle_t), intent(in) :: obstacles(:)
      real(dp), intent(in) :: bottom
      real(dp), allocatable :: heights(:), all(:)
      integer :: k

      allocate (all(1), source=0.0_dp)
      do k = 1, size(obstacles)
         all = [all, obstacles(k)%outline(2, :) - bottom]
      end do
      all = pack(all, all >= 0)
      heights = all(ascending(all))
   end function corner_heights

   ! Mass, potential and elastic energy of fluid at rest up to a level.
   pure function layer_sums(obstacles, sides, heights, level, fluid) result(sums)
      type(obstacle_t), intent(in) :: obstacles(:)
      real(dp), intent(in) :: sides(3), heights(:), level, fluid(3)
      real(dp) :: sums(3), lower, upper, y, thickness, rho
      integer :: i, k

      sums = 0
      do i = 1, size(heights)
         lower = heights(i)
         upper = level
         if (i < size(heights)) upper = min(level, heights(i + 1))
         thickness = (upper - lower)/layers
         if (.not. thickness > 0) cycle
         do k = 1, layers
            y = lower + (k - 0.5_dp)*thickness
            rho = fluid(1)*exp(fluid(3)*(level - y)/fluid(2)**2)
            sums = sums + thickness*free_width(obstacles, sides, y)*rho &
                   *[1.0_dp, fluid(3)*y, fluid(2)**2*elastic_energy(rho/fluid(1) - 1)]
         end do
      end do
   end function layer_sums

   ! What solids leave of the tank's width at a height: without the union of the pieces that they cover.
   pure real(dp) function free_width(obstacles, sides, height) result(width)
      type(obstacle_t), intent(in) :: obstacles(:)
      real(dp), intent(in) :: sides(3), height
      real(dp), allocatable :: from(:), to(:), crossing(:)
      integer, allocatable :: order(:)
      real(dp) :: y, reached
      integer :: k, m, n

      allocate (from(0), to(0))
      y = sides(3) + height
      do k = 1, size(obstacles)
         if (y < obstacles(k)%lower(2) .or. y > obstacles(k)%upper(2)) cycle
         allocate (crossing(0))
         n = size(obstacles(k)%outline, 2)
         do m = 1, n
            associate (a => obstacles(k)%outline(:, m), b => obstacles(k)%outline(:, mod(m, n) + 1))
               if ((a(2) > y) .neqv. (b(2) > y)) crossing = [crossing, a(1) + (b(1) - a(1))*(y - a(2))/(b(2) - a(2))]
            end associate
         end do
         crossing = min(max(crossing(ascending(crossing)), sides(1)), sides(2))
         from = [from, crossing(1::2)]
         to = [to, crossing(2::2)]
         deallocate (crossing)
      end do
      width = sides(2) - sides(1)
      reached = sides(1)
      order = ascending(from)
      do k = 1, size(from)
         width = width - max(0.0_dp, to(order(k)) - max(reached, from(order(k))))
         reached = max(reached, to(order(k)))
      end do
   end function free_width

   ! first = 2: exp(x) - 1 - x = sum_{n>=2} x**n/n!;
   ! first = 3: (x - 2) exp(x) + 2 + x = sum_{n>=3} (n - 2) x**n/n!. Summed because x is small.
   pure real(dp) function series(x, first) result(total)
      real(dp), intent(in) :: x
      integer, intent(in) :: first
      real(dp) :: power
      integer :: n

      total = 0
      power = x
      do n = 2, 60
         power = power*x/n
         if (first == 2) total = total + power
         if (first == 3) total = total + (n - 2)*power
      end do
   end function series

end module rest_state
