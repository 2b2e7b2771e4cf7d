!> dynsph-spectra probe: power spectral density of the signals of probes (docs/spectra.md).
module probe_command
   use, intrinsic :: iso_fortran_env, only: output_unit
   use errors, only: exit_input, failure
   use file_system, only: path_exists
   use kinds, only: dp
   use options, only: options_t
   use probe_report, only: print_spectra, write_spectra
   use probe_signals, only: load_signals, signals_t
   use probe_spectra, only: compute_spectra, request_t, spectra_t
   use text, only: quoted, short
   use text_table_reader, only: table_name_length
   use windows, only: window_names
   implicit none
   private

   public :: run_probe_command

contains

   subroutine run_probe_command(arguments, problem)
      character(*), intent(in) :: arguments(:)
      type(failure), intent(inout) :: problem
      type(options_t) :: options
      type(request_t) :: request
      type(signals_t), allocatable :: runs(:)
      type(spectra_t) :: spectra
      integer :: i

      call declare(options)
      call options%parse(arguments, problem)
      if (problem%raised()) return
      if (options%help) then
         call print_help(options)
         return
      end if
      if (size(options%files) == 0) call problem%raise(exit_input, options%command//': which tables? '//options%command &
                                                       //' probes.dat; --help tells more')
      if (.not. problem%raised()) call take_request(options, request, problem)
      if (problem%raised()) return
      allocate (runs(size(options%files)))
      do i = 1, size(runs)
         call load_signals(trim(options%files(i)), request%probes, request%from, request%until, runs(i), problem)
         if (problem%raised()) return
         if (i == 1) request%probes = runs(1)%names   ! the others must have them too
      end do
      call take_box(options, runs(1), request, problem)
      if (.not. problem%raised()) call compute_spectra(runs, request, spectra, problem)
      if (.not. problem%raised()) call write_spectra(runs, request, spectra, problem)
      if (.not. problem%raised()) call print_spectra(output_unit, runs, request, spectra)
   end subroutine run_probe_command

   subroutine declare(options)
      type(options_t), intent(inout) :: options

      options%command = 'dynsph-spectra probe'
      call options%add('--probe', 'NAME,...', '', 'columns to take [all in the unit of the first one, but constant ones]')
      call options%add('--from', 'T', '', 'leave out what is before, in the unit of the column time')
      call options%add('--to', 'T', '', 'leave out what is after')
      call options%add('--segment', 'T', '', 'length of a segment in time [a quarter of the range]')
      call options%add('--overlap', 'X', '0.5', 'share of a segment that the next one has too, 0 <= X < 1')
      call options%add('--window', 'NAME', 'hann', 'hann, hamming, blackman or none')
      call options%add('--detrend', 'NAME', 'mean', 'what is taken off each segment: mean or line')
      call options%add('--rate', 'F', '', 'even samples per unit of time [1/median step, the largest of the files]')
      call options%add('--above', 'F', '', 'say which share of the power is above this frequency')
      call options%add('--length', 'L', '', 'width of the box, for the mode c0/(2L) [from the table]')
      call options%add('--height', 'H', '', 'height of the fluid, for the mode c0/(2H) [from the table]')
      call options%add('--sound-speed', 'C', '', 'c0 [from the table]')
      call options%add('--output', 'FILE', '', 'table to write [probe_spectrum.dat beside the first file]')
      call options%add('--overwrite', '', '', 'replace it if it is there')
   end subroutine declare

   subroutine print_help(options)
      type(options_t), intent(in) :: options

      write (output_unit, '(a)') &
         'usage: dynsph-spectra probe PROBES.DAT... [options]', '', &
         'One-sided power spectral density of pressure signals by Welch''s method. Steps may be uneven: the signal is', &
         'brought to even ones by a cubic spline. Several files are repeated runs: their spectra are averaged.', ''
      call options%write_help(output_unit)
      write (output_unit, '(a)') '', &
         'example: what the impact leaves in probe P1, and the share above f = 50', &
         '   dynsph-spectra probe result/probes.dat --probe P1 --from 6 --segment 2 --above 50', &
         '   gnuplot -e "tables=''result/probe_spectrum.dat''" utils/plots/probe_spectra.gp'
   end subroutine print_help

   subroutine take_request(options, request, problem)
      type(options_t), intent(in) :: options
      type(request_t), intent(out) :: request
      type(failure), intent(inout) :: problem
      character(:), allocatable :: first

      call take_list(options%word('--probe'), request%probes)
      if (options%given('--from')) request%from = options%real_number('--from', problem)
      if (options%given('--to')) request%until = options%real_number('--to', problem)
      if (.not. request%from < request%until) call problem%raise(exit_input, options%command//': --from '//short(request%from) &
                                                                 //' is not before --to '//short(request%until))
      call take_positive(options, '--segment', request%segment, problem)
      call take_positive(options, '--rate', request%rate, problem)
      call take_positive(options, '--above', request%above, problem)
      request%overlap = options%real_number('--overlap', problem)
      if (request%overlap < 0 .or. request%overlap >= 1) call problem%raise(exit_input, options%command//': --overlap ' &
                                                        //options%word('--overlap')//' is out of range: 0 or more, less than 1')
      request%window = options%word('--window')
      call options%check_choice('--window', window_names, problem)
      call options%check_choice('--detrend', [character(8) :: 'mean', 'line'], problem)
      request%straight = options%word('--detrend') == 'line'

      first = trim(options%files(1))
      request%output = options%word('--output')
      if (request%output == '') request%output = first(:index(first, '/', back=.true.))//'probe_spectrum.dat'
      if (any(options%files == request%output)) call problem%raise(exit_input, options%command//': --output ' &
                                                                   //quoted(request%output)//' is a table to read')
      if (.not. path_exists(request%output)) return
      if (.not. options%given('--overwrite')) then
         call problem%raise(exit_input, quoted(request%output)//' is there already; --overwrite replaces it, --output FILE '// &
                            'names another')
      else if (.not. is_spectrum(request%output)) then
         call problem%raise(exit_input, quoted(request%output)//' is not a table of spectra and is not replaced; --output FILE '// &
                            'names another')
      end if
   end subroutine take_request

   !> What the box is like: options, else what the first table says, else 0.
   subroutine take_box(options, run, request, problem)
      type(options_t), intent(in) :: options
      type(signals_t), intent(in) :: run
      type(request_t), intent(inout) :: request
      type(failure), intent(inout) :: problem

      request%sound_speed = run%table%head_number('sound_speed')
      request%length = run%table%head_number('domain_width')
      request%height = run%table%head_number('fluid_height')
      call take_positive(options, '--sound-speed', request%sound_speed, problem)
      call take_positive(options, '--length', request%length, problem)
      call take_positive(options, '--height', request%height, problem)
      if ((options%given('--length') .or. options%given('--height')) .and. .not. request%sound_speed > 0) &
         call problem%raise(exit_input, options%command//': modes of the box need --sound-speed, which the table does not tell')
   end subroutine take_box

   subroutine take_positive(options, name, number, problem)
      type(options_t), intent(in) :: options
      character(*), intent(in) :: name
      real(dp), intent(inout) :: number          !! stays if the user did not say it
      type(failure), intent(inout) :: problem

      if (.not. options%given(name)) return
      number = options%real_number(name, problem)
      if (.not. (number > 0 .or. problem%raised())) call problem%raise(exit_input, options%command//': '//name//' ' &
                                                                       //options%word(name)//' must be above 0')
   end subroutine take_positive

   !> Whether a file is what this command writes, so that nothing else is replaced.
   logical function is_spectrum(path)
      character(*), intent(in) :: path
      character(200) :: line
      integer :: status, unit

      is_spectrum = .false.
      open (newunit=unit, file=path, status='old', action='read', iostat=status)
      if (status /= 0) return
      do while (.not. is_spectrum)
         read (unit, '(a)', iostat=status) line
         if (status /= 0 .or. line(1:1) /= '#') exit
         is_spectrum = index(line, '# what: one-sided power spectral density') == 1
      end do
      close (unit)
   end function is_spectrum

   ! The words between commas.
   subroutine take_list(list, words)
      character(*), intent(in) :: list
      character(table_name_length), allocatable, intent(out) :: words(:)
      integer :: at, comma

      allocate (words(0))
      at = 1
      do while (at <= len(list))
         comma = index(list(at:)//',', ',') + at - 1
         ! A name said twice is taken once.
         associate (word => list(at:comma - 1))
            if (word /= '' .and. .not. any(words == word)) words = [character(table_name_length) :: words, word]
         end associate
         at = comma + 1
      end do
   end subroutine take_list

end module probe_command
