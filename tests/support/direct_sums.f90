!> The sums over neighbours of eqs. 5-7, written as they are printed and taken over all pairs.
module direct_sums
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
   use kinds, only: dp
   use model, only: model_t
   use patches, only: points_t
   implicit none
   private

   public :: direct_t, sum_directly, diffuse_directly, gradients_directly, strain_directly, viscosity_directly, lose_directly
   public :: deviation

   real(dp), parameter :: pi = acos(-1.0_dp)

   !> Sums of the own particles 1..n over own particles and images.
   type :: direct_t
      real(dp), allocatable :: divergence(:)    !! (n) sum_j u_ji.grad W V_j
      real(dp), allocatable :: force(:, :)      !! (2, n) sum_j (s_i + s_j) grad W V_j
      real(dp), allocatable :: matrix(:, :, :)  !! (2, 2, n) sum_j r_ji (x) grad W V_j
      real(dp), allocatable :: density(:, :)    !! (2, n) sum_j (s_j - s_i) grad W V_j
      real(dp), allocatable :: kernel(:, :)     !! (2, n) sum_j grad W V_j
      real(dp), allocatable :: viscous(:, :)    !! (2, n) sum_j pi_ij grad W V_j
      real(dp), allocatable :: largest_pi(:)    !! (n) max_j |pi_ij|, own images left out
   end type direct_t

