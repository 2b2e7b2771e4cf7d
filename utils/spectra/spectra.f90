!> dynsph-spectra: spectra of what runs wrote. Exit codes as dynsph's.
program spectra
   use, intrinsic :: iso_fortran_env, only: output_unit
   use errors, only: end_program, exit_input, failure
   use probe_command, only: run_probe_command
   use text, only: quoted
   use vorticity_command, only: run_vorticity_command
   implicit none

   type(failure) :: problem
   character(:), allocatable :: arguments(:), command

   call take_arguments(command, arguments)
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
      call problem%raise(exit_input, 'dynsph-spectra: there is no '//quoted(command)//'; commands are vorticity and probe')
   end select
   call end_program(problem)

contains

   !> The first argument and the others: gfortran 12 hands arguments(2:) on from the first.
   subroutine take_arguments(command, arguments)
      character(:), allocatable, intent(out) :: command        !! '--help' without any
      character(:), allocatable, intent(out) :: arguments(:)   !! all of the longest's length
      integer :: i, length, longest, others

      others = max(0, command_argument_count() - 1)
      longest = len('--help')
      do i = 1, command_argument_count()
         call get_command_argument(i, length=length)
         longest = max(longest, length)
      end do
      allocate (character(longest) :: arguments(others))
      do i = 1, others
         call get_command_argument(1 + i, arguments(i))
      end do
      command = repeat(' ', longest)
      call get_command_argument(1, command)
      command = trim(command)
      if (command == '') command = '--help'
   end subroutine take_arguments

end program spectra
