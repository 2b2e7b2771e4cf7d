!> What the processes of a run tell each other: MPI, and nothing else names it.
!!
!! Buffers are contiguous and stay where they are until messages have arrived: gfortran's MPI modules take no others.
module communication
   use, intrinsic :: iso_fortran_env, only: int8
   use kinds, only: dp, i8
   use mpi_f08, only: mpi_allreduce, mpi_alltoall, mpi_bcast, mpi_byte, mpi_character, mpi_recv, mpi_send, mpi_status_ignore, &
      mpi_comm_rank, mpi_comm_size, mpi_comm_world, mpi_double_precision, &
      mpi_finalize, mpi_in_place, mpi_init_thread, mpi_integer, mpi_integer8, mpi_irecv, mpi_isend, mpi_lor, mpi_logical, mpi_max, &
      mpi_request, mpi_statuses_ignore, mpi_sum, mpi_thread_funneled, mpi_waitall
   implicit none
   private

   public :: start_processes, end_processes, n_processes, this_process, is_first, any_process, largest_of_all, sums_of_all, &
      exchange_counts, exchange, tell_all, to_first, from_process

contains

   !> To be called before all others.
   subroutine start_processes()
      integer :: provided

      call mpi_init_thread(mpi_thread_funneled, provided)
   end subroutine start_processes

   !> To be called when all is written.
   subroutine end_processes()
      call mpi_finalize()
   end subroutine end_processes

   !> How many there are.
   integer function n_processes()
      call mpi_comm_size(mpi_comm_world, n_processes)
   end function n_processes

   !> Which of them this is, from 0.
   integer function this_process()
      call mpi_comm_rank(mpi_comm_world, this_process)
   end function this_process

   !> Whether this is the process that writes files and talks to the user.
   logical function is_first()
      is_first = this_process() == 0
   end function is_first

   !> Whether a statement holds in some process.
   logical function any_process(statement)
      logical, intent(in) :: statement

      any_process = statement
      call mpi_allreduce(mpi_in_place, any_process, 1, mpi_logical, mpi_lor, mpi_comm_world)
   end function any_process

   !> Each value becomes its largest over all processes.
   subroutine largest_of_all(n, values)
      integer, intent(in) :: n
      real(dp), intent(inout) :: values(n)

      call mpi_allreduce(mpi_in_place, values, n, mpi_double_precision, mpi_max, mpi_comm_world)
   end subroutine largest_of_all

   !> Each number becomes its sum over all processes.
   subroutine sums_of_all(n, numbers)
      integer, intent(in) :: n
      integer(i8), intent(inout) :: numbers(n)

      call mpi_allreduce(mpi_in_place, numbers, n, mpi_integer8, mpi_sum, mpi_comm_world)
   end subroutine sums_of_all

   !> Tells each process a number.
   subroutine exchange_counts(outgoing, incoming)
      integer, intent(in) :: outgoing(0:)    !! (processes) for each
      integer, intent(out) :: incoming(0:)   !! (processes) of each

      call mpi_alltoall(outgoing, 1, mpi_integer, incoming, 1, mpi_integer, mpi_comm_world)
   end subroutine exchange_counts

   !> Sends to each process the numbers before and including `out_end` of it, from one after that of the process before it.
   subroutine exchange(outgoing, out_end, incoming, in_end)
      real(dp), contiguous, intent(in), asynchronous :: outgoing(:)
      integer, intent(in) :: out_end(-1:)   !! (-1:processes-1)
      real(dp), contiguous, intent(inout), asynchronous :: incoming(:)
      integer, intent(in) :: in_end(-1:)
      type(mpi_request) :: requests(2*(size(out_end) - 1))
      integer :: n, process

      n = 0
      do process = 0, size(in_end) - 2
         call receive(in_end(process) - in_end(process - 1), incoming(in_end(process - 1) + 1:in_end(process)))
      end do
      do process = 0, size(out_end) - 2
         call send(out_end(process) - out_end(process - 1), outgoing(out_end(process - 1) + 1:out_end(process)))
      end do
      call mpi_waitall(n, requests, mpi_statuses_ignore)

   contains

      subroutine receive(length, buffer)
         integer, intent(in) :: length
         real(dp), intent(inout), asynchronous :: buffer(length)

         if (length == 0) return
         n = n + 1
         call mpi_irecv(buffer, length, mpi_double_precision, process, 0, mpi_comm_world, requests(n))
      end subroutine receive

      subroutine send(length, buffer)
         integer, intent(in) :: length
         real(dp), intent(in), asynchronous :: buffer(length)

         if (length == 0) return
         n = n + 1
         call mpi_isend(buffer, length, mpi_double_precision, process, 0, mpi_comm_world, requests(n))
      end subroutine send

   end subroutine exchange

   !> All get the text of one of them.
   subroutine tell_all(text, process)
      character(:), allocatable, intent(inout) :: text
      integer, intent(in) :: process
      character(:), allocatable :: buffer
      integer :: length

      length = len(text)
      call mpi_bcast(length, 1, mpi_integer, process, mpi_comm_world)
      allocate (character(length) :: buffer)
      if (this_process() == process) buffer = text
      call mpi_bcast(buffer, length, mpi_character, process, mpi_comm_world)
      call move_alloc(buffer, text)
   end subroutine tell_all

   !> Sends bytes to the first process, which takes them with `from_process`.
   subroutine to_first(bytes)
      integer(int8), contiguous, intent(in) :: bytes(:)

      call mpi_send(bytes, size(bytes), mpi_byte, 0, 1, mpi_comm_world)
   end subroutine to_first

   !> Takes bytes that another process sends to the first one.
   subroutine from_process(process, bytes)
      integer, intent(in) :: process
      integer(int8), contiguous, intent(inout) :: bytes(:)

      call mpi_recv(bytes, size(bytes), mpi_byte, process, 1, mpi_comm_world, mpi_status_ignore)
   end subroutine from_process

end module communication
