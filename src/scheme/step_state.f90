!> What the steps of a run leave behind, besides the particles.
module step_state
   use archive, only: archive_t
   use communication, only: largest_of_all
   use equation_of_state, only: specific_pressure
   use kinds, only: dp, i8
   use model, only: model_t
   use motions, only: pose_t
   use particles, only: particles_t
   use rigid_bodies, only: acceleration_of, pose_from, rate_of, way_of
   implicit none
   private

   public :: step_t, start_extremes, take_extremes

   integer, parameter, public :: n_of_solid = 6   !! sums of each solid

   !> What steps leave behind: time, counts, sums and extremes.
   type :: step_t
      real(dp) :: time = 0
      real(dp) :: dt = 0                    !! last step
      integer :: step = 0                   !! steps done
      integer(i8) :: crossings = 0          !! particles put back behind a wall
      integer(i8) :: singular = 0           !! particle-steps without a density gradient
      integer(i8) :: limited = 0            !! steps shorter than eq. 8, for the diffusive terms' stability
      integer(i8) :: sorted = 0             !! times that particles were sorted and neighbours listed
      integer(i8) :: repeated = 0           !! steps done again, with a larger search margin or shorter
      real(dp) :: work_alpha = 0            !! energy given by viscosity, <= 0
      real(dp) :: work_delta = 0            !! energy given by density diffusion
      real(dp) :: work_walls = 0            !! energy given by the walls' images, and by moving no-slip walls
      real(dp) :: work_force = 0            !! energy given by the uniform force
      real(dp) :: work_still = 0            !! energy given by solids besides -F.U: by the hydrostatic parts of their pressure
      real(dp), allocatable :: solids(:, :) !! (n_of_solid, solids) energy given by each by -F.U, of it friction's; impulse (2) by
                                            !! particles that were put back, its moment, energy given to them
      type(pose_t), allocatable :: poses(:) !! (solids) of prescribed ones as the motions have them, set_poses
      real(dp), allocatable :: drag(:, :)   !! (3, solids) force and moment of friction on free ones; where there are any
      real(dp) :: work_damper = 0           !! energy given by dampers of free solids, <= 0
      real(dp) :: work_rebound = 0          !! energy that these have by what they put back
      real(dp), allocatable :: work_sponges !! energy given by sponge layers, <= 0; where there are any
      real(dp) :: mach = 0                  !! eq. 4: max of |u| and sqrt(p/rho) over c0, of the base state
      real(dp) :: speed = 0                 !! max |u| of the base state
      real(dp) :: variation = 0             !! max |rho - rho0|/rho0 of the base state
      real(dp) :: largest_mach = 0          !! over all steps
      real(dp) :: largest_variation = 0     !! over all steps
      logical :: lost = .false.             !! some particle's or free solid's state left its range (not kept: then all ends)
      integer :: lost_solid = 0             !! number of such a solid; 0 if none (not kept: then all ends)
      integer :: lost_slot = 0              !! slot of a particle whose state left its range; 0 if none (not kept: then all ends)
      logical :: scattered = .false.        !! some particle is too far away for the neighbour search (not kept: then all ends)
   contains
      procedure :: set_poses
      procedure :: take_solids
      procedure :: take_sponges
      procedure :: given_by_sponges
      procedure :: work_solids
      procedure :: archive => archive_step
   end type step_t

