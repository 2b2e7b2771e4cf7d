!> Time of a step's sums over pairs as the compiler makes them for this processor: CMake builds it with each way of taking the
!! root and each number of lanes, runs them in turn and takes the fastest (cmake/Lanes.cmake).
!!
!! Prints ns per particle: of the fastest of many passes over a disordered patch, listed as in a run.
program measure_pairs
   use, intrinsic :: iso_fortran_env, only: output_unit
   use candidates, only: block_slots
   use diffusion_sums, only: sum_diffusion
   use first_sums, only: first_sums_t, pass_constant, sum_first
   use flow_sums, only: flow_sums_t, sum_flow
   use images, only: walls_t
   use kernel, only: kernel_t, new_kernel
   use kinds, only: dp, i8
   use neighbours, only: list_neighbours, neighbours_t, sort_particles
   use particles, only: allocate_particles, features_t, particles_t
   implicit none

   integer, parameter :: columns = 64, repeats = 60
   type(particles_t) :: p
   type(neighbours_t) :: near
   type(kernel_t) :: kernel
   real(dp) :: check
   integer(i8) :: began, ended, rate, fastest
   integer :: k

   call disordered_patch()
   fastest = huge(fastest)
   check = 0
   do k = 1, repeats
      call system_clock(began, rate)
      call all_passes(check)
      call system_clock(ended)
      fastest = min(fastest, ended - began)
   end do
   ! The sums are printed too, so that none can be left out.
   write (output_unit, '(f0.3, es12.3)') real(fastest, dp)*1.0e9_dp/(real(rate, dp)*p%n), check

contains

   subroutine disordered_patch()
      logical :: scattered
      integer :: i
      real(dp) :: noise(4)

      call allocate_particles(p, columns**2, features_t())
      kernel = new_kernel(2.0_dp)
      p%n_own = p%n
      do i = 1, p%n
         call random_number(noise)
         p%id(i) = i
         p%m(i) = 1
         p%next%x(i) = mod(i, columns) + 0.4_dp*noise(1)
         p%next%y(i) = i/columns + 0.4_dp*noise(2)
         p%next%u(i) = noise(3)
         p%next%v(i) = noise(4)
         p%next%s(i) = noise(1)*0.01_dp
         p%next%w(i) = 1
      end do
      near%slack = 0.02_dp
      call sort_particles(near, p, kernel, walls_t(), 1.0_dp, 0.1_dp, scattered)
      call list_neighbours(near, p, kernel, 0.05_dp)
      p%grad_x = 0.01_dp
      p%grad_y = 0.02_dp
   end subroutine disordered_patch

   ! Those of a step with constant coefficients.
   subroutine all_passes(check)
      real(dp), intent(inout) :: check
      type(first_sums_t) :: first
      type(flow_sums_t) :: flow
      real(dp) :: diffusion(block_slots)
      integer :: b, stage

      do b = 1, near%n_blocks
         call sum_first(pass_constant, kernel, near%blocks(b), p, near%images%source, (b - 1)*block_slots, first)
         call sum_diffusion(kernel, near%blocks(b), p, (b - 1)*block_slots, diffusion)
         check = check + first%matrix_xx(1) + diffusion(1)
      end do
      do stage = 1, 3
         do b = 1, near%n_blocks
            call sum_flow(kernel, near%blocks(b), p%base, (b - 1)*block_slots, flow)
            check = check + flow%divergence(1)
         end do
      end do
   end subroutine all_passes

end program measure_pairs
