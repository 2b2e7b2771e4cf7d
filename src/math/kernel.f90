!> The Wendland C2 kernel in two dimensions.
!!
!! Source: Meringolo et al. 2019, sec. 2; with q = r/h < 2,
!! W(r) = 7/(4 pi h**2) (1 - q/2)**4 (1 + 2q) and grad_i W_ij = F(r) (r_j - r_i),
!! F(r) = -W'(r)/r = 35/(4 pi h**4) (1 - q/2)**3, which is finite at r = 0.
module kernel
   use kinds, only: dp, i8
   use lanes, only: hardware_root
   implicit none
   private

   public :: kernel_t, new_kernel, kernel_value, kernel_gradient, pair, pair_with_value, squared_distance, root

   real(dp), parameter :: pi = acos(-1.0_dp)

   !> K of eq. 16, mu = alpha h c0 rho0/K: 2 (n + 2) in n = 2 dimensions.
   real(dp), parameter, public :: k_2d = 8

   !> Distance in h below which a pair counts as this far apart in max |pi_ij|. Nothing keeps particles from meeting, because the
   !! kernel's gradient is 0 at r = 0; with eq. 8 as printed, steps would shrink to nothing before they do.
   real(dp), parameter, public :: closest = 0.01_dp

   !> Added to r**2, so that it can be divided by: nothing for particles that do not stand in the same place.
   real(dp), parameter, public :: nothing = 1.0e-100_dp

   !> A kernel of given smoothing length with its constants worked out.
   type :: kernel_t
      real(dp) :: h                  !! smoothing length
      real(dp) :: support            !! radius 2h beyond which W is zero
      real(dp) :: inverse_support    !! 1/(2h)
      real(dp) :: value_factor       !! 7/(4 pi h**2)
      real(dp) :: gradient_factor    !! 35/(4 pi h**4)
   end type kernel_t

contains

   !> The kernel of smoothing length h.
   pure type(kernel_t) function new_kernel(h) result(self)
      real(dp), intent(in) :: h   !! smoothing length

      self = kernel_t(h=h, support=2*h, inverse_support=1/(2*h), &
                      value_factor=7/(4*pi*h**2), gradient_factor=35/(4*pi*h**4))
   end function new_kernel

   !> W(r).
   elemental real(dp) function kernel_value(self, r) result(w)
      type(kernel_t), intent(in) :: self
      real(dp), intent(in) :: r   !! distance

      associate (t => max(0.0_dp, 1 - r*self%inverse_support))
         w = self%value_factor*t**4*(1 + 2*r/self%h)
      end associate
   end function kernel_value

   !> F(r), so that grad_i W_ij = F (r_j - r_i).
   elemental real(dp) function kernel_gradient(self, r) result(f)
      type(kernel_t), intent(in) :: self
      real(dp), intent(in) :: r   !! distance

      f = self%gradient_factor*max(0.0_dp, 1 - r*self%inverse_support)**3
   end function kernel_gradient

   !> What every sum over neighbours takes of a pair: F V_j without its constant factor, and 1/r**2.
   !!
   !! F = factor t**3 with t = 1 - r/2h, 0 beyond the support. What a caller does not use is not computed: this is inlined. Which
   !! root is faster is the processor's: CMake measures it (cmake/Lanes.cmake).
   elemental subroutine pair(dx, dy, inverse_support, volume, weight, inverse_2)
      real(dp), intent(in) :: dx, dy            !! r_j - r_i
      real(dp), intent(in) :: inverse_support   !! 1/2h
      real(dp), intent(in) :: volume            !! V_j
      real(dp), intent(out) :: weight           !! t**3 V_j
      real(dp), intent(out) :: inverse_2        !! 1/r**2
      real(dp) :: z, r, inverse, t

      z = squared_distance(dx, dy)
      if (hardware_root) then
         r = sqrt(z)
         inverse_2 = 1/z
      else
         call root(z, r, inverse)
         inverse_2 = inverse*inverse
      end if
      t = max(0.0_dp, 1 - inverse_support*r)
      weight = t*t*(t*volume)
   end subroutine pair

   !> What sums over solids' ghosts take of a pair: F and W, both without their constant factors.
   elemental subroutine pair_with_value(dx, dy, inverse_support, weight, value)
      real(dp), intent(in) :: dx, dy            !! r_j - r_i
      real(dp), intent(in) :: inverse_support   !! 1/2h
      real(dp), intent(out) :: weight           !! t**3
      real(dp), intent(out) :: value            !! t**4 (5 - 4 t), because 1 + 2q = 5 - 4t
      real(dp) :: r, inverse, t

      if (hardware_root) then
         r = sqrt(squared_distance(dx, dy))
      else
         call root(squared_distance(dx, dy), r, inverse)
      end if
      t = max(0.0_dp, 1 - inverse_support*r)
      weight = t*t*t
      value = weight*t*(5 - 4*t)
   end subroutine pair_with_value

   !> r**2, not 0 where two particles stand in the same place.
   elemental real(dp) function squared_distance(dx, dy) result(z)
      real(dp), intent(in) :: dx, dy   !! r_j - r_i

      z = dx*dx + (dy*dy + nothing)
   end function squared_distance

   !> sqrt(z) and 1/sqrt(z) of z > 0 to 2e-14, by multiplications alone.
   !!
   !! The vector square root of some processors occupies its unit for 18 cycles and more,
   !! half the time of a pair; a seed from the exponent bits and two third-order
   !! iterations cost 6. The result depends on z alone, so both particles of a pair see the
   !! same distance and the pair forces stay exactly opposite.
   elemental subroutine root(z, r, inverse)
      real(dp), intent(in) :: z          !! squared distance, > 0
      real(dp), intent(out) :: r         !! sqrt(z)
      real(dp), intent(out) :: inverse   !! 1/sqrt(z)
      integer(i8), parameter :: magic = int(z'5FE40B50C7B537A9', i8)
      ! (1 - e)**(-1/2) over the seed's 0.153 < e < 0.247, coefficients of least maximum error
      real(dp), parameter :: c0 = 1.004320414056_dp, c1 = 0.437227568657_dp, c2 = 0.656696587151_dp
      real(dp) :: e

      inverse = transfer(magic - shiftr(transfer(z, 1_i8), 1), 1.0_dp)
      e = 1 - (z*inverse)*inverse
      inverse = inverse*(c0 + e*(c1 + e*c2))
      r = z*inverse
      e = 1 - r*inverse
      e = e*(0.5_dp + e*0.375_dp)
      r = r + r*e
      inverse = inverse + inverse*e
   end subroutine root

end module kernel
