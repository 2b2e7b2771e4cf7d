!> What the processes of a run tell each other: MPI, and nothing else names it.
!!
!! Buffers are contiguous and stay where they are until messages have arrived: gfortran's MPI modules take no others.
module communication
   use, intrinsic :: iso_c_binding, only: c_f_pointer, c_ptr
   use, intrinsic :: iso_fortran_env, only: int8
   use kinds, only: dp, i8
   use mpi_f08, only: mpi_abort, mpi_allreduce, mpi_alltoall, mpi_bcast, mpi_byte, mpi_character, mpi_comm, mpi_comm_dup, &
      mpi_comm_free, mpi_comm_rank, mpi_comm_size, mpi_comm_split_type, mpi_comm_type_shared, mpi_comm_world, mpi_datatype, &
      mpi_double_precision, mpi_finalize, mpi_get_library_version, mpi_ibarrier, mpi_in_place, mpi_info_null, mpi_init_thread, &
      mpi_initialized, mpi_integer, mpi_integer8, mpi_irecv, mpi_isend, mpi_logical, mpi_lor, mpi_max, &
      mpi_max_library_version_string, mpi_op, mpi_op_create, mpi_recv, mpi_request, mpi_send, mpi_status_ignore, &
      mpi_statuses_ignore, mpi_sum, mpi_test, mpi_testall, mpi_thread_funneled, mpi_type_commit, mpi_type_contiguous, &
      mpi_type_free, mpi_type_size, mpi_waitall, mpi_wtime
   implicit none
   private

   public :: start_processes, end_processes, all_end, end_all, n_processes, this_process, processes_here, is_first, &
      library_words, reductions, any_process, largest_of_all, sums_of_all, combine, exchange_counts, exchange, exchange_t, &
      tell_all, to_first, from_process

   !> Numbers on their way to and from the others.
   type :: exchange_t
      real(dp), allocatable :: outgoing(:), incoming(:)   !! those of a process behind those of the one before it
      integer(i8) :: messages = 0, bytes = 0              !! sent so far
      integer, allocatable, private :: out_end(:), in_end(:)   ! (-1:processes-1)
      type(mpi_request), allocatable, private :: requests(:)
      integer, private :: n = 0                           ! requests
      logical, private :: arrived = .true.
   contains
      procedure :: make_room
      procedure :: start
      procedure :: go_on
      procedure :: finish
   end type exchange_t

   integer, save :: n_started = 1, rank = 0
   integer(i8), save :: n_reductions = 0
   type(mpi_comm), save :: farewell   !! of messages at the end alone: they must not meet others
   type(mpi_op), save :: combination          !! of records: combine_records
   type(mpi_datatype), save :: record         !! of `record_length` integers
   integer, save :: record_length = 0
   real(dp), parameter :: patience = 10   !! [s] that processes may end one after the other

