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

   !> Cuts where each process gets about as large a load.
   subroutine cut(self, first_place, loads)
      type(division_t), intent(inout) :: self
      integer(i8), intent(in) :: first_place   !! of all
      integer(i8), intent(in) :: loads(:)      !! (places) of each
      integer(i8) :: before, total
      integer :: k, n, process

      n = n_processes()
      if (.not. allocated(self%first)) allocate (self%first(0:n))
      self%first = all_places + 1
      self%first(0) = -all_places
      total = sum(loads)
      before = 0
      process = 1
      do k = 1, size(loads)
         ! A place goes where its middle is.
         do while (process < n)
            if (real(2*before + loads(k), dp)*n < 2.0_dp*process*total) exit
            self%first(process) = first_place + k - 1
            process = process + 1
         end do
         before = before + loads(k)
      end do
   end subroutine cut

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
