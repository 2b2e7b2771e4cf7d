!> How many threads are worth their while.
module threads
   use communication, only: n_processes
   use omp_lib, only: omp_get_max_threads, omp_get_num_procs, omp_set_num_threads
   use text, only: to_text
   implicit none
   private

   public :: limit_threads, sane_threads

   !> Particles of a thread: with fewer, waiting for the others costs more than a thread gains.
   integer, parameter, public :: least_per_thread = 1000
   !> Threads of a processor: with more, OMP_NUM_THREADS was meant for another machine, or is a typing error.
   integer, parameter, public :: most_per_processor = 8

contains

   !> Lets the program use no more threads than have enough particles each. What is computed does not depend on it.
   subroutine limit_threads(particles, before)
      integer, intent(in) :: particles           !! of all processes
      integer, intent(out), optional :: before   !! threads that there were, for omp_set_num_threads

      if (present(before)) before = omp_get_max_threads()
      call omp_set_num_threads(max(1, min(omp_get_max_threads(), particles/(least_per_thread*n_processes()))))
   end subroutine limit_threads

   !> Lets the program use one thread a processor if absurdly many are asked for: they would wait for each other, or cannot be made.
   subroutine sane_threads(remark)
      character(:), allocatable, intent(out) :: remark   !! '' unless that was so
      integer :: asked, processors

      asked = omp_get_max_threads()
      processors = omp_get_num_procs()
      remark = ''
      if (asked <= most_per_processor*processors) return
      call omp_set_num_threads(processors)
      remark = 'OMP_NUM_THREADS asks for '//to_text(asked)//' threads, and there are '//to_text(processors) &
         //' processors: at most '//to_text(processors)//' threads are used, and the results are the same'
   end subroutine sane_threads

end module threads