contains

   subroutine archive_step(self, file)
      class(step_t), intent(inout) :: self
      class(archive_t), intent(inout) :: file

      call file%part('step')
      call file%keep('time', self%time)
      call file%keep('dt', self%dt)
      call file%keep('step', self%step)
      call file%keep('crossings', self%crossings)
      call file%keep('singular', self%singular)
      call file%keep('limited', self%limited)
      call file%keep('sorted', self%sorted)
      call file%keep('repeated', self%repeated)
      call file%keep('work_alpha', self%work_alpha)
      call file%keep('work_delta', self%work_delta)
      call file%keep('work_walls', self%work_walls)
      call file%keep('work_force', self%work_force)
      if (allocated(self%solids)) call file%keep('work_still', self%work_still)
      if (allocated(self%solids)) call archive_solids(self, file)
      if (allocated(self%drag)) then
         call archive_poses(self%poses, self%drag, file)
         call file%keep('work_damper', self%work_damper)
         call file%keep('work_rebound', self%work_rebound)
      end if
      if (allocated(self%work_sponges)) call file%keep('work_sponges', self%work_sponges)
      call file%keep('mach', self%mach)
      call file%keep('speed', self%speed)
      call file%keep('variation', self%variation)
      call file%keep('largest_mach', self%largest_mach)
      call file%keep('largest_variation', self%largest_variation)
   end subroutine archive_step

   subroutine archive_solids(self, file)
      class(step_t), intent(inout) :: self
      class(archive_t), intent(inout) :: file
      real(dp) :: numbers(size(self%solids))

      numbers = reshape(self%solids, [size(self%solids)])
      call file%keep('solids', numbers)
      self%solids = reshape(numbers, shape(self%solids))
   end subroutine archive_solids

   subroutine archive_poses(poses, drag, file)
      type(pose_t), intent(inout) :: poses(:)
      real(dp), intent(inout) :: drag(:, :)
      class(archive_t), intent(inout) :: file
      real(dp) :: numbers(12, size(poses)), flat(12*size(poses))
      integer :: k

      do k = 1, size(poses)
         numbers(:, k) = [way_of(poses(k)), rate_of(poses(k)), acceleration_of(poses(k)), drag(:, k)]
      end do
      flat = reshape(numbers, [size(flat)])
      call file%keep('poses', flat)
      numbers = reshape(flat, shape(numbers))
      do k = 1, size(poses)
         poses(k) = pose_from(numbers(1:3, k), numbers(4:6, k), numbers(7:9, k))
         drag(:, k) = numbers(10:12, k)
      end do
   end subroutine archive_poses

   !> Poses of solids at the time of the run; free ones stay as they are, or start.
   pure subroutine set_poses(self, model)
      class(step_t), intent(inout) :: self
      type(model_t), intent(in) :: model

      if (allocated(self%poses)) then
         self%poses = model%poses_at(self%time, self%poses)
      else
         self%poses = model%poses_at(self%time)
         if (model%has_free_bodies()) allocate (self%drag(3, size(self%poses)), source=0.0_dp)
      end if
   end subroutine set_poses

   !> Adds what a step's solids have come to.
   pure subroutine take_solids(self, given, solids)
      class(step_t), intent(inout) :: self
      real(dp), intent(in) :: given          !! [J/m] that the fluid got by their pressure
      real(dp), intent(in) :: solids(:, :)   !! (n_of_solid, solids) as in step_t

      if (.not. allocated(self%solids)) allocate (self%solids, source=0*solids)
      self%solids = self%solids + solids
      ! Friction is no pressure.
      self%work_still = self%work_still + given - sum(solids(1, :) - solids(2, :))
   end subroutine take_solids

   !> Adds what a step's sponge layers have given.
   pure subroutine take_sponges(self, given)
      class(step_t), intent(inout) :: self
      real(dp), intent(in) :: given   !! [J/m]

      if (.not. allocated(self%work_sponges)) allocate (self%work_sponges, source=0.0_dp)
      self%work_sponges = self%work_sponges + given
   end subroutine take_sponges

   !> Energy that sponge layers have given [J/m].
   pure real(dp) function given_by_sponges(self) result(work)
      class(step_t), intent(in) :: self

      work = 0
      if (allocated(self%work_sponges)) work = self%work_sponges
   end function given_by_sponges

   !> Energy that solids have given: by -F.U, free ones left out, for they have it of the fluid; by putting particles back [J/m].
   pure function work_solids(self, model) result(work)
      class(step_t), intent(in) :: self
      type(model_t), intent(in) :: model
      real(dp) :: work(2)

      work = 0
      if (.not. allocated(self%solids)) return
      work = [sum(self%solids(1, :), mask=.not. model%solids%body%is_free()), sum(self%solids(6, :)) + self%work_rebound]
   end function work_solids

   !> Extremes of the state that the run starts with; steps take those of the states they end with.
   subroutine start_extremes(model, p, run)
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p         !! base state
      type(step_t), intent(inout) :: run
      real(dp) :: largest(3)   ! |u|**2, p/rho, |rho - rho0|

      if (model%has_solids()) allocate (run%solids(n_of_solid, size(model%solids)), source=0.0_dp)
      if (allocated(model%sponges)) allocate (run%work_sponges, source=0.0_dp)
      associate (own => p%id(1:p%n_own) > 0, s => p%base%s(1:p%n_own))
         largest = [maxval(p%base%u(1:p%n_own)**2 + p%base%v(1:p%n_own)**2, mask=own), &
                    maxval(specific_pressure(model%c0, model%rho0, s), mask=own), maxval(abs(s), mask=own)]
      end associate
      call largest_of_all(3, largest)
      call take_extremes(model, largest(1), largest(2), largest(3), run)
   end subroutine start_extremes

   !> Extremes of a state, and what they make of the largest so far.
   pure subroutine take_extremes(model, speed_2, pressure, largest_s, run)
      type(model_t), intent(in) :: model
      real(dp), intent(in) :: speed_2     !! largest |u|**2
      real(dp), intent(in) :: pressure    !! largest p/rho
      real(dp), intent(in) :: largest_s   !! largest |rho - rho0|
      type(step_t), intent(inout) :: run

      run%speed = sqrt(speed_2)
      run%mach = sqrt(max(speed_2, pressure))/model%c0
      run%variation = largest_s/model%rho0
      run%largest_mach = max(run%largest_mach, run%mach)
      run%largest_variation = max(run%largest_variation, run%variation)
   end subroutine take_extremes

end module step_state
