!> Gauges: where the fluid ends on a straight line through the box.
!!
!! A vertical line is a wave gauge and measures the height of the surface; a horizontal one on the floor follows the front
!! of a surge. A point is in the fluid if sum_j W V_j >= 1/2, its value at a straight free surface; so single
!! particles of spray do not count.
module gauges
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
   pure real(dp) function measure_gauge(model, p, near, gauge) result(value)
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      type(neighbours_t), intent(in) :: near
      type(gauge_t), intent(in) :: gauge
      real(dp) :: s, step, previous, here, share
      integer :: k, n

      ! Half a spacing resolves what particles can.
      n = max(1, ceiling((gauge%to - gauge%from)/(0.5_dp*model%dx)))
      step = (gauge%to - gauge%from)/n
      value = merge(gauge%from, gauge%to, gauge%measure == 'end')
      if (gauge%measure == 'wetted') value = 0
      if (gauge%measure == 'end') step = -step   ! from the far end: the first wet point is the last one
      s = merge(gauge%to, gauge%from, step < 0)
      previous = volume_at(model, p, near, gauge, s)
      if (previous >= at_surface .and. gauge%measure /= 'wetted') then
         value = s
         return
      end if
      do k = 1, n
         here = volume_at(model, p, near, gauge, s + step)
         if (here >= at_surface .and. gauge%measure /= 'wetted') then
            value = s + step*(at_surface - previous)/(here - previous)
            return
         end if
         ! The part of this piece that is wet, with the sum linear between its ends.
         share = merge(1.0_dp, 0.0_dp, min(previous, here) >= at_surface)
         if ((previous - at_surface)*(here - at_surface) < 0) &
            share = (max(previous, here) - at_surface)/abs(here - previous)
         if (gauge%measure == 'wetted') value = value + share*step
         previous = here
         s = s + step
      end do
   end function measure_gauge

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
