!> Von Neumann analysis of the linearised scheme on a square lattice at rest.
!!
!! A wave exp(i k.r) in the sums of eq. 5 around u = 0, rho = rho0 gives for w = -i u and s = c0 (rho - rho0)/rho0, with lengths in
!! units of dx, times in units of h/c0, grad W = F r and sums over the lattice,
!!   dw/dt = -S s - alpha M w        S = h sum sin(k.r) F r,   M = h**2 sum (1 - cos k.r) F r r/r**2
!!   ds/dt =  S.w - delta D s        D = h**2 [ 2 sum (1 - cos k.r) F - |S/h|**2/L ],   L = sum x**2 F.
!! The terms with S are A of `step_matrix`, those with alpha and delta are B, which may be frozen over the step.
module von_neumann
   use integrators, only: integrator_t
   use kernel, only: kernel_gradient, kernel_t, new_kernel
   use kinds, only: dp
   implicit none
   private

   public :: wave_t, lattice_waves, fastest_rates, growth, stable_cfl

   real(dp), parameter :: tolerance = 1.0e-5_dp   !! growth of a step that is nobody's
   real(dp), parameter :: highest_cfl = 10.0_dp   !! looked for

   !> What the lattice's sums make of a wave.
   type :: wave_t
      real(dp) :: sound(2)     !! S
      real(dp) :: viscous(3)   !! M: xx, xy, yy
      real(dp) :: diffusive    !! D
   end type wave_t

contains

   !> The waves of a lattice: an eighth of all wave vectors, the rest follow by symmetry.
   pure function lattice_waves(ratio, n) result(waves)
      real(dp), intent(in) :: ratio   !! h/dx
      integer, intent(in) :: n        !! wave numbers up to that of 2 dx, along an axis
      type(wave_t) :: waves(n*(n + 3)/2)
      real(dp), parameter :: pi = acos(-1.0_dp)
      integer :: i, j, k

      k = 0
      do i = 1, n
         do j = 0, i
            k = k + 1
            waves(k) = lattice_wave(ratio, pi/n*[i, j])
         end do
      end do
   end function lattice_waves

   pure type(wave_t) function lattice_wave(ratio, k) result(wave)
      real(dp), intent(in) :: ratio
      real(dp), intent(in) :: k(2)   !! times dx
      type(kernel_t) :: kernel
      real(dp) :: f, r(2), versine, inverse_l
      integer :: i, j, n

      kernel = new_kernel(ratio)
      n = ceiling(2*ratio)
      wave = wave_t(0.0_dp, 0.0_dp, 0.0_dp)
      inverse_l = 0
      do j = -n, n
         do i = -n, n
            if (i == 0 .and. j == 0) cycle
            r = [real(i, dp), real(j, dp)]
            f = kernel_gradient(kernel, norm2(r))
            versine = 2*sin(dot_product(k, r)/2)**2
            wave%sound = wave%sound + ratio*sin(dot_product(k, r))*f*r
            wave%viscous = wave%viscous + ratio**2*versine*f/dot_product(r, r)*[r(1)**2, r(1)*r(2), r(2)**2]
            wave%diffusive = wave%diffusive + 2*ratio**2*versine*f
            inverse_l = inverse_l + r(1)**2*f
         end do
      end do
      wave%diffusive = wave%diffusive - sum(wave%sound**2)/inverse_l
   end function lattice_wave

   !> Largest rates over all waves in units of c0/h: of sound, of density diffusion over delta, of viscosity over alpha.
   pure function fastest_rates(waves) result(rates)
      type(wave_t), intent(in) :: waves(:)
      real(dp) :: rates(3)

      associate (xx => waves%viscous(1), xy => waves%viscous(2), yy => waves%viscous(3))
         rates(1) = sqrt(maxval(waves%sound(1)**2 + waves%sound(2)**2))
         rates(2) = maxval(waves%diffusive)
         rates(3) = maxval((xx + yy)/2 + sqrt(((xx - yy)/2)**2 + xy**2))
      end associate
   end function fastest_rates

   !> Factor by which the wave that grows fastest grows in a step; 1 if none does.
   pure real(dp) function growth(waves, integrator, frozen, delta, alpha, cfl)
      type(wave_t), intent(in) :: waves(:)
      type(integrator_t), intent(in) :: integrator
      logical, intent(in) :: frozen             !! diffusive terms are held over the step
      real(dp), intent(in) :: delta, alpha, cfl
      integer :: k

      growth = 1
      do k = 1, size(waves)
         growth = max(growth, spectral_radius(step_matrix(waves(k), integrator, frozen, delta, alpha, cfl)))
      end do
   end function growth

   !> Courant number dt c0/h from which on some wave grows.
   pure real(dp) function stable_cfl(waves, integrator, frozen, delta, alpha) result(stable)
      type(wave_t), intent(in) :: waves(:)
      type(integrator_t), intent(in) :: integrator
      logical, intent(in) :: frozen
      real(dp), intent(in) :: delta, alpha
      real(dp) :: cfl, beyond
      integer :: bisection

      ! Upwards, because beyond the limit there may be islands of stability.
      stable = 0
      do
         beyond = stable + max(0.01_dp, stable/50)
         if (beyond > highest_cfl) return
         if (growth(waves, integrator, frozen, delta, alpha, beyond) > 1 + tolerance) exit
         stable = beyond
      end do
      do bisection = 1, 10
         cfl = (stable + beyond)/2
         if (growth(waves, integrator, frozen, delta, alpha, cfl) > 1 + tolerance) then
            beyond = cfl
         else
            stable = cfl
         end if
      end do
   end function stable_cfl

   ! What a step makes of (w, s): the scheme applied to the unit matrix.
   pure function step_matrix(wave, integrator, frozen, delta, alpha, cfl) result(step)
      type(wave_t), intent(in) :: wave
      type(integrator_t), intent(in) :: integrator
      logical, intent(in) :: frozen
      real(dp), intent(in) :: delta, alpha, cfl
      real(dp), dimension(3, 3) :: step, unit, a, b, rates, stage
      integer :: k

      a = 0
      a(1:2, 3) = -cfl*wave%sound
      a(3, 1:2) = cfl*wave%sound
      b = 0
      b(1, 1:2) = -cfl*alpha*wave%viscous(1:2)
      b(2, 1:2) = -cfl*alpha*wave%viscous(2:3)
      b(3, 3) = -cfl*delta*wave%diffusive
      unit = reshape([1, 0, 0, 0, 1, 0, 0, 0, 1], [3, 3])
      step = unit
      stage = unit
      do k = 1, integrator%stages
         rates = matmul(a, stage) + b
         if (.not. frozen) rates = matmul(a + b, stage)
         step = step + integrator%weight(k)*rates
         stage = unit + integrator%ahead(k)*rates
      end do
   end function step_matrix

   ! |G**n|**(1/n) of n = 2**20: off by less than 1e-6.
   pure real(dp) function spectral_radius(matrix) result(radius)
      real(dp), intent(in) :: matrix(3, 3)
      integer, parameter :: squarings = 20
      real(dp) :: power(3, 3), size_, logarithm
      integer :: k

      power = matrix
      logarithm = 0
      do k = 0, squarings
         size_ = maxval(abs(power))
         if (.not. size_ > 0) then
            radius = 0
            return
         end if
         logarithm = logarithm + log(size_)/2.0_dp**k
         power = power/size_
         if (k < squarings) power = matmul(power, power)
      end do
      radius = exp(logarithm)
   end function spectral_radius

end module von_neumann
