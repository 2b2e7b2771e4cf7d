!> The one error type, the exit codes, and the only place that ends the program.
!!
!! A procedure that can fail takes a `type(failure)`, describes what went wrong
!! with `raise` and returns; its caller looks at `raised` and returns too. Only
!! `main` turns a failure into an exit code.
module errors
   use, intrinsic :: iso_c_binding, only: c_int
   use, intrinsic :: iso_fortran_env, only: error_unit, output_unit
   use communication, only: all_end, any_process, end_all, end_processes, is_first, largest_of_all, n_processes, &
      tell_all, this_process
   use kinds, only: dp
   implicit none
   private

   public :: failure, end_program, text_of_any, text_of_largest

   integer, parameter, public :: exit_ok = 0         !! everything done
   integer, parameter, public :: exit_input = 1      !! command line or namelist
   integer, parameter, public :: exit_numerics = 2   !! the solution left its range
   integer, parameter, public :: exit_files = 3      !! a file or directory
   integer, parameter, public :: exit_stopped = 4    !! stopped from outside; the run can go on

   !> What went wrong: what, where, and what to do about it.
   type :: failure
      integer :: code = exit_ok               !! exit code of the program
      character(:), allocatable :: message    !! lines separated by new_line('a')
   contains
      procedure :: raise
      procedure :: raised
      procedure :: tell
   end type failure

   interface
      ! The C library's exit: closes every unit and returns exactly this status,
      ! without the banner that `error stop` prints.
      subroutine c_exit(status) bind(c, name='exit')
         import :: c_int
         integer(c_int), value :: status
      end subroutine c_exit
   end interface

contains

   !> Records a failure; a later one is added below an earlier one of the same run.
   subroutine raise(self, code, message)
      class(failure), intent(inout) :: self
      integer, intent(in) :: code              !! one of the exit codes above
      character(*), intent(in) :: message

      if (self%code == exit_ok) then
         self%code = code
         self%message = message
      else
         self%message = self%message//new_line('a')//message
      end if
   end subroutine raise

   !> True once something was raised.
   pure logical function raised(self)
      class(failure), intent(in) :: self

      raised = self%code /= exit_ok
   end function raised

   !> What one process has raised all have raised. To be called by all.
   subroutine tell(self)
      class(failure), intent(inout) :: self
      real(dp) :: first(2)   ! -number of the first process that has failed, its code
      integer :: process

      if (.not. any_process(self%raised())) return
      first(1) = -huge(1.0_dp)
      if (self%raised()) first(1) = -this_process()
      call largest_of_all(1, first)
      process = nint(-first(1))
      first(2) = 0
      if (this_process() == process) first(2) = self%code
      call largest_of_all(1, first(2:))
      self%code = nint(first(2))
      if (.not. allocated(self%message)) self%message = ''
      call tell_all(self%message, process)
   end subroutine tell

   !> A text that some process has is what all have then: that of the first one whose is not ''. To be called by all.
   subroutine text_of_any(text)
      character(:), allocatable, intent(inout) :: text
      real(dp) :: first(1)

      if (.not. any_process(text /= '')) return
      first = -huge(1.0_dp)
      if (text /= '') first = -this_process()
      call largest_of_all(1, first)
      call tell_all(text, nint(-first(1)))
   end subroutine text_of_any

   !> The text of the process whose value is the largest. To be called by all.
   subroutine text_of_largest(value, text)
      real(dp), intent(in) :: value
      character(:), allocatable, intent(inout) :: text
      real(dp) :: mine, largest(1), first(1)

      mine = value
      if (.not. mine <= huge(mine)) mine = huge(mine)   ! nothing is larger than what is no number
      largest = mine
      call largest_of_all(1, largest)
      first = -huge(1.0_dp)
      if (mine >= largest(1)) first = -this_process()
      call largest_of_all(1, first)
      call tell_all(text, nint(-first(1)))
   end subroutine text_of_largest

   !> Ends the program with the failure's exit code, its message on standard error. Where one process ends and others do not, it
   !! ends them.
   subroutine end_program(problem)
      type(failure), intent(in) :: problem

      integer :: ignored

      flush (output_unit, iostat=ignored)
      if (problem%raised() .and. is_first()) write (error_unit, '(a)', iostat=ignored) problem%message
      if (.not. all_end()) then
         write (error_unit, '(a, i0, a, i0, a)', iostat=ignored) 'rank ', this_process(), ' of ', n_processes(), &
            ' ends alone, and ends the others'
         if (problem%raised() .and. .not. is_first()) write (error_unit, '(a)', iostat=ignored) problem%message
         flush (error_unit, iostat=ignored)
         call end_all(max(1, problem%code))
      end if
      flush (error_unit, iostat=ignored)
      call end_processes()
      call c_exit(int(problem%code, c_int))
   end subroutine end_program

end module errors
