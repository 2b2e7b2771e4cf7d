!> Takes the command line apart.
module command_line
   use errors, only: exit_input, failure
   use text, only: nearest_word, quoted
   implicit none
   private

   public :: command_line_t, parse_command_line, write_help

   integer, parameter :: option_length = 12
   character(option_length), parameter :: switches(*) = [character(option_length) :: '--check', '--overwrite', &
                                                         '--quiet', '--shortest', '--template', '--keys', '--help', &
                                                         '--version']
   character(option_length), parameter :: with_value(*) = [character(option_length) :: '--set', '--output', '--resume', &
                                                           '--fork']
   character(*), parameter :: see_help = 'dynsph --help lists the options'

   !> What the user asks for.
   type :: command_line_t
      character(:), allocatable :: scene          !! path of the scene file; '' if none is needed
      character(:), allocatable :: output         !! directory of the results; '' if not said
      character(:), allocatable :: resume         !! directory of the run that goes on; '' for one that begins
      character(:), allocatable :: fork           !! directory that it goes on in, changed; '' if it is the same
      character(:), allocatable :: overrides(:)   !! 'group.key=value', in their order
      logical :: check = .false.                  !! validate only
      logical :: overwrite = .false.              !! existing results may be replaced
      logical :: quiet = .false.                  !! nothing on the screen but errors
      logical :: shortest = .false.               !! print the scene in few lines only
      logical :: template = .false.               !! print a template of all keys
      logical :: keys = .false.                   !! print the list of keys
      logical :: help = .false.
      logical :: version = .false.
   contains
      procedure, private :: switch_on
      procedure, private :: take_value
      procedure, private :: add_override
      procedure, private :: take_scene
   end type command_line_t

