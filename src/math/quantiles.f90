!> Order statistics of many numbers.
module quantiles
   use kinds, only: dp
   implicit none
   private

   public :: quantile, weighted_quantile

contains

   !> The smallest of the values that a share of them does not exceed.
   !!
   !! The same for any order of the values.
   pure real(dp) function quantile(values, share)
      real(dp), intent(in) :: values(:)   !! (n) n > 0
      real(dp), intent(in) :: share       !! above 0, at most 1
      real(dp) :: work(size(values))
      integer :: wanted

      work = values
      wanted = min(size(values), max(1, ceiling(share*size(values))))
      call select_rank(work, wanted)
      quantile = work(wanted)
   end function quantile

   !> The smallest of the values that, by weight, a share of them does not exceed.
   pure real(dp) function weighted_quantile(values, weights, share) result(bound)
      real(dp), intent(in) :: values(:)    !! (n) n > 0
      real(dp), intent(in) :: weights(:)   !! (n) not below 0
      real(dp), intent(in) :: share        !! above 0, at most 1
      real(dp) :: below, middle
      integer :: k

      below = minval(values)
      bound = maxval(values)
      if (sum(weights, mask=values <= below) >= share*sum(weights)) bound = below
      ! Halve the interval until nothing lies between its ends.
      do k = 1, digits(bound) + maxexponent(bound)
         middle = below + (bound - below)/2
         if (.not. (middle > below .and. middle < bound)) exit
         if (sum(weights, mask=values <= middle) >= share*sum(weights)) then
            bound = maxval(values, mask=values <= middle)
         else
            below = middle
         end if
      end do
   end function weighted_quantile

   ! Brings the value of a rank to its place, smaller ones before it (Hoare's selection).
   pure subroutine select_rank(work, rank)
      real(dp), intent(inout) :: work(:)
      integer, intent(in) :: rank
      real(dp) :: pivot, other
      integer :: first, last, i, j

      first = 1
      last = size(work)
      do while (first < last)
         pivot = work(rank)
         i = first
         j = last
         do
            do while (work(i) < pivot)
               i = i + 1
            end do
            do while (pivot < work(j))
               j = j - 1
            end do
            if (i <= j) then
               other = work(i)
               work(i) = work(j)
               work(j) = other
               i = i + 1
               j = j - 1
            end if
            if (i > j) exit
         end do
         if (j < rank) first = i
         if (rank < i) last = j
      end do
   end subroutine select_rank

end module quantiles
