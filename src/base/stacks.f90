!> Whether there is stack enough: a program that runs out of it ends without a word.
module stacks
   use, intrinsic :: iso_c_binding, only: c_int, c_long
   use errors, only: exit_files, failure
   use kinds, only: i8
   use text, only: lower_case, parse_integer, quoted, to_text
   implicit none
   private

   public :: check_stacks, stack_bytes

   integer(i8), parameter, public :: least_stack = 524288   !! [bytes] five times what was needed, of the process and of each thread
   integer(i8), parameter :: usual_stack = 8388608          !! [bytes] that systems give

   integer(c_int), parameter :: rlimit_stack = 3            ! of Linux, BSD and macOS

   type, bind(c) :: rlimit_t
      integer(c_long) :: soft, hard   !! [bytes], < 0: no limit
   end type rlimit_t

   interface
      integer(c_int) function getrlimit(resource, limit) bind(c)
         import :: c_int, rlimit_t
         integer(c_int), value :: resource
         type(rlimit_t), intent(out) :: limit
      end function getrlimit

      integer(c_int) function setrlimit(resource, limit) bind(c)
         import :: c_int, rlimit_t
         integer(c_int), value :: resource
         type(rlimit_t), intent(in) :: limit
      end function setrlimit
   end interface

contains

   !> Raises a stack that is too small, as far as it may be. Raises exit_files if that is not enough, or if OMP_STACKSIZE is not.
   subroutine check_stacks(grown, problem)
      logical, intent(out) :: grown   !! the process has more now; its threads only if the program is started anew
      type(failure), intent(inout) :: problem
      type(rlimit_t) :: limit

      grown = .false.
      if (getrlimit(rlimit_stack, limit) == 0) then
         if (is_short(int(limit%hard, i8))) then
            call problem%raise(exit_files, 'the stack is limited to '//to_text(int(limit%hard/1024))//' kB, and dynsph needs ' &
                               //to_text(int(least_stack/1024))//": say 'ulimit -s "//to_text(int(usual_stack/1024)) &
                               //"' where the limit was set")
         else if (is_short(int(limit%soft, i8))) then
            limit%soft = usual_stack
            if (limit%hard > 0) limit%soft = min(limit%soft, limit%hard)
            grown = setrlimit(rlimit_stack, limit) == 0
         end if
      end if
      if (.not. problem%raised()) call check_stack_of_threads(problem)
   end subroutine check_stacks

   pure logical function is_short(bytes)
      integer(i8), intent(in) :: bytes   !! < 0: no limit

      is_short = bytes >= 0 .and. bytes < least_stack
   end function is_short

   subroutine check_stack_of_threads(problem)
      type(failure), intent(inout) :: problem
      character(*), parameter :: names(2) = [character(14) :: 'OMP_STACKSIZE', 'GOMP_STACKSIZE']
      character(100) :: value
      integer :: k, status

      do k = 1, size(names)
         call get_environment_variable(trim(names(k)), value, status=status)
         if (status /= 0 .or. value == '') cycle
         if (is_short(stack_bytes(value))) call problem%raise(exit_files, 'each thread has a stack of '//trim(names(k))//' = ' &
            //quoted(trim(value))//', which is too small: leave it out, or give '//to_text(int(least_stack/1024))//'k or more')
         return   ! the first one counts
      end do
   end subroutine check_stack_of_threads

   !> What OMP_STACKSIZE says, in bytes: a number, of kB unless B, K, M or G follows; -1 if it is something else.
   pure integer(i8) function stack_bytes(value) result(bytes)
      character(*), intent(in) :: value
      character(*), parameter :: units = 'bkmg'
      character(:), allocatable :: message, number
      integer :: amount, last, power

      bytes = -1
      number = lower_case(trim(adjustl(value)))
      last = len(number)
      if (last == 0) return
      power = index(units, number(last:)) - 1
      if (power >= 0) last = last - 1
      if (power < 0) power = 1
      call parse_integer(trim(number(:last)), amount, message)
      if (message == '' .and. amount >= 0) bytes = amount*1024_i8**power
   end function stack_bytes

end module stacks
