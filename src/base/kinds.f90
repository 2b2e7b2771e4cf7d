!> Numeric kinds used throughout.
module kinds
   use, intrinsic :: iso_fortran_env, only: real64, real32, int64
   implicit none
   private

   integer, parameter, public :: dp = real64   !! working precision
   integer, parameter, public :: sp = real32   !! single precision, for files and for margins
   integer, parameter, public :: i8 = int64    !! counters that may pass 2**31
end module kinds
