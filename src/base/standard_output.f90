!> Standard output: a program that could not say what it was asked for fails.
module standard_output
   use, intrinsic :: iso_c_binding, only: c_char, c_int, c_intptr_t, c_null_char, c_size_t
   use, intrinsic :: iso_fortran_env, only: output_unit
   use communication, only: is_first
   use errors, only: exit_files, failure
   use system_words, only: forget_reason, last_reason, reason_of
   implicit none
   private

   public :: check_screen, errors_for_signals, print_text

   character(*), parameter :: no_screen = 'cannot write to standard output: '
   integer(c_int), parameter :: descriptor = 1

   interface
      integer(c_intptr_t) function c_signal(number, handler) bind(c, name='signal')
         import :: c_int, c_intptr_t
         integer(c_int), value :: number
         integer(c_intptr_t), value :: handler
      end function c_signal

      integer(c_size_t) function c_write(descriptor, bytes, count) bind(c, name='write')
         import :: c_char, c_int, c_size_t
         integer(c_int), value :: descriptor
         character(kind=c_char), intent(in) :: bytes(*)
         integer(c_size_t), value :: count
      end function c_write
   end interface

contains

   !> From here on a write beyond the limit of a file's size (ulimit -f) fails as one to a full disk does, and does not end the
   !! program; so does one into a pipe that nobody reads any more, where that is asked for.
   subroutine errors_for_signals(pipes)
      logical, intent(in) :: pipes
      integer(c_int), parameter :: broken_pipe = 13, beyond_file_size = 25   ! SIGPIPE, SIGXFSZ of Linux
      integer(c_intptr_t), parameter :: ignore = 1                          ! SIG_IGN
      integer(c_intptr_t) :: before

      before = c_signal(beyond_file_size, ignore)
      if (pipes) before = c_signal(broken_pipe, ignore)
   end subroutine errors_for_signals

   !> Writes a text, with its own line ends, to standard output.
   subroutine print_text(text, problem)
      character(*), intent(in) :: text
      type(failure), intent(inout) :: problem   !! exit_files
      integer(c_size_t) :: done, taken

      if (.not. is_first()) return
      flush (output_unit)
      done = 0
      do while (done < len(text))
         taken = c_write(descriptor, text(done + 1:), len(text) - done)
         if (taken <= 0) then
            call problem%raise(exit_files, no_screen//reason_of(-1_c_int))
            exit
         end if
         done = done + taken
      end do
   end subroutine print_text

   !> Raises exit_files if standard output does not take what was written to it.
   subroutine check_screen(problem)
      type(failure), intent(inout) :: problem
      character(:), allocatable :: reason

      call forget_reason()
      flush (output_unit)
      reason = last_reason('')
      if (reason == '') reason = reason_of(int(c_write(descriptor, c_null_char, 0_c_size_t), c_int))
      if (reason /= '') call problem%raise(exit_files, no_screen//reason)
   end subroutine check_screen

end module standard_output
