!> Whole time steps of a small set of particles.
module march
   use energy, only: energies_t, measure_energies
   use kinds, only: dp
   use model, only: model_t
   use neighbours, only: neighbours_t
   use particles, only: particles_t
   use patches, only: deal, points_of, points_t, scatter
   use step_state, only: step_t
   use time_step, only: advance, refresh
   use timers, only: timers_t
   implicit none
   private

   public :: end_t, march_on, new_timers

   !> What is left at the end.
   type :: end_t
      type(points_t) :: at          !! last state
      type(step_t) :: run
      type(energies_t) :: first, last
      real(dp), allocatable :: dissipated(:)   !! (n) if it was asked for
   contains
      procedure :: balance_error
   end type end_t

contains

   !> Takes steps from the state in `next` until each of `n` intervals has passed, in steps of the model's own choice or shorter.
   subroutine march_on(model, start, interval, n, finish)
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: start   !! as from the set-up
      real(dp), intent(in) :: interval
      integer, intent(in) :: n
      type(end_t), intent(out) :: finish
      type(particles_t) :: p
      type(neighbours_t) :: near
      type(timers_t) :: timers
      integer :: k

      p = start
      call deal(p)
      timers = new_timers()
      call refresh(model, p, near, finish%run, timers)
      call measure_energies(model, p, finish%first)
      do k = 1, n
         do while (finish%run%time < k*interval)
            call advance(model, p, near, finish%run, k*interval, timers)
            if (finish%run%lost .or. finish%run%scattered) error stop 'the test''s particles were lost'
            call refresh(model, p, near, finish%run, timers)
         end do
      end do
      call measure_energies(model, p, finish%last)
      finish%at = points_of(p)
      if (.not. p%features%dissipation) return
      allocate (finish%dissipated(p%n))
      call scatter(p, p%dissipated, finish%dissipated)
   end subroutine march_on

   !> Watches for the phases of a step.
   type(timers_t) function new_timers() result(timers)
      call timers%initialise([character(9) :: 'sort', 'gradients', 'diffusion', 'stages'])
   end function new_timers

   !> Energy that appeared from nowhere.
   pure real(dp) function balance_error(self)
      class(end_t), intent(in) :: self

      balance_error = self%last%total() - self%first%total() - self%run%work_alpha - self%run%work_delta - self%run%work_walls &
                      - self%run%work_force - self%run%given_by_sponges()
   end function balance_error

end module march
