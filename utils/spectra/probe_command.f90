!> dynsph-spectra probe.
module probe_command
   use errors, only: failure
   use options, only: options_t
   implicit none
   private

   public :: run_probe_command

contains

   subroutine run_probe_command(arguments, problem)
      character(*), intent(in) :: arguments(:)
      type(failure), intent(inout) :: problem
      type(options_t) :: options

      options%command = 'dynsph-spectra probe'
      call options%add('--window', 'NAME', 'hann', 'x')
      call options%parse(arguments, problem)
   end subroutine run_probe_command

end module probe_command
