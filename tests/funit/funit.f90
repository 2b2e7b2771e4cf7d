!> Stand-in for the part of pFUnit 4 that the tests use, for machines where pFUnit is not installed.
!!
!! Where the two could differ this one is the stricter, so that a file that passes here passes there: `tolerance` and `message`
!! have to be named (`location` stands third among the dummy arguments for that reason alone), and kinds are not converted
!! except an `int32` expected against an `int64` actual, or in order against a `real64`.
module funit
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite, ieee_is_nan
   use, intrinsic :: iso_fortran_env, only: int32, int64, output_unit, real64
   use funit_values, only: flat, list_of, subscripts, text
   implicit none
   private

   public :: assertEqual, assertTrue, assertFalse, assertRelativelyEqual, assertIsNaN, assertIsFinite
   public :: assertLessThan, assertLessThanOrEqual, assertGreaterThan, assertGreaterThanOrEqual
   public :: assertExceptionRaised, assertFail, throw, anyExceptions, SourceLocation
   public :: funit_run_test, funit_skip_test, funit_finish, funit_check_ranks   ! for generated code only

   !> A line of a test file.
   type :: SourceLocation
      character(80) :: file_name = ''
      integer :: line = 0
   end type SourceLocation

   !> What a failed assert or a call of `throw` leaves behind.
   type :: exception
      character(:), allocatable :: message
      type(SourceLocation) :: location
   end type exception

   abstract interface
      subroutine test_procedure()
      end subroutine test_procedure
   end interface

   !> Fails unless `actual` equals `expected`, of the same shape or a scalar. Reals may differ by `tolerance` (absolute, default 0).
   interface assertEqual
      procedure equal_real64, equal_int32, equal_int64, equal_int32_int64, equal_logical, equal_character
   end interface assertEqual

   !> Fails unless all of `condition` is true.
   interface assertTrue
      procedure scalar_is_true, list_is_true
   end interface assertTrue

   !> Fails unless all of `condition` is false.
   interface assertFalse
      procedure scalar_is_false, list_is_false
   end interface assertFalse

   !> Compiles for the ranks that pFUnit's assertEqual has, of expected and actual: a scalar against anything, else both the same.
   !! Never called.
   interface funit_check_ranks
      procedure scalar_expected, list_expected, table_expected
   end interface funit_check_ranks

   character, parameter :: eol = new_line('a')

   type(exception), allocatable :: pending(:)   !! raised in the running test and not expected by it so far
   integer :: tests_run = 0, tests_failed = 0, tests_disabled = 0
   integer(int64) :: started = -1               !! clock at the first test [ticks]

