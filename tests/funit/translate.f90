!> Translates a test file with pFUnit annotations into Fortran: `funit_translate test_x.pf test_x.F90`.
!!
!! Every line keeps its number through #line, so compilers, debuggers and failures speak of the .pf file. What pFUnit's own
!! preprocessor passes over in silence (a test that never runs) or cannot read is an error here, `file:line: error: ...`,
!! and the exit status is 1.
program translate
   use, intrinsic :: iso_fortran_env, only: error_unit
   implicit none

   integer, parameter :: longest_line = 132   !! of the language
   integer, parameter :: longest_name = 44    !! of a test, in pFUnit
   integer, parameter :: name_length = 63     !! of any name, in the language

   !> Annotations that become calls.
   character(*), parameter :: asserts(*) = [character(name_length) :: 'assertequal', 'asserttrue', 'assertfalse', &
      'assertlessthan', 'assertlessthanorequal', 'assertgreaterthan', 'assertgreaterthanorequal', 'assertrelativelyequal', &
      'assertisnan', 'assertisfinite', 'assertexceptionraised', 'assertfail']
   !> Names that pFUnit's module exports too: a procedure of this name does not compile there.
   character(*), parameter :: taken(*) = [character(name_length) :: 'run', 'initialize', 'finalize', 'string']

   type :: test_case
      character(name_length) :: name = ''
      logical :: disabled = .false.
   end type test_case

   character(:), allocatable :: path, file_name           ! of the test file, with and without its directory
   character(name_length) :: module_name = '', before = '', after = ''
   character(name_length) :: awaited = ''                 ! annotation whose subroutine has to come on this line
   logical :: disabled = .false.
   type(test_case), allocatable :: tests(:)
   character(1024) :: line
   integer :: number = 0, errors = 0
   integer :: pf, f90, status

   path = argument(1)
   file_name = path(index(path, '/', back=.true.) + 1:)
   open (newunit=pf, file=path, status='old', action='read')
   open (newunit=f90, file=argument(2), status='replace', action='write')
   allocate (tests(0))

   call write_line_marker(1)
   do
      read (pf, '(a)', iostat=status) line
      if (status /= 0) exit
      number = number + 1
      if (len_trim(line) > longest_line) call error('line of more than 132 columns')
      if (index(line, '/*') > 0) call error('/* begins a comment of the preprocessor, which would swallow code')
      if (index(adjustl(line), '@') == 1) then
         call translate_annotation(trim(adjustl(line(index(line, '@') + 1:))))
      else
         if (awaited /= '') call take_procedure(trim(adjustl(line)))
         call check_name(lower(trim(adjustl(line))))
         if (module_name == '') call take_module_name(trim(adjustl(line)))
         write (f90, '(a)') trim(line)
      end if
   end do
   call check_file()

   if (errors > 0) then
      close (f90, status='delete')
      stop 1, quiet=.true.
   end if
   call write_suite()

