!> Gauges: where the fluid ends on a straight line through the box.
!!
!! A vertical line is a wave gauge and measures the height of the surface; a horizontal one on the floor follows the front
!! of a surge. A point is in the fluid if sum_j W V_j >= 1/2, its value at a straight free surface; so single
!! particles of spray do not count.
module gauges
   use communication, only: largest_of_all
   use exact_sum, only: add_over_processes, exact_sum_t
   use kinds, only: dp
   use model, only: model_t
   use neighbours, only: neighbours_t
   use particles, only: particles_t
   use point_sums, only: at_surface, sum_at
   use settings, only: gauge_settings
   implicit none
   private

   public :: gauge_t, new_gauge, measure_gauge

   !> A line and what is measured on it.
   type :: gauge_t
      integer :: along = 2                   !! 1: parallel to x, 2: to y
      real(dp) :: at = 0                     !! its y or x [m]
      real(dp) :: from = 0, to = 0           !! its ends [m]
      character(:), allocatable :: measure   !! 'end', 'start' or 'wetted'
   end type gauge_t

   ! A way along the line in equal steps, from point 0 to point n. Points are whole numbers of any size: a box may be wide and
   ! empty, and what a gauge costs must not grow with it.
   type :: walk_t
      real(dp) :: n = 1, step = 0          !! [-], [m]; step is below 0 on a way backwards
      real(dp) :: reach = 0                !! of a particle, in steps
      real(dp), allocatable :: seen(:)     !! particles and images near the line, in steps
   end type walk_t

