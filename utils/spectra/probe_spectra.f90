!> Spectra of probes, averaged over repeated runs.
module probe_spectra
   use errors, only: exit_input, failure
   use kinds, only: dp
   use probe_signals, only: least_samples, signals_t
   use resampling, only: median_step, resample
   use text, only: short, to_text
   use text_table_reader, only: table_name_length
   use welch, only: count_segments, spectrum_t, welch_spectrum
   use windows, only: window_values
   implicit none
   private

   public :: compute_spectra, request_t, spectra_t

   integer, parameter :: most_samples = 10**8   !! of an even signal: 0.8 GB

   !> What the user asked for.
   type :: request_t
      character(table_name_length), allocatable :: probes(:)   !! none: all
      real(dp) :: from = -huge(1.0_dp), until = huge(1.0_dp)   !! range of time
      real(dp) :: segment = 0                    !! in time; 0: a quarter of the range
      real(dp) :: overlap = 0
      character(24) :: window = ''
      logical :: straight = .false.              !! a straight line is taken off, not the mean alone
      real(dp) :: rate = 0                       !! 0: that of the files
      real(dp) :: above = 0                      !! 0: no share is asked for
      real(dp) :: sound_speed = 0, length = 0, height = 0   !! 0: not known
      character(:), allocatable :: output
   end type request_t

   !> What came out.
   type :: spectra_t
      type(spectrum_t), allocatable :: mean(:)   !! (probes) over the runs
      real(dp), allocatable :: lowest(:, :), highest(:, :)   !! (frequencies, probes) over the runs
      real(dp) :: rate = 0                       !! even samples per unit of time
      real(dp) :: nyquist = 0                    !! highest frequency that all runs have
      integer :: length = 0                      !! of a segment, in samples
      real(dp) :: least_step = 0, median_step = 0, largest_step = 0   !! of the times in the files
   end type spectra_t

contains

   !> Spectra of all probes. Raises exit_input if segments or frequencies do not fit the signals.
   subroutine compute_spectra(runs, request, spectra, problem)
      type(signals_t), intent(in) :: runs(:)
      type(request_t), intent(in) :: request
      type(spectra_t), intent(out) :: spectra
      type(failure), intent(inout) :: problem
      type(spectrum_t) :: one
      integer :: i, k, kept

      call choose_rate(runs, request, spectra)
      call choose_length(runs, request, spectra, problem)
      if (request%above >= spectra%nyquist) call problem%raise(exit_input, '--above '//short(request%above) &
         //' is not below the highest frequency, '//short(spectra%nyquist)//' (half of 1/median step, or of --rate)')
      call check_scales(runs, problem)
      if (problem%raised()) return
      kept = min(spectra%length/2, floor(spectra%nyquist*spectra%length/spectra%rate + 1.0e-9_dp)) + 1
      allocate (spectra%mean(size(request%probes)))
      allocate (spectra%lowest(kept, size(request%probes)), spectra%highest(kept, size(request%probes)))
      do k = 1, size(request%probes)
         do i = 1, size(runs)
            one = welch_spectrum(resample(runs(i)%time, runs(i)%values(:, k), 1/spectra%rate), spectra%rate, request%overlap, &
                                 window_values(trim(request%window), spectra%length), request%straight)
            one%frequency = one%frequency(:kept)
            one%density = one%density(:kept)
            if (i == 1) then
               spectra%mean(k) = one
               spectra%lowest(:, k) = one%density
               spectra%highest(:, k) = one%density
            else
               call add_run(spectra%mean(k), one)
               spectra%lowest(:, k) = min(spectra%lowest(:, k), one%density)
               spectra%highest(:, k) = max(spectra%highest(:, k), one%density)
            end if
         end do
         spectra%mean(k)%density = spectra%mean(k)%density/size(runs)
      end do
   end subroutine compute_spectra

   ! Each run counts the same, however long it is.
   pure subroutine add_run(total, one)
      type(spectrum_t), intent(inout) :: total
      type(spectrum_t), intent(in) :: one

      total%density = total%density + one%density
      total%segments = total%segments + one%segments
      total%freedom = total%freedom + one%freedom
   end subroutine add_run

   !> The rate of the run with the shortest steps, so that nothing is folded; frequencies that all runs have.
   subroutine choose_rate(runs, request, spectra)
      type(signals_t), intent(in) :: runs(:)
      type(request_t), intent(in) :: request
      type(spectra_t), intent(inout) :: spectra
      real(dp) :: medians(size(runs))
      integer :: i

      spectra%least_step = huge(1.0_dp)
      do i = 1, size(runs)
         associate (t => runs(i)%time)
            medians(i) = median_step(t)
            spectra%least_step = min(spectra%least_step, minval(t(2:) - t(:size(t) - 1)))
            spectra%largest_step = max(spectra%largest_step, maxval(t(2:) - t(:size(t) - 1)))
         end associate
      end do
      spectra%median_step = minval(medians)
      spectra%rate = 1/spectra%median_step
      if (request%rate > 0) spectra%rate = request%rate
      spectra%nyquist = 0.5_dp*min(spectra%rate, 1/maxval(medians))
   end subroutine choose_rate

   !> Samples of a segment.
   subroutine choose_length(runs, request, spectra, problem)
      type(signals_t), intent(in) :: runs(:)
      type(request_t), intent(in) :: request
      type(spectra_t), intent(inout) :: spectra
      type(failure), intent(inout) :: problem
      real(dp) :: range, shortest, samples
      integer :: i

      shortest = huge(1.0_dp)
      do i = 1, size(runs)
         range = runs(i)%time(size(runs(i)%time)) - runs(i)%time(1)
         shortest = min(shortest, range)
         if (spectra%rate*range > most_samples) call problem%raise(exit_input, 'rate '//short(spectra%rate)//' makes more than ' &
            //to_text(most_samples)//' samples of '//runs(i)%table%path//'; choose a lower --rate')
         if (request%segment > range) call problem%raise(exit_input, '--segment '//short(request%segment) &
            //' is longer than the signal, '//short(range)//', in '//runs(i)%table%path)
      end do
      samples = spectra%rate*shortest/4
      if (request%segment > 0) samples = spectra%rate*request%segment
      if (problem%raised()) return
      spectra%length = nint(samples)
      if (spectra%length < least_samples) call problem%raise(exit_input, 'a segment of '//short(samples/spectra%rate)//' has ' &
         //to_text(spectra%length)//' samples, at least '//to_text(least_samples)//' are needed; --segment T makes it longer')
   end subroutine choose_length

   ! Repeated runs have one scale of time.
   subroutine check_scales(runs, problem)
      type(signals_t), intent(in) :: runs(:)
      type(failure), intent(inout) :: problem
      integer :: i

      do i = 2, size(runs)
         if (abs(runs(i)%scale/runs(1)%scale - 1) > 1.0e-6_dp) call problem%raise(exit_input, &
            'time_scaled of '//runs(i)%table%path//' is another than that of '//runs(1)%table%path//': no repeated runs')
      end do
   end subroutine check_scales

end module probe_spectra
