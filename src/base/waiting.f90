!> How threads wait for each other: by sleeping after a short while, so that a run next to other work does not crawl.
!!
!! A thread of gfortran's OpenMP library that waits for the others keeps its core busy for milliseconds. On a machine whose cores
!! have other work too, those that are waited for do not get on meanwhile, and a run takes many times as long as it need.
module waiting
   use, intrinsic :: iso_c_binding, only: c_char, c_int, c_loc, c_null_char, c_null_ptr, c_ptr, c_size_t
   implicit none
   private

   public :: sleep_while_waiting

   interface
      integer(c_int) function setenv(name, value, overwrite) bind(c)
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: name(*), value(*)
         integer(c_int), value :: overwrite
      end function setenv

      integer(c_size_t) function readlink(link, path, room) bind(c)
         import :: c_char, c_size_t
         character(kind=c_char), intent(in) :: link(*)
         character(kind=c_char), intent(inout) :: path(*)
         integer(c_size_t), value :: room
      end function readlink

      integer(c_int) function execv(path, arguments) bind(c)
         import :: c_char, c_int, c_ptr
         character(kind=c_char), intent(in) :: path(*)
         type(c_ptr), intent(in) :: arguments(*)
      end function execv
   end interface

contains

   !> Starts the program anew, once, with a short time of waiting awake, unless the environment says how threads shall wait.
   !!
   !! The library reads it before the program begins, so there is no other way from inside. Where the program cannot be started
   !! anew, it goes on as it is. To be called first of all.
   subroutine sleep_while_waiting(anew)
      logical, intent(in), optional :: anew   !! start it anew in any case: something else is other now
      character(kind=c_char), allocatable, target :: words(:, :)
      type(c_ptr), allocatable :: arguments(:)
      character(kind=c_char) :: path(4096)
      character(:), allocatable :: word
      integer :: k, n, longest, length
      integer(c_int) :: status
      logical :: settled

      settled = is_set('OMP_WAIT_POLICY')
      if (.not. settled) settled = is_set('GOMP_SPINCOUNT')
      if (present(anew)) settled = settled .and. .not. anew
      if (settled) return
      n = command_argument_count()
      longest = 0
      do k = 0, n
         call get_command_argument(k, length=length)
         longest = max(longest, length)
      end do
      allocate (words(longest + 1, 0:n), arguments(0:n + 1))
      words = c_null_char
      allocate (character(longest) :: word)
      do k = 0, n
         call get_command_argument(k, word, length)
         words(:length, k) = transfer(word(:length), words, length)
         arguments(k) = c_loc(words(1, k))
      end do
      arguments(n + 1) = c_null_ptr
      status = 0
      if (.not. is_set('OMP_WAIT_POLICY')) status = setenv('GOMP_SPINCOUNT'//c_null_char, '10000'//c_null_char, 0_c_int)
      ! The name of the link would be the process's name.
      path = c_null_char
      if (readlink('/proc/self/exe'//c_null_char, path, size(path, kind=c_size_t) - 1) <= 0) return
      ! Returns only if it fails.
      if (status == 0) status = execv(path, arguments)
   end subroutine sleep_while_waiting

   logical function is_set(name)
      character(*), intent(in) :: name
      integer :: status

      call get_environment_variable(name, status=status)
      is_set = status /= 1
   end function is_set

end module waiting
