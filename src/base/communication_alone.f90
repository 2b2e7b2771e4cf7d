!> What the processes of a run tell each other. This source is for a run of one process: nobody is asked.
module communication
   use, intrinsic :: iso_fortran_env, only: int8
   use kinds, only: dp, i8
   implicit none
   private

   public :: start_processes, end_processes, all_end, end_all, n_processes, this_process, processes_here, is_first, &
      library_words, reductions, any_process, largest_of_all, sums_of_all, combine, exchange_counts, exchange, exchange_t, &
      tell_all, to_first, from_process

   !> Numbers on their way to and from the others.
   type :: exchange_t
      real(dp), allocatable :: outgoing(:), incoming(:)   !! those of a process behind those of the one before it
      integer(i8) :: messages = 0, bytes = 0              !! sent so far
   contains
      procedure :: make_room
      procedure :: start
      procedure :: go_on
      procedure :: finish
   end type exchange_t

contains

   !> To be called before all others.
   subroutine start_processes()
   end subroutine start_processes

   !> To be called when all is written.
   subroutine end_processes()
   end subroutine end_processes

   !> Whether all have come to their end.
   pure logical function all_end()
      all_end = .true.
   end function all_end

   !> Ends all processes, wherever they are; here the caller, which does so itself.
   pure subroutine end_all(code)
      integer, intent(in) :: code   !! of the program

      if (code == 0) return
   end subroutine end_all

   !> How many there are.
   pure integer function n_processes()
      n_processes = 1
   end function n_processes

   !> Which of them this is, from 0.
   pure integer function this_process()
      this_process = 0
   end function this_process

   !> How many of them share the memory of this machine.
   pure integer function processes_here()
      processes_here = 1
   end function processes_here

   !> What lets them talk to each other, for the user; '' in a program of one process.
   pure function library_words() result(words)
      character(:), allocatable :: words

      words = ''
   end function library_words

   !> Whether this is the process that writes files and talks to the user.
   pure logical function is_first()
      is_first = .true.
   end function is_first

   !> How often all have waited for one number of all so far.
   pure integer(i8) function reductions()
      reductions = 0
   end function reductions

   !> Whether a statement holds in some process.
   pure logical function any_process(statement)
      logical, intent(in) :: statement

      any_process = statement
   end function any_process

   !> Each value becomes its largest over all processes.
   pure subroutine largest_of_all(n, values)
      integer, intent(in) :: n
      real(dp), intent(inout) :: values(n)

      values = values
   end subroutine largest_of_all

   !> Each number becomes its sum over all processes.
   pure subroutine sums_of_all(n, numbers)
      integer, intent(in) :: n
      integer(i8), intent(inout) :: numbers(n)

      numbers = numbers
   end subroutine sums_of_all

   !> Both in one reduction: each number becomes its sum over all processes, each value its largest.
   pure subroutine combine(numbers, values)
      integer(i8), contiguous, intent(inout) :: numbers(:)
      real(dp), contiguous, intent(inout) :: values(:)

      numbers = numbers
      values = values
   end subroutine combine

   !> Tells each process a number.
   pure subroutine exchange_counts(outgoing, incoming)
      integer, intent(in) :: outgoing(0:)    !! (processes) for each
      integer, intent(out) :: incoming(0:)   !! (processes) of each

      incoming = outgoing
   end subroutine exchange_counts

   !> Sends to each process the numbers before and including `out_end` of it, from one after that of the process before it.
   pure subroutine exchange(outgoing, out_end, incoming, in_end)
      real(dp), contiguous, intent(in) :: outgoing(:)
      integer, intent(in) :: out_end(-1:)   !! (-1:processes-1)
      real(dp), contiguous, intent(inout) :: incoming(:)
      integer, intent(in) :: in_end(-1:)

      incoming(in_end(-1) + 1:in_end(0)) = outgoing(out_end(-1) + 1:out_end(0))
   end subroutine exchange

   !> Room for so many values of each thing that goes to and comes from the others.
   pure subroutine make_room(self, values, out_end, in_end)
      class(exchange_t), intent(inout) :: self
      integer, intent(in) :: values
      integer, intent(in) :: out_end(-1:), in_end(-1:)   !! (-1:processes-1) things until those of a process

      if (allocated(self%outgoing)) deallocate (self%outgoing, self%incoming)
      allocate (self%outgoing(values*out_end(0)), self%incoming(values*in_end(0)))
   end subroutine make_room

   !> Sends what `outgoing` holds.
   pure subroutine start(self)
      class(exchange_t), intent(inout) :: self

      self%incoming = self%outgoing
   end subroutine start

   !> Lets messages go on that need a hand.
   pure subroutine go_on(self)
      class(exchange_t), intent(inout) :: self

      if (size(self%incoming) == 0) return
   end subroutine go_on

   !> Waits until `incoming` is there, and `outgoing` may change again.
   pure subroutine finish(self)
      class(exchange_t), intent(inout) :: self

      if (size(self%incoming) == 0) return
   end subroutine finish

   !> All get the text of one of them.
   pure subroutine tell_all(text, process)
      character(:), allocatable, intent(inout) :: text
      integer, intent(in) :: process

      if (process == 0) text = text
   end subroutine tell_all

   !> Sends bytes to the first process, which takes them with `from_process`.
   pure subroutine to_first(bytes)
      integer(int8), contiguous, intent(in) :: bytes(:)

      if (size(bytes) > 0) return
   end subroutine to_first

   !> Takes bytes that another process sends to the first one.
   pure subroutine from_process(process, bytes)
      integer, intent(in) :: process
      integer(int8), contiguous, intent(inout) :: bytes(:)

      if (process > 0) bytes = 0
   end subroutine from_process

end module communication
