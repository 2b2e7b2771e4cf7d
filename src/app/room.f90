!> Whether there is room for a run: memory before anything large is allocated, space on the disk for what it will write.
module room
   use cadence, only: cadence_t
   use communication, only: n_processes, processes_here
   use cost, only: cost_t
   use errors, only: exit_files, failure
   use kinds, only: dp
   use machine, only: available_memory, endless, free_space
   use run_log, only: log_t
   use settings, only: settings_t
   use solid_table, only: solid_columns
   use text, only: short
   implicit none
   private

   public :: check_room, output_bytes

   real(dp), parameter :: number_width = 25      !! letters of a number in a table
   real(dp), parameter :: checkpoint_bytes = 64  !! of a particle in each of the two
   real(dp), parameter :: energy_columns = 30, error_columns = 10, wall_columns = 8   !! about

contains

   !> Raises exit_files where memory does not suffice; warns of a full disk, and of output more often than there are steps.
   subroutine check_room(scene, costs, path, log, problem)
      type(settings_t), intent(in) :: scene
      type(cost_t), intent(in) :: costs
      character(*), intent(in) :: path          !! directory of the results
      type(log_t), intent(inout) :: log
      type(failure), intent(inout) :: problem
      real(dp) :: memory, needed, bytes, disk

      associate (output => scene%output)
         call check_cadence('energy', output%energy)
         if (size(scene%probes) + size(scene%gauges) > 0) call check_cadence('probes', output%probes)
         if (scene%exact%solution /= 'none') call check_cadence('errors', output%errors)
         if (size(scene%solids) > 0) call check_cadence('solids', output%solids)
         call check_cadence('walls', output%walls)
         call check_cadence('snapshots', output%snapshots)
      end associate
      bytes = output_bytes(scene, costs)
      disk = free_space(path)
      if (bytes > disk) call log%warn('disk', 'the run will write about '//size_text(bytes)//', and '//size_text(disk) &
                                      //" are free where '"//path//"' is: write less often, or elsewhere with --output DIR")
      memory = available_memory()
      needed = costs%bytes*processes_here()/n_processes()
      if (needed > memory) call problem%raise(exit_files, 'the run needs about '//size_text(needed) &
         //' of memory, and '//size_text(memory)//' are free: lower the resolution, or run it on a larger machine')

   contains

      subroutine check_cadence(name, phrase)
         character(*), intent(in) :: name, phrase
         type(cadence_t) :: when
         character(:), allocatable :: ignored

         call when%parse(trim(phrase), ignored)
         if (when%interval() < costs%dt/2) call log%warn('output '//name, "&output "//name//" = '"//trim(phrase) &
            //"' is more often than there are steps, of up to "//short(costs%dt)//': each step is written')
      end subroutine check_cadence

   end subroutine check_room

   !> About what a run will write.
   real(dp) function output_bytes(scene, costs) result(bytes)
      type(settings_t), intent(in) :: scene
      type(cost_t), intent(in) :: costs
      real(dp) :: per_number, per_particle
      integer :: k

      associate (output => scene%output)
         ! Positions, numbers and cells; vectors have three components.
         per_number = merge(8.0_dp, 4.0_dp, output%precision == 'double')
         per_particle = 3*per_number + 21
         do k = 1, output%n_fields
            per_particle = per_particle + per_number*merge(3, 1, output%fields(k) == 'velocity')
         end do
         bytes = written(output%snapshots)*costs%particles*per_particle + written(output%energy)*energy_columns*number_width
         if (size(scene%probes) + size(scene%gauges) > 0) &
            bytes = bytes + written(output%probes)*(2 + size(scene%probes) + size(scene%gauges))*number_width
         if (scene%exact%solution /= 'none') bytes = bytes + written(output%errors)*error_columns*number_width
         if (size(scene%solids) > 0) bytes = bytes + written(output%solids)*solid_columns(scene%solids)*number_width
         bytes = bytes + written(output%walls)*wall_columns*number_width
         if (output%checkpoint /= 'never') bytes = bytes + 2*costs%particles*checkpoint_bytes
      end associate

   contains

      real(dp) function written(phrase)
         character(*), intent(in) :: phrase
         type(cadence_t) :: when
         character(:), allocatable :: ignored

         call when%parse(trim(phrase), ignored)
         written = when%number(costs%steps, scene%time%end_time)
      end function written

   end function output_bytes

   ! 1.5 GB
   pure function size_text(bytes) result(words)
      real(dp), intent(in) :: bytes
      character(:), allocatable :: words

      if (bytes >= endless) then
         words = 'any amount'
      else if (bytes < 1.0e9_dp) then
         words = short(max(0.0_dp, bytes)/1.0e6_dp)//' MB'
      else
         words = short(bytes/1.0e9_dp)//' GB'
      end if
   end function size_text

end module room
