!> Time that a program spends in parallel regions, for all of them and without a word in their code.
!!
!! A program that is linked with this module enters its parallel regions through it: it stands before the procedure of the same
!! name in gfortran's OpenMP library, and calls that. What is outside can be had on one thread as the rest of the time.
module parallel_clock
   use, intrinsic :: iso_c_binding, only: c_char, c_f_procpointer, c_funptr, c_int, c_intptr_t, c_null_char, c_ptr
   use kinds, only: dp, i8
   use omp_lib, only: omp_in_parallel
   implicit none
   private

   public :: parallel_seconds, enter_parallel

   integer(i8) :: inside = 0   ! ticks in parallel regions so far

   abstract interface
      subroutine gomp_parallel_t(region, data, threads, flags) bind(c)
         import :: c_funptr, c_int, c_ptr
         type(c_funptr), value :: region
         type(c_ptr), value :: data
         integer(c_int), value :: threads, flags
      end subroutine gomp_parallel_t
   end interface

   interface
      type(c_funptr) function next_of_name(handle, name) bind(c, name='dlsym')
         import :: c_char, c_funptr, c_intptr_t
         integer(c_intptr_t), value :: handle
         character(kind=c_char), intent(in) :: name(*)
      end function next_of_name
   end interface

contains

   !> Wall time in parallel regions since the program's start [s].
   real(dp) function parallel_seconds()
      integer(i8) :: now, rate

      call system_clock(now, rate)
      parallel_seconds = real(inside, dp)/real(rate, dp)
   end function parallel_seconds

   !> What the compiler calls for a parallel region.
   subroutine enter_parallel(region, data, threads, flags) bind(c, name='GOMP_parallel')
      type(c_funptr), value :: region      !! the region's code
      type(c_ptr), value :: data           !! what it shares
      integer(c_int), value :: threads, flags
      integer(c_intptr_t), parameter :: next = -1   ! RTLD_NEXT
      procedure(gomp_parallel_t), pointer :: library
      integer(i8) :: began, ended

      call c_f_procpointer(next_of_name(next, 'GOMP_parallel'//c_null_char), library)
      if (omp_in_parallel()) then
         call library(region, data, threads, flags)
         return
      end if
      call system_clock(began)
      call library(region, data, threads, flags)
      call system_clock(ended)
      inside = inside + (ended - began)
   end subroutine enter_parallel

end module parallel_clock
