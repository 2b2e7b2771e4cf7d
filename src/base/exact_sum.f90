!> Sums of floating-point numbers that know no order: all bits of every summand are kept until the sum is rounded, once.
!!
!! A double is an integer times 2**-1074, so all of them fit into one long fixed-point number, as digits of 32 bits in integers of
!! 64. Adding integers has no order, and sums of parts can be added to each other: any number of threads or processes gives the
!! same bits. Source: Kulisch's accumulator; Demmel & Nguyen, IEEE Trans. Comput. 64 (2015) 2060-2070, on what it is good for.
module exact_sum
   use communication, only: sums_of_all
   use, intrinsic :: ieee_arithmetic, only: ieee_negative_inf, ieee_positive_inf, ieee_quiet_nan, ieee_value
   use kinds, only: dp, i8
   implicit none
   private

   public :: exact_sum_t, exact_sums, exact_totals, add_over_processes, integers_of, take_integers

   integer, parameter :: digit_bits = 32
   integer(i8), parameter :: digit_mask = 2_i8**digit_bits - 1
   integer, parameter :: n_digits = 68                 ! 2098 bits of a double, and 2**63 summands
   integer, parameter :: least_exponent = -1074        ! of the last digit's last bit
   integer, parameter :: mantissa_bits = 53
   integer(i8), parameter :: most_added = 2_i8**29     ! summands until digits are carried on

   !> A sum that has not been rounded yet.
   type :: exact_sum_t
      private
      integer(i8) :: digit(0:n_digits - 1) = 0   ! from the last on; may exceed its 32 bits, and be negative
      integer(i8) :: infinite(2) = 0             ! summands that were +Inf, -Inf
      integer(i8) :: undefined = 0               ! summands that were NaN
      integer(i8) :: added = 0                   ! since digits were carried on
   contains
      procedure :: add
      procedure :: add_sum
      procedure :: value
   end type exact_sum_t

