!> Small text helpers: numbers to and from text, lower case, and the nearest known word.
module text
   use, intrinsic :: iso_c_binding, only: c_char, c_double, c_null_char, c_null_ptr, c_ptr
   use kinds, only: dp, i8
   implicit none
   private

   public :: to_text, short, rounded_down, rounded_up, parse_real, parse_integer, behind, has_control_characters, lower_case, &
      quoted, for_shell, nearest_word

   integer, parameter :: largest_exponent = range(1.0_dp)   ! powers of ten both ways
   integer, parameter :: beyond = 10**6     ! stands for any exponent far too large
   real(dp), parameter :: slack = 1.0e-9_dp ! of a digit: rounding of the number
   integer, parameter :: full_digits = 17   ! enough to give every real(dp) back bit by bit

   interface
      ! Numbers are read by the C library, which is what a Fortran read does in the end; that takes five times as long.
      pure real(c_double) function c_strtod(letters, behind_it) bind(c, name='strtod')
         import :: c_char, c_double, c_ptr
         character(kind=c_char), intent(in) :: letters(*)
         type(c_ptr), value :: behind_it
      end function c_strtod
   end interface

   !> A number as text, without blanks; a real in the fewest digits that read back exactly.
   interface to_text
      module procedure integer_text, long_text, real_text, vector_text
   end interface to_text

