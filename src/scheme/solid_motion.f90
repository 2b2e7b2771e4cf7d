!> Solids through the stages of a step: prescribed ones where they are then, free ones where forces lead them.
!!
!! Source: ours (docs/equations.md, Free bodies): the scheme of the fluid, with the same stages and weights.
module solid_motion
   use blocks, only: moment_t
   use box, only: box_t
   use free_bodies, only: add_drag, outer_power, own_force
   use kinds, only: dp
   use model, only: model_t, terms_t
   use motions, only: pose_t
   use neighbours, only: neighbours_t
   use particles, only: particles_t
   use rigid_bodies, only: acceleration_of, pose_from, rate_of, way_of
   use runge_kutta, only: fastest
   use solid_terms, only: meet_solids
   use solids, only: obstacle_t, obstacles_in
   use step_state, only: step_t
   implicit none
   private

   public :: solid_motion_t, new_solid_motion, lost_solid, meet_at_base

   !> The way of all solids in a step.
   type :: solid_motion_t
      type(pose_t), allocatable :: poses(:)            !! (solids) at the stage; at last, at the end of the step
      real(dp) :: damped = 0                           !! [J/m] that dampers took,
      real(dp) :: given = 0                            !! [J/m] and that the uniform force and inertia gave
      integer :: lost = 0                              !! a free solid that has left its range as a particle can; 0: none
      type(pose_t), allocatable, private :: base(:)
      real(dp), allocatable, private :: change(:, :)   ! (6, solids) dt sum_k b_k of velocity and acceleration
   contains
      procedure :: find_obstacles
      procedure :: take_forces
      procedure :: lead_on
      procedure, private :: keep_range
   end type solid_motion_t

contains

   !> At the start of a step.
   pure type(solid_motion_t) function new_solid_motion(poses) result(self)
      type(pose_t), intent(in) :: poses(:)

      allocate (self%poses, self%base, source=poses)
      allocate (self%change(6, size(poses)), source=0.0_dp)
   end function new_solid_motion

   !> Takes what forces do to free solids at a stage, when they are known; the last one leads to the end of the step.
   subroutine take_forces(self, model, near, moment)
      class(solid_motion_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      type(neighbours_t), intent(inout) :: near   !! friction on its ghosts is that of the step, or of the stage
      type(moment_t), intent(inout) :: moment     !! of the last stage, gets its obstacles
      type(terms_t) :: has
      real(dp) :: force(3), weight
      integer :: k

      if (.not. allocated(near%ghosts%free)) return
      has = model%terms()
      ! Even if forces on ghosts are frozen, their moment is not: ghosts give it its power where they are.
      if (has%friction_works) call add_drag(model, near)
      weight = model%integrator%weight(moment%stage)*moment%dt
      do k = 1, size(self%poses)
         associate (body => model%solids(k)%body, pose => self%poses(k))
            if (.not. body%is_free()) cycle
            force = near%ghosts%free%load(:, k) + near%ghosts%free%drag(:, k) + own_force(model, moment%box, k, pose)
            force = merge(force/body%masses(), 0.0_dp, body%moves)
            pose%acceleration = force(:2)
            pose%spin_rate = force(3)
            self%change(:, k) = self%change(:, k) + weight*[rate_of(pose), force]
            self%damped = self%damped + weight*body%damped_power(pose)
            self%given = self%given + weight*outer_power(model, moment%box, k, pose)
         end associate
      end do
      if (moment%stage < model%integrator%stages) return
      self%poses = model%poses_at(moment%last_box%time, ahead(self, 1.0_dp, self%change))
      call self%keep_range(model)
      call self%find_obstacles(model, moment%last_box, moment%obstacles)
   end subroutine take_forces

   !> All solids in a box at the end of the step; of free ones, those of the stage.
   pure subroutine find_obstacles(self, model, box, obstacles)
      class(solid_motion_t), intent(in) :: self
      type(model_t), intent(in) :: model
      type(box_t), intent(in) :: box
      type(obstacle_t), allocatable, intent(inout) :: obstacles(:)

      if (allocated(obstacles)) deallocate (obstacles)
      obstacles = obstacles_in(model%solids, model%poses_at(box%time, self%poses), box)
   end subroutine find_obstacles

   !> Goes on to the next stage's poses; how far they are from where lists reach, else what it was.
   subroutine lead_on(self, model, near, moment, time, farthest)
      class(solid_motion_t), intent(inout) :: self
      type(model_t), intent(in) :: model
      type(neighbours_t), intent(inout) :: near
      type(moment_t), intent(in) :: moment        !! a stage but the last
      real(dp), intent(in) :: time                !! of the next stage [s]
      real(dp), intent(inout) :: farthest         !! [m]
      real(dp) :: rates(6, size(self%poses)), step, way
      integer :: k

      if (.not. model%has_solids()) return
      step = model%integrator%ahead(moment%stage)*moment%dt
      do k = 1, size(self%poses)
         rates(:, k) = [rate_of(self%poses(k)), self%poses(k)%acceleration, self%poses(k)%spin_rate]
      end do
      self%poses = model%poses_at(time, ahead(self, step, rates))
      if (.not. allocated(near%ghosts%free)) return
      call self%keep_range(model)
      call near%ghosts%free%overreach(model%solids, self%poses, near%age + step, way)
      if (self%lost > 0) way = huge(way)   ! no lists are for it
      farthest = max(farthest, way)
   end subroutine lead_on

   ! Puts solids that left their range back to where the step began, and notes that there are any.
   pure subroutine keep_range(self, model)
      class(solid_motion_t), intent(inout) :: self
      type(model_t), intent(in) :: model

      if (self%lost == 0) self%lost = lost_solid(model, self%poses)
      if (self%lost > 0) self%poses = self%base
   end subroutine keep_range

   !> The number of a free solid that is too fast for any lists, or nowhere; 0 if there is none.
   pure integer function lost_solid(model, poses) result(lost)
      type(model_t), intent(in) :: model
      type(pose_t), intent(in) :: poses(:)
      integer :: k

      lost = 0
      do k = 1, size(poses)
         associate (pose => poses(k), solid => model%solids(k))
            if (solid%body%is_free() .and. .not. norm2(pose%velocity) + abs(pose%spin)*solid%radius() < fastest*model%c0) lost = k
         end associate
      end do
   end function lost_solid

   ! From the base: by a time and rates.
   pure function ahead(self, time, rates) result(poses)
      type(solid_motion_t), intent(in) :: self
      real(dp), intent(in) :: time, rates(:, :)
      type(pose_t) :: poses(size(self%base))
      real(dp) :: way(3), rate(3), acceleration(3)
      integer :: k

      do k = 1, size(poses)
         way = way_of(self%base(k))
         rate = rate_of(self%base(k))
         acceleration = acceleration_of(self%poses(k))
         poses(k) = pose_from(way + time*rates(:3, k), rate + time*rates(4:, k), acceleration)
      end do
   end function ahead

   !> Ghosts and fluid at the base state.
   subroutine meet_at_base(model, p, near, run)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      type(neighbours_t), intent(inout) :: near
      type(step_t), intent(in) :: run

      if (.not. near%ghosts%exist()) return
      if (allocated(near%ghosts%free)) near%ghosts%free%drag = run%drag
      call meet_solids(model, model%box_at(run%time), run%poses, near, p%base)
   end subroutine meet_at_base

end module solid_motion
