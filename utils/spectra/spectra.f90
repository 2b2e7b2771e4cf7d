!> dynsph-spectra: spectra of what runs wrote. Exit codes as dynsph's.
program spectra
   use, intrinsic :: iso_fortran_env, only: output_unit
   use errors, only: end_program, exit_input, failure
   use probe_command, only: run_probe_command
   use process_start, only: start_process
   use program_arguments, only: take_arguments
   use standard_output, only: check_screen, errors_for_signals
   use text, only: quoted
   use vorticity_command, only: run_vorticity_command
   implicit none

   type(failure) :: problem
   character(:), allocatable :: arguments(:)   ! behind the command
   character(16) :: command

   call start_process()
   call errors_for_signals(pipes=.false.)
   call take_arguments(arguments, from=2)
   command = '--help'
   if (command_argument_count() > 0) call get_command_argument(1, command)
   select case (command)
   case ('vorticity')
      call run_vorticity_command(arguments, problem)
   case ('probe')
      call run_probe_command(arguments, problem)
   case ('--help')
      write (output_unit, '(a)') &
         'usage: dynsph-spectra vorticity SNAPSHOT.vtkhdf...   enstrophy and kinetic energy over wavenumber', &
         '       dynsph-spectra probe probes.dat...            power of a probe''s signal over frequency', &
         '', 'dynsph-spectra vorticity --help and dynsph-spectra probe --help list their options.'
   case default
      call problem%raise(exit_input, 'dynsph-spectra: there is no '//quoted(trim(command))//'; commands are vorticity and probe')
   end select
   if (.not. problem%raised()) call check_screen(problem)
   call end_program(problem)

end program spectra
