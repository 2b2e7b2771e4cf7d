!> Pair sums of a step's first pass, for a block of clusters: everything that needs no gradient and no coefficient of a
!! neighbour.
!!
!! Source: eqs. 5-8 and 23. Besides the flow terms these are, as far as a scene needs them, the renormalisation matrix L**-1,
!! the gradient of density, the viscous sum or the velocity gradient, and the largest |pi_ij|.
module first_sums
   use candidates, only: block_slots, candidates_t
   use flow_sums, only: flow_sums_t
   use kernel, only: closest, kernel_t, pair
   use kinds, only: dp
   use lanes, only: nl
   use particles, only: particles_t
   implicit none
   private

   public :: first_sums_t, sum_first

   integer, parameter, public :: pass_flow = 1        !! no diffusive term
   integer, parameter, public :: pass_viscous = 2     !! viscosity, but no density diffusion: no gradients
   integer, parameter, public :: pass_diffusive = 3   !! density diffusion without viscosity
   integer, parameter, public :: pass_constant = 4    !! both, constant coefficients
   integer, parameter, public :: pass_dynamic = 5     !! the velocity gradient instead of the viscous sum, whose coefficients follow

   !> The sums of a block, without the kernel's constant factor F = factor t**3; a pass sets what it is for.
   type, extends(flow_sums_t) :: first_sums_t
      real(dp) :: largest_pi(block_slots)   !! [1/s] max_j |pi_ij|, with r >= closest h; the particle's own images left out
      real(dp) :: viscous_x(block_slots)    !! [m3/s] sum_j pi_ij x_ji t**3 V_j
      real(dp) :: viscous_y(block_slots)   !! [m3/s]
      real(dp) :: matrix_xx(block_slots)    !! [m4] sum_j x_ji x_ji t**3 V_j, and so on: L**-1
      real(dp) :: matrix_xy(block_slots)   !! [m4]
      real(dp) :: matrix_yy(block_slots)   !! [m4]
      real(dp) :: density_x(block_slots)    !! [kg] sum_j (s_j - s_i) x_ji t**3 V_j
      real(dp) :: density_y(block_slots)   !! [kg]
      real(dp) :: density_0(block_slots)    !! [kg/m] sum_j (s_j - s_i) t**3 V_j
      real(dp) :: kernel_x(block_slots)     !! [m3] sum_j x_ji t**3 V_j: the sum of grad W
      real(dp) :: kernel_y(block_slots)   !! [m3]
      real(dp) :: crowd(block_slots)        !! [m2] sum_j t**3 V_j, the particle and its own images left out
      real(dp) :: u_x(block_slots)          !! [m4/s] sum_j u_ji x_ji t**3 V_j, and so on: the velocity gradient before L
      real(dp) :: u_y(block_slots)   !! [m4/s]
      real(dp) :: v_x(block_slots)   !! [m4/s]
      real(dp) :: v_y(block_slots)   !! [m4/s]
   end type first_sums_t

contains

   !> Sums of the base state over all candidates; the lanes of the inner loop are a cluster's particles.
   pure subroutine sum_first(pass, kernel, block, p, source, i0, sums)
      integer, intent(in) :: pass              !! pass_flow, ...
      type(kernel_t), intent(in) :: kernel
      type(candidates_t), intent(in) :: block
      type(particles_t), intent(in) :: p
      integer, intent(in) :: source(:)         !! (images) slot of an image's source
      integer, intent(in) :: i0                !! slot before the block's first
      type(first_sums_t), intent(inout) :: sums
      integer :: c, k, n

      do c = 1, block%n_clusters
         k = (c - 1)*nl
         n = block%first(c + 1) - block%first(c)
         associate (near => block%slot(block%first(c):block%first(c + 1) - 1), s => p%base, reach => kernel%inverse_support)
            select case (pass)
            case (pass_flow)
               call flow_loop(n, near, size(s%x), s%x, s%y, s%u, s%v, s%s, s%volume, p%n_held, source, i0 + k, k, reach, sums)
            case (pass_viscous)
               call viscous_loop(n, near, size(s%x), s%x, s%y, s%u, s%v, s%s, s%volume, p%n_held, source, i0 + k, k, reach, sums)
            case (pass_diffusive)
               call diffusive_loop(n, near, size(s%x), s%x, s%y, s%u, s%v, s%s, s%volume, p%n_held, source, i0 + k, k, reach, sums)
            case (pass_constant)
               call constant_loop(n, near, size(s%x), s%x, s%y, s%u, s%v, s%s, s%volume, p%n_held, source, i0 + k, k, reach, sums)
            case (pass_dynamic)
               call dynamic_loop(n, near, size(s%x), s%x, s%y, s%u, s%v, s%s, s%volume, p%n_held, source, i0 + k, k, reach, sums)
            end select
         end associate
      end do
   end subroutine sum_first

   pure subroutine flow_loop(n_near, near, n, x, y, u, v, s, volume, n_held, source, i0, k0, inverse_support, sums)
      logical, parameter :: gradients = .false., strain = .false., viscosity = .false.
      include 'first_pass.inc'
   end subroutine flow_loop

   pure subroutine viscous_loop(n_near, near, n, x, y, u, v, s, volume, n_held, source, i0, k0, inverse_support, sums)
      logical, parameter :: gradients = .false., strain = .false., viscosity = .true.
      include 'first_pass.inc'
   end subroutine viscous_loop

   pure subroutine diffusive_loop(n_near, near, n, x, y, u, v, s, volume, n_held, source, i0, k0, inverse_support, sums)
      logical, parameter :: gradients = .true., strain = .false., viscosity = .false.
      include 'first_pass.inc'
   end subroutine diffusive_loop

   pure subroutine constant_loop(n_near, near, n, x, y, u, v, s, volume, n_held, source, i0, k0, inverse_support, sums)
      logical, parameter :: gradients = .true., strain = .false., viscosity = .true.
      include 'first_pass.inc'
   end subroutine constant_loop

   pure subroutine dynamic_loop(n_near, near, n, x, y, u, v, s, volume, n_held, source, i0, k0, inverse_support, sums)
      logical, parameter :: gradients = .true., strain = .true., viscosity = .false.
      include 'first_pass.inc'
   end subroutine dynamic_loop

end module first_sums