contains

   !> grad_i W_ij V_j, from the derivative of W; 0 where i = j.
   pure function gradient(model, points, i, j) result(grad)
      type(model_t), intent(in) :: model
      type(points_t), intent(in) :: points
      integer, intent(in) :: i, j
      real(dp) :: grad(2), r_ji(2), q, derivative

      grad = 0
      r_ji = [points%x(j) - points%x(i), points%y(j) - points%y(i)]
      associate (h => model%kernel%h, r => norm2(r_ji))
         q = r/h
         if (q >= 2 .or. .not. q > 0) return
         ! of 7/(4 pi h**2) (1 - q/2)**4 (1 + 2q) by q
         derivative = 7/(4*pi*h**2)*(2*(1 - q/2)**4 - 2*(1 - q/2)**3*(1 + 2*q))
         grad = -derivative/h*r_ji/r*points%w(j)
      end associate
   end function gradient

   !> Everything that needs no density gradient of a neighbour.
   pure type(direct_t) function sum_directly(model, points, n) result(sums)
      type(model_t), intent(in) :: model
      type(points_t), intent(in) :: points   !! images included
      integer, intent(in) :: n               !! own particles
      real(dp) :: grad(2), r_ji(2), u_ji(2), pi_ij
      integer :: i, j

      allocate (sums%divergence(n), sums%force(2, n), sums%matrix(2, 2, n), sums%density(2, n), sums%kernel(2, n), &
                sums%viscous(2, n), sums%largest_pi(n))
      sums%divergence = 0
      sums%force = 0
      sums%matrix = 0
      sums%density = 0
      sums%kernel = 0
      sums%viscous = 0
      sums%largest_pi = 0
      do i = 1, n
         do j = 1, size(points%x)
            r_ji = [points%x(j) - points%x(i), points%y(j) - points%y(i)]
            if (j == i .or. norm2(r_ji) >= 2*model%kernel%h) cycle
            grad = gradient(model, points, i, j)
            u_ji = [points%u(j) - points%u(i), points%v(j) - points%v(i)]
            pi_ij = dot_product(u_ji, r_ji)/dot_product(r_ji, r_ji)
            sums%divergence(i) = sums%divergence(i) + dot_product(u_ji, grad)
            sums%force(:, i) = sums%force(:, i) + (points%s(i) + points%s(j))*grad
            sums%matrix(:, 1, i) = sums%matrix(:, 1, i) + r_ji*grad(1)
            sums%matrix(:, 2, i) = sums%matrix(:, 2, i) + r_ji*grad(2)
            sums%density(:, i) = sums%density(:, i) + (points%s(j) - points%s(i))*grad
            sums%kernel(:, i) = sums%kernel(:, i) + grad
            sums%viscous(:, i) = sums%viscous(:, i) + pi_ij*grad
            if (points%owner(j) /= points%owner(i)) sums%largest_pi(i) = max(sums%largest_pi(i), abs(pi_ij))
         end do
      end do
   end function sum_directly

   !> L of the own particle i.
   pure function renormalisation(direct, i) result(l)
      type(direct_t), intent(in) :: direct
      integer, intent(in) :: i
      real(dp) :: l(2, 2)

      associate (m => direct%matrix(:, :, i))
         l(1, :) = [m(2, 2), -m(1, 2)]
         l(2, :) = [-m(2, 1), m(1, 1)]
         l = l/(m(1, 1)*m(2, 2) - m(1, 2)*m(2, 1))
      end associate
   end function renormalisation

   !> G of all points, eq. 6: of the images by the continuation of a linear hydrostatic field.
   pure function gradients_directly(direct, points, slope) result(gradients)
      type(direct_t), intent(in) :: direct
      type(points_t), intent(in) :: points   !! images included
      real(dp), intent(in) :: slope(2)       !! hydrostatic
      real(dp) :: gradients(2, size(points%x))
      integer :: i

      do i = 1, size(points%x)
         associate (own => points%owner(i), s => [points%sign_x(i), points%sign_y(i)])
            gradients(:, i) = s*matmul(renormalisation(direct, own), direct%density(:, own)) + (1 - s)*slope
         end associate
      end do
   end function gradients_directly

   !> ||D|| of the own particles, eqs. 22 and 23: D = 1/2 sum_j [u_ji (x) L grad W + L grad W (x) u_ji] V_j.
   pure function strain_directly(model, points, direct) result(norm)
      type(model_t), intent(in) :: model
      type(points_t), intent(in) :: points   !! images included, with the velocities that viscosity sees
      type(direct_t), intent(in) :: direct
      real(dp) :: norm(size(direct%divergence)), d(2, 2), l(2, 2), u_ji(2), grad(2)
      integer :: i, j, k

      do i = 1, size(norm)
         l = renormalisation(direct, i)
         d = 0
         do j = 1, size(points%x)
            u_ji = [points%u(j) - points%u(i), points%v(j) - points%v(i)]
            grad = matmul(l, gradient(model, points, i, j))
            do k = 1, 2
               d(:, k) = d(:, k) + (u_ji*grad(k) + grad*u_ji(k))/2
            end do
         end do
         norm(i) = sqrt(2*sum(d**2))
      end do
   end function strain_directly

   !> The harmonic mean, 0 where one is 0.
   elemental real(dp) function mean(a, b)
      real(dp), intent(in) :: a, b

      mean = 0
      if (a > 0 .and. b > 0) mean = 2*a*b/(a + b)
   end function mean

   !> (rho0/rho_i) h c0 sum_j alpha_ij pi_ij grad W V_j, eq. 5 with eq. 24, of the own particles.
   pure function viscosity_directly(model, points, n, alpha) result(acceleration)
      type(model_t), intent(in) :: model
      type(points_t), intent(in) :: points       !! images included, with the velocities that viscosity sees
      integer, intent(in) :: n                   !! own particles
      real(dp), intent(in) :: alpha(:)           !! (n) alpha_i
      real(dp) :: acceleration(2, n), r_ji(2), pi_ij
      integer :: i, j

      acceleration = 0
      do i = 1, n
         do j = 1, size(points%x)
            r_ji = [points%x(j) - points%x(i), points%y(j) - points%y(i)]
            if (j == i .or. norm2(r_ji) >= 2*model%kernel%h) cycle
            pi_ij = ((points%u(j) - points%u(i))*r_ji(1) + (points%v(j) - points%v(i))*r_ji(2))/sum(r_ji**2)
            acceleration(:, i) = acceleration(:, i) + model%rho0/(model%rho0 + points%s(i))*model%kernel%h*model%c0 &
                                 *(model%alpha + mean(alpha(i), alpha(points%owner(j))))*pi_ij*gradient(model, points, i, j)
         end do
      end do
   end function viscosity_directly

   !> h c0 sum_j delta_ij D_ij.grad W V_j with D_ij of eq. 6, of the own particles.
   pure function diffuse_directly(model, points, n, gradients, delta) result(rate)
      type(model_t), intent(in) :: model
      type(points_t), intent(in) :: points       !! images included
      integer, intent(in) :: n                   !! own particles
      real(dp), intent(in) :: gradients(:, :)    !! (2, all points) G
      real(dp), intent(in), optional :: delta(:) !! (n) delta_i; without, the model's delta
      real(dp) :: rate(n), r_ji(2), d_ij(2), delta_ij
      integer :: i, j

      rate = 0
      delta_ij = model%delta
      do i = 1, n
         do j = 1, size(points%x)
            r_ji = [points%x(j) - points%x(i), points%y(j) - points%y(i)]
            if (j == i .or. norm2(r_ji) >= 2*model%kernel%h) cycle
            if (present(delta)) delta_ij = mean(delta(i), delta(points%owner(j)))
            d_ij = 2*((points%s(j) - points%s(i)) - dot_product(gradients(:, i) + gradients(:, j), r_ji)/2) &
                   *r_ji/dot_product(r_ji, r_ji)
            rate(i) = rate(i) + delta_ij*model%kernel%h*model%c0*dot_product(d_ij, gradient(model, points, i, j))
         end do
      end do
   end function diffuse_directly

   !> The power that the own particles dissipate: eqs. 12 and 13, each pair's given to its two particles in halves.
   pure function lose_directly(model, points, n, gradients, alpha, delta) result(power)
      type(model_t), intent(in) :: model
      type(points_t), intent(in) :: points          !! images included
      integer, intent(in) :: n                      !! own particles
      real(dp), intent(in) :: gradients(:, :)       !! (2, all points) G
      real(dp), intent(in) :: alpha(:), delta(:)    !! (n) alpha_i, besides the model's alpha, and delta_i
      real(dp) :: power(n), r_ji(2), u_ji(2), grad(2), d_ij(2), pi_ij, p_by_rho(2)
      integer :: i, j

      power = 0
      do i = 1, n
         do j = 1, size(points%x)
            r_ji = [points%x(j) - points%x(i), points%y(j) - points%y(i)]
            if (j == i .or. norm2(r_ji) >= 2*model%kernel%h) cycle
            grad = gradient(model, points, i, j)*points%w(i)/2
            u_ji = [points%u(j) - points%u(i), points%v(j) - points%v(i)]
            pi_ij = dot_product(u_ji, r_ji)/sum(r_ji**2)
            d_ij = 2*((points%s(j) - points%s(i)) - dot_product(gradients(:, i) + gradients(:, j), r_ji)/2)*r_ji/sum(r_ji**2)
            p_by_rho = model%c0**2*points%s([i, j])/(model%rho0 + points%s([i, j]))
            power(i) = power(i) + model%kernel%h*model%c0*( &
                       model%rho0*(model%alpha + mean(alpha(i), alpha(points%owner(j))))*pi_ij*dot_product(u_ji, grad) &
                       + mean(delta(i), delta(points%owner(j)))*(p_by_rho(2) - p_by_rho(1))*dot_product(d_ij, grad))
         end do
      end do
   end function lose_directly

   !> Largest difference relative to the largest expected value.
   pure real(dp) function deviation(expected, actual)
      real(dp), intent(in) :: expected(:), actual(:)

      deviation = huge(1.0_dp)
      if (any(ieee_is_nan(actual))) return   ! maxval passes over them
      deviation = maxval(abs(actual - expected))/maxval(abs(expected))
   end function deviation

end module direct_sums
