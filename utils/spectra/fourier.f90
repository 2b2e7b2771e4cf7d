!> Discrete Fourier transforms of real values, by FFTW.
!!
!! transform(m) = sum_j values(j) exp(-2 pi i j m/n), j and m from 0, not divided by n. The other half is the complex
!! conjugate of the half that is returned.
module fourier
   use, intrinsic :: iso_c_binding, only: c_char, c_double, c_double_complex, c_float, c_float_complex, c_funptr, c_int, &
      c_int32_t, c_intptr_t, c_ptr, c_size_t
   use kinds, only: dp
   implicit none
   private

   public :: transform_line, transform_plane

   include 'fftw3.f03'

contains

   !> Of a row of values.
   function transform_line(values) result(transform)
      real(dp), intent(in) :: values(:)                !! (n)
      complex(dp), allocatable :: transform(:)         !! (n/2 + 1)
      real(dp), allocatable :: copy(:)
      type(c_ptr) :: plan

      allocate (transform(size(values)/2 + 1))
      copy = values   ! FFTW may write over its input
      plan = fftw_plan_dft_r2c_1d(size(values), copy, transform, fftw_estimate)
      call fftw_execute_dft_r2c(plan, copy, transform)
      call fftw_destroy_plan(plan)
   end function transform_line

   !> Of values on a grid, in both directions.
   function transform_plane(values) result(transform)
      real(dp), intent(in) :: values(:, :)             !! (nx, ny)
      complex(dp), allocatable :: transform(:, :)      !! (nx/2 + 1, ny)
      real(dp), allocatable :: copy(:, :)
      type(c_ptr) :: plan

      allocate (transform(size(values, 1)/2 + 1, size(values, 2)))
      copy = values
      plan = fftw_plan_dft_r2c_2d(size(values, 2), size(values, 1), copy, transform, fftw_estimate)   ! C's order
      call fftw_execute_dft_r2c(plan, copy, transform)
      call fftw_destroy_plan(plan)
   end function transform_plane

end module fourier
