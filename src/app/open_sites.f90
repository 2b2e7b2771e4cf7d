!> The sites of a body's particles that no solid covers.
module open_sites
   use body_particles, only: count_sites, place_sites, sites_t
   use kinds, only: dp
   use settings, only: body_settings
   use solids, only: cover, obstacle_t
   implicit none
   private

   public :: count_open, place_open

   integer, parameter :: chunk = 65536   ! sites that are looked at at a time

contains

   !> Number of such sites.
   pure integer function count_open(body, dx, obstacles) result(n)
      type(body_settings), intent(in) :: body
      real(dp), intent(in) :: dx
      type(obstacle_t), intent(in) :: obstacles(:)   !! where the body is placed
      type(sites_t) :: sites
      integer :: first, i

      n = count_sites(body, dx)
      if (.not. any_meets(body, obstacles)) return
      do first = 1, count_sites(body, dx), chunk
         call place_sites(body, dx, sites, first, min(first + chunk - 1, count_sites(body, dx)))
         n = n - count([(cover(obstacles, [sites%x(i), sites%y(i)]) > 0, i=lbound(sites%x, 1), ubound(sites%x, 1))])
      end do
   end function count_open

   !> Some of them, counted from 1.
   pure subroutine place_open(body, dx, obstacles, first, last, sites)
      type(body_settings), intent(in) :: body
      real(dp), intent(in) :: dx
      type(obstacle_t), intent(in) :: obstacles(:)
      integer, intent(in) :: first, last
      type(sites_t), intent(out) :: sites
      type(sites_t) :: part
      integer :: begin, i, n, total

      if (.not. any_meets(body, obstacles)) then
         call place_sites(body, dx, sites, first, last)
         return
      end if
      allocate (sites%x(first:last), sites%y(first:last), sites%area(first:last))
      n = 0
      total = count_sites(body, dx)
      do begin = 1, total, chunk
         if (n >= last) exit
         call place_sites(body, dx, part, begin, min(begin + chunk - 1, total))
         do i = lbound(part%x, 1), ubound(part%x, 1)
            if (cover(obstacles, [part%x(i), part%y(i)]) > 0) cycle
            n = n + 1
            if (n < first .or. n > last) cycle
            sites%x(n) = part%x(i)
            sites%y(n) = part%y(i)
            sites%area(n) = part%area(i)
         end do
      end do
   end subroutine place_open

   ! Whether the boxes around them overlap.
   pure logical function any_meets(body, obstacles)
      type(body_settings), intent(in) :: body
      type(obstacle_t), intent(in) :: obstacles(:)
      integer :: k

      any_meets = any([(all(obstacles(k)%lower < body%upper .and. obstacles(k)%upper > body%lower), k=1, size(obstacles))])
   end function any_meets

end module open_sites
