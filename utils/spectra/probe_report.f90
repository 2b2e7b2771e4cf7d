!> What dynsph-spectra probe writes: a table of spectra, and a few lines on the screen.
module probe_report
   use columns, only: column_unit_length, columns_t
   use errors, only: failure
   use file_system, only: delete_file, partial_path, publish
   use kinds, only: dp
   use probe_signals, only: signals_t
   use probe_spectra, only: request_t, spectra_t
   use table, only: table_t
   use text, only: short, to_text
   implicit none
   private

   public :: print_spectra, write_spectra

   integer, parameter :: head_length = 400

contains

   !> Writes the table of spectra; complete under its name, or not there.
   subroutine write_spectra(runs, request, spectra, problem)
      type(signals_t), intent(in) :: runs(:)
      type(request_t), intent(in) :: request
      type(spectra_t), intent(in) :: spectra
      type(failure), intent(inout) :: problem   !! exit_files: cannot be written
      character(head_length), allocatable :: head(:)
      character(:), allocatable :: ignored
      type(table_t) :: table
      type(columns_t) :: row
      integer :: i

      call make_head(runs, request, spectra, head)
      row = row_of(1, runs, spectra)
      call table%create(partial_path(request%output), head, row%names, row%units, problem)
      do i = 1, size(spectra%mean(1)%frequency)
         if (problem%raised()) exit
         row = row_of(i, runs, spectra)
         call table%row(row%values, problem)
      end do
      call table%close(problem)
      if (.not. problem%raised()) call publish(request%output, problem)
      if (problem%raised()) call delete_file(partial_path(request%output), ignored)
   end subroutine write_spectra

   function row_of(i, runs, spectra) result(row)
      integer, intent(in) :: i                  !! number of the frequency
      type(signals_t), intent(in) :: runs(:)
      type(spectra_t), intent(in) :: spectra
      type(columns_t) :: row
      character(column_unit_length) :: unit
      integer :: k

      call row%add('frequency', '1/time', spectra%mean(1)%frequency(i))
      call row%add('frequency_scaled', 'f '//scale_name(runs(1)), spectra%mean(1)%frequency(i)*runs(1)%scale)
      do k = 1, size(spectra%mean)
         associate (name => runs(1)%names(k))
            unit = trim(runs(1)%units(k))//'^2 time'
            call row%add('S_'//trim(name), unit, spectra%mean(k)%density(i))
            if (size(runs) == 1) cycle
            call row%add('S_min_'//trim(name), unit, spectra%lowest(i, k))
            call row%add('S_max_'//trim(name), unit, spectra%highest(i, k))
         end associate
      end do
   end function row_of

   ! What time_scaled is called, turned into the scale of a frequency: 't sqrt(g/d)' gives '/ sqrt(g/d)', 't U/d' '/ (U/d)'.
   pure function scale_name(run) result(name)
      type(signals_t), intent(in) :: run
      character(:), allocatable :: name
      integer :: k

      name = '* time/time_scaled'
      do k = 1, size(run%table%names)
         if (run%table%names(k) /= 'time_scaled' .or. index(run%table%units(k), 't ') /= 1) cycle
         name = '/ '//trim(run%table%units(k) (3:))
         if (index(name, 'sqrt') == 0 .and. index(name(3:), '/') > 0) name = '/ ('//name(3:)//')'
      end do
   end function scale_name

   subroutine make_head(runs, request, spectra, head)
      type(signals_t), intent(in) :: runs(:)
      type(request_t), intent(in) :: request
      type(spectra_t), intent(in) :: spectra
      character(head_length), allocatable, intent(out) :: head(:)
      integer :: i, k

      allocate (head(0))
      call say('title', runs(1)%table%head_text('title'))
      call say('what', 'one-sided power spectral density of probes, Welch''s method')
      do i = 1, size(runs)
         call say('file', runs(i)%table%path)
         call say('range', to_text(runs(i)%time(1))//' to '//to_text(runs(i)%time(size(runs(i)%time)))//', ' &
                  //to_text(size(runs(i)%time))//' samples')
      end do
      call say('steps', 'least '//short(spectra%least_step)//', median '//short(spectra%median_step)//', largest ' &
               //short(spectra%largest_step))
      call say('rate', to_text(spectra%rate))
      call say('segment', to_text(spectra%length/spectra%rate)//', '//to_text(spectra%length)//' samples')
      call say('overlap', to_text(request%overlap))
      call say('window', trim(request%window))
      call say('detrend', trim(merge('line', 'mean', request%straight)))
      call say('segments', to_text(spectra%mean(1)%segments))
      call say('degrees_of_freedom', short(spectra%mean(1)%freedom))
      if (request%sound_speed > 0) then
         call say('sound_speed', to_text(request%sound_speed))
         if (request%length > 0) call say('f_L', to_text(request%sound_speed/(2*request%length)))
         if (request%height > 0) call say('f_H', to_text(request%sound_speed/(2*request%height)))
      end if
      if (request%above > 0) call say('noise_above', to_text(request%above))
      do k = 1, size(spectra%mean)
         call say('variance of '//trim(runs(1)%names(k)), to_text(spectra%mean(k)%power_above(0.0_dp)))
         call say('peak of '//trim(runs(1)%names(k)), peak_text(spectra, k))
         if (request%above > 0) call say('noise share of '//trim(runs(1)%names(k)), to_text(noise_share(request, spectra, k)))
      end do

   contains

      subroutine say(key, words)
         character(*), intent(in) :: key, words

         head = [character(head_length) :: head, key//': '//words]
      end subroutine say

   end subroutine make_head

   !> Power above the frequency chosen over all power.
   pure real(dp) function noise_share(request, spectra, k)
      type(request_t), intent(in) :: request
      type(spectra_t), intent(in) :: spectra
      integer, intent(in) :: k

      noise_share = 0
      associate (all_of => spectra%mean(k)%power_above(0.0_dp))
         if (all_of > 0) noise_share = spectra%mean(k)%power_above(request%above)/all_of
      end associate
   end function noise_share

   pure function peak_text(spectra, k) result(words)
      type(spectra_t), intent(in) :: spectra
      integer, intent(in) :: k
      character(:), allocatable :: words

      words = 'none'
      if (spectra%mean(k)%peak() > 0) words = short(spectra%mean(k)%peak())
   end function peak_text

   !> What the spectra come to.
   subroutine print_spectra(unit, runs, request, spectra)
      integer, intent(in) :: unit
      type(signals_t), intent(in) :: runs(:)
      type(request_t), intent(in) :: request
      type(spectra_t), intent(in) :: spectra
      character(16) :: share
      integer :: k

      write (unit, '(a)') to_text(size(runs))//trim(merge(' run:  ', ' runs: ', size(runs) == 1))//' ' &
         //to_text(spectra%mean(1)%segments)//' segments of '//short(spectra%length/spectra%rate)//' ('//to_text(spectra%length) &
         //' samples, '//trim(request%window)//'), '//short(spectra%mean(1)%freedom)//' degrees of freedom, frequencies to ' &
         //short(spectra%nyquist)//' in steps of '//short(spectra%mean(1)%spacing)
      if (0.5_dp/spectra%largest_step < (1 - 1.0e-6_dp)*spectra%nyquist) write (unit, '(a)') 'the longest step, ' &
         //short(spectra%largest_step)//', shows frequencies to '//short(0.5_dp/spectra%largest_step)
      if (request%sound_speed > 0 .and. request%length > 0) write (unit, '(a)') 'c0/(2L) = ' &
         //short(request%sound_speed/(2*request%length))
      if (request%sound_speed > 0 .and. request%height > 0) write (unit, '(a)') 'c0/(2H) = ' &
         //short(request%sound_speed/(2*request%height))
      if (spectra%rate < (1 - 1.0e-9_dp)/spectra%median_step) write (unit, '(a)') 'note: --rate is below that of the samples (' &
         //short(1/spectra%median_step)//'): what is faster than '//short(spectra%rate/2)//' is folded back, not left out'
      if (runs(1)%left_out /= '') write (unit, '(a)') 'left out, constant or of another unit: '//runs(1)%left_out
      share = ''
      if (request%above > 0) share = 'above '//short(request%above)
      write (unit, '(a32, 4a16)') 'probe                           ', 'variance', 'deviation', 'peak at', adjustr(share)
      do k = 1, size(spectra%mean)
         if (request%above > 0) write (share, '(f14.4, " %")') 100*noise_share(request, spectra, k)
         write (unit, '(a32, 2es16.4e3, 2a16)') runs(1)%names(k), spectra%mean(k)%power_above(0.0_dp), &
            sqrt(spectra%mean(k)%power_above(0.0_dp)), right(peak_text(spectra, k)), share
      end do
      write (unit, '(a)') request%output
   end subroutine print_spectra

   pure function right(words) result(cell)
      character(*), intent(in) :: words
      character(16) :: cell

      cell = words
      cell = adjustr(cell)
   end function right

end module probe_report