contains

   !> An integer as text.
   pure function integer_text(number) result(text_of)
      integer, intent(in) :: number
      character(:), allocatable :: text_of

      text_of = long_text(int(number, i8))
   end function integer_text

   !> A long integer as text.
   pure function long_text(number) result(text_of)
      integer(i8), intent(in) :: number
      character(:), allocatable :: text_of

      character(24) :: buffer
      integer(i8) :: rest
      integer :: at

      ! Not by a write, which takes ten times as long.
      rest = number
      at = len(buffer) + 1
      do
         at = at - 1
         buffer(at:at) = achar(iachar('0') + int(abs(mod(rest, 10_i8))))
         rest = rest/10
         if (rest == 0) exit
      end do
      text_of = buffer(at:)
      if (number < 0) text_of = '-'//text_of
   end function long_text

   !> A real in the fewest significant digits that read back as the same number.
   pure function real_text(number) result(text_of)
      real(dp), intent(in) :: number
      character(:), allocatable :: text_of

      character(40) :: buffer
      logical :: exact
      integer :: digit_count

      ! A number that is exact in fewer than 15 digits has zeros behind them; those near 0 have not even 15.
      do digit_count = merge(1, 15, abs(number) < tiny(number)), full_digits
         call write_digits(number, digit_count, buffer, exact)
         if (exact) exit
      end do
      text_of = plain_notation(trim(adjustl(buffer)))

   end function real_text

   ! A real in so many digits, and whether that reads back as the same number. NaN and Infinity have no digits.
   pure subroutine write_digits(number, digit_count, buffer, exact)
      real(dp), intent(in) :: number
      integer, intent(in) :: digit_count
      character(*), intent(out) :: buffer
      logical, intent(out) :: exact
      real(dp) :: again

      write (buffer, '(es40.'//integer_text(digit_count - 1)//'e3)') number
      exact = digit_count == full_digits .or. scan(buffer, 'Ny') > 0
      if (exact) return
      again = c_strtod(trim(adjustl(buffer))//c_null_char, c_null_ptr)
      exact = transfer(again, 0_i8) == transfer(number, 0_i8)
   end subroutine write_digits

   !> A vector as text, its numbers parted by commas.
   pure function vector_text(numbers) result(text_of)
      real(dp), intent(in) :: numbers(:)
      character(:), allocatable :: text_of

      integer :: i

      text_of = ''
      do i = 1, size(numbers)
         if (i > 1) text_of = text_of//', '
         text_of = text_of//real_text(numbers(i))
      end do
   end function vector_text

   !> Turns '-1.2500E-002' into '-0.0125' where that is as easy to read, else into '-1.25e-2'.
   pure function plain_notation(scientific) result(plain)
      character(*), intent(in) :: scientific   !! from an es edit descriptor
      character(:), allocatable :: plain

      integer, parameter :: least = -4, greatest = 6   ! exponents shown without an E
      character(:), allocatable :: digit_string, message, sign_text
      integer :: at_e, exponent_value, point

      at_e = index(scientific, 'E')
      plain = scientific
      if (at_e == 0) return   ! NaN and Infinity have no exponent
      call parse_integer(scientific(at_e + 1:), exponent_value, message)
      sign_text = ''
      digit_string = scientific(:verify(scientific(:at_e - 1), '0', back=.true.))
      if (digit_string(1:1) == '-') then
         sign_text = '-'
         digit_string = behind(digit_string, 1)
      end if
      point = index(digit_string, '.')
      if (exponent_value < least .or. exponent_value > greatest) then
         if (point == len(digit_string)) digit_string = digit_string//'0'
         plain = sign_text//digit_string//'e'//integer_text(exponent_value)
         return
      end if
      digit_string = digit_string(:point - 1)//digit_string(point + 1:)
      if (exponent_value < 0) then
         plain = sign_text//'0.'//repeat('0', -exponent_value - 1)//digit_string
      else
         if (len(digit_string) < exponent_value + 2) then
            digit_string = digit_string//repeat('0', exponent_value + 2 - len(digit_string))
         end if
         plain = sign_text//digit_string(:exponent_value + 1)//'.'//digit_string(exponent_value + 2:)
      end if
   end function plain_notation

   !> Reads one real number and nothing else.
   !! The form is checked first: a list-directed read would also take '1,5', '2*3', '1-5' or
   !! 'nan'. So is the magnitude: converting 1e400 would stop a program that traps overflow.
   pure subroutine parse_real(word, number, message)
      character(*), intent(in) :: word
      real(dp), intent(out) :: number
      character(:), allocatable, intent(out) :: message   !! '' when read, else why not

      integer :: marks

      number = 0.0_dp
      message = ''
      if (.not. is_real_form(word)) then
         message = quoted(word)//' is not a number'
      else if (abs(decimal_exponent(word)) > largest_exponent) then
         message = quoted(word)//' is beyond the range of numbers'
      else
         marks = scan(word//'d', 'dD') - 1   ! what C does not know as the mark of an exponent
         number = c_strtod(word(:marks)//trim(merge('e', ' ', marks < len(word)))//word(marks + 2:)//c_null_char, c_null_ptr)
      end if
   end subroutine parse_real

   !> Power of ten of the first digit of a real number that is not 0; 0 for zero.
   pure integer function decimal_exponent(word)
      character(*), intent(in) :: word   !! of a form that is_real_form accepts

      character(:), allocatable :: message
      integer :: first, mantissa_end, point

      decimal_exponent = 0
      mantissa_end = scan(word//'e', 'eEdD') - 1
      first = scan(word(:mantissa_end), '123456789')
      if (first == 0) return
      if (mantissa_end < len(word)) then
         call parse_integer(word(mantissa_end + 2:), decimal_exponent, message)
         if (message /= '' .or. abs(decimal_exponent) > beyond) decimal_exponent = beyond
      end if
      point = index(word(:mantissa_end)//'.', '.')
      decimal_exponent = decimal_exponent + point - first
      if (first < point) decimal_exponent = decimal_exponent - 1
   end function decimal_exponent

   !> Reads one integer and nothing else.
   pure subroutine parse_integer(word, number, message)
      character(*), intent(in) :: word
      integer, intent(out) :: number
      character(:), allocatable, intent(out) :: message   !! '' when read, else why not

      integer(i8) :: long
      integer :: at, i

      number = 0
      at = 1
      call skip_sign(word, at)
      if (digit_run(word, at) == 0 .or. at + digit_run(word, at) <= len(word)) then
         message = quoted(word)//' is not a whole number'
         return
      end if
      long = 0
      do i = at, len(word)
         if (long <= huge(number)) long = 10*long + iachar(word(i:i)) - iachar('0')
      end do
      if (word(1:1) == '-') long = -long
      if (long > huge(number) .or. long < -huge(number) - 1_i8) then
         message = quoted(word)//' is beyond the range of whole numbers'
      else
         message = ''
         number = int(long)
      end if
   end subroutine parse_integer

   !> True for [sign] digits with at most one point, then [e|d [sign] digits].
   pure logical function is_real_form(word)
      character(*), intent(in) :: word

      integer :: at, count_of

      is_real_form = .false.
      at = 1
      call skip_sign(word, at)
      count_of = digit_run(word, at)
      at = at + count_of
      if (at <= len(word)) then
         if (word(at:at) == '.') then
            at = at + 1
            count_of = count_of + digit_run(word, at)
            at = at + digit_run(word, at)
         end if
      end if
      if (count_of == 0) return
      if (at <= len(word)) then
         if (scan(word(at:at), 'eEdD') == 0) return
         at = at + 1
         call skip_sign(word, at)
         if (digit_run(word, at) == 0) return
         at = at + digit_run(word, at)
      end if
      is_real_form = at > len(word)
   end function is_real_form

   !> Steps over a sign.
   pure subroutine skip_sign(word, at)
      character(*), intent(in) :: word
      integer, intent(inout) :: at

      if (at > len(word)) return
      if (scan(word(at:at), '+-') > 0) at = at + 1
   end subroutine skip_sign

   !> Number of digits that stand from a position on.
   pure integer function digit_run(word, at)
      character(*), intent(in) :: word
      integer, intent(in) :: at

      digit_run = 0
      if (at > len(word)) return
      digit_run = verify(word(at:), '0123456789') - 1
      if (digit_run < 0) digit_run = len(word) - at + 1
   end function digit_run

   !> A text in single quotes, those inside doubled, as a namelist has it.
   pure function quoted(word) result(in_quotes)
      character(*), intent(in) :: word
      character(:), allocatable :: in_quotes
      character(2*len(word) + 2) :: buffer
      integer :: i, length

      buffer(1:1) = "'"
      length = 1
      do i = 1, len_trim(word)
         if (word(i:i) == "'") then
            length = length + 1
            buffer(length:length) = "'"
         end if
         length = length + 1
         buffer(length:length) = word(i:i)
      end do
      in_quotes = buffer(:length)//"'"
   end function quoted

   !> A word as a shell takes it for one.
   pure function for_shell(word) result(safe)
      character(*), intent(in) :: word
      character(:), allocatable :: safe
      character(*), parameter :: plain = 'abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./+,:=@%'
      integer :: i

      safe = word
      if (verify(word, plain) == 0 .and. len(word) > 0) return
      safe = "'"
      do i = 1, len(word)
         if (word(i:i) == "'") then
            safe = safe//"'\''"
         else
            safe = safe//word(i:i)
         end if
      end do
      safe = safe//"'"
   end function for_shell

   !> What comes behind the first letters of a text. (`words = words(3:)` reads beyond its end with gfortran 12: it is made
   !! shorter before it is read.)
   pure function behind(words, letters) result(rest)
      character(*), intent(in) :: words
      integer, intent(in) :: letters
      character(:), allocatable :: rest

      rest = words(letters + 1:)
   end function behind

   !> Whether a text has a line end or the like in it.
   pure logical function has_control_characters(words)
      character(*), intent(in) :: words

      integer :: i

      has_control_characters = any([(iachar(words(i:i)) < 32 .or. iachar(words(i:i)) == 127, i=1, len(words))])
   end function has_control_characters

   !> The word in lower case.
   pure function lower_case(word) result(lower)
      character(*), intent(in) :: word
      character(len(word)) :: lower

      integer, parameter :: shift = iachar('a') - iachar('A')
      integer :: i

      lower = word
      do i = 1, len(word)
         if (word(i:i) >= 'A' .and. word(i:i) <= 'Z') lower(i:i) = achar(iachar(word(i:i)) + shift)
      end do
   end function lower_case

   !> The known word most like the given one, or '' when none is close enough to be meant.
   pure function nearest_word(word, known) result(nearest)
      character(*), intent(in) :: word
      character(*), intent(in) :: known(:)
      character(:), allocatable :: nearest

      integer :: distance, i, least

      nearest = ''
      least = max(1, len_trim(word)/3) + 1   ! one slip per three letters is still a slip
      do i = 1, size(known)
         distance = edit_distance(lower_case(trim(word)), lower_case(trim(known(i))))
         if (distance < least) then
            least = distance
            nearest = trim(known(i))
         end if
      end do
   end function nearest_word

   !> Letters to insert, drop, change or swap with their neighbour to turn one word into the other.
   pure integer function edit_distance(word, other)
      character(*), intent(in) :: word
      character(*), intent(in) :: other

      integer :: row(0:len(word), 0:len(other))   ! row(i, j): the first i letters against the first j
      integer :: changed, i, j

      row(:, 0) = [(i, i=0, len(word))]
      row(0, :) = [(j, j=0, len(other))]
      do j = 1, len(other)
         do i = 1, len(word)
            changed = merge(0, 1, word(i:i) == other(j:j))
            row(i, j) = min(row(i - 1, j) + 1, row(i, j - 1) + 1, row(i - 1, j - 1) + changed)
            if (i > 1 .and. j > 1) then
               if (word(i:i) == other(j - 1:j - 1) .and. word(i - 1:i - 1) == other(j:j)) then
                  row(i, j) = min(row(i, j), row(max(i, 2) - 2, max(j, 2) - 2) + 1)
               end if
            end if
         end do
      end do
      edit_distance = row(len(word), len(other))
   end function edit_distance

   !> A number in four significant digits, without trailing zeros.
   pure function short(value) result(words)
      real(dp), intent(in) :: value
      character(:), allocatable :: words
      character(32) :: buffer
      character(:), allocatable :: form
      integer :: decimals

      if (abs(value) > huge(value)) then   ! it has no digits to count
         words = 'Infinity'
         if (value < 0) words = '-Infinity'
         return
      end if
      decimals = 3
      if (abs(value) > 0) decimals = 3 - floor(log10(abs(value)))
      if (decimals > 7 .or. decimals < -5) then
         ! 8.000E+300 needs a third digit, or the E goes.
         form = '(es10.3)'
         if (decimals > 99 .or. decimals < -93) form = '(es12.3e3)'
         write (buffer, form) value
         words = trim(adjustl(buffer))
         return
      end if
      write (buffer, '(f0.'//integer_text(max(0, decimals))//')') value
      words = trim(buffer)
      do while (index(words, '.') > 0 .and. scan(words(len(words):), '0.') > 0)
         decimals = len(words) - 1
         if (words(len(words):) == '.') then
            words = words(:decimals)
            exit
         end if
         words = words(:decimals)
      end do
      if (words == '') words = '0'
      if (words(1:1) == '.') words = '0'//words
      if (len(words) > 1) then
         if (words(1:2) == '-.') words = '-0'//words(2:)
      end if
   end function short

   !> A number rounded down to four digits, so that a limit can be copied from a message; 0 if it is not positive.
   pure function rounded_down(number) result(words)
      real(dp), intent(in) :: number
      character(:), allocatable :: words

      words = four_digits(real(floor(number/fourth_digit(number) + slack), dp)*fourth_digit(number))
   end function rounded_down

   !> The same rounded up.
   pure function rounded_up(number) result(words)
      real(dp), intent(in) :: number
      character(:), allocatable :: words

      words = four_digits(real(ceiling(number/fourth_digit(number) - slack), dp)*fourth_digit(number))
   end function rounded_up

   ! What the fourth digit counts.
   pure real(dp) function fourth_digit(number)
      real(dp), intent(in) :: number

      real(dp), parameter :: least = 1.0e-300_dp   ! so that the power of ten has an inverse

      fourth_digit = 10.0_dp**(floor(log10(max(number, least))) - 3)
   end function fourth_digit

   pure function four_digits(number) result(words)
      real(dp), intent(in) :: number
      character(:), allocatable :: words

      character(24) :: buffer
      real(dp) :: rounded

      write (buffer, '(es24.3e3)') max(number, 0.0_dp)
      read (buffer, *) rounded
      words = to_text(rounded)
   end function four_digits

end module text
