!> What is settled before a program does anything else: that its stacks suffice, how many threads it has and how they wait.
module process_start
   use, intrinsic :: iso_fortran_env, only: error_unit
   use errors, only: end_program, failure
   use stacks, only: check_stacks
   use threads, only: sane_threads
   use waiting, only: sleep_while_waiting
   implicit none
   private

   public :: start_process

contains

   !> To be called first of all. Ends the program where a stack is too small; what it does about threads it says on standard error.
   subroutine start_process()
      type(failure) :: problem
      character(:), allocatable :: remark
      logical :: grown

      call check_stacks(grown, problem)
      if (problem%raised()) call end_program(problem)
      call sleep_while_waiting(anew=grown)
      call sane_threads(remark)
      if (remark /= '') write (error_unit, '(a)') 'warning: '//remark
   end subroutine start_process

end module process_start
