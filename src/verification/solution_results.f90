!> Lines of the summary about an exact solution, from the columns of errors.dat over time.
module solution_results
   use columns, only: column_name_length
   use fitting, only: line_fit
   use kinds, only: dp
   implicit none
   private

   public :: result_t, history_t, known, share, last, time_mean, mean_between, log_fit

   !> A line of the summary.
   type :: result_t
      character(48) :: key = ''
      real(dp) :: value = 0
      logical :: known = .false.   !! false where the run is too short to tell
   end type result_t

   !> A table so far.
   type :: history_t
      character(column_name_length), allocatable :: names(:)   !! (columns)
      real(dp), allocatable :: times(:)                        !! (rows) [s]
      real(dp), allocatable :: values(:, :)                    !! (columns, rows)
   contains
      procedure :: column
   end type history_t

contains

   !> The column of a name, which must be there.
   pure function column(self, name) result(values)
      class(history_t), intent(in) :: self
      character(*), intent(in) :: name
      real(dp) :: values(size(self%times))
      character(column_name_length) :: padded

      padded = name
      values = self%values(findloc(self%names, padded, 1), :)
   end function column

   !> A result that is known however short the run.
   pure type(result_t) function known(key, value)
      character(*), intent(in) :: key
      real(dp), intent(in) :: value

      known = result_t(key, value, .true.)
   end function known

   !> A ratio, which is not known where the reference is zero.
   pure type(result_t) function share(key, value, reference, found)
      character(*), intent(in) :: key
      real(dp), intent(in) :: value, reference
      logical, intent(in) :: found   !! the value is known

      share = result_t(key, 0.0_dp, .false.)
      if (found .and. abs(reference) > 0) share = result_t(key, value/reference, .true.)
   end function share

   pure real(dp) function last(values)
      real(dp), intent(in) :: values(:)

      last = values(size(values))
   end function last

   !> Mean over time by the trapezoidal rule.
   pure real(dp) function time_mean(times, values) result(mean)
      real(dp), intent(in) :: times(:), values(:)
      integer :: n

      n = size(times)
      mean = values(n)
      if (times(n) > times(1)) mean = sum((values(2:) + values(:n - 1))*(times(2:) - times(:n - 1)))/(2*(times(n) - times(1)))
   end function time_mean

   !> Mean over a part of the time, by straight lines between the samples.
   pure real(dp) function mean_between(times, values, from, to) result(mean)
      real(dp), intent(in) :: times(:), values(:)
      real(dp), intent(in) :: from, to   !! from < to; within the samples

      mean = (integral(times, values, to) - integral(times, values, from))/(to - from)
   end function mean_between

   ! From the first sample to a time.
   pure real(dp) function integral(times, values, to)
      real(dp), intent(in) :: times(:), values(:)
      real(dp), intent(in) :: to
      real(dp) :: step
      integer :: i

      integral = 0
      do i = 1, size(times) - 1
         step = min(times(i + 1), to) - times(i)
         if (.not. step > 0) cycle
         integral = integral + step*(values(i) + (values(i + 1) - values(i))*step/(2*(times(i + 1) - times(i))))
      end do
   end function integral

   !> A straight line through the logarithms of positive samples.
   subroutine log_fit(times, values, offset, slope, found)
      real(dp), intent(in) :: times(:), values(:)
      real(dp), intent(out) :: offset, slope
      logical, intent(out) :: found

      call line_fit(times, log(max(values, tiny(1.0_dp))), offset, slope, found)
      found = found .and. all(values > 0)
   end subroutine log_fit

end module solution_results
