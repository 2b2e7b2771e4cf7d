!> What the kernel sums make of plane waves when the particles stand on a square lattice.
!!
!! A wave exp(i k.r) is an eigenfunction of the sums over a lattice of spacing dx, so each sum turns into a number. With
!! grad W = F r these numbers are what the long-wave integrals (1/8 for shear, 3/8 for compression, c0 for sound)
!! become at finite h/dx and finite k dx. Lengths are in units of dx, so F has the kernel of smoothing length h/dx.
module square_lattice
   use kernel, only: kernel_gradient, kernel_t, new_kernel
   use kinds, only: dp
   implicit none
   private

   public :: lattice_crowd, shear_coefficient, compression_coefficient, sound_t, lattice_sound

   !> How a plane sound wave travels on the lattice.
   type :: sound_t
      real(dp) :: speed = 1     !! c(k)/c0
      real(dp) :: s_delta = 0   !! damping by the density diffusion, sigma dx/(delta c0)
      real(dp) :: s_alpha = 0   !! damping by the viscous term, sigma dx/(alpha c0)
   end type sound_t

contains

   !> sum_j (1 - r/(2h))**3 over the others within 2h: what F_ij V_j sums up to, but for factors.
   pure real(dp) function lattice_crowd(ratio) result(total)
      real(dp), intent(in) :: ratio   !! h/dx
      integer :: i, j, n

      n = ceiling(2*ratio)
      total = -1
      do j = -n, n
         do i = -n, n
            total = total + max(0.0_dp, 1 - norm2([real(i, dp), real(j, dp)])/(2*ratio))**3
         end do
      end do
   end function lattice_crowd

   !> nu/(alpha h c0) of a transverse wave: sum_j (1 - cos k.r) (t.r)**2/r**2 F dx**2 / k**2, t normal to k.
   !!
   !! Tends to 1/8 for h >> dx (eq. 16, K = 8). Without `k`: the limit of long waves,
   !! sum_j (e.r)**2 (t.r)**2/(2 r**2) F dx**2, along `direction`.
   pure real(dp) function shear_coefficient(ratio, direction, k) result(coefficient)
      real(dp), intent(in) :: ratio          !! h/dx
      real(dp), intent(in) :: direction(2)   !! of the wave, of any length
      real(dp), intent(in), optional :: k    !! wave number times dx

      coefficient = viscous_coefficient(ratio, direction, [-direction(2), direction(1)], k)
   end function shear_coefficient

   !> The same for a longitudinal wave; tends to 3/8 for h >> dx.
   pure real(dp) function compression_coefficient(ratio, direction, k) result(coefficient)
      real(dp), intent(in) :: ratio          !! h/dx
      real(dp), intent(in) :: direction(2)   !! of the wave, of any length
      real(dp), intent(in), optional :: k    !! wave number times dx

      coefficient = viscous_coefficient(ratio, direction, direction, k)
   end function compression_coefficient

   ! The viscous sum, eqs. 5 and 7, of u = a exp(i k e.r).
   pure real(dp) function viscous_coefficient(ratio, along, motion, k) result(total)
      real(dp), intent(in) :: ratio, along(2), motion(2)
      real(dp), intent(in), optional :: k
      type(kernel_t) :: kernel
      real(dp) :: e(2), a(2), r(2), curvature
      integer :: i, j, n

      kernel = new_kernel(ratio)
      e = along/norm2(along)
      a = motion/norm2(motion)
      n = ceiling(2*ratio)
      total = 0
      do j = -n, n
         do i = -n, n
            if (i == 0 .and. j == 0) cycle
            r = [real(i, dp), real(j, dp)]
            curvature = dot_product(e, r)**2/2
            ! 1 - cos(z) without cancellation
            if (present(k)) curvature = 2*sin(k*dot_product(e, r)/2)**2/k**2
            total = total + curvature*dot_product(a, r)**2/dot_product(r, r)*kernel_gradient(kernel, norm2(r))
         end do
      end do
   end function viscous_coefficient

   !> Speed and damping of a plane sound wave along a lattice axis, exact in time.
   !!
   !! With q = sum_j x sin(kx) F dx**2 the sums of eq. 5 give ds/dt = -i q rho u and du/dt = -i q c0**2 s/rho: c/c0 = q/k.
   !! The density diffusion damps s by delta h c0 (2 sum_j (1 - cos kx) F dx**2 - q**2/M), M = sum_j x**2 F dx**2 the
   !! inverse of L; the viscous term damps u by alpha h c0 sum_j (1 - cos kx) x**2/r**2 F dx**2. The wave, half of it in s and
   !! half in u, takes half of each: exp(-sigma t) with sigma = (c0/dx) (delta s_delta + alpha s_alpha).
   pure type(sound_t) function lattice_sound(ratio, k) result(sound)
      real(dp), intent(in) :: ratio   !! h/dx
      real(dp), intent(in) :: k       !! wave number times dx, > 0
      type(kernel_t) :: kernel
      real(dp) :: f, q, m, curvature
      integer :: i, j, n

      kernel = new_kernel(ratio)
      n = ceiling(2*ratio)
      q = 0
      m = 0
      curvature = 0
      do j = -n, n
         do i = -n, n
            f = kernel_gradient(kernel, norm2([real(i, dp), real(j, dp)]))
            q = q + i*sin(k*i)*f
            m = m + i**2*f
            curvature = curvature + 2*sin(k*i/2)**2*f
         end do
      end do
      sound%speed = q/k
      sound%s_delta = ratio*(2*curvature - q**2/m)/2
      sound%s_alpha = ratio*compression_coefficient(ratio, [1.0_dp, 0.0_dp], k)*k**2/2
   end function lattice_sound

end module square_lattice
