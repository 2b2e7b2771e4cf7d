!> What a step makes of a block of the fluid, besides its state: sums and extremes; and the stage that it is at.
module blocks
   use box, only: box_t
   use candidates, only: block_groups
   use integrators, only: most_stages
   use kinds, only: dp
   use solids, only: obstacle_t
   use strips, only: extent_t
   implicit none
   private

   public :: block_t, moment_t

   !> A stage of a step.
   type :: moment_t
      integer :: stage = 1   !! of the model's integrator
      real(dp) :: dt = 0     !! [s] length of the step
      type(box_t) :: box         !! at the stage's time,
      type(box_t) :: last_box    !! at the end of the step
      type(obstacle_t), allocatable :: obstacles(:)   !! solids at the end of the step, where there are any
   end type moment_t

   !> Extremes of a block, and sums over each of its groups: a group lies in one strip, and no sum depends on where blocks end.
   type :: block_t
      real(dp) :: work(block_groups, 4) = 0       !! [J/m] alpha, delta, walls, uniform force
      real(dp) :: wall_power(block_groups) = 0    !! [W/m] of no-slip walls that move
      real(dp) :: solid_power(block_groups) = 0   !! [W/m] that solids give in a stage, friction left out,
      real(dp) :: solid_work(block_groups) = 0    !! [J/m] and in the step: part of the walls' work
      real(dp) :: sponge_work(block_groups) = 0   !! [J/m] by sponge layers, <= 0
      real(dp), allocatable :: rubbed(:, :)       !! [m3/s] (slots, 2) viscous sums over ghosts that the first pass had near
      real(dp), allocatable :: struck(:, :)       !! (4, solids) of particles put back: impulse on it, moment of that, their energy
      real(dp) :: speed_2 = 0        !! max |u|**2
      real(dp) :: pressure = 0       !! max p/rho
      real(dp) :: largest_s = 0
      type(extent_t) :: extent       !! in x, and of velocities
      real(dp) :: largest_pi = 0
      real(dp) :: largest_alpha = 0  !! alpha_i of the dynamic model
      real(dp) :: largest_delta = 0  !! delta_i, or delta, times crowding
      integer :: crossings = 0
      integer :: singular = 0
      integer :: lost_slot = 0
      real(dp) :: behind = 0         !! max |u - u when sorted| of the base state,
      real(dp) :: ahead = 0          !! and some time later, as its first sums have it
      real(dp) :: change(most_stages) = 0   !! of each stage max |u - u when sorted|
      real(dp) :: jump = 0           !! largest way that a wall has put a particle back
      logical :: wrapped = .false.   !! a particle went through a periodic side
   end type block_t

end module blocks