contains

   !> To be called before all others.
   subroutine start_processes()
      integer :: provided

      call mpi_init_thread(mpi_thread_funneled, provided)
      call mpi_comm_dup(mpi_comm_world, farewell)
      call mpi_comm_size(mpi_comm_world, n_started)
      call mpi_comm_rank(mpi_comm_world, rank)
   end subroutine start_processes

   !> Whether all have come to their end. Else some wait for a message that will not come.
   logical function all_end()
      type(mpi_request) :: request
      real(dp) :: start, waited

      all_end = .true.
      if (n_processes() == 1) return
      call mpi_ibarrier(farewell, request)
      start = mpi_wtime()
      waited = 0
      do while (waited < patience)
         call mpi_test(request, all_end, mpi_status_ignore)
         if (all_end) exit
         waited = mpi_wtime() - start
      end do
   end function all_end

   !> Ends all processes, wherever they are.
   subroutine end_all(code)
      integer, intent(in) :: code   !! of the program

      call mpi_abort(mpi_comm_world, code)
   end subroutine end_all

   !> To be called when all is written.
   subroutine end_processes()
      logical :: started

      call mpi_initialized(started)
      if (started) call mpi_finalize()
   end subroutine end_processes

   !> How many there are; one before they are started, as in a test.
   pure integer function n_processes()
      n_processes = n_started
   end function n_processes

   !> Which of them this is, from 0.
   pure integer function this_process()
      this_process = rank
   end function this_process

   !> How many of them share the memory of this machine.
   integer function processes_here()
      type(mpi_comm) :: machine

      processes_here = 1
      if (n_processes() == 1) return
      call mpi_comm_split_type(mpi_comm_world, mpi_comm_type_shared, 0, mpi_info_null, machine)
      call mpi_comm_size(machine, processes_here)
      call mpi_comm_free(machine)
   end function processes_here

   !> What lets them talk to each other, for the user; '' in a program of one process.
   function library_words() result(words)
      character(:), allocatable :: words
      character(mpi_max_library_version_string) :: buffer
      integer :: length

      call mpi_get_library_version(buffer, length)
      words = buffer(:length)
      if (scan(words, ',;('//new_line('a')) > 1) words = words(:scan(words, ',;('//new_line('a')) - 1)
   end function library_words

   !> Whether this is the process that writes files and talks to the user.
   pure logical function is_first()
      is_first = this_process() == 0
   end function is_first

   !> How often all have waited for one number of all so far: for a largest value, a sum, or counts of each.
   pure integer(i8) function reductions()
      reductions = n_reductions
   end function reductions

   !> Whether a statement holds in some process.
   logical function any_process(statement)
      logical, intent(in) :: statement

      any_process = statement
      if (n_processes() == 1) return
      n_reductions = n_reductions + 1
      call mpi_allreduce(mpi_in_place, any_process, 1, mpi_logical, mpi_lor, mpi_comm_world)
   end function any_process

   !> Each value becomes its largest over all processes.
   subroutine largest_of_all(n, values)
      integer, intent(in) :: n
      real(dp), intent(inout) :: values(n)

      if (n_processes() == 1) return
      n_reductions = n_reductions + 1
      call mpi_allreduce(mpi_in_place, values, n, mpi_double_precision, mpi_max, mpi_comm_world)
   end subroutine largest_of_all

   !> Each number becomes its sum over all processes.
   subroutine sums_of_all(n, numbers)
      integer, intent(in) :: n
      integer(i8), intent(inout) :: numbers(n)

      if (n_processes() == 1) return
      n_reductions = n_reductions + 1
      call mpi_allreduce(mpi_in_place, numbers, n, mpi_integer8, mpi_sum, mpi_comm_world)
   end subroutine sums_of_all

   !> Both in one reduction: each number becomes its sum over all processes, each value its largest.
   subroutine combine(numbers, values)
      integer(i8), contiguous, intent(inout) :: numbers(:)
      real(dp), contiguous, intent(inout) :: values(:)
      integer(i8) :: buffer(2 + size(numbers) + size(values))

      if (n_processes() == 1) return
      n_reductions = n_reductions + 1
      if (record_length /= size(buffer)) then
         if (record_length == 0) call mpi_op_create(combine_records, .true., combination)
         if (record_length > 0) call mpi_type_free(record)
         record_length = size(buffer)
         call mpi_type_contiguous(record_length, mpi_integer8, record)
         call mpi_type_commit(record)
      end if
      buffer = [int([size(numbers), size(values)], i8), numbers, transfer(values, numbers)]
      call mpi_allreduce(mpi_in_place, buffer, 1, record, combination, mpi_comm_world)
      numbers = buffer(3:2 + size(numbers))
      values = transfer(buffer(3 + size(numbers):), values)
   end subroutine combine

   ! Of MPI: what two processes have. A record tells how many sums and largest values are in it.
   subroutine combine_records(theirs, ours, n, kind)
      type(c_ptr), value :: theirs, ours
      integer :: n   !! records
      type(mpi_datatype) :: kind
      integer(i8), pointer, contiguous :: a(:), b(:)
      integer :: k, first, sums, length

      call mpi_type_size(kind, length)
      length = length/(storage_size(a)/8)
      call c_f_pointer(theirs, a, [n*length])
      call c_f_pointer(ours, b, [n*length])
      do first = 0, (n - 1)*length, length
         sums = int(b(first + 1))
         do k = first + 3, first + 2 + sums
            b(k) = a(k) + b(k)
         end do
         do k = first + 3 + sums, first + length
            b(k) = transfer(max(transfer(a(k), 1.0_dp), transfer(b(k), 1.0_dp)), b(k))
         end do
      end do
   end subroutine combine_records

   !> Tells each process a number.
   subroutine exchange_counts(outgoing, incoming)
      integer, intent(in) :: outgoing(0:)    !! (processes) for each
      integer, intent(out) :: incoming(0:)   !! (processes) of each

      incoming = outgoing
      if (n_processes() == 1) return
      n_reductions = n_reductions + 1
      call mpi_alltoall(outgoing, 1, mpi_integer, incoming, 1, mpi_integer, mpi_comm_world)
   end subroutine exchange_counts

   !> Sends to each process the numbers before and including `out_end` of it, from one after that of the process before it.
   subroutine exchange(outgoing, out_end, incoming, in_end)
      real(dp), contiguous, intent(in) :: outgoing(:)
      integer, intent(in) :: out_end(-1:)   !! (-1:processes-1)
      real(dp), contiguous, intent(inout) :: incoming(:)
      integer, intent(in) :: in_end(-1:)
      type(exchange_t) :: messages

      if (n_processes() == 1) then
         incoming = outgoing
         return
      end if
      call messages%make_room(1, out_end, in_end)
      messages%outgoing = outgoing
      call messages%start()
      call messages%finish()
      incoming = messages%incoming
   end subroutine exchange

   !> Room for so many values of each thing that goes to and comes from the others.
   subroutine make_room(self, values, out_end, in_end)
      class(exchange_t), intent(inout) :: self
      integer, intent(in) :: values
      integer, intent(in) :: out_end(-1:), in_end(-1:)   !! (-1:processes-1) things until those of a process
      integer :: n

      n = n_processes()
      if (.not. allocated(self%requests)) allocate (self%requests(2*n), self%out_end(-1:n - 1), self%in_end(-1:n - 1))
      self%out_end = values*out_end
      self%in_end = values*in_end
      if (allocated(self%outgoing)) then
         if (size(self%outgoing) /= self%out_end(n - 1)) deallocate (self%outgoing)
      end if
      if (allocated(self%incoming)) then
         if (size(self%incoming) /= self%in_end(n - 1)) deallocate (self%incoming)
      end if
      if (.not. allocated(self%outgoing)) allocate (self%outgoing(self%out_end(n - 1)))
      if (.not. allocated(self%incoming)) allocate (self%incoming(self%in_end(n - 1)))
   end subroutine make_room

   !> Sends what `outgoing` holds.
   subroutine start(self)
      class(exchange_t), intent(inout), asynchronous :: self
      integer :: process

      self%n = 0
      self%arrived = .false.
      do process = 0, ubound(self%in_end, 1)
         associate (first => self%in_end(process - 1) + 1, last => self%in_end(process))
            if (last >= first) call receive(self, process, last - first + 1, self%incoming(first:last))
         end associate
      end do
      do process = 0, ubound(self%out_end, 1)
         associate (first => self%out_end(process - 1) + 1, last => self%out_end(process))
            if (last < first) cycle
            call send(self, process, last - first + 1, self%outgoing(first:last))
            self%messages = self%messages + 1
            self%bytes = self%bytes + storage_size(0.0_dp)/8*(last - first + 1)
         end associate
      end do
   end subroutine start

   subroutine receive(self, process, length, buffer)
      class(exchange_t), intent(inout) :: self
      integer, intent(in) :: process, length
      real(dp), intent(inout), asynchronous :: buffer(length)

      self%n = self%n + 1
      call mpi_irecv(buffer, length, mpi_double_precision, process, 0, mpi_comm_world, self%requests(self%n))
   end subroutine receive

   subroutine send(self, process, length, buffer)
      class(exchange_t), intent(inout) :: self
      integer, intent(in) :: process, length
      real(dp), intent(in), asynchronous :: buffer(length)

      self%n = self%n + 1
      call mpi_isend(buffer, length, mpi_double_precision, process, 0, mpi_comm_world, self%requests(self%n))
   end subroutine send

   !> Lets messages go on that need a hand.
   subroutine go_on(self)
      class(exchange_t), intent(inout), asynchronous :: self

      if (.not. self%arrived) call mpi_testall(self%n, self%requests, self%arrived, mpi_statuses_ignore)
   end subroutine go_on

   !> Waits until `incoming` is there, and `outgoing` may change again.
   subroutine finish(self)
      class(exchange_t), intent(inout), asynchronous :: self

      if (.not. self%arrived) call mpi_waitall(self%n, self%requests, mpi_statuses_ignore)
      self%arrived = .true.
   end subroutine finish

   !> All get the text of one of them.
   subroutine tell_all(text, process)
      character(:), allocatable, intent(inout) :: text
      integer, intent(in) :: process
      character(:), allocatable :: buffer
      integer :: length

      if (n_processes() == 1) return
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
