!> Reads text files of numbers: rows of columns, with # comments, and blanks or commas between the numbers.
module number_files
   use errors, only: failure
   use file_system, only: path_exists, read_whole_file
   use kinds, only: dp
   use text, only: parse_real, to_text
   implicit none
   private

   public :: read_rows

   character, parameter :: newline = achar(10)
   character(*), parameter :: gaps = ' ,'//achar(9)//achar(13)
   character(*), parameter :: byte_order_mark = char(239)//char(187)//char(191)

contains

   !> Reads the rows of a file, all of as many columns as the first has.
   subroutine read_rows(path, columns, most_rows, rows, message)
      character(*), intent(in) :: path
      integer, intent(in) :: columns(2)                 !! fewest and most
      integer, intent(in) :: most_rows
      real(dp), allocatable, intent(out) :: rows(:, :)  !! (columns, rows); none where it cannot be read
      character(:), allocatable, intent(out) :: message !! '' when read, else where it is wrong and why
      character(:), allocatable :: content
      real(dp) :: row(columns(2))
      real(dp), allocatable :: found(:, :)
      integer :: at, line, n, past, there, wanted

      allocate (rows(0, 0))
      call load(path, content, message)
      if (message /= '') return
      allocate (found(columns(2), most_rows))
      at = 1
      if (index(content, byte_order_mark) == 1) at = 1 + len(byte_order_mark)
      line = 0
      n = 0
      wanted = 0
      do while (at <= len(content))
         past = index(content(at:), newline)
         if (past == 0) past = len(content) - at + 2
         line = line + 1
         call take_row(content(at:at + past - 2), row, there, message)
         at = at + past
         if (message == '' .and. there == 0) cycle
         if (wanted == 0) wanted = min(max(there, columns(1)), columns(2))
         if (message == '' .and. there /= wanted) message = to_text(there)//' numbers stand where '//to_text(wanted)//' are wanted'
         if (message == '' .and. n == most_rows) message = 'at most '//to_text(most_rows)//' rows of numbers are possible'
         if (message /= '') then
            message = path//':'//to_text(line)//': '//message
            return
         end if
         n = n + 1
         found(:, n) = row
      end do
      if (n == 0) message = path//': there are no numbers in this file'
      deallocate (rows)
      allocate (rows(wanted, n))
      rows(:, :) = found(:wanted, :n)
   end subroutine read_rows

   ! The text of a file.
   subroutine load(path, content, message)
      character(*), intent(in) :: path
      character(:), allocatable, intent(out) :: content
      character(:), allocatable, intent(out) :: message   ! '' when read
      type(failure) :: problem

      content = ''
      message = path//': there is no such file'
      if (.not. path_exists(path)) return
      call read_whole_file(path, content, problem)
      message = ''
      if (problem%raised()) message = problem%message
   end subroutine load

   ! The numbers of a line.
   pure subroutine take_row(line, row, n, message)
      character(*), intent(in) :: line
      real(dp), intent(out) :: row(:)                     ! as many as it has room for
      integer, intent(out) :: n                           ! numbers there
      character(:), allocatable, intent(out) :: message   ! '' if they are numbers
      real(dp) :: number
      integer :: at, last, length

      message = ''
      row = 0.0_dp
      n = 0
      last = index(line//'#', '#') - 1
      at = 1
      do while (at <= last)
         if (scan(line(at:at), gaps) > 0) then
            at = at + 1
            cycle
         end if
         length = scan(line(at:last)//' ', gaps) - 1
         call parse_real(line(at:at + length - 1), number, message)
         if (message /= '') return
         n = n + 1
         if (n <= size(row)) row(n) = number
         at = at + length
      end do
   end subroutine take_row

end module number_files
