!> dynsph-spectra vorticity.
module vorticity_command
   use errors, only: failure
   use options, only: options_t
   implicit none
   private

   public :: run_vorticity_command

contains

   subroutine run_vorticity_command(arguments, problem)
      character(*), intent(in) :: arguments(:)
      type(failure), intent(inout) :: problem
      type(options_t) :: options

      options%command = 'dynsph-spectra vorticity'
      call options%parse(arguments, problem)
   end subroutine run_vorticity_command

end module vorticity_command
