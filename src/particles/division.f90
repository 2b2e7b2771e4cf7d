!> How the fluid is divided among the processes: each computes the strips between two cuts, and holds copies of those beside them.
!!
!! No result depends on where cuts are. Places of strips are counted from the origin of `strips_t`.
module division
   use communication, only: n_processes, this_process
   use kinds, only: dp, i8
   use strips, only: all_places
   implicit none
   private

   public :: division_t, cut, owner, needed_by

   !> Places of all processes.
   type :: division_t
      integer(i8), allocatable :: first(:)   !! (0:processes) first place of each; of the last one behind all
      integer(i8) :: margin = 0              !! places beyond its own that a process needs
      logical :: periodic = .false.          !! and near the left side those near the right one, and the other way round
      integer(i8) :: ends(2) = 0             !! places of these sides
      real(dp) :: busy = 0                   !! [s] that this process has computed since it was cut,
      real(dp) :: busy_before = 0            !! [s] and until then
      real(dp) :: waiting = 0                !! [s] that it has waited for copies
   contains
      procedure :: own_places
   end type division_t

contains

   !> Cuts so that the largest load of a process is as small as whole places allow, and others are as even as they can be then.
   subroutine cut(self, first_place, loads)
      type(division_t), intent(inout) :: self
      integer(i8), intent(in) :: first_place   !! of all
      integer(i8), intent(in) :: loads(:)      !! (places) of each
      integer(i8) :: before(0:size(loads))     ! load of so many places
      integer(i8) :: most
      integer, allocatable :: least(:), cuts(:)   ! places before each process
      integer :: k, n, process

      n = n_processes()
      if (.not. allocated(self%first)) allocate (self%first(0:n))
      before(0) = 0
      do k = 1, size(loads)
         before(k) = before(k - 1) + loads(k)
      end do
      most = least_maximum(n, before, maxval(loads))
      ! With fewer places before it, a process and those behind it would have to bear more than that.
      allocate (least(0:n), cuts(0:n))
      least(n) = size(loads)
      do process = n - 1, 0, -1
         k = least(process + 1)
         do while (k > 0)
            if (before(least(process + 1)) - before(k - 1) > most) exit
            k = k - 1
         end do
         least(process) = k
      end do
      cuts(0) = 0
      k = 0
      do process = 1, n
         ! A place goes where its middle is.
         do while (k < size(loads))
            if (real(before(k) + before(k + 1), dp)*n >= 2.0_dp*process*before(size(loads))) exit
            k = k + 1
         end do
         cuts(process) = max(k, least(process))
         do while (before(cuts(process)) - before(cuts(process - 1)) > most)
            cuts(process) = cuts(process) - 1
         end do
      end do
      self%first = first_place + cuts
      self%first(0) = -all_places
      where (cuts == size(loads)) self%first = all_places + 1
   end subroutine cut

   ! The smallest load that no process has to exceed.
   pure integer(i8) function least_maximum(n, before, largest) result(most)
      integer, intent(in) :: n
      integer(i8), intent(in) :: before(0:)   !! load of so many places
      integer(i8), intent(in) :: largest      !! of a place
      integer(i8) :: low, middle

      low = max(largest, (before(ubound(before, 1)) + n - 1)/n)
      most = low + largest
      do while (low < most)
         middle = (low + most)/2
         if (processes_for(before, middle) > n) then
            low = middle + 1
         else
            most = middle
         end if
      end do
   end function least_maximum

   ! How many are needed where none bears more.
   pure integer function processes_for(before, most) result(n)
      integer(i8), intent(in) :: before(0:)
      integer(i8), intent(in) :: most   !! at least that of each place
      integer(i8) :: done
      integer :: k

      n = 1
      done = 0
      do k = 1, ubound(before, 1)
         if (before(k) - done <= most) cycle
         n = n + 1
         done = before(k - 1)
      end do
   end function processes_for

   !> From and to which place this process computes.
   function own_places(self) result(places)
      class(division_t), intent(in) :: self
      integer(i8) :: places(2)

      places = [self%first(this_process()), self%first(this_process() + 1) - 1]
   end function own_places

   !> Who computes a place.
   pure integer function owner(self, place)
      type(division_t), intent(in) :: self
      integer(i8), intent(in) :: place
      integer :: low, high, middle

      low = 0
      high = ubound(self%first, 1)
      do while (high - low > 1)
         middle = (low + high)/2
         if (self%first(middle) <= place) then
            low = middle
         else
            high = middle
         end if
      end do
      owner = low
   end function owner

   !> Whether a process computes a place or holds a copy of it.
   pure logical function needed_by(self, process, place) result(needed)
      type(division_t), intent(in) :: self
      integer, intent(in) :: process
      integer(i8), intent(in) :: place

      needed = .false.
      associate (from => self%first(process), to => self%first(process + 1) - 1)
         if (from > to) return
         needed = place >= from - self%margin .and. place <= to + self%margin
         if (needed .or. .not. self%periodic) return
         needed = (from <= self%ends(1) + self%margin .and. place >= self%ends(2) - self%margin) &
                  .or. (to >= self%ends(2) - self%margin .and. place <= self%ends(1) + self%margin)
      end associate
   end function needed_by

end module division