contains

   !> Takes the arguments of the program apart.
   !! Raises exit_input with all that is wrong.
   subroutine parse_command_line(arguments, parsed, problem)
      character(*), intent(in) :: arguments(:)
      type(command_line_t), intent(out) :: parsed
      type(failure), intent(inout) :: problem

      character(:), allocatable :: name, value
      integer :: at
      logical :: has_value

      parsed%scene = ''
      parsed%output = ''
      parsed%resume = ''
      parsed%fork = ''
      allocate (character(1) :: parsed%overrides(0))
      at = 0
      do while (at < size(arguments))
         at = at + 1
         if (index(arguments(at), '-') /= 1) then
            call parsed%take_scene(trim(arguments(at)), problem)
            cycle
         end if
         call split_option(arguments(at), name, value, has_value)
         if (any(with_value == name)) then
            if (.not. has_value .and. at < size(arguments)) then
               ! What begins with -- is the next option: the value was forgotten.
               has_value = index(arguments(at + 1), '--') /= 1
               if (has_value) at = at + 1
               if (has_value) value = trim(arguments(at))
            end if
            call parsed%take_value(name, value, has_value, problem)
         else if (has_value .and. any(switches == name)) then
            call problem%raise(exit_input, 'command line: '//name//' takes no value; '//see_help)
         else
            call parsed%switch_on(name, problem)
         end if
      end do
      if (.not. problem%raised()) call check_what_is_run(parsed, problem)
   end subroutine parse_command_line

   !> A scene that begins, or a run that goes on.
   subroutine check_what_is_run(parsed, problem)
      type(command_line_t), intent(in) :: parsed
      type(failure), intent(inout) :: problem

      if (parsed%template .or. parsed%keys .or. parsed%help .or. parsed%version) return
      if (parsed%resume == '') then
         if (parsed%fork /= '') then
            call problem%raise(exit_input, 'command line: --fork needs --resume DIR, the run that is forked')
         else if (parsed%scene == '') then
            call problem%raise(exit_input, 'command line: which scene? Usage: dynsph [options] scene.nml; '//see_help)
         end if
      else if (parsed%scene /= '') then
         call problem%raise(exit_input, 'command line: --resume goes on with the input in '//quoted(parsed%resume)//'; leave out ' &
                            //quoted(parsed%scene)//', and change a value with --set')
      else if (parsed%output /= '') then
         call problem%raise(exit_input, 'command line: --resume writes where the run did; leave out --output, or write elsewhere ' &
                            //'with --fork DIR')
      else if (parsed%overwrite .and. parsed%fork == '') then
         call problem%raise(exit_input, 'command line: --resume keeps the results; leave out --overwrite')
      else if (parsed%check .or. parsed%shortest) then
         call problem%raise(exit_input, 'command line: --check and --shortest take a scene; '//parsed%resume &
                            //'/input_used.nml is that of the run')
      end if
   end subroutine check_what_is_run

   !> Parts '--output=DIR' into '--output' and 'DIR'.
   pure subroutine split_option(argument, name, value, has_value)
      character(*), intent(in) :: argument
      character(:), allocatable, intent(out) :: name, value
      logical, intent(out) :: has_value

      integer :: equals

      equals = index(argument, '=')
      has_value = equals > 0
      if (has_value) then
         name = argument(:equals - 1)
         value = trim(argument(equals + 1:))
      else
         name = trim(argument)
         value = ''
      end if
   end subroutine split_option

   !> Keeps the scene file; there can be one only.
   subroutine take_scene(self, path, problem)
      class(command_line_t), intent(inout) :: self
      character(*), intent(in) :: path
      type(failure), intent(inout) :: problem

      if (path == '') then
         call problem%raise(exit_input, 'command line: an argument is empty; a scene file is wanted')
      else if (self%scene /= '') then
         call problem%raise(exit_input, 'command line: one scene at a time, not both '//quoted(self%scene)//' and ' &
                            //quoted(path)//'; results go to --output DIR')
      else
         self%scene = path
      end if
   end subroutine take_scene

   !> Sets an option that takes no value.
   subroutine switch_on(self, name, problem)
      class(command_line_t), intent(inout) :: self
      character(*), intent(in) :: name
      type(failure), intent(inout) :: problem

      character(:), allocatable :: meant

      select case (name)
      case ('--check')
         self%check = .true.
      case ('--overwrite')
         self%overwrite = .true.
      case ('--quiet')
         self%quiet = .true.
      case ('--shortest')
         self%shortest = .true.
      case ('--template')
         self%template = .true.
      case ('--keys')
         self%keys = .true.
      case ('--help', '-h')
         self%help = .true.
      case ('--version')
         self%version = .true.
      case default
         meant = nearest_word(name, [switches, with_value])
         if (meant /= '') then
            call problem%raise(exit_input, 'command line: there is no option '//name//"; did you mean '"//meant//"'?")
         else
            call problem%raise(exit_input, 'command line: there is no option '//name//'; '//see_help)
         end if
      end select
   end subroutine switch_on

   !> Keeps the value of an option that takes one.
   subroutine take_value(self, name, value, has_value, problem)
      class(command_line_t), intent(inout) :: self
      character(*), intent(in) :: name, value
      logical, intent(in) :: has_value
      type(failure), intent(inout) :: problem

      character(:), allocatable :: what

      what = 'the name of a directory'
      if (name == '--set') what = 'group.key=value'
      if (.not. has_value .or. value == '') then
         call problem%raise(exit_input, 'command line: '//name//' needs '//what)
         return
      end if
      select case (name)
      case ('--set')
         call self%add_override(value)
      case ('--resume')
         call take_directory(name, value, self%resume, problem)
      case ('--fork')
         call take_directory(name, value, self%fork, problem)
      case default
         call take_directory(name, value, self%output, problem)
      end select
   end subroutine take_value

   subroutine take_directory(name, value, directory, problem)
      character(*), intent(in) :: name, value
      character(:), allocatable, intent(inout) :: directory   !! '' so far
      type(failure), intent(inout) :: problem

      if (directory /= '') then
         call problem%raise(exit_input, 'command line: '//name//' is given twice, '//quoted(directory)//' and '//quoted(value))
      else
         directory = value
      end if
   end subroutine take_directory

   !> Appends an override.
   subroutine add_override(self, phrase)
      class(command_line_t), intent(inout) :: self
      character(*), intent(in) :: phrase

      character(max(len(self%overrides), len(phrase))) :: longer(size(self%overrides) + 1)
      integer :: i

      do i = 1, size(self%overrides)
         longer(i) = self%overrides(i)
      end do
      longer(size(longer)) = phrase
      deallocate (self%overrides)
      allocate (character(len(longer)) :: self%overrides(size(longer)))
      do i = 1, size(longer)
         self%overrides(i) = longer(i)
      end do
   end subroutine add_override

   !> Writes what the program can do.
   subroutine write_help(unit)
      integer, intent(in) :: unit

      write (unit, '(a)') &
         'Usage: dynsph [options] scene.nml', &
         '       dynsph --resume DIR [--set group.key=value] [--fork DIR2]', &
         '', &
         'Runs the free-surface flow that a namelist file describes, by the delta-SPH scheme.', &
         '', &
         '  --check                 validate the scene and say what it would do; run nothing', &
         '  --set group.key=value   put a value in the place of the one in the file; repeatable', &
         '                          body(2).velocity=1,0 means the second &body', &
         '  --output DIR            directory of the results', &
         '  --overwrite             results that are in DIR already may be replaced', &
         '  --resume DIR            go on with the run in DIR from its latest checkpoint', &
         '  --fork DIR2             with --resume: go on in DIR2, where more than the end and the output may be changed', &
         '  --quiet                 nothing on the screen but errors', &
         '  --shortest              print what of the scene differs from the defaults; run nothing', &
         '  --template              print a scene with all keys, defaults, units and ranges', &
         '  --keys                  print the same as Markdown tables', &
         '  --help                  print this', &
         '  --version               print version, compiler and flags', &
         '', &
         'The number of threads is OMP_NUM_THREADS.', &
         'A run stops, and can go on, at SIGTERM, SIGINT, SIGHUP, SIGXCPU, SIGUSR1, a file STOP in its directory, max_wall_time.', &
         'Exit codes: 0 done, 1 wrong command line or input, 2 the solution left its range, 3 a file or directory, 4 stopped.', &
         '', &
         'Example: dynsph --set scene.resolution=40 --output results/coarse input/dam_break.nml'
   end subroutine write_help

end module command_line
