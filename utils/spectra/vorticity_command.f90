!> dynsph-spectra vorticity: spectra of enstrophy and kinetic energy in a rectangle inside the fluid.
module vorticity_command
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan, ieee_quiet_nan, ieee_value
   use, intrinsic :: iso_fortran_env, only: output_unit
   use errors, only: exit_files, exit_input, failure
   use file_system, only: path_exists, write_whole_file
   use gradient_fields, only: gradient_fields_t, measure_gradients
   use interpolation, only: covering_grid, filling, fluid_t, grid_t, grid_values, scheme_h, sort_fluid
   use kernel_transform, only: transform_of_kernel
   use kinds, only: dp
   use options, only: options_t
   use particle_snapshot, only: particle_snapshot_t, read_snapshot
   use plane_spectrum, only: add_spectrum, new_rings, power_above, rings_t
   use rectangles, only: largest_rectangle
   use text, only: behind, parse_real, quoted, short, to_text
   use windows, only: window_names
   implicit none
   private

   public :: run_vorticity_command

   real(dp), parameter :: pi = acos(-1.0_dp)
   integer, parameter :: fewest = 8           !! points across a rectangle

   !> What the user asks for.
   type :: request_t
      real(dp) :: smoothing = 1.25_dp         !! h/dx of the interpolation
      real(dp) :: least_filling = 0.8_dp
      real(dp) :: rectangle(4) = 0            !! x0, y0, x1, y1
      logical :: has_rectangle = .false.
      character(8) :: window = 'hann'
      logical :: with_field = .false.
      logical :: overwrite = .false.
   end type request_t

