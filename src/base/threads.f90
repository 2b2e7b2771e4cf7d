!> How many threads are worth their while.
module threads
   use omp_lib, only: omp_get_max_threads, omp_set_num_threads
   implicit none
   private

   public :: limit_threads

   !> Particles of a thread: with fewer, waiting for the others costs more than a thread gains.
   integer, parameter, public :: least_per_thread = 1000

contains

   !> Lets the program use no more threads than have enough particles each. What is computed does not depend on it.
   subroutine limit_threads(particles, before)
      integer, intent(in) :: particles
      integer, intent(out), optional :: before   !! threads that there were, for omp_set_num_threads

      if (present(before)) before = omp_get_max_threads()
      call omp_set_num_threads(max(1, min(omp_get_max_threads(), particles/least_per_thread)))
   end subroutine limit_threads

end module threads
