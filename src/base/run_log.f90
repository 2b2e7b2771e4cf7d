!> What a run tells its user: on the screen and in `run.log`.
!!
!! The module is not named `log`, which would hide the intrinsic function.
module run_log
   use, intrinsic :: iso_c_binding, only: c_int
   use, intrinsic :: iso_fortran_env, only: error_unit, output_unit
   use communication, only: is_first
   use errors, only: exit_files, failure
   use file_system, only: file_bytes, flush_unit, secure_unit, seek_end
   use growing_text, only: growing_text_t
   use kinds, only: i8
   use standard_output, only: check_screen
   implicit none
   private

   public :: log_t

   integer, parameter, public :: warnings_shown = 3   !! of each kind; further ones are only counted

   integer, parameter :: no_unit = -1
   integer, parameter :: widest_text = 512
   character(*), parameter :: return_and_clear = achar(13)//achar(27)//'[K'
   character(*), parameter :: wrap_off = achar(27)//'[?7l', wrap_on = achar(27)//'[?7h'

   !> How often one kind of warning came, and its latest text.
   type :: tally_t
      character(:), allocatable :: key, latest
      integer :: number = 0
   end type tally_t

   !> A log; usable before `open`, and after `close`, as a plain screen.
   type :: log_t
      private
      integer :: unit = no_unit
      character(:), allocatable :: path
      integer(i8) :: bytes = 0               !! that the file must have by now
      character(:), allocatable :: lost      !! why some of it could not be written; not allocated while all was
      logical :: quiet = .false.             !! nothing on standard output
      logical :: terminal = .false.          !! standard output is a terminal
      logical :: unicode = .false.           !! the user's locale is UTF-8
      logical :: transient_shown = .false.   !! the cursor stands in a transient line
      logical :: blind = .false.             !! standard output cannot be written any more,
      character(:), allocatable :: blindness !! for this reason
      type(tally_t), allocatable :: tallies(:)
      type(growing_text_t) :: early          !! what the file will begin with
   contains
      procedure :: open => open_log
      procedure :: open_file
      procedure :: line
      procedure :: note
      procedure :: keep
      procedure :: transient
      procedure :: box
      procedure :: warn
      procedure :: warning_count
      procedure :: report_warnings
      procedure :: close => close_log
      procedure :: on_terminal
   end type log_t

   interface
      integer(c_int) function c_isatty(descriptor) bind(c, name='isatty')
         import :: c_int
         integer(c_int), value :: descriptor
      end function c_isatty
   end interface

