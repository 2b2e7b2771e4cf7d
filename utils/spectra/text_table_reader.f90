!> Reads the tables of numbers that a run writes (module table): a head of comments, column names, rows.
module text_table_reader
   use, intrinsic :: ieee_arithmetic, only: ieee_negative_inf, ieee_positive_inf, ieee_quiet_nan, ieee_value
   use errors, only: exit_files, failure
   use kinds, only: dp, i8
   use text, only: lower_case, parse_real, quoted, to_text
   implicit none
   private

   public :: text_table_t, read_text_table

   integer, parameter, public :: table_name_length = 64   !! of a column's name and of its unit
   integer, parameter :: head_length = 1000

   !> A table in memory.
   type :: text_table_t
      character(:), allocatable :: path
      character(head_length), allocatable :: head(:)         !! comment lines, without #
      character(table_name_length), allocatable :: names(:)  !! (columns)
      character(table_name_length), allocatable :: units(:)  !! (columns) '' where the head has none
      real(dp), allocatable :: values(:, :)                  !! (columns, rows) NaN and infinities too
      integer, allocatable :: lines(:)                       !! (rows) where each row stands in the file
   contains
      procedure :: head_text
      procedure :: head_number
      procedure :: column
   end type text_table_t

contains

   !> Reads a whole table; a last line without its end is still being written and is left out.
   subroutine read_text_table(path, table, problem)
      character(*), intent(in) :: path
      type(text_table_t), intent(out) :: table
      type(failure), intent(inout) :: problem   !! exit_files: unreadable, or no such table; names file and line
      character(:), allocatable :: content
      character(head_length) :: buffer
      integer :: first, last, line, rows

      table%path = trim(path)
      allocate (table%head(0), table%lines(0))
      call read_content(table%path, content, problem)
      if (problem%raised()) return
      rows = 0
      line = 0
      first = 1
      do
         last = index(content(first:), new_line('a')) + first - 2
         if (last < first - 1) exit
         line = line + 1
         buffer = adjustl(content(first:last))
         if (buffer(1:1) == '#') then
            buffer = adjustl(buffer(2:))
            if (.not. allocated(table%names)) table%head = [table%head, buffer]
         else if (buffer /= '') then
            if (.not. allocated(table%names)) then
               call take_names(table, content(first:last), line, problem)
               ! No row is shorter than two characters a column.
               if (.not. problem%raised()) allocate (table%values(size(table%names), len(content)/(2*size(table%names)) + 1))
            else
               call take_row(table, content(first:last), line, rows, problem)
            end if
            if (problem%raised()) return
         end if
         first = last + 2
      end do
      if (.not. allocated(table%names)) then
         call problem%raise(exit_files, table%path//': no line of column names: this is no table of dynsph')
         return
      end if
      table%values = table%values(:, :rows)
      table%lines = table%lines(:rows)
   end subroutine read_text_table

   subroutine read_content(path, content, problem)
      character(*), intent(in) :: path
      character(:), allocatable, intent(out) :: content
      type(failure), intent(inout) :: problem
      character(256) :: message
      integer(i8) :: length
      integer :: status, unit

      content = ''
      length = 0
      open (newunit=unit, file=path, access='stream', form='unformatted', status='old', action='read', iostat=status, &
         iomsg=message)
      if (status == 0) then
         inquire (unit=unit, size=length)
         if (length <= huge(status)) then
            content = repeat(' ', max(0, int(length)))
            read (unit, iostat=status, iomsg=message) content
         end if
         close (unit)
      end if
      if (status /= 0) then
         call problem%raise(exit_files, "cannot read '"//path//"': "//trim(message))
      else if (length > huge(status)) then
         call problem%raise(exit_files, path//': the table has more than 2 GB; cut it into parts, each with the head')
      else if (len(content) == 0) then
         call problem%raise(exit_files, path//': the file is empty')
      end if
   end subroutine read_content

   ! The line of names, and the units that the head lists in lines such as '3  P1 [pressure]'.
   subroutine take_names(table, content, line, problem)
      type(text_table_t), intent(inout) :: table
      character(*), intent(in) :: content
      integer, intent(in) :: line
      type(failure), intent(inout) :: problem
      character(head_length) :: entry
      integer :: i, k, opened

      call split(content, table%names)
      if (looks_like_number(table%names(1))) then
         call problem%raise(exit_files, table%path//':'//to_text(line)//': numbers instead of column names: the head is missing')
         return
      end if
      allocate (table%units(size(table%names)))
      table%units = ''
      do i = 1, size(table%head)
         entry = table%head(i)
         opened = index(entry, ' [')
         if (opened == 0 .or. scan(entry(1:1), '0123456789') == 0) cycle
         entry = adjustl(entry(scan(entry, ' '):))
         opened = index(entry, ' [')
         do k = 1, size(table%names)
            if (entry(:opened) == table%names(k)) table%units(k) = entry(opened + 2:index(entry, ']', back=.true.) - 1)
         end do
      end do
   end subroutine take_names

   subroutine take_row(table, content, line, rows, problem)
      type(text_table_t), intent(inout) :: table
      character(*), intent(in) :: content
      integer, intent(in) :: line
      integer, intent(inout) :: rows            !! so far
      type(failure), intent(inout) :: problem
      character(table_name_length), allocatable :: words(:)
      character(:), allocatable :: message
      integer :: k

      call split(content, words)
      if (size(words) /= size(table%names)) then
         call problem%raise(exit_files, table%path//':'//to_text(line)//': '//to_text(size(words))//' numbers in a table of ' &
                            //to_text(size(table%names))//' columns')
         return
      end if
      rows = rows + 1
      do k = 1, size(words)
         call read_number(trim(words(k)), table%values(k, rows), message)
         if (message /= '') call problem%raise(exit_files, table%path//':'//to_text(line)//': '//message)
         if (problem%raised()) return
      end do
      if (rows > size(table%lines)) table%lines = [table%lines, spread(0, 1, rows)]
      table%lines(rows) = line
   end subroutine take_row

   ! A number, NaN or an infinity, as Fortran writes them.
   subroutine read_number(word, number, message)
      character(*), intent(in) :: word
      real(dp), intent(out) :: number
      character(:), allocatable, intent(out) :: message   !! '' when read

      message = ''
      select case (lower_case(word))
      case ('nan', '+nan', '-nan')
         number = ieee_value(number, ieee_quiet_nan)
      case ('inf', '+inf', 'infinity', '+infinity')
         number = ieee_value(number, ieee_positive_inf)
      case ('-inf', '-infinity')
         number = ieee_value(number, ieee_negative_inf)
      case default
         call parse_real(word, number, message)
      end select
   end subroutine read_number

   ! The words between blanks.
   pure subroutine split(content, words)
      character(*), intent(in) :: content
      character(table_name_length), allocatable, intent(out) :: words(:)
      character(*), parameter :: blanks = ' '//achar(9)//achar(13)
      integer :: at, count_of, length, pass

      do pass = 1, 2   ! count, then take
         at = 1
         count_of = 0
         do
            length = verify(content(at:), blanks)
            if (length == 0) exit
            at = at + length - 1
            length = scan(content(at:)//' ', blanks) - 1
            count_of = count_of + 1
            if (pass == 2) words(count_of) = content(at:at + length - 1)
            at = at + length
            if (at > len(content)) exit
         end do
         if (pass == 1) allocate (words(count_of))
      end do
   end subroutine split

   pure logical function looks_like_number(word)
      character(*), intent(in) :: word
      character(:), allocatable :: message
      real(dp) :: number

      call parse_real(trim(word), number, message)
      looks_like_number = message == ''
   end function looks_like_number

   !> What the head says behind 'key: '; '' where it does not.
   pure function head_text(self, key) result(words)
      class(text_table_t), intent(in) :: self
      character(*), intent(in) :: key
      character(:), allocatable :: words
      integer :: i

      words = ''
      do i = size(self%head), 1, -1
         if (index(self%head(i), key//':') == 1) words = trim(adjustl(self%head(i) (len(key) + 2:)))
      end do
   end function head_text

   !> The same as a number; 0 where the head has none.
   pure real(dp) function head_number(self, key)
      class(text_table_t), intent(in) :: self
      character(*), intent(in) :: key
      character(:), allocatable :: message

      call parse_real(self%head_text(key), head_number, message)
   end function head_number

   !> The number of the column of this name. Raises exit_files where there is none.
   integer function column(self, name, problem)
      class(text_table_t), intent(in) :: self
      character(*), intent(in) :: name
      type(failure), intent(inout) :: problem
      integer :: k

      column = 0
      do k = 1, size(self%names)
         if (self%names(k) == name) column = k
      end do
      if (column == 0) call problem%raise(exit_files, self%path//': no column '//quoted(name)//'; there are '//listed(self%names))
   end function column

   pure function listed(words) result(list)
      character(*), intent(in) :: words(:)
      character(:), allocatable :: list
      integer :: i

      list = ''
      do i = 1, size(words)
         if (i > 1) list = list//', '
         list = list//trim(words(i))
      end do
   end function listed

end module text_table_reader