contains

   !> Raises an exception: the running test fails unless it expects this message.
   subroutine throw(message, location)
      character(*), intent(in) :: message
      type(SourceLocation), intent(in), optional :: location
      type(exception), allocatable :: longer(:)
      integer :: n

      n = 0
      if (allocated(pending)) n = size(pending)
      allocate (longer(n + 1))
      if (n > 0) longer(:n) = pending
      longer(n + 1)%message = message
      if (present(location)) longer(n + 1)%location = location
      call move_alloc(longer, pending)
   end subroutine throw

   !> Whether an exception is pending: after each assert the translator has the subroutine return if so.
   logical function anyExceptions()
      anyExceptions = .false.
      if (allocated(pending)) anyExceptions = size(pending) > 0
   end function anyExceptions

   !> Takes back one pending exception, the first with this `message` or the first of all; fails if there is none.
   subroutine assertExceptionRaised(message, location)
      character(*), intent(in), optional :: message
      type(SourceLocation), intent(in), optional :: location
      type(exception), allocatable :: others(:)
      integer :: i

      if (anyExceptions()) then
         do i = 1, size(pending)
            if (present(message)) then
               if (pending(i)%message /= message) cycle
            end if
            allocate (others, source=[pending(:i - 1), pending(i + 1:)])
            call move_alloc(others, pending)
            return
         end do
      end if
      if (present(message)) then
         call throw('Expected exception was not raised: <' // message // '>', location)
      else
         call throw('Expected exception was not raised', location)
      end if
   end subroutine assertExceptionRaised

   !> Fails.
   subroutine assertFail(message, location)
      character(*), intent(in) :: message
      type(SourceLocation), intent(in), optional :: location

      call throw(message, location)
   end subroutine assertFail

   !> Raises the exception of an assert: the author's `message`, if any, then what was found.
   subroutine fail(found, location, message)
      character(*), intent(in) :: found
      type(SourceLocation), intent(in), optional :: location
      character(*), intent(in), optional :: message

      if (present(message)) then
         call throw(message // eol // '   ' // found, location)
      else
         call throw(found, location)
      end if
   end subroutine fail

   ! ---------------------------------------------------------------- conditions and order

   subroutine scalar_is_true(condition, location, message)
      logical, intent(in) :: condition
      type(SourceLocation), intent(in), optional :: location
      character(*), intent(in), optional :: message

      call require_all(.true., [condition], [integer ::], location, message)
   end subroutine scalar_is_true

   subroutine list_is_true(condition, location, message)
      logical, intent(in) :: condition(:)
      type(SourceLocation), intent(in), optional :: location
      character(*), intent(in), optional :: message

      call require_all(.true., condition, shape(condition), location, message)
   end subroutine list_is_true

   subroutine scalar_is_false(condition, location, message)
      logical, intent(in) :: condition
      type(SourceLocation), intent(in), optional :: location
      character(*), intent(in), optional :: message

      call require_all(.false., [condition], [integer ::], location, message)
   end subroutine scalar_is_false

   subroutine list_is_false(condition, location, message)
      logical, intent(in) :: condition(:)
      type(SourceLocation), intent(in), optional :: location
      character(*), intent(in), optional :: message

      call require_all(.false., condition, shape(condition), location, message)
   end subroutine list_is_false

   subroutine require_all(wanted, list, extents, location, message)
      logical, intent(in) :: wanted, list(:)
      integer, intent(in) :: extents(:)
      type(SourceLocation), intent(in), optional :: location
      character(*), intent(in), optional :: message

      if (any(list .neqv. wanted)) &
         call fail_unequal(list .neqv. wanted, text(wanted), text(.not. wanted), '', extents, location, message)
   end subroutine require_all

   !> Fails unless a < b.
   subroutine assertLessThan(a, b, location, message)
      class(*), intent(in) :: a, b
      type(SourceLocation), intent(in), optional :: location
      character(*), intent(in), optional :: message

      call require_order([-1], a, '<', b, location, message)
   end subroutine assertLessThan

   !> Fails unless a <= b.
   subroutine assertLessThanOrEqual(a, b, location, message)
      class(*), intent(in) :: a, b
      type(SourceLocation), intent(in), optional :: location
      character(*), intent(in), optional :: message

      call require_order([-1, 0], a, '<=', b, location, message)
   end subroutine assertLessThanOrEqual

   !> Fails unless a > b.
   subroutine assertGreaterThan(a, b, location, message)
      class(*), intent(in) :: a, b
      type(SourceLocation), intent(in), optional :: location
      character(*), intent(in), optional :: message

      call require_order([1], a, '>', b, location, message)
   end subroutine assertGreaterThan

   !> Fails unless a >= b.
   subroutine assertGreaterThanOrEqual(a, b, location, message)
      class(*), intent(in) :: a, b
      type(SourceLocation), intent(in), optional :: location
      character(*), intent(in), optional :: message

      call require_order([0, 1], a, '>=', b, location, message)
   end subroutine assertGreaterThanOrEqual

   subroutine require_order(allowed, a, relation, b, location, message)
      integer, intent(in) :: allowed(:)   !! orders that pass, see `compare`
      class(*), intent(in) :: a, b
      character(*), intent(in) :: relation
      type(SourceLocation), intent(in), optional :: location
      character(*), intent(in), optional :: message

      integer :: order
      character(:), allocatable :: difference

      call compare(a, b, order, difference)
      if (any(allowed == order)) return
      call fail('Expected a ' // relation // ' b but found a = ' // text(a) // ', b = ' // text(b) &
         // '; difference b - a = ' // difference, location, message)
   end subroutine require_order

   !> Order and difference of two numbers of the same type, or of an `int32` and a `real64`.
   recursive subroutine compare(a, b, order, difference)
      class(*), intent(in) :: a, b
      integer, intent(out) :: order   !! -1, 0 or 1 as a < b, a = b or a > b; 2 if there is none (NaN, different types)
      character(:), allocatable, intent(out) :: difference   !! b - a

      order = 2
      difference = 'none (the types differ or are not supported)'
      select type (a)
      type is (real(real64))
         select type (b)
         type is (real(real64))
            difference = text(b - a)
            ! Asked first because comparing NaN traps in a Debug build.
            if (.not. (ieee_is_nan(a) .or. ieee_is_nan(b))) order = merge(1, 0, a > b) - merge(1, 0, a < b)
         end select
      type is (integer(int32))
         select type (b)
         type is (integer(int32))
            difference = text(int(b, int64) - int(a, int64))
            order = merge(1, 0, a > b) - merge(1, 0, a < b)
         type is (real(real64))
            call compare(real(a, real64), b, order, difference)
         end select
      type is (integer(int64))
         select type (b)
         type is (integer(int64))
            difference = text(b - a)
            order = merge(1, 0, a > b) - merge(1, 0, a < b)
         end select
      end select
   end subroutine compare

   !> Fails unless abs(actual - expected) <= tolerance * abs(expected).
   subroutine assertRelativelyEqual(expected, actual, location, tolerance, message)
      real(real64), intent(in) :: expected, actual
      type(SourceLocation), intent(in), optional :: location
      real(real64), intent(in), optional :: tolerance
      character(*), intent(in), optional :: message
      real(real64) :: allowed

      allowed = 0
      if (present(tolerance)) allowed = tolerance
      if (near(expected, actual, allowed * abs(expected))) return
      call fail_unequal([.true.], text(expected), text(actual), '; difference ' // text(actual - expected) &
         // ' > relative tolerance ' // text(allowed), [integer ::], location, message)
   end subroutine assertRelativelyEqual

   !> Fails unless x is NaN.
   subroutine assertIsNaN(x, location, message)
      real(real64), intent(in) :: x
      type(SourceLocation), intent(in), optional :: location
      character(*), intent(in), optional :: message

      if (.not. ieee_is_nan(x)) call fail('Expected NaN but found ' // text(x), location, message)
   end subroutine assertIsNaN

   !> Fails unless x is neither NaN nor infinite.
   subroutine assertIsFinite(x, location, message)
      real(real64), intent(in) :: x
      type(SourceLocation), intent(in), optional :: location
      character(*), intent(in), optional :: message

      if (.not. ieee_is_finite(x)) call fail('Expected a finite number but found ' // text(x), location, message)
   end subroutine assertIsFinite

   ! ---------------------------------------------------------------- equality

   subroutine equal_real64(expected, actual, location, tolerance, message)
      real(real64), intent(in) :: expected(..), actual(..)
      type(SourceLocation), intent(in), optional :: location
      real(real64), intent(in), optional :: tolerance
      character(*), intent(in), optional :: message
      real(real64), allocatable :: e(:), a(:)
      real(real64) :: allowed
      integer :: i

      if (.not. shapes_match(shape(expected), shape(actual), location, message)) return
      allocate (e, source=flat(expected, size(actual)))
      allocate (a, source=flat(actual, 1))
      allowed = 0
      if (present(tolerance)) allowed = tolerance
      i = findloc(near(e, a, allowed), .false., dim=1)
      if (i > 0) call fail_unequal(.not. near(e, a, allowed), text(e(i)), text(a(i)), '; difference ' // text(a(i) - e(i)) &
         // ' > tolerance ' // text(allowed), shape(actual), location, message)
   end subroutine equal_real64

   !> Whether two numbers differ by no more than `tolerance`; NaN is near to nothing.
   elemental logical function near(expected, actual, tolerance)
      real(real64), intent(in) :: expected, actual, tolerance

      near = .false.
      if (ieee_is_nan(expected) .or. ieee_is_nan(actual)) return
      near = .not. (expected < actual .or. expected > actual)   ! before the difference, which is NaN for equal infinities
      if (.not. near) near = abs(actual - expected) <= tolerance
   end function near

   subroutine equal_int32(expected, actual, location, message)
      integer(int32), intent(in) :: expected(..), actual(..)
      type(SourceLocation), intent(in), optional :: location
      character(*), intent(in), optional :: message

      if (.not. shapes_match(shape(expected), shape(actual), location, message)) return
      call compare_integers(flat(expected, size(actual)), flat(actual, 1), shape(actual), location, message)
   end subroutine equal_int32

   subroutine equal_int32_int64(expected, actual, location, message)
      integer(int32), intent(in) :: expected(..)
      integer(int64), intent(in) :: actual(..)
      type(SourceLocation), intent(in), optional :: location
      character(*), intent(in), optional :: message

      if (.not. shapes_match(shape(expected), shape(actual), location, message)) return
      call compare_integers(flat(expected, size(actual)), flat(actual, 1), shape(actual), location, message)
   end subroutine equal_int32_int64

   subroutine equal_int64(expected, actual, location, message)
      integer(int64), intent(in) :: expected(..), actual(..)
      type(SourceLocation), intent(in), optional :: location
      character(*), intent(in), optional :: message

      if (.not. shapes_match(shape(expected), shape(actual), location, message)) return
      call compare_integers(flat(expected, size(actual)), flat(actual, 1), shape(actual), location, message)
   end subroutine equal_int64

   subroutine compare_integers(e, a, extents, location, message)
      integer(int64), intent(in) :: e(:), a(:)
      integer, intent(in) :: extents(:)
      type(SourceLocation), intent(in), optional :: location
      character(*), intent(in), optional :: message
      integer :: i

      i = findloc(e /= a, .true., dim=1)
      if (i > 0) call fail_unequal(e /= a, text(e(i)), text(a(i)), '; difference ' // text(a(i) - e(i)), extents, location, message)
   end subroutine compare_integers

   subroutine equal_logical(expected, actual, location, message)
      logical, intent(in) :: expected(..), actual(..)
      type(SourceLocation), intent(in), optional :: location
      character(*), intent(in), optional :: message
      logical, allocatable :: e(:), a(:)
      integer :: i

      if (.not. shapes_match(shape(expected), shape(actual), location, message)) return
      allocate (e, source=flat(expected, size(actual)))
      allocate (a, source=flat(actual, 1))
      i = findloc(e .neqv. a, .true., dim=1)
      if (i > 0) call fail_unequal(e .neqv. a, text(e(i)), text(a(i)), '', shape(actual), location, message)
   end subroutine equal_logical

   subroutine equal_character(expected, actual, location, message)
      character(*), intent(in) :: expected(..), actual(..)
      type(SourceLocation), intent(in), optional :: location
      character(*), intent(in), optional :: message
      character(len(expected)), allocatable :: e(:)
      character(len(actual)), allocatable :: a(:)
      integer :: i, at

      if (.not. shapes_match(shape(expected), shape(actual), location, message)) return
      allocate (e, source=flat(expected, size(actual)))
      allocate (a, source=flat(actual, 1))
      i = findloc(e /= a, .true., dim=1)
      if (i == 0) return
      do at = 1, min(len(expected), len(actual))
         if (e(i)(at:at) /= a(i)(at:at)) exit
      end do
      call fail_unequal(e /= a, text(e(i)), text(a(i)), '; difference from character ' // text(at) // ' on', shape(actual), &
         location, message)
   end subroutine equal_character

   !> Whether `expected` is a scalar or has the shape of `actual`; fails if not.
   logical function shapes_match(expected, actual, location, message)
      integer, intent(in) :: expected(:), actual(:)   !! the two shapes
      type(SourceLocation), intent(in), optional :: location
      character(*), intent(in), optional :: message

      shapes_match = size(expected) == 0
      if (size(expected) == size(actual)) shapes_match = all(expected == actual)
      if (.not. shapes_match) then
         call fail('Expected shape ' // list_of(expected) // ' but found shape ' // list_of(actual), location, message)
      else if (size(actual) > 2) then
         shapes_match = .false.
         call fail('Ranks above 2 are not supported', location, message)
      end if
   end function shapes_match

   subroutine scalar_expected(expected, actual)
      type(*), intent(in) :: expected, actual(..)
   end subroutine scalar_expected

   subroutine list_expected(expected, actual)
      type(*), intent(in) :: expected(:), actual(:)
   end subroutine list_expected

   subroutine table_expected(expected, actual)
      type(*), intent(in) :: expected(:, :), actual(:, :)
   end subroutine table_expected

   !> Fails with the first pair of values that differ and where in the array they stand.
   subroutine fail_unequal(unequal, expected, actual, detail, extents, location, message)
      logical, intent(in) :: unequal(:)              !! which elements differ
      character(*), intent(in) :: expected, actual   !! the first that do
      character(*), intent(in) :: detail             !! size of the difference
      integer, intent(in) :: extents(:)              !! shape of the array
      type(SourceLocation), intent(in), optional :: location
      character(*), intent(in), optional :: message
      character(:), allocatable :: place

      place = ''
      if (size(extents) > 0) place = '; first at ' // list_of(subscripts(findloc(unequal, .true., dim=1), extents)) &
         // ', ' // text(count(unequal)) // ' of ' // text(size(unequal)) // ' elements differ'
      call fail('Expected ' // expected // ' but found ' // actual // detail // place, location, message)
   end subroutine fail_unequal

   ! ---------------------------------------------------------------- the runner

   !> Runs one test, between its set-up and its clean-up, and reports it. The clean-up is left out only if the set-up failed.
   subroutine funit_run_test(suite, name, test, before, after)
      character(*), intent(in) :: suite, name
      procedure(test_procedure) :: test
      procedure(test_procedure), optional :: before, after

      if (started < 0) call system_clock(started)
      tests_run = tests_run + 1
      ! Named before it runs, so that the log of a crash names the test.
      write (output_unit, '(5a)', advance='no') ' ', suite, '.', name, ' ... '
      flush (output_unit)
      if (present(before)) call before()
      if (.not. anyExceptions()) then
         call test()
         if (present(after)) call after()
      end if
      if (anyExceptions()) then
         tests_failed = tests_failed + 1
         write (output_unit, '(a)') 'FAILED'
         call report_failures(suite // '.' // name)
      else
         write (output_unit, '(a)') 'ok'
      end if
   end subroutine funit_run_test

   !> Prints what the test left pending and forgets it.
   subroutine report_failures(test_name)
      character(*), intent(in) :: test_name
      integer :: i

      do i = 1, size(pending)
         write (output_unit, '(2a)') ' Failure in: ', test_name
         associate (at => pending(i)%location)
            if (at%line > 0) write (output_unit, '(5a)') '   Location: [', trim(at%file_name), ':', text(at%line), ']'
         end associate
         write (output_unit, '(2a)') '   ', pending(i)%message
      end do
      deallocate (pending)
   end subroutine report_failures

   !> Counts a disabled test.
   subroutine funit_skip_test(suite, name)
      character(*), intent(in) :: suite, name

      tests_disabled = tests_disabled + 1
      write (output_unit, '(5a)') ' ', suite, '.', name, ' ... disabled'
   end subroutine funit_skip_test

   !> Prints the closing lines; ends the program with exit status 2 if a test failed.
   subroutine funit_finish()
      integer(int64) :: now, ticks_per_second
      real(real64) :: seconds

      call system_clock(now, ticks_per_second)
      seconds = 0
      if (started >= 0) seconds = real(now - started, real64) / real(ticks_per_second, real64)
      write (output_unit, '(/, a, f12.3, a, /)') ' Time:', seconds, ' seconds'
      if (tests_failed == 0) then
         write (output_unit, '(a)') ' OK'
         write (output_unit, '(5a)') ' (', text(tests_run), ' tests, ', text(tests_disabled), ' disabled)'
      else
         write (output_unit, '(a)') ' FAILURES!!!'
         write (output_unit, '(6a)') ' Tests run: ', text(tests_run), ', Failures: ', text(tests_failed), &
            ', Errors: 0, Disabled: ', text(tests_disabled)
         flush (output_unit)
         stop 2
      end if
   end subroutine funit_finish

end module funit