contains

   !> Starts a log without a file; what comes before the file does is kept for it.
   subroutine open_log(self, quiet)
      class(log_t), intent(inout) :: self
      logical, intent(in) :: quiet              !! nothing on standard output; warnings go to standard error

      self%quiet = quiet
      self%terminal = c_isatty(1_c_int) == 1
      self%unicode = locale_is_utf8()
   end subroutine open_log

   !> Writes to a file from here on, and what came before; an earlier file of that name is replaced, or goes on.
   subroutine open_file(self, path, goes_on, problem)
      class(log_t), intent(inout) :: self
      character(*), intent(in) :: path
      logical, intent(in) :: goes_on
      type(failure), intent(inout) :: problem   !! exit_files: the file cannot be written
      character(256) :: message
      character(:), allocatable :: before
      integer :: status

      if (.not. is_first()) then
         call problem%tell()
         return
      end if
      before = self%early%text()
      self%path = trim(path)
      self%bytes = 0
      open (newunit=self%unit, file=path, status=merge('unknown', 'replace', goes_on), position='append', action='write', &
         iostat=status, iomsg=message)
      if (status == 0) then
         if (goes_on) self%bytes = max(0_i8, file_bytes(path))
         call seek_end(self%unit)
         if (len(before) > 0) call to_file(self, before(:len(before) - 1))
         if (self%blind) call complain_of_blindness(self)
      else
         self%unit = no_unit
         call problem%raise(exit_files, "cannot write the log '"//trim(path)//"': "//trim(message))
      end if
      call problem%tell()
   end subroutine open_file

   !> Writes one line, or several separated by new_line, to the screen and the file.
   subroutine line(self, text)
      class(log_t), intent(inout) :: self
      character(*), intent(in) :: text

      if (.not. self%quiet) call to_screen(self, output_unit, text)
      call to_file(self, text)
   end subroutine line

   !> Writes a line that a terminal need not keep: to the file, and to a screen that is none.
   subroutine note(self, text)
      class(log_t), intent(inout) :: self
      character(*), intent(in) :: text

      if (.not. (self%quiet .or. self%terminal)) call to_screen(self, output_unit, text)
      call to_file(self, text)
   end subroutine note

   !> Writes a line to the file only.
   subroutine keep(self, text)
      class(log_t), intent(inout) :: self
      character(*), intent(in) :: text

      call to_file(self, text)
   end subroutine keep

   !> Shows a line, on a terminal only, that the next line of any kind replaces.
   subroutine transient(self, text)
      class(log_t), intent(inout) :: self
      character(*), intent(in) :: text

      if (self%quiet .or. .not. self%terminal) return
      call show(self, return_and_clear//wrap_off//text//wrap_on)
      self%transient_shown = .true.
   end subroutine transient

   !> Writes lines in a frame as wide as the widest of them, the title in its upper edge.
   subroutine box(self, title, lines)
      class(log_t), intent(inout) :: self
      character(*), intent(in) :: title
      character(*), intent(in) :: lines(:)   !! trailing blanks do not count
      character(3) :: corners(4), dash, bar  !! one character each, up to three bytes
      integer :: i, width

      if (self%unicode) then
         corners = ['┌', '┐', '└', '┘']
         dash = '─'
         bar = '│'
      else
         corners = '+'
         dash = '-'
         bar = '|'
      end if
      width = columns(title) + 2
      do i = 1, size(lines)
         width = max(width, columns(lines(i)))
      end do
      call self%line(trim(corners(1))//trim(dash)//' '//trim(title)//' '//repeat(trim(dash), width - columns(title) - 1)// &
         trim(corners(2)))
      do i = 1, size(lines)
         call self%line(trim(bar)//' '//trim(lines(i))//repeat(' ', width - columns(lines(i)))//' '//trim(bar))
      end do
      call self%line(trim(corners(3))//repeat(trim(dash), width + 2)//trim(corners(4)))
   end subroutine box

   !> Counts a warning, and writes the first few of its kind.
   subroutine warn(self, key, text)
      class(log_t), intent(inout) :: self
      character(*), intent(in) :: key    !! the kind: one or two words
      character(*), intent(in) :: text
      integer :: i

      i = tally_index(self, key)
      self%tallies(i)%number = self%tallies(i)%number + 1
      self%tallies(i)%latest = text
      if (self%tallies(i)%number > warnings_shown) return
      call write_warning(self, 'warning: '//text)
      if (self%tallies(i)%number == warnings_shown) &
         call write_warning(self, "         (further warnings '"//key//"' are only counted)")
   end subroutine warn

   !> How often one kind of warning came so far.
   pure integer function warning_count(self, key)
      class(log_t), intent(in) :: self
      character(*), intent(in) :: key
      integer :: i

      warning_count = 0
      if (.not. allocated(self%tallies)) return
      do i = 1, size(self%tallies)
         if (self%tallies(i)%key == key) warning_count = self%tallies(i)%number
      end do
   end function warning_count

   !> Writes how often each kind of warning came that was not always shown, with the latest.
   subroutine report_warnings(self)
      class(log_t), intent(inout) :: self
      character(widest_text) :: text
      integer :: i

      if (.not. allocated(self%tallies)) return
      do i = 1, size(self%tallies)
         associate (tally => self%tallies(i))
            if (tally%number <= warnings_shown) cycle   ! all of them were shown
            write (text, '(3a, i0, 2a)') "warning '", tally%key, "' came ", tally%number, ' times; the latest: ', tally%latest
            call write_warning(self, trim(text))
         end associate
      end do
   end subroutine report_warnings

   !> Ends the file, which is on the disk then. Raises exit_files if a part of it could not be written.
   subroutine close_log(self, problem)
      class(log_t), intent(inout) :: self
      type(failure), intent(inout), optional :: problem
      character(:), allocatable :: reason
      integer :: ignored

      call clear_transient(self)
      if (self%unit /= no_unit) then
         call secure_unit(self%unit, self%bytes, reason)
         if (reason /= '' .and. .not. allocated(self%lost)) self%lost = reason
         close (self%unit, iostat=ignored)
         self%unit = no_unit
      end if
      if (.not. present(problem)) return
      if (allocated(self%lost)) call problem%raise(exit_files, "cannot write the log '"//self%path//"': "//self%lost)
      call problem%tell()
   end subroutine close_log

   !> True when transient lines are shown.
   pure logical function on_terminal(self)
      class(log_t), intent(in) :: self

      on_terminal = self%terminal .and. .not. self%quiet
   end function on_terminal

   !> A warning is shown even by a quiet run, but not on standard output.
   subroutine write_warning(self, text)
      class(log_t), intent(inout) :: self
      character(*), intent(in) :: text

      call to_screen(self, merge(error_unit, output_unit, self%quiet), text)
      call to_file(self, text)
   end subroutine write_warning

   subroutine to_screen(self, unit, text)
      class(log_t), intent(inout) :: self
      integer, intent(in) :: unit
      character(*), intent(in) :: text

      call clear_transient(self)
      if (unit == output_unit) then
         call show(self, text//new_line('a'))
      else
         call complain(text)
      end if
   end subroutine to_screen

   !> Writes to standard output. A run that has lost it says so once, and goes on: its log has the same lines.
   subroutine show(self, text)
      class(log_t), intent(inout) :: self
      character(*), intent(in) :: text   !! with its line ends
      type(failure) :: problem
      integer :: ignored

      if (self%blind .or. .not. is_first()) return
      write (output_unit, '(a)', advance='no', iostat=ignored) text
      call check_screen(problem)
      self%blind = problem%raised()
      if (.not. self%blind) return
      self%blindness = problem%message
      if (self%unit /= no_unit) call complain_of_blindness(self)
   end subroutine show

   subroutine complain_of_blindness(self)
      class(log_t), intent(in) :: self

      call complain('warning: '//self%blindness//"; the run goes on, and '"//self%path//"' has what it says")
   end subroutine complain_of_blindness

   subroutine complain(text)
      character(*), intent(in) :: text
      integer :: ignored

      if (.not. is_first()) return
      write (error_unit, '(a)', iostat=ignored) text
      flush (error_unit, iostat=ignored)
   end subroutine complain

   !> A log that cannot be written on (a full disk) does not end the run at once: its results may.
   subroutine to_file(self, text)
      class(log_t), intent(inout) :: self
      character(*), intent(in) :: text
      character(:), allocatable :: reason
      integer :: ignored

      if (.not. is_first()) return
      if (self%unit == no_unit) then
         call self%early%add_line(text)
         return
      end if
      write (self%unit, '(a)', iostat=ignored) text
      self%bytes = self%bytes + len(text) + 1
      call flush_unit(self%unit, self%bytes, reason)
      if (reason /= '' .and. .not. allocated(self%lost)) self%lost = reason
   end subroutine to_file

   subroutine clear_transient(self)
      class(log_t), intent(inout) :: self

      if (.not. self%transient_shown) return
      call show(self, return_and_clear)
      self%transient_shown = .false.
   end subroutine clear_transient

   !> The place of a kind of warning; a new kind gets a new one.
   integer function tally_index(self, key) result(i)
      class(log_t), intent(inout) :: self
      character(*), intent(in) :: key
      type(tally_t), allocatable :: longer(:)

      if (.not. allocated(self%tallies)) allocate (self%tallies(0))
      do i = 1, size(self%tallies)
         if (self%tallies(i)%key == key) return
      end do
      allocate (longer(i))   ! gfortran 12 miscompiles array constructors of such types
      longer(:i - 1) = self%tallies
      longer(i)%key = key
      call move_alloc(longer, self%tallies)
   end function tally_index

   !> Characters of a UTF-8 text without its trailing blanks: bytes that do not continue one.
   pure integer function columns(text)
      character(*), intent(in) :: text
      integer :: i

      columns = 0
      do i = 1, len_trim(text)
         if (iand(ichar(text(i:i)), 192) /= 128) columns = columns + 1
      end do
   end function columns

   !> Whether the locale the user chose writes UTF-8; the first variable set decides, as in POSIX.
   logical function locale_is_utf8()
      character(*), parameter :: variables(3) = [character(8) :: 'LC_ALL', 'LC_CTYPE', 'LANG']
      character(64) :: value
      integer :: i

      do i = 1, size(variables)
         call get_environment_variable(trim(variables(i)), value)
         if (value /= '') exit
      end do
      locale_is_utf8 = index(value, 'UTF-8') + index(value, 'utf8') + index(value, 'UTF8') + index(value, 'utf-8') > 0
   end function locale_is_utf8

end module run_log
