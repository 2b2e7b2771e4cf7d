!> Runs a scene as dynsph does, but with other margins of the time step: how those of module `linear_stability` were found.
!!
!! usage: dynsph-margins [--sound S] [--diffusion D] [--viscous V] [options] SCENE.nml     (--help lists them)
!!
!! A margin is the share of a still lattice's limit that the time step may use; 1 is all of it. Results are those of dynsph, with
!! the margins in run.log; preliminary runs of reference_speed = 'auto' keep those of dynsph. A cfl below the limit of sound rules
!! the step whatever the margins: --set time.cfl=2.49 tries those.
program margins
   use, intrinsic :: iso_fortran_env, only: output_unit
   use command_line, only: command_line_t
   use errors, only: end_program, exit_input, failure
   use kinds, only: dp
   use linear_stability, only: margins_t
   use options, only: options_t
   use process_start, only: start_process
   use program_arguments, only: take_arguments
   use scene_input, only: load_scene, read_settings_text
   use scene_run, only: run_into_directory
   use settings, only: settings_t
   use solution_register, only: solutions_t
   use standard_output, only: check_screen, errors_for_signals
   use text, only: short
   implicit none

   real(dp), parameter :: least = 0.01_dp, largest = 1.2_dp
   type(options_t) :: given
   type(failure) :: problem
   character(:), allocatable :: arguments(:)

   call declare_options(given)
   call start_process()
   call errors_for_signals(pipes=.true.)
   call take_arguments(arguments)
   call given%parse(arguments, problem)
   if (given%help) then
      write (output_unit, '(a)') 'usage: dynsph-margins [--sound S] [--diffusion D] [--viscous V] SCENE.nml', ''
      call given%write_help(output_unit)
      call check_screen(problem)
   else if (.not. problem%raised()) then
      call run_scene()
   end if
   call end_program(problem)

contains

   subroutine declare_options(list)
      type(options_t), intent(out) :: list

      list%command = 'dynsph-margins'
      call list%add('--sound', 'S', '', 'share of a lattice''s limit of sound; without it that of dynsph')
      call list%add('--diffusion', 'D', '', 'the same of density diffusion')
      call list%add('--viscous', 'V', '', 'the same of viscosity')
      call list%add('--set', 'GROUP.KEY=VALUE', '', 'put a value in the place of the one in the file; repeatable')
      call list%add('--output', 'DIR', '', 'directory of the results')
      call list%add('--overwrite', '', '', 'results that are in DIR already may be replaced')
      call list%add('--quiet', '', '', 'nothing on the screen but errors')
   end subroutine declare_options

   subroutine run_scene()
      type(command_line_t) :: as_dynsph
      type(settings_t) :: scene
      type(margins_t) :: shares
      character(:), allocatable :: content, warnings(:)

      if (size(given%files) /= 1) then
         call problem%raise(exit_input, 'dynsph-margins: give one scene file; --help lists the options')
         return
      end if
      as_dynsph%scene = trim(given%files(1))
      as_dynsph%output = given%word('--output')
      as_dynsph%overrides = given%words('--set')
      as_dynsph%overwrite = given%given('--overwrite')
      as_dynsph%quiet = given%given('--quiet')
      call load_scene(as_dynsph%scene, content, problem)
      if (problem%raised()) return
      call read_settings_text(content, as_dynsph%scene, as_dynsph%overrides, solutions_t(), scene, warnings, problem)
      if (problem%raised()) return
      call take('--sound', shares%sound)
      call take('--diffusion', shares%diffusion)
      call take('--viscous', shares%viscous)
      if (.not. problem%raised()) call run_into_directory(as_dynsph, content, scene, warnings, problem, shares)
   end subroutine run_scene

   ! A share that the user gives.
   subroutine take(name, share)
      character(*), intent(in) :: name
      real(dp), intent(inout) :: share   !! unchanged without it
      real(dp) :: value

      if (.not. given%given(name)) return
      value = given%real_number(name, problem)
      if (problem%raised()) return
      if (value >= least .and. value <= largest) then
         share = value
      else
         call problem%raise(exit_input, 'dynsph-margins: '//name//' must be from '//short(least)//' to '//short(largest) &
                            //'; 1 is the limit of a lattice')
      end if
   end subroutine take

end program margins
