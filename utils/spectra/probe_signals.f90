!> Signals of probes out of the tables that runs write.
module probe_signals
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use errors, only: exit_files, exit_input, failure
   use kinds, only: dp
   use text, only: behind, short, to_text
   use text_table_reader, only: read_text_table, table_name_length, text_table_t
   implicit none
   private

   public :: signals_t, load_signals

   integer, parameter, public :: least_samples = 16   !! of a segment, and so of a signal

   !> What one run's probes measured.
   type :: signals_t
      type(text_table_t) :: table                              !! its head, names, units; no values
      character(table_name_length), allocatable :: names(:)    !! (probes)
      character(table_name_length), allocatable :: units(:)    !! (probes)
      real(dp), allocatable :: time(:)                         !! (samples)
      real(dp), allocatable :: values(:, :)                    !! (samples, probes)
      real(dp) :: scale = 1                                    !! time over time_scaled
      character(:), allocatable :: left_out                    !! names of columns passed over, '' if none was
   end type signals_t

contains

   !> Reads the probes asked for within a range of time.
   subroutine load_signals(path, wanted, from, until, signals, problem)
      character(*), intent(in) :: path
      character(*), intent(in) :: wanted(:)       !! names of columns; none: all in the first probe's unit that vary
      real(dp), intent(in) :: from, until         !! in the unit of the column time
      type(signals_t), intent(out) :: signals
      type(failure), intent(inout) :: problem     !! what is missing or not a number, with file and line
      integer, allocatable :: places(:), rows(:)
      integer :: i, time, time_scaled

      call read_text_table(path, signals%table, problem)
      if (problem%raised()) return
      associate (table => signals%table)
         time = table%column('time', problem)
         time_scaled = table%column('time_scaled', problem)
         if (problem%raised()) return
         if (size(wanted) > 0) then
            allocate (places(size(wanted)))
            do i = 1, size(wanted)
               places(i) = table%column(trim(wanted(i)), problem)
               if (problem%raised()) return
            end do
         else if (size(table%names) < 3) then
            call problem%raise(exit_files, table%path//': no column but times: there is no probe')
            return
         end if
         call check_times(table, time, problem)
         if (problem%raised()) return
         rows = pack([(i, i=1, size(table%values, 2))], table%values(time, :) >= from .and. table%values(time, :) <= until)
         call check_number_of_rows(table, time, size(rows), problem)
         if (problem%raised()) return
         signals%left_out = ''
         if (.not. allocated(places)) call choose_columns(table, rows, places, signals%left_out, problem)
         if (problem%raised()) return
         signals%names = table%names(places)
         signals%units = table%units(places)
         call check_values(table, places, rows, problem)
         if (.not. problem%raised()) call take_scale(table, time, time_scaled, rows, signals%scale, problem)
         if (problem%raised()) return
         signals%time = table%values(time, rows)
         signals%values = transpose(table%values(places, rows))
         deallocate (table%values)
      end associate
   end subroutine load_signals

   !> All columns that are no times, have the unit of the first of them and vary: a dry probe says nothing.
   subroutine choose_columns(table, rows, places, left_out, problem)
      type(text_table_t), intent(in) :: table
      integer, intent(in) :: rows(:)
      integer, allocatable, intent(out) :: places(:)
      character(:), allocatable, intent(out) :: left_out
      type(failure), intent(inout) :: problem
      logical :: is_probe(size(table%names)), is_taken(size(table%names))
      integer :: i

      is_probe = table%names /= 'time' .and. table%names /= 'time_scaled'
      is_taken = is_probe
      left_out = ''
      do i = 1, size(table%names)
         if (.not. is_probe(i)) cycle
         is_taken(i) = table%units(i) == table%units(findloc(is_probe, .true., dim=1))
         associate (y => table%values(i, rows))
            ! What is not finite has a message of its own.
            if (all(ieee_is_finite(y))) is_taken(i) = is_taken(i) .and. maxval(y) > minval(y)
         end associate
         if (.not. is_taken(i)) left_out = left_out//', '//trim(table%names(i))
      end do
      left_out = behind(left_out, len(', '))
      places = pack([(i, i=1, size(table%names))], is_taken)
      if (size(places) == 0) then
         call problem%raise(exit_input, table%path//': '//left_out//': the same all the time, or of another unit; --from and '// &
                            '--to choose another range, --probe columns')
      end if
   end subroutine choose_columns

   subroutine take_scale(table, time, time_scaled, rows, scale, problem)
      type(text_table_t), intent(in) :: table
      integer, intent(in) :: time, time_scaled, rows(:)
      real(dp), intent(out) :: scale
      type(failure), intent(inout) :: problem
      real(dp) :: span

      scale = 1
      associate (first => rows(1), last => rows(size(rows)))
         span = 0
         if (all(ieee_is_finite(table%values(time_scaled, [first, last])))) &
            span = table%values(time_scaled, last) - table%values(time_scaled, first)
         if (span > 0) then
            scale = (table%values(time, last) - table%values(time, first))/span
         else
            call problem%raise(exit_files, place(table, last)//': time_scaled does not rise with time')
         end if
      end associate
   end subroutine take_scale

   subroutine check_times(table, time, problem)
      type(text_table_t), intent(in) :: table
      integer, intent(in) :: time
      type(failure), intent(inout) :: problem
      integer :: i

      do i = 1, size(table%values, 2)
         if (.not. ieee_is_finite(table%values(time, i))) then
            call problem%raise(exit_files, place(table, i)//': time is not finite')
            return
         end if
         if (i == 1) cycle
         if (table%values(time, i) > table%values(time, i - 1)) cycle
         call problem%raise(exit_files, place(table, i)//': time '//short(table%values(time, i))//' is not after the row before')
         return
      end do
   end subroutine check_times

   subroutine check_number_of_rows(table, time, rows, problem)
      type(text_table_t), intent(in) :: table
      integer, intent(in) :: time, rows
      type(failure), intent(inout) :: problem
      character(:), allocatable :: held

      if (rows >= least_samples .or. problem%raised()) return
      held = ''
      if (size(table%values, 2) > 0) held = '; the table holds t = '//short(table%values(time, 1))//' to ' &
                                            //short(table%values(time, size(table%values, 2)))
      call problem%raise(exit_input, table%path//': '//to_text(rows)//' samples in the range of time, at least ' &
                         //to_text(least_samples)//' are needed'//held)
   end subroutine check_number_of_rows

   ! All finite, and no probe without a signal.
   subroutine check_values(table, places, rows, problem)
      type(text_table_t), intent(in) :: table
      integer, intent(in) :: places(:), rows(:)
      type(failure), intent(inout) :: problem
      integer :: i, k

      do k = 1, size(places)
         do i = 1, size(rows)
            if (ieee_is_finite(table%values(places(k), rows(i)))) cycle
            call problem%raise(exit_files, place(table, rows(i))//': '//trim(table%names(places(k)))//' is not a finite number' &
                               //'; --from and --to leave times out')
            return
         end do
         associate (y => table%values(places(k), rows))
            if (maxval(y) > minval(y)) cycle
            call problem%raise(exit_input, table%path//': '//trim(table%names(places(k)))//' is '//short(y(1)) &
                               //' all the time; --from, --to and --probe choose what is looked at')
         end associate
      end do
   end subroutine check_values

   pure function place(table, row)
      type(text_table_t), intent(in) :: table
      integer, intent(in) :: row
      character(:), allocatable :: place

      place = table%path//':'//to_text(table%lines(row))
   end function place

end module probe_signals
