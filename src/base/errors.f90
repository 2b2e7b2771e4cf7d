!> The one error type, the exit codes, and the only place that ends the program.
!!
!! A procedure that can fail takes a `type(failure)`, describes what went wrong
!! with `raise` and returns; its caller looks at `raised` and returns too. Only
!! `main` turns a failure into an exit code.
module errors
   use, intrinsic :: iso_c_binding, only: c_int
   use, intrinsic :: iso_fortran_env, only: error_unit, output_unit
   implicit none
   private

   public :: failure, end_program

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

   !> Ends the program with the failure's exit code, its message on standard error.
   subroutine end_program(problem)
      type(failure), intent(in) :: problem

      integer :: ignored

      flush (output_unit, iostat=ignored)
      if (problem%raised()) write (error_unit, '(a)', iostat=ignored) problem%message
      flush (error_unit, iostat=ignored)
      call c_exit(int(problem%code, c_int))
   end subroutine end_program

end module errors
