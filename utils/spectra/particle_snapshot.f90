!> The particles of a snapshot, with what spectra need to know of them.
module particle_snapshot
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use errors, only: exit_files, failure
   use hdf5_reader, only: hdf5_reader_t, name_length
   use kinds, only: dp
   implicit none
   private

   public :: particle_snapshot_t, read_snapshot

   !> Units are those of the run.
   type :: particle_snapshot_t
      character(:), allocatable :: title
      real(dp) :: time = 0
      real(dp) :: spacing = 0                     !! dx
      real(dp) :: gravity = 0, reference_length = 0
      real(dp), allocatable :: x(:), y(:), u(:), v(:)   !! (n)
      real(dp), allocatable :: volume(:)          !! (n) dx**2 rho0/rho; dx**2 where the density is not known
   end type particle_snapshot_t

contains

   !> Raises exit_files if it cannot be read, has no velocity, no particles, or numbers that are not finite.
   subroutine read_snapshot(path, snapshot, problem)
      character(*), intent(in) :: path
      type(particle_snapshot_t), intent(out) :: snapshot
      type(failure), intent(inout) :: problem
      type(hdf5_reader_t) :: file
      character(name_length), allocatable :: names(:)
      real(dp), allocatable :: points(:, :), velocity(:, :), values(:, :)
      real(dp) :: density, sound_speed

      call file%open(path, problem)
      if (.not. problem%raised()) call file%field_names(names, problem)
      if (.not. problem%raised()) then
         if (.not. any(names == 'velocity')) call problem%raise(exit_files, "'"//path//"' has no velocity; "// &
                                                                "write it with &output fields = 'velocity', ...")
      end if
      if (.not. problem%raised()) call file%read_points(points, problem)
      if (.not. problem%raised()) call file%read_field('velocity', size(points, 2), velocity, problem)
      if (.not. problem%raised()) then
         if (size(velocity, 1) /= 3) call problem%raise(exit_files, "the velocity of '"//path//"' is no vector")
      end if
      if (.not. problem%raised()) then
         snapshot%title = file%title()
         snapshot%time = file%number('time')
         snapshot%spacing = file%number('spacing')
         snapshot%gravity = file%number('gravity')
         snapshot%reference_length = file%number('reference_length')
         density = file%number('density')
         sound_speed = file%number('sound_speed')
         snapshot%x = points(1, :)
         snapshot%y = points(2, :)
         snapshot%u = velocity(1, :)
         snapshot%v = velocity(2, :)
         allocate (snapshot%volume(size(snapshot%x)))
         snapshot%volume = snapshot%spacing**2
         if (any(names == 'density')) then
            call file%read_field('density', size(points, 2), values, problem)
            if (.not. problem%raised()) snapshot%volume = snapshot%volume*density/values(1, :)
         else if (any(names == 'pressure') .and. sound_speed > 0) then
            call file%read_field('pressure', size(points, 2), values, problem)
            ! p = c0**2 (rho - rho0)
            if (.not. problem%raised()) snapshot%volume = snapshot%volume &
               /(1 + values(1, :)/(density*sound_speed**2))
         end if
      end if
      call file%close()
      if (problem%raised()) return
      if (size(snapshot%x) == 0) then
         call problem%raise(exit_files, "'"//path//"' has no particles")
      else if (.not. all(ieee_is_finite([snapshot%x, snapshot%y, snapshot%u, snapshot%v, snapshot%volume]))) then
         call problem%raise(exit_files, "'"//path//"' has positions, velocities or densities that are not finite; take an "// &
                            'earlier one')
      else if (.not. snapshot%spacing > 0) then
         call problem%raise(exit_files, "'"//path//"' does not say its spacing")
      end if
   end subroutine read_snapshot

end module particle_snapshot
