!> How far the spectra of dynsph-spectra vorticity can be trusted: known waves pass through its derivative and interpolation.
!!
!! usage: dynsph-spectra-accuracy [options] SNAPSHOT.vtkhdf     or with --disorder in the place of a snapshot (--help lists them)
!!
!! Waves of random phases, periodic in a rectangle inside the fluid, with the energy spectrum k^-3 up to a largest wavenumber, are
!! given to the particles, and exactly to the grid; both go through the same window and transform. It prints, with k in pi/dx:
!! points each way; of enstrophy over the exact one and what the kernel leaves of it, the largest deviation for k from 0.05 to 0.25
!! and on to 0.5, and from which k on it is more than 1.1 and 2, 1 if nowhere; what share of enstrophy is above pi/(2h) and pi/h.
program spectra_accuracy
   use, intrinsic :: iso_fortran_env, only: output_unit
   use errors, only: end_program, exit_input, failure
   use gradient_fields, only: gradient_fields_t, measure_gradients
   use interpolation, only: covering_grid, filling, fluid_t, grid_t, grid_values, scheme_h, sort_fluid
   use kernel_transform, only: transform_of_kernel
   use kinds, only: dp, i8
   use options, only: options_t
   use particle_snapshot, only: particle_snapshot_t, read_snapshot
   use plane_spectrum, only: add_spectrum, new_rings, power_above, rings_t
   use process_start, only: start_process
   use program_arguments, only: take_arguments
   use rectangles, only: largest_rectangle
   use standard_output, only: check_screen, errors_for_signals
   implicit none

   real(dp), parameter :: pi = acos(-1.0_dp)
   integer, parameter :: lattice_size(2) = [160, 100]   ! particles of one that is disturbed

   !> Waves Re(c exp(i k.r)) from the lower corner of a rectangle.
   type :: waves_t
      real(dp) :: lower(2) = 0, extent(2) = 0
      complex(dp), allocatable :: u(:, :), v(:, :), vorticity(:, :)   !! (0:mx, -my:my) coefficients
   end type waves_t

   type(options_t) :: given
   type(failure) :: problem
   type(particle_snapshot_t) :: snapshot
   type(waves_t) :: waves
   type(rings_t) :: measured, exact
   character(:), allocatable :: arguments(:)
   real(dp) :: smoothing, largest, disorder

   given%command = 'dynsph-spectra-accuracy'
   call given%add('--disorder', 'X', '', 'a lattice, each particle moved by up to X dx in x and y')
   call given%add('--smoothing', 'H/DX', '1.25', 'smoothing length of the interpolation, over dx')
   call given%add('--largest', 'K', '1', 'largest wavenumber of the waves, over pi/dx')
   call start_process()
   call errors_for_signals(pipes=.false.)
   call take_arguments(arguments)
   call given%parse(arguments, problem)
   if (given%help) then
      write (output_unit, '(a)') 'usage: dynsph-spectra-accuracy [options] SNAPSHOT.vtkhdf', ''
      call given%write_help(output_unit)
      call check_screen(problem)
      call end_program(problem)
   end if
   smoothing = given%real_number('--smoothing', problem)
   largest = given%real_number('--largest', problem)
   if (.not. problem%raised() .and. .not. min(smoothing, largest) > 0) &
      call problem%raise(exit_input, given%command//': --smoothing and --largest must be above 0')
   if (given%given('--disorder') .and. size(given%files) == 0) then
      disorder = given%real_number('--disorder', problem)
      if (.not. problem%raised()) snapshot = disturbed_lattice(disorder)
   else if (size(given%files) == 1 .and. .not. given%given('--disorder')) then
      call read_snapshot(trim(given%files(1)), snapshot, problem)
   else
      call problem%raise(exit_input, given%command//': give one snapshot, or --disorder alone; --help lists the options')
   end if
   if (.not. problem%raised()) call measure(snapshot, smoothing, largest, waves, measured, exact, problem)
   if (.not. problem%raised()) call print_row(nint(waves%extent/snapshot%spacing), measured, exact, snapshot%spacing, smoothing)
   if (.not. problem%raised()) call check_screen(problem)
   call end_program(problem)

contains

   !> A number from 0 to 1, the next one at each call; the same on every machine.
   real(dp) function random(state)
      integer(i8), intent(inout) :: state

      state = mod(16807_i8*state, 2147483647_i8)
      random = real(state, dp)/2147483647.0_dp
   end function random

   type(particle_snapshot_t) function disturbed_lattice(disorder) result(lattice)
      real(dp), intent(in) :: disorder   !! largest way of a particle, in dx
      integer(i8) :: state
      integer :: i, n

      n = product(lattice_size)
      lattice%spacing = 1
      allocate (lattice%x(n), lattice%y(n), lattice%volume(n))
      lattice%volume = 1
      state = 1
      do i = 1, n
         lattice%x(i) = modulo(i - 1, lattice_size(1)) + disorder*(2*random(state) - 1)
         lattice%y(i) = (i - 1)/lattice_size(1) + disorder*(2*random(state) - 1)
      end do
      lattice%u = 0*lattice%x
      lattice%v = 0*lattice%x
   end function disturbed_lattice

   !> Rings of both spectra of waves in the largest rectangle inside the fluid.
   subroutine measure(snapshot, smoothing, largest, waves, measured, exact, problem)
      type(particle_snapshot_t), intent(inout) :: snapshot   !! its velocity becomes that of the waves
      real(dp), intent(in) :: smoothing, largest
      type(waves_t), intent(out) :: waves
      type(rings_t), intent(out) :: measured, exact
      type(failure), intent(inout) :: problem
      type(fluid_t) :: fluid
      type(gradient_fields_t) :: gradients
      type(grid_t) :: grid
      real(dp), allocatable :: share(:, :), values(:, :, :), field(:, :)
      real(dp) :: velocity(3)
      integer :: corners(4), i, j

      call sort_fluid(snapshot, fluid, problem)
      if (problem%raised()) return
      grid = covering_grid(snapshot)
      call filling(fluid, grid, share)
      corners = largest_rectangle(share >= 0.8_dp, 8)
      if (corners(1) == 0) call problem%raise(exit_input, 'no rectangle of 8 x 8 points at spacing dx is inside the fluid')
      if (problem%raised()) return
      grid%lower = grid%lower + grid%spacing*(corners(1:2) - 1)
      grid%n = corners(3:4) - corners(1:2) + 1
      call make_waves(grid, largest, waves)
      do i = 1, size(snapshot%x)
         velocity = waves_at(waves, [snapshot%x(i), snapshot%y(i)])
         snapshot%u(i) = velocity(1)
         snapshot%v(i) = velocity(2)
      end do
      call sort_fluid(snapshot, fluid, problem)
      call measure_gradients(fluid%model, fluid%p, fluid%near, gradients)
      call grid_values(fluid, smoothing*snapshot%spacing, grid, reshape(gradients%vorticity, [fluid%p%n_own, 1]), values)
      allocate (field(grid%n(1), grid%n(2)))
      do j = 1, grid%n(2)
         do i = 1, grid%n(1)
            velocity = waves_at(waves, grid%lower + grid%spacing*[i - 1, j - 1])
            field(i, j) = velocity(3)
         end do
      end do
      call new_rings(grid%n, grid%spacing, measured)
      call new_rings(grid%n, grid%spacing, exact)
      call add_spectrum(measured, values(:, :, 1), 'hann', 0.5_dp)
      call add_spectrum(exact, field, 'hann', 0.5_dp)
   end subroutine measure

   !> All waves of half the plane that are periodic in the grid's rectangle: vorticity of amplitude 1/k.
   subroutine make_waves(grid, largest, waves)
      type(grid_t), intent(in) :: grid
      real(dp), intent(in) :: largest   !! wavenumber, in pi/dx
      type(waves_t), intent(out) :: waves
      complex(dp) :: phase
      real(dp) :: k(2)
      integer(i8) :: state
      integer :: a, b, m(2)

      waves%lower = grid%lower
      waves%extent = grid%n*grid%spacing
      m = grid%n/2
      allocate (waves%u(0:m(1), -m(2):m(2)), waves%v(0:m(1), -m(2):m(2)), waves%vorticity(0:m(1), -m(2):m(2)))
      state = 1
      do b = -m(2), m(2)
         do a = 0, m(1)
            phase = exp(cmplx(0, 2*pi*random(state), dp))
            k = 2*pi*[a, b]/waves%extent
            if ((a == 0 .and. b <= 0) .or. norm2(k) > largest*pi/grid%spacing) phase = 0
            associate (amplitude => phase/max(norm2(k), tiny(1.0_dp)), square => max(sum(k**2), tiny(1.0_dp)))
               ! psi = -vorticity/k**2, u = -dpsi/dy, v = dpsi/dx
               waves%vorticity(a, b) = amplitude
               waves%u(a, b) = cmplx(0, k(2), dp)*amplitude/square
               waves%v(a, b) = -cmplx(0, k(1), dp)*amplitude/square
            end associate
         end do
      end do
   end subroutine make_waves

   !> u, v and vorticity at a place.
   pure function waves_at(waves, place) result(values)
      type(waves_t), intent(in) :: waves
      real(dp), intent(in) :: place(2)
      real(dp) :: values(3)
      complex(dp) :: along(0:ubound(waves%u, 1)), up(size(waves%u, 2))
      integer :: k, m

      m = ubound(waves%u, 2)
      associate (angle => 2*pi*(place - waves%lower)/waves%extent)
         along = exp([(cmplx(0, k*angle(1), dp), k=0, size(along) - 1)])
         up = exp([(cmplx(0, k*angle(2), dp), k=-m, m)])
      end associate
      values = real([sum(along*matmul(waves%u, up)), sum(along*matmul(waves%v, up)), sum(along*matmul(waves%vorticity, up))], dp)
   end function waves_at

   subroutine print_row(points, measured, exact, dx, smoothing)
      integer, intent(in) :: points(2)
      type(rings_t), intent(in) :: measured, exact
      real(dp), intent(in) :: dx, smoothing
      real(dp) :: k(size(exact%k)), ratio(size(exact%k)), largest(2), from(2), above(2)

      k = exact%k/exact%nyquist
      ratio = measured%power/max(exact%power, tiny(1.0_dp)) &
              /(transform_of_kernel(scheme_h*dx, exact%k)*transform_of_kernel(smoothing*dx, exact%k))**2
      ! Where there are no waves all is error.
      largest = [maxval(abs(ratio - 1), k >= 0.05_dp .and. k <= 0.25_dp), maxval(abs(ratio - 1), k > 0.25_dp .and. k <= 0.5_dp)]
      from = min(1.0_dp, [minval(k, ratio > 1.1_dp .and. k >= 0.05_dp), minval(k, ratio > 2 .and. k >= 0.05_dp)])
      above = [power_above(measured, pi/(2*scheme_h*dx)), power_above(measured, pi/(scheme_h*dx))]/measured%total
      write (output_unit, '(2i5, 2f8.4, 2f6.2, 2es9.1)') points, min(largest, 99.0_dp), from, above
   end subroutine print_row

end program spectra_accuracy
