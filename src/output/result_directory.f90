!> The directory a run writes to: made if need be, never mixed with another run's results.
module result_directory
   use directory_lock, only: directory_lock_t
   use communication, only: is_first
   use errors, only: exit_files, exit_input, failure
   use file_system, only: delete_file, file_bytes, find_files, is_directory, is_writable, longest_path, make_directory, &
      path_exists, remove_directory
   implicit none
   private

   public :: result_directory_t, snapshot_name

   ! Names of files, shared by those who write them and by those who delete them.
   character(*), parameter, public :: log_name = 'run.log'
   character(*), parameter, public :: input_name = 'input_used.nml'
   character(*), parameter, public :: energy_name = 'energy.dat'
   character(*), parameter, public :: probes_name = 'probes.dat'
   character(*), parameter, public :: errors_name = 'errors.dat'
   character(*), parameter, public :: solids_name = 'solids.dat'
   character(*), parameter, public :: walls_name = 'walls.dat'
   character(*), parameter, public :: summary_name = 'summary.txt'
   character(*), parameter, public :: series_name = 'snapshots.vtkhdf.series'
   character(*), parameter, public :: outlines_name = 'outlines.xdmf'
   character(*), parameter, public :: checkpoint_names(2) = ['checkpoint_a.h5', 'checkpoint_b.h5']   !! in turn
   character(*), parameter, public :: lock_name = 'run.lock'
   character(*), parameter, public :: stop_name = 'STOP'   !! a file that the user makes: the run shall stop

   character(*), parameter :: digit = '[0-9]'
   character(*), parameter :: any_snapshot = 'snapshot_'//repeat(digit, 6)//'.vtkhdf'

   !> Everything dynsph writes and may therefore delete, as shell patterns.
   character(*), parameter :: own_files(*) = [character(64) :: checkpoint_names, log_name, energy_name, probes_name, summary_name, &
      errors_name, solids_name, walls_name, outlines_name, series_name, any_snapshot, &
      input_name, &   ! by the last one the others are known
      input_name//'.partial', summary_name//'.partial', series_name//'.partial', any_snapshot//'.partial', &
      outlines_name//'.partial', checkpoint_names//'.partial']

   !> What shows that a directory holds a result.
   character(*), parameter :: result_signs(*) = [character(16) :: log_name, energy_name, summary_name, '*.vtkhdf', &
      checkpoint_names]

   !> How files begin that a run has written; one that begins otherwise is somebody else's.
   type :: beginning_t
      character(24) :: ending    !! of the name
      character(24) :: letters
   end type beginning_t

   type(beginning_t), parameter :: beginnings(*) = [beginning_t('.dat', '# title: '), &
      beginning_t(summary_name, 'status = '), beginning_t('.series', '{'), beginning_t('.vtkhdf', char(137)//'HDF'), &
      beginning_t('.xdmf', '<?xml'), beginning_t('.h5', 'dynsph sealed file'), beginning_t(input_name, '! The complete input'), &
      beginning_t(input_name, '! Forked from')]

   !> A result directory, and how much of its path this run has made.
   type :: result_directory_t
      character(:), allocatable :: path
      character(longest_path), allocatable, private :: made(:)   !! directories made by this run, outermost first
      logical, private :: cleared = .false.                      !! what is in it is this run's
      type(directory_lock_t), private :: lock
   contains
      procedure :: prepare
      procedure :: clear
      procedure :: release
      procedure :: keep_alive
      procedure :: reopen
      procedure :: look_for_foreign
      procedure :: delete_later_snapshots
      procedure :: file
      procedure :: snapshot_path
      procedure :: discard_if_empty
      procedure :: discard
   end type result_directory_t

contains

   !> Makes the directory, or takes an existing one, for this process alone; changes nothing when it cannot be used, and deletes
   !! nothing.
   subroutine prepare(self, path, overwrite, problem)
      class(result_directory_t), intent(inout) :: self
      character(*), intent(in) :: path
      logical, intent(in) :: overwrite          !! an earlier result may be deleted, by `clear`
      type(failure), intent(inout) :: problem   !! exit_input: holds a result, or another run; exit_files: cannot be used

      self%path = without_slashes(path)
      self%cleared = .false.
      if (allocated(self%made)) deallocate (self%made)
      allocate (self%made(0))
      if (is_first()) call take(self, overwrite, problem)
      call problem%tell()
   end subroutine prepare

   subroutine take(self, overwrite, problem)
      class(result_directory_t), intent(inout) :: self
      logical, intent(in) :: overwrite
      type(failure), intent(inout) :: problem
      character(:), allocatable :: reason

      if (.not. path_exists(self%path)) call make_with_parents(self, problem)
      if (problem%raised()) then
         call self%discard_if_empty()
      else if (.not. is_directory(self%path)) then
         call problem%raise(exit_files, "cannot write results to '"//self%path//"': it is not a directory that can be read"// &
            hint_other())
      else if (.not. is_writable(self%path, reason)) then
         call problem%raise(exit_files, "cannot write results to '"//self%path//"': "//reason//hint_other())
      else
         call self%lock%acquire(self%path, lock_name, problem)
         if (problem%raised()) call self%discard_if_empty()
         if (problem%raised()) return
         if (size(self%made) == 0) call look_at_earlier_result(self%path, overwrite, problem)
         if (problem%raised()) call self%release()
      end if
   end subroutine take

   !> Takes the directory of a run that shall go on, for this process alone unless it is only read. Changes nothing.
   subroutine reopen(self, path, only_read, problem)
      class(result_directory_t), intent(inout) :: self
      character(*), intent(in) :: path
      logical, intent(in) :: only_read
      type(failure), intent(inout) :: problem   !! exit_files: cannot be used; exit_input: another run holds it
      character(:), allocatable :: reason

      self%path = without_slashes(path)
      self%cleared = .false.
      if (allocated(self%made)) deallocate (self%made)
      if (.not. is_first()) then
         continue   ! as the first one finds it
      else if (.not. is_directory(self%path)) then
         call problem%raise(exit_files, "cannot go on with '"//self%path//"': it is not a directory that can be read")
      else if (only_read) then
         continue
      else if (.not. is_writable(self%path, reason)) then
         call problem%raise(exit_files, "cannot go on with '"//self%path//"': "//reason)
      else
         call self%lock%acquire(self%path, lock_name, problem)
      end if
      call problem%tell()
   end subroutine reopen

   !> Deletes an earlier result's files, now that the new run can start.
   subroutine clear(self, problem)
      class(result_directory_t), intent(inout) :: self
      type(failure), intent(inout) :: problem   !! exit_files: something cannot be deleted

      self%cleared = .true.
      if (size(self%made) == 0 .and. is_first()) call delete_own_files(self%path, problem)
      call problem%tell()
   end subroutine clear

   !> Gives the directory free, as the last thing.
   subroutine release(self)
      class(result_directory_t), intent(inout) :: self

      call self%lock%release()
   end subroutine release

   !> Tells other machines that the directory is in use; to be called now and then.
   subroutine keep_alive(self)
      class(result_directory_t), intent(inout) :: self

      call self%lock%beat()
   end subroutine keep_alive

   !> Refuses a directory that has files of others under our names. A checkpoint may be damaged: there are two.
   subroutine look_for_foreign(self, problem)
      class(result_directory_t), intent(in) :: self
      type(failure), intent(inout) :: problem   !! exit_input

      if (is_first()) call find_foreign(self%path, .true., problem)
      call problem%tell()
   end subroutine look_for_foreign

   !> Deletes the snapshots from a number on, and what was being written when a run was broken off.
   subroutine delete_later_snapshots(self, number, problem)
      class(result_directory_t), intent(in) :: self
      integer, intent(in) :: number             !! of the first that goes
      type(failure), intent(inout) :: problem   !! exit_files: something cannot be deleted
      character(longest_path), allocatable :: found(:)
      character(:), allocatable :: reason
      integer :: i, k

      do i = 1, size(own_files)
         if (.not. is_first()) exit
         if (index(own_files(i), '.partial') == 0 .and. own_files(i) /= any_snapshot) cycle
         call find_files(self%path, trim(own_files(i)), found)
         do k = 1, size(found)
            if (own_files(i) == any_snapshot) then
               if (llt(found(k), self%snapshot_path(number))) cycle
            end if
            call delete_file(trim(found(k)), reason)
            if (len(reason) > 0) call problem%raise(exit_files, "cannot delete '"//trim(found(k))//"': "//reason)
         end do
      end do
      call problem%tell()
   end subroutine delete_later_snapshots

   !> The path of a file in this directory.
   pure function file(self, name) result(path)
      class(result_directory_t), intent(in) :: self
      character(*), intent(in) :: name
      character(:), allocatable :: path

      path = self%path//'/'//name
   end function file

   !> The path of a numbered snapshot.
   pure function snapshot_path(self, number) result(path)
      class(result_directory_t), intent(in) :: self
      integer, intent(in) :: number   !! 0 to 999999
      character(:), allocatable :: path

      path = self%file(snapshot_name(number))
   end function snapshot_path

   !> Its name alone.
   pure function snapshot_name(number) result(name)
      integer, intent(in) :: number   !! 0 to 999999
      character(:), allocatable :: name
      character(6) :: digits

      write (digits, '(i6.6)') number
      name = 'snapshot_'//digits//'.vtkhdf'
   end function snapshot_name

   !> Takes back what this run did to the directory, and gives it free.
   subroutine discard(self, problem)
      class(result_directory_t), intent(inout) :: self
      type(failure), intent(inout) :: problem   !! exit_files: something cannot be deleted

      if (self%cleared .and. is_first()) call delete_own_files(self%path, problem)
      call problem%tell()
      call self%release()
      call self%discard_if_empty()
   end subroutine discard

   !> Removes what this run made of the path, as far as it is still empty.
   subroutine discard_if_empty(self)
      class(result_directory_t), intent(inout) :: self
      character(:), allocatable :: reason
      integer :: i

      if (.not. allocated(self%made)) return
      do i = size(self%made), 1, -1
         call remove_directory(trim(self%made(i)), reason)
         if (len(reason) > 0) exit
      end do
      deallocate (self%made)
   end subroutine discard_if_empty

   !> Makes the directory and those of its parents that are missing.
   subroutine make_with_parents(self, problem)
      class(result_directory_t), intent(inout) :: self
      type(failure), intent(inout) :: problem   !! exit_files
      character(:), allocatable :: reason, step
      character(longest_path) :: made
      integer :: last, slash

      last = 0
      do while (last < len(self%path))
         slash = index(self%path(last + 2:), '/')
         last = merge(last + slash, len(self%path), slash > 0)
         step = self%path(:last)
         if (path_exists(step)) cycle
         call make_directory(step, reason)
         if (len(reason) > 0) then
            call problem%raise(exit_files, "cannot make the directory '"//step//"': "//reason//hint_other())
            return
         end if
         made = step
         self%made = [self%made, made]
      end do
   end subroutine make_with_parents

   !> Refuses a directory with a result unless that may be deleted, and files of others under the names of ours.
   subroutine look_at_earlier_result(path, overwrite, problem)
      character(*), intent(in) :: path
      logical, intent(in) :: overwrite
      type(failure), intent(inout) :: problem
      character(longest_path), allocatable :: found(:)
      integer :: i

      if (.not. overwrite) then
         do i = 1, size(result_signs)
            call find_files(path, trim(result_signs(i)), found)
            if (size(found) == 0) cycle
            call problem%raise(exit_input, "'"//path//"' already holds a result ("//trim(found(1)(len(path) + 2:))// &
               "): choose another directory with --output DIR, or replace the result with --overwrite")
            return
         end do
      end if
      call find_foreign(path, .false., problem)
   end subroutine look_at_earlier_result

   ! Refuses what has a name of ours and is not ours.
   subroutine find_foreign(path, but_checkpoints, problem)
      character(*), intent(in) :: path
      logical, intent(in) :: but_checkpoints
      type(failure), intent(inout) :: problem   !! exit_input
      character(longest_path), allocatable :: found(:)
      integer :: i, k

      do i = 1, size(own_files)
         if (but_checkpoints .and. any(own_files(i) == checkpoint_names)) cycle
         call find_files(path, trim(own_files(i)), found)
         do k = 1, size(found)
            if (is_foreign(path, trim(found(k)))) call problem%raise(exit_input, "'"//trim(found(k)) &
               //"' was not written by a run of dynsph, which has that name for one of its own: move it away, or choose " &
               //'another directory with --output DIR')
         end do
      end do
   end subroutine find_foreign

   ! Whether somebody else has written a file with a name of ours. A log and what was being written can be known only by the input
   ! beside them.
   logical function is_foreign(directory, path)
      character(*), intent(in) :: directory, path
      integer :: k

      is_foreign = is_directory(path)
      if (is_foreign) return
      if (file_bytes(path) == 0) return   ! nothing can be lost
      if (path == directory//'/'//log_name .or. ends_with(path, '.partial')) &
         is_foreign = .not. path_exists(directory//'/'//input_name)
      do k = 1, size(beginnings)
         if (.not. ends_with(path, trim(beginnings(k)%ending))) cycle
         is_foreign = .not. begins_with(path, trim(beginnings(k)%letters))
         if (.not. is_foreign) return
      end do
   end function is_foreign

   pure logical function ends_with(path, letters)
      character(*), intent(in) :: path, letters

      ends_with = len(path) >= len(letters) .and. path(max(1, len(path) - len(letters) + 1):) == letters
   end function ends_with

   logical function begins_with(path, letters)
      character(*), intent(in) :: path, letters
      character(len(letters)) :: start
      integer :: unit, status

      begins_with = .false.
      open (newunit=unit, file=path, access='stream', form='unformatted', status='old', action='read', iostat=status)
      if (status /= 0) return
      read (unit, iostat=status) start
      begins_with = status == 0 .and. start == letters
      close (unit)
   end function begins_with

   subroutine delete_own_files(path, problem)
      character(*), intent(in) :: path
      type(failure), intent(inout) :: problem
      character(longest_path), allocatable :: found(:)
      character(:), allocatable :: reason
      integer :: i, k

      do i = 1, size(own_files)
         call find_files(path, trim(own_files(i)), found)
         do k = 1, size(found)
            call delete_file(trim(found(k)), reason)
            if (len(reason) > 0) call problem%raise(exit_files, "cannot delete '"//trim(found(k))//"': "//reason//hint_other())
         end do
      end do
   end subroutine delete_own_files

   pure function hint_other() result(hint)
      character(:), allocatable :: hint

      hint = '; choose another directory with --output DIR'
   end function hint_other

   !> A path without blanks and slashes at its end; '.' for none at all.
   pure function without_slashes(path) result(clean)
      character(*), intent(in) :: path
      character(:), allocatable :: clean

      clean = trim(path)
      do while (len(clean) > 1)
         if (clean(len(clean):) /= '/') exit
         clean = clean(:len(clean) - 1)
      end do
      if (len(clean) == 0) clean = '.'
   end function without_slashes

end module result_directory