contains

   !> Raises exit_input for what is asked wrongly, exit_files for what cannot be read, written or transformed.
   subroutine run_vorticity_command(arguments, problem)
      character(*), intent(in) :: arguments(:)
      type(failure), intent(inout) :: problem
      type(options_t) :: options
      type(request_t) :: request
      integer :: i

      call declare(options)
      call options%parse(arguments, problem)
      if (problem%raised()) return
      if (options%help) then
         call write_usage(options)
         return
      end if
      if (size(options%files) == 0) call problem%raise(exit_input, options%command//': which snapshots? '//options%command// &
                                                       ' --help shows an example')
      call take_request(options, request, problem)
      if (problem%raised()) return
      ! Before anything is written.
      do i = 1, size(options%files)
         if (.not. request%overwrite) call check_outputs(trim(options%files(i)), request%with_field, problem)
      end do
      if (problem%raised()) return
      do i = 1, size(options%files)
         call transform_snapshot(trim(options%files(i)), request, i == 1, problem)
         if (problem%raised()) return
      end do
   end subroutine run_vorticity_command

   subroutine declare(options)
      type(options_t), intent(inout) :: options

      options%command = 'dynsph-spectra vorticity'
      call options%add('--rectangle', 'X0,Y0,X1,Y1', '', &
                       'where, in the units of the run; else the largest rectangle in the fluid')
      call options%add('--window', 'NAME', 'hann', 'hann, hamming, blackman or none')
      call options%add('--smoothing', 'H/DX', '1.25', 'smoothing length of the interpolation, over dx')
      call options%add('--filling', 'SHARE', '0.8', 'least sum of W V that counts as inside the fluid')
      call options%add('--field', '', '', 'write the vorticity of all the fluid on the grid too, for pictures')
      call options%add('--overwrite', '', '', 'replace spectra that are there')
   end subroutine declare

   subroutine write_usage(options)
      type(options_t), intent(in) :: options

      write (output_unit, '(a)') 'usage: dynsph-spectra vorticity [options] SNAPSHOT.vtkhdf...', '', &
         'Writes vorticity_spectrum_NNNNNN.dat beside each snapshot_NNNNNN.vtkhdf: enstrophy and kinetic energy over', &
         'wavenumber, of what differs from the mean in a rectangle inside the fluid. Prints their sums, and the shares above', &
         'the wavenumbers pi/(2h) and pi/h, where the kernel resolves little and nothing: noise.', &
         'docs/spectra.md has the definitions.', ''
      call options%write_help(output_unit)
      write (output_unit, '(a)') '', &
         'example: dynsph-spectra vorticity --rectangle 0.5,0.02,4.8,0.3 results/dam_break/snapshot_000020.vtkhdf'
   end subroutine write_usage

   subroutine take_request(options, request, problem)
      type(options_t), intent(in) :: options
      type(request_t), intent(out) :: request
      type(failure), intent(inout) :: problem

      request%smoothing = options%real_number('--smoothing', problem)
      request%least_filling = options%real_number('--filling', problem)
      request%window = options%word('--window')
      request%with_field = options%given('--field')
      request%overwrite = options%given('--overwrite')
      request%has_rectangle = options%given('--rectangle')
      if (request%has_rectangle) call take_rectangle(options%word('--rectangle'), options%command, request%rectangle, problem)
      if (problem%raised()) return
      call options%check_choice('--window', window_names, problem)
      if (.not. (request%smoothing >= 1 .and. request%smoothing <= 4)) &
         call problem%raise(exit_input, options%command//': --smoothing must be from 1 to 4')
      if (.not. (request%least_filling > 0 .and. request%least_filling < 1)) &
         call problem%raise(exit_input, options%command//': --filling must be between 0 and 1')
   end subroutine take_request

   subroutine take_rectangle(word, command, rectangle, problem)
      character(*), intent(in) :: word, command
      real(dp), intent(out) :: rectangle(4)
      type(failure), intent(inout) :: problem
      character(:), allocatable :: message, rest
      integer :: comma, k

      rectangle = 0
      rest = word//','
      do k = 1, 4
         comma = index(rest, ',')
         if (comma == 0) exit
         call parse_real(trim(adjustl(rest(:comma - 1))), rectangle(k), message)
         if (message /= '') exit
         rest = behind(rest, comma)
      end do
      if (k <= 4 .or. rest /= '') then
         call problem%raise(exit_input, command//': --rectangle '//quoted(word)//': write four numbers x0,y0,x1,y1')
      else if (any(rectangle(3:4) <= rectangle(1:2))) then
         call problem%raise(exit_input, command//': --rectangle '//quoted(word)//': x1, y1 must be above x0, y0')
      end if
   end subroutine take_rectangle

   !> One snapshot: reads, interpolates, transforms, writes.
   subroutine transform_snapshot(path, request, first, problem)
      character(*), intent(in) :: path
      type(request_t), intent(in) :: request
      logical, intent(in) :: first   !! what is printed begins with a head
      type(failure), intent(inout) :: problem
      type(particle_snapshot_t) :: snapshot
      type(grid_t) :: grid
      type(rings_t) :: enstrophy, energy
      type(fluid_t) :: fluid
      type(gradient_fields_t) :: gradients
      real(dp), allocatable :: values(:, :, :)
      real(dp) :: h
      integer :: corners(4)

      call read_snapshot(path, snapshot, problem)
      if (problem%raised()) return
      h = request%smoothing*snapshot%spacing
      call sort_fluid(snapshot, fluid, problem)
      if (problem%raised()) return
      grid = covering_grid(snapshot)
      call choose_rectangle(fluid, request, grid, path, corners, problem)
      if (problem%raised()) return
      call measure_gradients(fluid%model, fluid%p, fluid%near, gradients)
      if (request%with_field) call write_field(path, snapshot, fluid, h, gradients%vorticity, problem)
      grid%lower = grid%lower + grid%spacing*(corners(1:2) - 1)
      grid%n = corners(3:4) - corners(1:2) + 1
      associate (n => fluid%p%n_own, base => fluid%p%base)
         call grid_values(fluid, h, grid, reshape([gradients%vorticity, base%u(:n), base%v(:n)], [n, 3]), values)
      end associate
      if (any(ieee_is_nan(values))) then
         call problem%raise(exit_input, path//': too few particles are near some points of the rectangle; choose another '// &
                            '--rectangle or a larger --filling')
         return
      end if
      call new_rings(grid%n, grid%spacing, enstrophy)
      call new_rings(grid%n, grid%spacing, energy)
      call add_spectrum(enstrophy, values(:, :, 1), request%window, 0.5_dp)
      call add_spectrum(energy, values(:, :, 2), request%window, 0.5_dp)
      call add_spectrum(energy, values(:, :, 3), request%window, 0.5_dp)
      call write_spectrum(path, snapshot, request, h, grid, enstrophy, energy, problem)
      if (problem%raised()) return
      if (first) write (output_unit, '(a)') &
         '        time    enstrophy  above pi/2h   above pi/h       energy  above pi/2h   above pi/h   x0, y0, x1, y1   file'
      associate (last => grid%lower + grid%spacing*(grid%n - 1))
         write (output_unit, '(f12.5, 2(es13.3, 2f13.6), 3x, 9a)') snapshot%time, enstrophy%total, &
            shares(enstrophy, snapshot%spacing), energy%total, shares(energy, snapshot%spacing), &
            short(grid%lower(1)), ', ', short(grid%lower(2)), ', ', short(last(1)), ', ', short(last(2)), '   ', path
      end associate
   end subroutine transform_snapshot

   !> Raises exit_input if what a snapshot gives is there already.
   subroutine check_outputs(path, with_field, problem)
      character(*), intent(in) :: path
      logical, intent(in) :: with_field
      type(failure), intent(inout) :: problem

      call must_not_be_there(output_name(path, 'spectrum'), problem)
      if (with_field) call must_not_be_there(output_name(path, 'field'), problem)
   end subroutine check_outputs

   subroutine must_not_be_there(path, problem)
      character(*), intent(in) :: path
      type(failure), intent(inout) :: problem

      if (path_exists(path)) call problem%raise(exit_input, "'"//path//"' is there already; --overwrite replaces it")
   end subroutine must_not_be_there

   !> The grid points asked for, or the largest rectangle of points inside the fluid.
   !! Raises exit_input if it is too small or reaches out of the fluid.
   subroutine choose_rectangle(fluid, request, grid, path, corners, problem)
      type(fluid_t), intent(in) :: fluid
      type(request_t), intent(in) :: request
      type(grid_t), intent(inout) :: grid
      character(*), intent(in) :: path
      integer, intent(out) :: corners(4)   !! [i1, j1, i2, j2]
      type(failure), intent(inout) :: problem
      real(dp), allocatable :: share(:, :)

      corners = 0
      if (request%has_rectangle) then
         grid%lower = request%rectangle(1:2)
         grid%n = nint(min((request%rectangle(3:4) - request%rectangle(1:2))/grid%spacing, 1.0e8_dp)) + 1
      end if
      if (request%has_rectangle .and. any(grid%n < fewest)) then
         call problem%raise(exit_input, path//': --rectangle has '//to_text(grid%n(1))//' x '//to_text(grid%n(2)) &
                            //' points at spacing dx, and '//to_text(fewest)//' each way are needed')
         return
      else if (product(real(grid%n, dp)) > 1.0e9_dp) then
         call problem%raise(exit_input, path//': a grid of '//to_text(grid%n(1))//' x '//to_text(grid%n(2))// &
                            ' points at spacing dx is too large; choose a part of the fluid by --rectangle')
         return
      end if
      call filling(fluid, grid, share)
      if (request%has_rectangle) then
         corners = [1, 1, grid%n]
         if (any(share < request%least_filling)) call problem%raise(exit_input, path//': '//short(100*count(share < &
            request%least_filling)/real(size(share), dp))//' % of --rectangle is not inside the fluid (sum W V below ' &
            //short(request%least_filling)//'); without it the largest rectangle in the fluid is found')
      else
         corners = largest_rectangle(share >= request%least_filling, fewest)
         if (corners(1) == 0) call problem%raise(exit_input, path//': no rectangle of '//to_text(fewest)//' x '//to_text(fewest) &
            //' points at spacing dx is inside the fluid (sum W V >= '//short(request%least_filling)//')')
      end if
   end subroutine choose_rectangle

   !> Shares above pi/(2h) and pi/h of the scheme.
   pure function shares(rings, spacing)
      type(rings_t), intent(in) :: rings
      real(dp), intent(in) :: spacing
      real(dp) :: shares(2)

      shares = 0
      if (rings%total > 0) &
         shares = [power_above(rings, pi/(2*scheme_h*spacing)), power_above(rings, pi/(scheme_h*spacing))]/rings%total
   end function shares

   subroutine write_spectrum(path, snapshot, request, h, grid, enstrophy, energy, problem)
      character(*), intent(in) :: path
      type(particle_snapshot_t), intent(in) :: snapshot
      type(request_t), intent(in) :: request
      real(dp), intent(in) :: h
      type(grid_t), intent(in) :: grid
      type(rings_t), intent(in) :: enstrophy, energy
      type(failure), intent(inout) :: problem
      character(:), allocatable :: content
      character(200) :: line
      integer :: k

      content = ''
      call add('# title: '//snapshot%title)
      call add('# snapshot: '//path)
      call add_numbers('time', [snapshot%time])
      call add_numbers('spacing', [snapshot%spacing])
      call add_numbers('interpolation_h', [h])
      call add_numbers('rectangle', [grid%lower, grid%lower + grid%spacing*(grid%n - 1)])
      call add('# grid: '//to_text(grid%n(1))//' x '//to_text(grid%n(2)))
      call add('# window: '//trim(request%window))
      call add_numbers('kernel_wavenumbers', [pi/(2*scheme_h*snapshot%spacing), pi/(scheme_h*snapshot%spacing)])
      call add_numbers('nyquist', [enstrophy%nyquist])
      call add_numbers('enstrophy', [enstrophy%total])
      call add_numbers('enstrophy_shares_above', shares(enstrophy, snapshot%spacing))
      call add_numbers('energy', [energy%total])
      call add_numbers('energy_shares_above', shares(energy, snapshot%spacing))
      call add('# enstrophy vorticity**2/2 and energy |u|**2/2 of what differs from the mean, weighted by the window; the sum')
      call add('# of the rows times their width is that, but for what is above nyquist')
      call add('# columns, name [unit]:')
      call add('#   1  wavenumber [1/length]')
      call add('#   2  kh/pi [-]')
      call add('#   3  width [1/length] of the ring')
      call add('#   4  enstrophy_spectrum [length/time**2]')
      call add('#   5  energy_spectrum [length**3/time**2]')
      call add('#   6  enstrophy_left [-] of a wave''s enstrophy, behind derivative and interpolation')
      call add('#   7  energy_left [-] of a wave''s energy, behind the interpolation')
      call add('               wavenumber                    kh/pi                    width       enstrophy_spectrum' &
               //'          energy_spectrum           enstrophy_left              energy_left')
      do k = 1, size(enstrophy%k)
         associate (w => enstrophy%k(k), dk => enstrophy%width(k), derivative_h => scheme_h*snapshot%spacing)
            write (line, '(7es25.16e3)') w, w*derivative_h/pi, dk, enstrophy%power(k)/dk, energy%power(k)/dk, &
               (transform_of_kernel(derivative_h, w)*transform_of_kernel(h, w))**2, transform_of_kernel(h, w)**2
         end associate
         call add(trim(line))
      end do
      call write_whole_file(output_name(path, 'spectrum'), content, problem)

   contains

      subroutine add(words)
         character(*), intent(in) :: words

         content = content//words//new_line('a')
      end subroutine add

      subroutine add_numbers(key, numbers)
         character(*), intent(in) :: key
         real(dp), intent(in) :: numbers(:)

         write (line, '(*(es24.15e3))') numbers
         call add('# '//key//': '//trim(adjustl(line)))
      end subroutine add_numbers

   end subroutine write_spectrum

   !> The vorticity of all the fluid at spacing dx, a row of numbers for each y, NaN where there is no fluid.
   subroutine write_field(path, snapshot, fluid, h, vorticity, problem)
      character(*), intent(in) :: path
      type(particle_snapshot_t), intent(in) :: snapshot
      type(fluid_t), intent(in) :: fluid
      real(dp), intent(in) :: h
      real(dp), intent(in) :: vorticity(:)   !! (slots)
      type(failure), intent(inout) :: problem
      real(dp), allocatable :: share(:, :), values(:, :, :)
      type(grid_t) :: grid
      character(:), allocatable :: row
      character(:), allocatable :: content
      character(240) :: line
      integer :: j

      grid = covering_grid(snapshot)
      call filling(fluid, grid, share)
      call grid_values(fluid, h, grid, reshape(vorticity, [size(vorticity), 1]), values)
      where (share < 0.5_dp) values(:, :, 1) = ieee_value(1.0_dp, ieee_quiet_nan)
      allocate (character(11*grid%n(1) + 1) :: row)
      allocate (character(grid%n(2)*len(row)) :: content)
      do j = 1, grid%n(2)
         write (row, '(*(es11.3))') values(:, j, 1)
         row(len(row):) = new_line('a')
         content((j - 1)*len(row) + 1:j*len(row)) = row
      end do
      write (line, '(3(a, es23.15e3), a, 2es23.15e3, a)') '# time: ', snapshot%time, new_line('a')//'# spacing: ', grid%spacing, &
         new_line('a')//'# reference_length: ', snapshot%reference_length, new_line('a')//'# lower: ', grid%lower, new_line('a')
      call write_whole_file(output_name(path, 'field'), '# title: '//snapshot%title//new_line('a')//trim(line)//content, problem)
   end subroutine write_field

   !> .../vorticity_spectrum_000020.dat for .../snapshot_000020.vtkhdf; another name is put behind vorticity_spectrum_.
   pure function output_name(path, kind) result(name)
      character(*), intent(in) :: path, kind
      character(:), allocatable :: name
      character(:), allocatable :: stem
      integer :: dot, slash

      slash = index(path, '/', back=.true.)
      stem = path(slash + 1:)
      dot = index(stem, '.', back=.true.)
      if (dot > 1) stem = stem(:dot - 1)
      if (index(stem, 'snapshot_') == 1) stem = behind(stem, len('snapshot_'))
      name = path(:slash)//'vorticity_'//kind//'_'//stem//'.dat'
   end function output_name

end module vorticity_command
