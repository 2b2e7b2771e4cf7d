!> The command line of a utility: files and options, each option with a value, a default and a line of help.
module options
   use errors, only: exit_input, failure
   use kinds, only: dp
   use text, only: nearest_word, parse_real, quoted, to_text
   implicit none
   private

   public :: options_t

   integer, parameter :: name_length = 24, value_length = 1000

   !> One option.
   type :: option_t
      character(name_length) :: name = ''       !! with its dashes
      character(name_length) :: value_name = '' !! '' for a switch, which takes none
      character(value_length) :: value = ''     !! what the user said, else the default
      character(value_length) :: meaning = ''
      logical :: given = .false.                !! the user said it
      character(value_length), allocatable :: all(:)   !! all that the user said, in its order
   end type option_t

   !> What a command takes and what the user gave it.
   type :: options_t
      character(:), allocatable :: command      !! as typed: 'dynsph-spectra probe'
      character(:), allocatable :: files(:)     !! arguments that are no options
      logical :: help = .false.                 !! --help was there
      type(option_t), allocatable :: list(:)
   contains
      procedure :: add
      procedure :: parse
      procedure :: write_help
      procedure :: given
      procedure :: word
      procedure :: words
      procedure :: real_number
      procedure :: check_choice
      procedure, private :: place
   end type options_t

contains

   !> Declares an option; in the order of the help.
   subroutine add(self, name, value_name, default, meaning)
      class(options_t), intent(inout) :: self
      character(*), intent(in) :: name, value_name, default, meaning

      if (.not. allocated(self%list)) allocate (self%list(0))
      self%list = [self%list, option_t(name, value_name, default, meaning)]
   end subroutine add

   !> Takes the arguments apart. Raises exit_input with what is unknown or lacks its value.
   subroutine parse(self, arguments, problem)
      class(options_t), intent(inout) :: self
      character(*), intent(in) :: arguments(:)
      type(failure), intent(inout) :: problem
      character(:), allocatable :: name
      logical :: is_file(size(arguments))
      integer :: at, equals, i

      is_file = .false.
      at = 0
      do while (at < size(arguments))
         at = at + 1
         if (index(arguments(at), '--') /= 1) then
            is_file(at) = .true.
            cycle
         end if
         equals = index(arguments(at), '=')
         name = trim(arguments(at))
         if (equals > 0) name = arguments(at) (:equals - 1)
         if (name == '--help') then
            self%help = .true.
            cycle
         end if
         i = self%place(name)
         if (i == 0) then
            call problem%raise(exit_input, self%command//': no option '//name//'; '//did_you_mean(self, name)//self%command &
                               //' --help lists them')
         else if (self%list(i)%value_name == '') then
            if (equals > 0) call problem%raise(exit_input, self%command//': '//name//' takes no value')
            self%list(i)%given = .true.
         else if (equals > 0) then
            call take(self%list(i), arguments(at) (equals + 1:), problem)
         else if (at == size(arguments)) then
            call problem%raise(exit_input, self%command//': '//name//' needs its '//trim(self%list(i)%value_name))
         else
            at = at + 1
            call take(self%list(i), arguments(at), problem)
         end if
      end do
      allocate (character(len(arguments)) :: self%files(count(is_file)))
      self%files = pack(arguments, is_file)
   end subroutine parse

   subroutine take(option, value, problem)
      type(option_t), intent(inout) :: option
      character(*), intent(in) :: value
      type(failure), intent(inout) :: problem

      if (len_trim(value) > value_length) call problem%raise(exit_input, trim(option%name)//' is too long: at most ' &
                                                             //to_text(value_length)//' letters')
      option%value = value
      if (.not. option%given) allocate (option%all(0))
      option%all = [option%all, option%value]
      option%given = .true.
   end subroutine take

   pure function did_you_mean(self, name) result(hint)
      class(options_t), intent(in) :: self
      character(*), intent(in) :: name
      character(:), allocatable :: hint
      character(name_length) :: names(size(self%list))

      names = self%list%name   ! one after the other, as the next line needs them
      hint = trim(nearest_word(name, names))
      if (hint /= '') hint = 'did you mean '//hint//'? '
   end function did_you_mean

   !> One line for each option.
   subroutine write_help(self, unit)
      class(options_t), intent(in) :: self
      integer, intent(in) :: unit
      character(2*name_length + 1) :: option
      character(value_length + 3) :: default
      integer :: i

      do i = 1, size(self%list)
         associate (o => self%list(i))
            option = trim(o%name)//' '//o%value_name
            default = ''
            if (o%value_name /= '' .and. o%value /= '') default = ' ['//trim(o%value)//']'
            write (unit, '(2x, a26, 2a)') option, trim(o%meaning), trim(default)
         end associate
      end do
      option = '--help'
      write (unit, '(2x, a26, a)') option, 'this text'
   end subroutine write_help

   pure integer function place(self, name)
      class(options_t), intent(in) :: self
      character(*), intent(in) :: name
      integer :: i

      place = 0
      do i = 1, size(self%list)
         if (self%list(i)%name == name) place = i
      end do
   end function place

   !> Whether the user said it.
   pure logical function given(self, name)
      class(options_t), intent(in) :: self
      character(*), intent(in) :: name

      given = self%list(self%place(name))%given
   end function given

   !> Its value as a word.
   pure function word(self, name)
      class(options_t), intent(in) :: self
      character(*), intent(in) :: name
      character(:), allocatable :: word

      word = trim(self%list(self%place(name))%value)
   end function word

   !> All its values, for an option that may be there more than once.
   pure function words(self, name)
      class(options_t), intent(in) :: self
      character(*), intent(in) :: name
      character(value_length), allocatable :: words(:)

      allocate (words(0))
      if (self%given(name)) words = self%list(self%place(name))%all
   end function words

   !> Its value as a number; raises exit_input if it is none.
   real(dp) function real_number(self, name, problem)
      class(options_t), intent(in) :: self
      character(*), intent(in) :: name
      type(failure), intent(inout) :: problem
      character(:), allocatable :: message

      call parse_real(self%word(name), real_number, message)
      if (message /= '') call problem%raise(exit_input, self%command//': '//name//' '//quoted(self%word(name))//': '//message)
   end function real_number

   !> Raises exit_input if its value is not one of those known.
   subroutine check_choice(self, name, known, problem)
      class(options_t), intent(in) :: self
      character(*), intent(in) :: name, known(:)
      type(failure), intent(inout) :: problem
      character(:), allocatable :: near, list
      integer :: i

      if (any(known == self%word(name))) return
      list = trim(known(1))
      do i = 2, size(known)
         list = list//', '//trim(known(i))
      end do
      near = nearest_word(self%word(name), known)
      if (near /= '') near = '; did you mean '//near//'?'
      call problem%raise(exit_input, self%command//': there is no '//name//' '//quoted(self%word(name))//': '//list//near)
   end subroutine check_choice

end module options
