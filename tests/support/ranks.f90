!> Tests that mpirun has started as several processes.
module ranks
   use communication, only: end_processes, n_processes, start_processes
   implicit none
   private

   public :: start_ranks, end_ranks

contains

   !> Before the first test.
   subroutine start_ranks()
      integer :: length

      call get_environment_variable('OMPI_COMM_WORLD_SIZE', length=length)
      if (length > 0) call start_processes()
   end subroutine start_ranks

   !> After the last one.
   subroutine end_ranks()
      if (n_processes() > 1) call end_processes()
   end subroutine end_ranks

end module ranks
