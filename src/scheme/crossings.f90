!> Particles that a step has led out of the box, or into a solid: put back, their energy kept or booked.
!!
!! Source: ours (docs/equations.md: Reflection, Periodic sides, Solid bodies).
module crossings
   use blocks, only: block_t
   use box, only: bottom_wall, box_t, find_bounds, left_wall, reflect, right_wall, top_wall, wrap
   use kinds, only: dp
   use model, only: model_t
   use particles, only: particles_t
   use solids, only: obstacle_t, push_out
   use strips, only: group_slots
   implicit none
   private

   public :: cross_sides, leave_solids

contains

   !> Puts back what got into solids.
   pure subroutine leave_solids(model, box, obstacles, p, i0, n, sums)
      type(model_t), intent(in) :: model
      type(box_t), intent(in) :: box                 ! at the end of the step
      type(obstacle_t), intent(in) :: obstacles(:)   ! at the end of the step
      type(particles_t), intent(inout) :: p
      integer, intent(in) :: i0, n
      type(block_t), intent(inout) :: sums
      real(dp) :: before(2), place(2), velocity(2), impulse(2), inertia(2), lifted
      integer :: covered_by(n), i, k

      call find_covered(obstacles, n, p%next%x(i0 + 1:i0 + n), p%next%y(i0 + 1:i0 + n), covered_by)
      do i = i0 + 1, i0 + n
         k = covered_by(i - i0)
         if (k == 0 .or. p%id(i) == 0) cycle
         before = [p%next%x(i), p%next%y(i)]
         place = before
         velocity = [p%next%u(i), p%next%v(i)]
         inertia = box%inertia%at(before, velocity)
         call push_out(obstacles(k), model%force_at(before) + inertia, place, velocity)
         impulse = p%m(i)*([p%next%u(i), p%next%v(i)] - velocity)
         lifted = p%m(i)*dot_product(model%acceleration + inertia, place - before)
         call book(1 + (i - i0 - 1)/group_slots, lifted, place - before, sums)
         if (.not. allocated(sums%struck)) allocate (sums%struck(4, size(model%solids)), source=0.0_dp)
         associate (pivot => obstacles(k)%pivot, number => obstacles(k)%number)
            sums%struck(:, number) = sums%struck(:, number) &
               + [impulse, (place(1) - pivot(1))*impulse(2) - (place(2) - pivot(2))*impulse(1), &
                  p%m(i)*(model%energy_at(place, velocity) - model%energy_at(before, [p%next%u(i), p%next%v(i)])) - lifted]
         end associate
         call put(p, i, place, velocity)
      end do
   end subroutine leave_solids

   ! The first obstacle that each place is in; 0 if there is none. Most blocks are beside the rooms around all obstacles.
   pure subroutine find_covered(obstacles, n, x, y, number)
      type(obstacle_t), intent(in) :: obstacles(:)
      integer, intent(in) :: n
      real(dp), intent(in) :: x(n), y(n)
      integer, intent(out) :: number(n)
      real(dp) :: least_x, most_x, least_y, most_y
      integer :: i, k

      least_x = huge(least_x); most_x = -huge(most_x); least_y = huge(least_y); most_y = -huge(most_y)
      !$omp simd reduction(min:least_x, least_y) reduction(max:most_x, most_y)
      do i = 1, n
         least_x = min(least_x, x(i))
         most_x = max(most_x, x(i))
         least_y = min(least_y, y(i))
         most_y = max(most_y, y(i))
         number(i) = 0
      end do
      do k = 1, size(obstacles)
         if (any([least_x, least_y] > obstacles(k)%upper .or. [most_x, most_y] < obstacles(k)%lower)) cycle
         do i = 1, n
            if (number(i) > 0) cycle
            if (obstacles(k)%covers([x(i), y(i)])) number(i) = k
         end do
      end do
   end subroutine find_covered

   !> Puts back what left the box.
   pure subroutine cross_sides(model, box, p, i0, n, sums)
      type(model_t), intent(in) :: model
      type(box_t), intent(in) :: box
      type(particles_t), intent(inout) :: p
      integer, intent(in) :: i0, n
      type(block_t), intent(inout) :: sums
      real(dp) :: lower(2), upper(2), before(2), place(2), velocity(2), at_wall(2), inertia(2)
      logical :: crossed
      integer :: i

      call find_bounds(box, lower, upper)
      do i = i0 + 1, i0 + n
         if (.not. (p%next%x(i) < lower(1) .or. p%next%x(i) > upper(1) .or. p%next%y(i) < lower(2) &
                    .or. p%next%y(i) > upper(2))) cycle
         if (p%id(i) == 0) cycle
         before = [p%next%x(i), p%next%y(i)]
         place = before
         velocity = [p%next%u(i), p%next%v(i)]
         at_wall = min(max(before, box%at([left_wall, bottom_wall])), box%at([right_wall, top_wall]))
         inertia = box%inertia%at(at_wall, velocity)
         call reflect(box, model%force_at(at_wall) + inertia, place, velocity, crossed)
         if (crossed) call book(1 + (i - i0 - 1)/group_slots, p%m(i)*dot_product(model%acceleration + inertia, place - before), &
                                place - before, sums)
         if (any(box%is_periodic([1, 2]))) then
            call wrap(box, place)
            sums%wrapped = .true.
         end if
         call put(p, i, place, velocity)
      end do
   end subroutine cross_sides

   ! A particle that was put back. What the uniform force and inertia gave is not in the positions, as gravity's energy is.
   pure subroutine book(group, lifted, way, sums)
      integer, intent(in) :: group
      real(dp), intent(in) :: lifted   ! their work on the way
      real(dp), intent(in) :: way(2)
      type(block_t), intent(inout) :: sums

      sums%work(group, 4) = sums%work(group, 4) + lifted
      sums%crossings = sums%crossings + 1
      sums%jump = max(sums%jump, hypot(way(1), way(2)))
   end subroutine book

   pure subroutine put(p, i, place, velocity)
      type(particles_t), intent(inout) :: p
      integer, intent(in) :: i
      real(dp), intent(in) :: place(2), velocity(2)

      p%next%x(i) = place(1)
      p%next%y(i) = place(2)
      p%next%u(i) = velocity(1)
      p%next%v(i) = velocity(2)
   end subroutine put

end module crossings