contains

   !> Adds a number.
   pure subroutine add(self, number)
      class(exact_sum_t), intent(inout) :: self
      real(dp), intent(in) :: number
      integer(i8) :: bits, mantissa, part(3)
      integer :: place, k, shift

      bits = transfer(number, 0_i8)
      place = int(ibits(bits, mantissa_bits - 1, 11))
      mantissa = ibits(bits, 0, mantissa_bits - 1)
      if (place == 0 .and. mantissa == 0) return
      if (place == 2047) then
         call add_special(self, bits < 0, mantissa /= 0)
         return
      end if
      if (place > 0) then
         mantissa = ibset(mantissa, mantissa_bits - 1)
         place = place - 1
      end if
      k = place/digit_bits
      shift = mod(place, digit_bits)
      part = [iand(shiftl(mantissa, shift), digit_mask), iand(ishft(mantissa, shift - digit_bits), digit_mask), &
              ishft(mantissa, shift - 2*digit_bits)]
      if (bits < 0) part = -part
      self%digit(k:k + 2) = self%digit(k:k + 2) + part
      self%added = self%added + 1
      if (self%added > most_added) call carry_on(self)
   end subroutine add

   pure subroutine add_special(self, negative, is_nan)
      type(exact_sum_t), intent(inout) :: self
      logical, intent(in) :: negative, is_nan

      if (is_nan) then
         self%undefined = self%undefined + 1
      else
         self%infinite = self%infinite + merge([0, 1], [1, 0], negative)
      end if
   end subroutine add_special

   !> Adds another sum.
   pure subroutine add_sum(self, other)
      class(exact_sum_t), intent(inout) :: self
      class(exact_sum_t), intent(in) :: other

      if (self%added + other%added > most_added) call carry_on(self)
      self%digit = self%digit + other%digit
      self%infinite = self%infinite + other%infinite
      self%undefined = self%undefined + other%undefined
      self%added = self%added + other%added
      if (self%added > most_added) call carry_on(self)
   end subroutine add_sum

   ! Brings all digits but the first into 0 .. 2**32 - 1.
   pure subroutine carry_on(self)
      type(exact_sum_t), intent(inout) :: self
      integer :: k

      do k = 0, n_digits - 2
         self%digit(k + 1) = self%digit(k + 1) + shifta(self%digit(k), digit_bits)
         self%digit(k) = iand(self%digit(k), digit_mask)
      end do
      self%added = 1   ! what is left counts as one summand
   end subroutine carry_on

   !> The sum, rounded to the nearest double; of two as near, to the even one.
   pure real(dp) function value(self)
      class(exact_sum_t), intent(in) :: self
      type(exact_sum_t) :: sum
      logical :: negative

      if (self%undefined > 0 .or. all(self%infinite > 0)) then
         value = ieee_value(value, ieee_quiet_nan)
      else if (self%infinite(1) > 0) then
         value = ieee_value(value, ieee_positive_inf)
      else if (self%infinite(2) > 0) then
         value = ieee_value(value, ieee_negative_inf)
      else
         sum%digit = self%digit
         call carry_on(sum)
         negative = sum%digit(n_digits - 1) < 0
         if (negative) then
            sum%digit = -sum%digit
            call carry_on(sum)
         end if
         value = rounded(sum%digit)
         if (negative) value = -value
      end if
   end function value

   ! Of digits that are none of them negative.
   pure real(dp) function rounded(digit)
      integer(i8), intent(in) :: digit(0:n_digits - 1)
      integer(i8) :: kept
      integer :: k, top, last, place

      rounded = 0
      top = -1
      do k = n_digits - 1, 0, -1
         if (digit(k) == 0) cycle
         top = digit_bits*k + 63 - leadz(digit(k))
         exit
      end do
      if (top < 0) return
      ! All bits that a double holds, and one more.
      last = max(0, top - mantissa_bits)
      kept = 0
      do place = top, last, -1
         kept = 2*kept + merge(1, 0, btest(digit(place/digit_bits), mod(place, digit_bits)))
      end do
      if (top >= mantissa_bits) then
         if (btest(kept, 0) .and. .not. btest(kept, 1) .and. .not. bits_below(digit, last)) kept = kept - 1
         kept = (kept + 1)/2
         last = last + 1
      end if
      rounded = scale(real(kept, dp), last + least_exponent)
   end function rounded

   ! Whether any bit below a place is set.
   pure logical function bits_below(digit, place)
      integer(i8), intent(in) :: digit(0:n_digits - 1)
      integer, intent(in) :: place

      bits_below = any(digit(:place/digit_bits - 1) /= 0) &
                   .or. ibits(digit(place/digit_bits), 0, mod(place, digit_bits)) /= 0
   end function bits_below

   !> All that sums are, so that those of other processes can be added, integer by integer.
   pure function integers_of(sums) result(numbers)
      type(exact_sum_t), intent(in) :: sums(:)
      integer(i8) :: numbers((n_digits + 3)*size(sums))
      type(exact_sum_t) :: one
      integer :: k

      do k = 1, size(sums)
         one = sums(k)
         call carry_on(one)
         numbers((n_digits + 3)*(k - 1) + 1:(n_digits + 3)*k) = [one%digit, one%infinite, one%undefined]
      end do
   end function integers_of

   !> The other way round.
   pure subroutine take_integers(numbers, sums)
      integer(i8), intent(in) :: numbers(:)
      type(exact_sum_t), intent(out) :: sums(:)
      integer :: k

      do k = 1, size(sums)
         associate (one => numbers((n_digits + 3)*(k - 1) + 1:(n_digits + 3)*k))
            sums(k)%digit = one(:n_digits)
            sums(k)%infinite = one(n_digits + 1:n_digits + 2)
            sums(k)%undefined = one(n_digits + 3)
         end associate
      end do
   end subroutine take_integers

   !> Each sum becomes that of all processes.
   subroutine add_over_processes(sums)
      type(exact_sum_t), intent(inout) :: sums(:)
      integer(i8) :: numbers((n_digits + 3)*size(sums))

      numbers = integers_of(sums)
      call sums_of_all(size(numbers), numbers)
      call take_integers(numbers, sums)
   end subroutine add_over_processes

   !> The sum of each row of what this process has, with all threads.
   function exact_sums(table) result(all)
      real(dp), intent(in) :: table(:, :)   !! (sums, summands)
      type(exact_sum_t) :: all(size(table, 1)), mine(size(table, 1))
      integer :: i, k

      !$omp parallel default(none) shared(table, all) private(mine, k)
      mine = exact_sum_t()
      !$omp do
      do i = 1, size(table, 2)
         do k = 1, size(mine)
            call mine(k)%add(table(k, i))
         end do
      end do
      !$omp end do nowait
      !$omp critical
      do k = 1, size(mine)
         call all(k)%add_sum(mine(k))
      end do
      !$omp end critical
      !$omp end parallel
   end function exact_sums

   !> The same of all processes.
   function exact_totals(table) result(totals)
      real(dp), intent(in) :: table(:, :)   !! (sums, summands)
      real(dp) :: totals(size(table, 1))
      type(exact_sum_t) :: sums(size(table, 1))
      integer :: k

      sums = exact_sums(table)
      call add_over_processes(sums)
      do k = 1, size(totals)
         totals(k) = sums(k)%value()
      end do
   end function exact_totals

end module exact_sum
