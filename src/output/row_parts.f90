!> Rows that each process has a part of, one part behind the other, and that the first process asks for chunk by chunk.
module row_parts
   use, intrinsic :: iso_c_binding, only: c_f_pointer, c_ptr
   use, intrinsic :: iso_fortran_env, only: int8
   use communication, only: from_process, n_processes, sums_of_all, this_process, to_first
   use kinds, only: i8
   implicit none
   private

   public :: rows_before, send_rows, take_rows

contains

   !> Rows before those of each process; behind the last one: all.
   function rows_before(mine) result(before)
      integer(i8), intent(in) :: mine   !! rows of this process
      integer(i8), allocatable :: before(:)
      integer :: process

      allocate (before(0:n_processes()), source=0_i8)
      before(this_process() + 1) = mine
      call sums_of_all(size(before), before)
      do process = 1, n_processes()
         before(process) = before(process - 1) + before(process)
      end do
   end function rows_before

   !> What a process other than the first has of each chunk.
   subroutine send_rows(before, chunk, row_bytes, address)
      integer(i8), intent(in) :: before(0:)
      integer(i8), intent(in) :: chunk   !! rows
      integer, intent(in) :: row_bytes
      type(c_ptr), intent(in) :: address
      integer(int8), pointer, contiguous :: bytes(:)
      integer(i8) :: first, last, start

      associate (mine => before(this_process()), next => before(this_process() + 1))
         if (next == mine) return
         call c_f_pointer(address, bytes, [(next - mine)*row_bytes])
         do start = 0, before(ubound(before, 1)) - 1, chunk
            first = max(start, mine)
            last = min(start + chunk, next)
            if (last > first) call to_first(bytes((first - mine)*row_bytes + 1:(last - mine)*row_bytes))
         end do
      end associate
   end subroutine send_rows

   !> Of the first process: all rows of a chunk, its own and those that others send.
   subroutine take_rows(before, start, n, row_bytes, address, chunk)
      integer(i8), intent(in) :: before(0:)
      integer(i8), intent(in) :: start, n        !! rows before the chunk, and in it
      integer, intent(in) :: row_bytes
      type(c_ptr), intent(in) :: address         !! of its own rows
      integer(int8), contiguous, intent(inout) :: chunk(:)
      integer(int8), pointer, contiguous :: mine(:)
      integer(i8) :: first, last, from, to
      integer :: process

      do process = 0, ubound(before, 1) - 1
         first = max(start, before(process))
         last = min(start + n, before(process + 1))
         if (last <= first) cycle
         from = (first - start)*row_bytes + 1
         to = (last - start)*row_bytes
         if (process == 0) then
            call c_f_pointer(address, mine, [before(1)*row_bytes])
            chunk(from:to) = mine(first*row_bytes + 1:last*row_bytes)
         else
            call from_process(process, chunk(from:to))
         end if
      end do
   end subroutine take_rows

end module row_parts
