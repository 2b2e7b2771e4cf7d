!> Velocities and slack in each strip.
module strip_extents
   use kinds, only: dp
   use particles, only: state_t
   use strips, only: extent_t, strips_t
   implicit none
   private

   public :: measure_strips, take_slack

contains

   !> Velocities of each strip and of all, without the dummies at a strip's end.
   subroutine measure_strips(strips, state)
      type(strips_t), intent(inout) :: strips
      type(state_t), intent(in) :: state
      integer :: k, first, last

      strips%overall = extent_t()
      if (strips%n == 0) return
      !$omp parallel do default(none) shared(strips, state) private(first, last) &
      !$omp schedule(dynamic, max(1, strips%n/256))
      do k = 1, strips%n
         strips%extent(k) = extent_t()
         first = strips%first(k)
         last = strips%last(k)
         do while (strips%point_of(last - strips%slots_before) == 0)
            last = last - 1
         end do
         associate (extent => strips%extent(k))
            call span_of(last - first + 1, state%u(first:last), extent%slowest(1), extent%fastest(1))
            call span_of(last - first + 1, state%v(first:last), extent%slowest(2), extent%fastest(2))
         end associate
      end do
      !$omp end parallel do
      do k = 1, strips%n
         strips%overall%slowest = min(strips%overall%slowest, strips%extent(k)%slowest)
         strips%overall%fastest = max(strips%overall%fastest, strips%extent(k)%fastest)
      end do
   end subroutine measure_strips

   pure subroutine span_of(n, values, least, most)
      integer, intent(in) :: n
      real(dp), intent(in) :: values(n)
      real(dp), intent(out) :: least, most
      integer :: i

      least = values(1)
      most = values(1)
      !$omp simd reduction(min:least) reduction(max:most)
      do i = 2, n
         least = min(least, values(i))
         most = max(most, values(i))
      end do
   end subroutine span_of

   !> Slack of each strip and of all.
   subroutine take_slack(strips, slack)
      type(strips_t), intent(inout) :: strips
      real(dp), intent(in) :: slack(:)
      integer :: k

      strips%overall%slack = 0
      if (strips%n == 0) return
      !$omp parallel do default(none) shared(strips, slack) schedule(dynamic, max(1, strips%n/256))
      do k = 1, strips%n
         strips%extent(k)%slack = max(0.0_dp, maxval(slack(strips%first(k):strips%last(k))))
      end do
      !$omp end parallel do
      strips%overall%slack = maxval(strips%extent(:strips%n)%slack)
   end subroutine take_slack

end module strip_extents
