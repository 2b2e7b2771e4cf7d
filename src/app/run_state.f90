!> All that a run is between two steps, and what of it a checkpoint keeps.
module run_state
   use archive, only: archive_t
   use kept_particles, only: archive_particles
   use limits, only: extremes_t
   use neighbours, only: neighbours_t
   use particles, only: particles_t
   use recorder, only: recorder_t
   use search_margins, only: plan_t
   use step_state, only: step_t
   implicit none
   private

   public :: run_state_t

   !> A run. It is kept only when the particles are about to be sorted: then neither their order nor the lists matter.
   type :: run_state_t
      type(step_t) :: step
      type(plan_t) :: plan          !! of the next sort, where the state is kept
      type(particles_t) :: p
      type(neighbours_t) :: near    !! (not kept: found by the sort)
      type(recorder_t) :: recorder
      type(extremes_t) :: extremes
      integer :: first_step = 0     !! that this process began with (not kept: of the process)
   contains
      procedure :: archive => archive_run
   end type run_state_t

contains

   !> Writes the state, or takes it into one that was set up for the same scene.
   subroutine archive_run(self, file)
      class(run_state_t), intent(inout) :: self
      class(archive_t), intent(inout) :: file

      call self%step%archive(file)
      call self%plan%archive(file)
      call archive_particles(self%p, file)
      call self%recorder%archive(file)
      call self%extremes%archive(file)
   end subroutine archive_run

end module run_state