contains

   !> Handles the annotation `words`, the line without its `@`.
   subroutine translate_annotation(words)
      character(*), intent(in) :: words
      character(:), allocatable :: name, rest

      name = lower(words(:length_of_name(words)))
      rest = words(len(name) + 1:)
      if (awaited /= '' .and. .not. (awaited == 'test' .and. name == 'disable')) then
         call error('@' // trim(awaited) // ' has to stand on the line above its subroutine')
         awaited = ''
      end if

      if (any(asserts == name)) then
         call translate_assert(name, rest)
         return
      end if
      select case (name)
      case ('test', 'before', 'after')
         awaited = name
         disabled = .false.
      case ('disable')
         if (awaited /= 'test') call error('@disable has to stand between @test and its subroutine')
         disabled = .true.
      case default
         call error('annotation @' // name // ' is not among those that the stand-in for pFUnit supports')
      end select
      if (rest /= '') call error('nothing may follow @' // name // ' on its line (options are not supported)')
      write (f90, '(2a)') '!@', name
   end subroutine translate_annotation

   !> Writes the call for an assert: its arguments on a line of their own, because the generated rest would not fit beside.
   subroutine translate_assert(name, rest)
      character(*), intent(in) :: name
      character(*), intent(in) :: rest   !! everything after the name: the arguments between parentheses
      character(:), allocatable :: arguments
      integer :: last

      last = closing_parenthesis(rest)
      if (last == 0) then
         call error('@' // name // ' needs its arguments between parentheses, all on its line (no &, no comment)')
         return
      end if
      if (rest(last + 1:) /= '') call error('nothing may follow the arguments of @' // name // ' on its line')
      arguments = trim(rest(2:last - 1))
      if (len('  call ' // name // '(' // rest(2:last - 1) // ', &') > longest_line) &
         call error('@' // name // ' makes a line of more than 132 columns in pFUnit: "  call ' // name // '(..., &"')
      if (name == 'assertequal') then
         call write_here('if (.false.) call funit_check_ranks( &')
         call write_here('& ' // first_two(arguments) // ')')
      end if
      call write_here('call ' // name // '( &')
      if (arguments /= '') call write_here('& ' // arguments // ', &')
      call write_here("& location=SourceLocation('" // file_name // "', __LINE__))")
      call write_here('if (anyExceptions()) return')
      call write_line_marker(number + 1)
   end subroutine translate_assert

   !> The first two of the arguments.
   function first_two(arguments) result(words)
      character(*), intent(in) :: arguments
      character(:), allocatable :: words
      integer :: at, commas, depth
      character :: quote

      commas = 0
      depth = 0
      quote = ' '
      do at = 1, len(arguments)
         call follow(arguments(at:at), depth, quote)
         if (arguments(at:at) == ',' .and. depth == 0 .and. quote == ' ') commas = commas + 1
         if (commas == 2) exit
      end do
      words = arguments(:at - 1)
   end function first_two

   !> Follows a text letter by letter: how deep in parentheses it is, those within strings do not count.
   subroutine follow(letter, depth, quote)
      character, intent(in) :: letter
      integer, intent(inout) :: depth
      character, intent(inout) :: quote   !! that has to end the string, blank outside strings

      if (quote /= ' ') then
         if (letter == quote) quote = ' '
         return
      end if
      select case (letter)
      case ('''', '"')
         quote = letter
      case ('(', '[')
         depth = depth + 1
      case (')', ']')
         depth = depth - 1
      end select
   end subroutine follow

   !> Position of the parenthesis that closes the one `text` begins with, 0 if there is none.
   integer function closing_parenthesis(text) result(at)
      character(*), intent(in) :: text
      integer :: depth
      character :: quote

      depth = 0
      quote = ' '
      do at = 1, len(text)
         if (text(at:at) == '!' .and. quote == ' ') exit
         call follow(text(at:at), depth, quote)
         if (depth == 0) exit
      end do
      if (at > len(text)) then
         at = 0
      else if (at == 1 .or. text(at:at) /= ')') then
         at = 0
      end if
   end function closing_parenthesis

   !> Takes the subroutine that the annotation on the line above stands for.
   subroutine take_procedure(words)
      character(*), intent(in) :: words
      character(*), parameter :: keyword = 'subroutine '
      character(:), allocatable :: name, rest

      if (index(lower(words), keyword) /= 1) then
         call error('@' // trim(awaited) // ' has to stand on the line above "subroutine name()", without prefixes')
      else
         rest = trim(adjustl(words(len(keyword):)))
         name = rest(:length_of_name(rest))
         rest = adjustl(rest(len(name) + 1:))
         if (rest /= '' .and. rest /= '()') call error('@' // trim(awaited) // ' procedures are declared "subroutine name()"')
         select case (awaited)
         case ('test')
            if (len(name) > longest_name) call error('test name of more than 44 characters')
            tests = [tests, test_case(name, disabled)]
         case ('before')
            if (before /= '') call error('second @before in this file')
            before = name
         case ('after')
            if (after /= '') call error('second @after in this file')
            after = name
         end select
      end if
      awaited = ''
   end subroutine take_procedure

   !> A procedure, of a test or not, must not have a name of pFUnit's.
   subroutine check_name(words)
      character(*), intent(in) :: words   !! a line in lower case
      character(:), allocatable :: name
      integer :: at, k
      character(*), parameter :: keywords(2) = ['subroutine', 'function  ']

      do k = 1, 2
         at = index(words, trim(keywords(k)) // ' ')
         if (at == 0 .or. verify(words(:at), 'abcdefghijklmnopqrstuvwxyz0123456789_() ') > 0 .or. index(words, 'end') == 1) cycle
         name = trim(adjustl(words(at + len_trim(keywords(k)):)))
         name = name(:length_of_name(name))
         if (any(taken == name)) call error('the name ' // name // ' clashes with one of pFUnit')
      end do
   end subroutine check_name

   !> Notes the module's name if this is a module statement, and checks it.
   subroutine take_module_name(words)
      character(*), intent(in) :: words

      if (index(lower(words), 'module ') /= 1) return
      module_name = adjustl(words(7:))
      module_name = lower(module_name(:length_of_name(module_name)))
      if (lower(file_name) /= trim(module_name) // '.pf') call error('module ' // trim(module_name) // ' in file ' // file_name &
         // ': the two names have to be the same')
   end subroutine take_module_name

   !> Checks what only the whole file shows.
   subroutine check_file()
      if (awaited /= '') call error('@' // trim(awaited) // ' without a subroutine')
      if (module_name == '') call error('no module in this file')
      if (size(tests) == 0) call error('no @test in this file')
   end subroutine check_file

   !> Appends the external procedure that runs the tests in the order of the file.
   subroutine write_suite()
      integer :: i

      write (f90, '(3a)') 'subroutine ', trim(module_name), '_suite()'
      write (f90, '(a)') '   use funit, only: funit_run_test, funit_skip_test'
      do i = 1, size(tests)
         if (.not. tests(i)%disabled) call write_use(tests(i)%name)
      end do
      if (before /= '') call write_use(before)
      if (after /= '') call write_use(after)
      write (f90, '(a)') '   implicit none'
      do i = 1, size(tests)
         write (f90, '(5a)') '   call ', trim(merge('funit_skip_test', 'funit_run_test ', tests(i)%disabled)), "('", &
            trim(module_name), "', &"
         write (f90, '(3a)', advance='no') "      '", trim(tests(i)%name), "'"
         if (.not. tests(i)%disabled) then
            write (f90, '(2a)', advance='no') ', ', trim(tests(i)%name)
            if (before /= '') write (f90, '(a, /, 2a)', advance='no') ', &', '      before=', trim(before)
            if (after /= '') write (f90, '(a, /, 2a)', advance='no') ', &', '      after=', trim(after)
         end if
         write (f90, '(a)') ')'
      end do
      write (f90, '(3a)') 'end subroutine ', trim(module_name), '_suite'
   end subroutine write_suite

   subroutine write_use(name)
      character(*), intent(in) :: name

      write (f90, '(4a)') '   use ', trim(module_name), ', only: ', trim(name)
   end subroutine write_use

   !> Writes a line of code that the compiler is to take for the line being read.
   subroutine write_here(code)
      character(*), intent(in) :: code

      call write_line_marker(number)
      write (f90, '(a)') code
   end subroutine write_here

   !> Tells the compiler that the next line is this one of the test file.
   subroutine write_line_marker(line_number)
      integer, intent(in) :: line_number

      write (f90, '(a, i0, 3a)') '#line ', line_number, ' "', path, '"'
   end subroutine write_line_marker

   !> Reports a mistake in the line being read.
   subroutine error(message)
      character(*), intent(in) :: message

      errors = errors + 1
      write (error_unit, '(2a, i0, 2a)') path, ':', number, ': error: ', message
   end subroutine error

   !> Number of characters of the name that `text` begins with.
   pure integer function length_of_name(text)
      character(*), intent(in) :: text

      length_of_name = verify(lower(text) // ' ', 'abcdefghijklmnopqrstuvwxyz0123456789_') - 1
   end function length_of_name

   pure function lower(text)
      character(*), intent(in) :: text
      character(len(text)) :: lower
      integer :: i

      lower = text
      do i = 1, len(text)
         if (lge(text(i:i), 'A') .and. lle(text(i:i), 'Z')) lower(i:i) = achar(iachar(text(i:i)) + 32)
      end do
   end function lower

   !> A command line argument; the program ends if it was not given.
   function argument(position) result(words)
      integer, intent(in) :: position
      character(:), allocatable :: words
      integer :: length

      if (command_argument_count() /= 2) error stop 'usage: funit_translate test_x.pf test_x.F90'
      call get_command_argument(position, length=length)
      allocate (character(length) :: words)
      call get_command_argument(position, words)
   end function argument

end program translate
