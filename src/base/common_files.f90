!> Files as the first process sees them, which is what all then know: another may see a file a moment later, or not at all.
!!
!! To be called by all.
module common_files
   use communication, only: any_process, is_first, tell_all
   use errors, only: failure
   use file_system, only: path_exists, read_whole_file, same_place
   implicit none
   private

   public :: exists_for_all, read_for_all, same_for_all

contains

   !> Whether there is a file or directory.
   logical function exists_for_all(path)
      character(*), intent(in) :: path

      exists_for_all = .false.
      if (is_first()) exists_for_all = path_exists(path)
      exists_for_all = any_process(exists_for_all)
   end function exists_for_all

   !> Whether two paths lead to one place.
   logical function same_for_all(one, other)
      character(*), intent(in) :: one, other

      same_for_all = .false.
      if (is_first()) same_for_all = same_place(one, other)
      same_for_all = any_process(same_for_all)
   end function same_for_all

   !> The bytes of a file; '' where it cannot be read.
   subroutine read_for_all(path, content, problem)
      character(*), intent(in) :: path
      character(:), allocatable, intent(out) :: content
      type(failure), intent(inout) :: problem   !! exit_files

      content = ''
      if (is_first()) call read_whole_file(path, content, problem)
      call problem%tell()
      call tell_all(content, 0)
   end subroutine read_for_all

end module common_files
