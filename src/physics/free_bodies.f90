!> How free solids are accelerated by the fluid, gravity, springs and dampers.
!!
!! Source: ours (docs/equations.md, Free bodies). The pressure of ghosts depends on the acceleration of their face: force and
!! acceleration follow together from three linear equations for each solid, and no share of the fluid's mass comes a stage late.
module free_bodies
   use box, only: box_t
   use exact_sum, only: add_over_processes, exact_sum_t
   use fitting, only: solve
   use kinds, only: dp
   use model, only: model_t
   use motions, only: pose_t, turn
   use neighbours, only: neighbours_t
   use particles, only: state_t
   use rigid_bodies, only: rate_of
   implicit none
   private

   public :: release, add_drag, own_force, outer_power

contains

   !> Gives ghosts, met by the fluid as if free solids were not accelerated, what their acceleration changes: density, force and
   !! power; sets the acceleration in the poses of the ghosts, and the load of pressure.
   subroutine release(model, box, near, state)
      type(model_t), intent(in) :: model
      type(box_t), intent(in) :: box               !! at the state's time
      type(neighbours_t), intent(inout) :: near
      type(state_t), intent(inout) :: state        !! density of the ghosts changes
      type(exact_sum_t) :: sums(12, size(model%solids))
      real(dp) :: totals(3, 4), parts(12), matrix(3, 3), right(3), arm(2), normal(2), along(3), change
      logical :: regular
      integer :: i, k, m, solid

      if (.not. allocated(near%ghosts%free)) return
      associate (ghosts => near%ghosts, free => near%ghosts%free, solids => model%solids)
         do k = 1, ghosts%n_slots
            solid = ghosts%solid_of(k)
            if (solid == 0) cycle
            if (.not. (solids(solid)%body%is_free() .and. near%computes(ghosts%x(k)))) cycle
            call face_of(model, near, k, arm, normal)
            along = [normal, arm(1)*normal(2) - arm(2)*normal(1)]*dot_product(normal, free%tilt(:, k))
            totals(:, 1) = with_moment(arm, free%push(:, k))
            do m = 1, 3
               totals(:, 1 + m) = with_moment(arm, free%area(:, k))*along(m)
            end do
            parts = reshape(totals, [12])
            do m = 1, 12
               call sums(m, solid)%add(parts(m))
            end do
         end do
         call add_all(sums)
         do solid = 1, size(solids)
            associate (body => solids(solid)%body, pose => ghosts%poses(solid))
               if (.not. body%is_free()) cycle
               totals = reshape([(sums(m, solid)%value(), m=1, 12)], [3, 4])
               matrix = -totals(:, 2:)
               right = totals(:, 1) + free%drag(:, solid) + own_force(model, box, solid, pose)
               do m = 1, 3
                  matrix(m, m) = matrix(m, m) + merge(body%mass, body%inertia, m < 3)
                  if (body%moves(m)) cycle
                  matrix(m, :) = 0
                  matrix(m, m) = 1
                  right(m) = 0
               end do
               call solve(matrix, right, regular)
               if (.not. regular) right = 0
               free%load(:, solid) = totals(:, 1) + matmul(totals(:, 2:), right)
               pose%acceleration = right(:2)
               pose%spin_rate = right(3)
            end associate
         end do
         do k = 1, ghosts%n_slots
            solid = ghosts%solid_of(k)
            if (solid == 0) cycle
            if (.not. solids(solid)%body%is_free()) cycle
            call face_of(model, near, k, arm, normal)
            i = ghosts%before + k
            associate (pose => ghosts%poses(solid))
               change = dot_product(normal, pose%acceleration + pose%spin_rate*[-arm(2), arm(1)]) &
                        *dot_product(normal, free%tilt(:, k))
            end associate
            state%s(i) = state%s(i) + change
            ghosts%force(:, k) = ghosts%force(:, k) + free%felt(:, k)*change
            ghosts%power(k) = ghosts%power(k) - dot_product(free%area(:, k), [state%u(i), state%v(i)])*change
         end do
      end associate
   end subroutine release

   ! From the pivot to a ghost, and the normal of its face.
   pure subroutine face_of(model, near, k, arm, normal)
      type(model_t), intent(in) :: model
      type(neighbours_t), intent(in) :: near
      integer, intent(in) :: k                 ! slot, counted from the first ghost's
      real(dp), intent(out) :: arm(2), normal(2)

      associate (ghosts => near%ghosts, cell => near%ghosts%drawn(near%ghosts%strips%point_of(k)))
         arm = ghosts%place(:, k) - model%solids(cell%solid)%pivot - ghosts%poses(cell%solid)%shift
         normal = turn(ghosts%poses(cell%solid)%angle, cell%normal)
      end associate
   end subroutine face_of

   pure function with_moment(arm, force) result(load)
      real(dp), intent(in) :: arm(2), force(2)
      real(dp) :: load(3)

      load = [force, arm(1)*force(2) - arm(2)*force(1)]
   end function with_moment

   subroutine add_all(sums)
      type(exact_sum_t), intent(inout) :: sums(:, :)
      type(exact_sum_t) :: flat(size(sums))

      flat = reshape(sums, [size(sums)])
      call add_over_processes(flat)
      sums = reshape(flat, shape(sums))
   end subroutine add_all

   !> Takes the drag of friction, when that of the ghosts is known.
   subroutine add_drag(model, near)
      type(model_t), intent(in) :: model
      type(neighbours_t), intent(inout) :: near
      type(exact_sum_t) :: sums(3, size(model%solids))
      real(dp) :: arm(2), normal(2), parts(3)
      integer :: k, m, solid

      if (.not. allocated(near%ghosts%free)) return
      associate (ghosts => near%ghosts)
         do k = 1, ghosts%n_slots
            solid = ghosts%solid_of(k)
            if (solid == 0) cycle
            if (.not. (model%solids(solid)%body%is_free() .and. near%computes(ghosts%x(k)))) cycle
            call face_of(model, near, k, arm, normal)
            parts = with_moment(arm, ghosts%friction(3:4, k))
            do m = 1, 3
               call sums(m, solid)%add(parts(m))
            end do
         end do
         call add_all(sums)
         do solid = 1, size(model%solids)
            ghosts%free%drag(:, solid) = [(sums(m, solid)%value(), m=1, 3)]
         end do
      end associate
   end subroutine add_drag

   !> Force and moment on a free solid that are not the fluid's: weight, other forces, springs and dampers [N/m, N/m, N].
   pure function own_force(model, box, solid, pose) result(force)
      type(model_t), intent(in) :: model
      type(box_t), intent(in) :: box
      integer, intent(in) :: solid
      type(pose_t), intent(in) :: pose
      real(dp) :: force(3)

      associate (body => model%solids(solid)%body)
         force = body%pull_back(pose) + outer_force(model, box, solid, pose)
         force(2) = force(2) - body%mass*model%gravity
      end associate
   end function own_force

   ! Of the uniform force, and because the box is moved.
   pure function outer_force(model, box, solid, pose) result(force)
      type(model_t), intent(in) :: model
      type(box_t), intent(in) :: box
      integer, intent(in) :: solid
      type(pose_t), intent(in) :: pose
      real(dp) :: force(3)

      associate (body => model%solids(solid)%body, pivot => model%solids(solid)%pivot + pose%shift)
         force(:2) = body%mass*(model%acceleration + box%inertia%at(pivot, pose%velocity))
         force(3) = -body%inertia*box%inertia%spin_rate
      end associate
   end function outer_force

   !> Their power, which is in no potential [W/m].
   pure real(dp) function outer_power(model, box, solid, pose) result(power)
      type(model_t), intent(in) :: model
      type(box_t), intent(in) :: box
      integer, intent(in) :: solid
      type(pose_t), intent(in) :: pose

      power = dot_product(outer_force(model, box, solid, pose), merge(rate_of(pose), 0.0_dp, model%solids(solid)%body%moves))
   end function outer_power

end module free_bodies