contains

   !> From wall to wall; an open side ends a line where the box ends.
   pure type(gauge_t) function new_gauge(setting, lower, upper) result(gauge)
      type(gauge_settings), intent(in) :: setting
      real(dp), intent(in) :: lower(2), upper(2)   !! corners of the box

      gauge%along = merge(1, 2, setting%along == 'x')
      gauge%at = setting%at
      gauge%from = lower(gauge%along)
      gauge%to = upper(gauge%along)
      gauge%measure = trim(setting%measure)
   end function new_gauge

   !> The largest ('end') or least ('start') coordinate of the fluid on the line, or how much of the line is in it
   !! ('wetted'), in the base state. On a dry line the end is where the line begins, and the start where it ends.
   real(dp) function measure_gauge(model, p, near, gauge) result(value)
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      type(neighbours_t), intent(in) :: near
      type(gauge_t), intent(in) :: gauge

      select case (gauge%measure)
      case ('end')
         value = first_wet(model, p, near, gauge, gauge%to, gauge%from)
      case ('start')
         value = first_wet(model, p, near, gauge, gauge%from, gauge%to)
      case default
         value = wetted_length(model, p, near, gauge)
      end select
   end function measure_gauge

   ! Divides the way from one end of a gauge's line to the other: half a spacing resolves what particles can.
   pure type(walk_t) function new_walk(model, p, gauge, from, to) result(walk)
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      type(gauge_t), intent(in) :: gauge
      real(dp), intent(in) :: from, to
      real(dp) :: pieces

      pieces = abs(to - from)/(0.5_dp*model%dx)
      walk%n = max(1.0_dp, aint(pieces))
      if (walk%n < pieces) walk%n = walk%n + 1
      walk%step = (to - from)/walk%n
      walk%reach = model%kernel%support/abs(walk%step)
      associate (x => p%base%x(:p%n_slots), y => p%base%y(:p%n_slots), support => model%kernel%support)
         if (gauge%along == 1) walk%seen = (pack(x, abs(y - gauge%at) < support) - from)/walk%step
         if (gauge%along == 2) walk%seen = (pack(y, abs(x - gauge%at) < support) - from)/walk%step
      end associate
   end function new_walk

   ! The next point of a walk: where there is no fluid, the one before the next that some particle reaches.
   pure real(dp) function next_point(walk, k, volume) result(next)
      type(walk_t), intent(in) :: walk
      real(dp), intent(in) :: k        !! where it is
      real(dp), intent(in) :: volume   !! sum_j W V_j there

      next = k + 1
      if (volume > 0) return
      next = max(next, aint(minval(walk%seen, mask=walk%seen > k) - walk%reach))
   end function next_point

   !> Where the fluid begins on the way from one end of the line to the other; `to` on a dry line.
   real(dp) function first_wet(model, p, near, gauge, from, to) result(place)
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      type(neighbours_t), intent(in) :: near
      type(gauge_t), intent(in) :: gauge
      real(dp), intent(in) :: from, to
      type(walk_t) :: walk
      real(dp) :: k, here, first(1), values(2)   ! values: at the first point in the fluid, and at the one before it

      walk = new_walk(model, p, gauge, from, to)
      first = walk%n + 1
      k = 0
      do while (k <= walk%n)
         here = 0
         if (is_mine(near, gauge, from + k*walk%step)) here = volume_at(model, p, near, gauge, from + k*walk%step)
         if (here >= at_surface) then
            first = k
            exit
         end if
         k = next_point(walk, k, here)
      end do
      first = -first
      call largest_of_all(1, first)   ! of all processes, each of which knows some points
      k = -first(1)
      place = to
      if (k > walk%n) return
      values = [volume_if_mine(k), volume_if_mine(k - 1)]
      call largest_of_all(2, values)
      place = from
      if (k > 0) place = from + walk%step*(k - (values(1) - at_surface)/(values(1) - values(2)))

   contains

      pure real(dp) function volume_if_mine(k) result(volume)
         real(dp), intent(in) :: k

         volume = 0
         if (is_mine(near, gauge, from + k*walk%step)) volume = volume_at(model, p, near, gauge, from + k*walk%step)
      end function volume_if_mine

   end function first_wet

   ! Whether this process has all that is near a point of the line.
   pure logical function is_mine(near, gauge, s)
      type(neighbours_t), intent(in) :: near
      type(gauge_t), intent(in) :: gauge
      real(dp), intent(in) :: s   ! its coordinate along the line

      is_mine = near%computes(merge(s, gauge%at, gauge%along == 1))
   end function is_mine

   !> The sum is taken as linear between the points of the line.
   real(dp) function wetted_length(model, p, near, gauge) result(length)
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      type(neighbours_t), intent(in) :: near
      type(gauge_t), intent(in) :: gauge
      type(walk_t) :: walk
      type(exact_sum_t) :: sums(1)
      real(dp) :: previous, here, k

      walk = new_walk(model, p, gauge, gauge%from, gauge%to)
      here = volume_at(model, p, near, gauge, gauge%from)
      k = next_point(walk, 0.0_dp, here)
      do while (k <= walk%n)
         previous = here
         here = volume_at(model, p, near, gauge, gauge%from + k*walk%step)
         ! Pieces of the line are those of who has their end.
         if (is_mine(near, gauge, gauge%from + k*walk%step)) then
            if (min(previous, here) >= at_surface) then
               call sums(1)%add(walk%step)
            else if (max(previous, here) > at_surface) then
               call sums(1)%add(walk%step*(max(previous, here) - at_surface)/abs(here - previous))
            end if
         end if
         k = next_point(walk, k, here)
      end do
      call add_over_processes(sums)
      length = sums(1)%value()
   end function wetted_length

   !> sum_j W V_j at a place on the line.
   pure real(dp) function volume_at(model, p, near, gauge, s) result(volume)
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      type(neighbours_t), intent(in) :: near
      type(gauge_t), intent(in) :: gauge
      real(dp), intent(in) :: s   !! its coordinate along the line
      real(dp) :: place(2), pressure

      place = gauge%at
      place(gauge%along) = s
      call sum_at(model, p, near, place(1), place(2), volume, pressure)
   end function volume_at

end module gauges
