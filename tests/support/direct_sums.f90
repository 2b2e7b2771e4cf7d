!> The sums over neighbours of eqs. 5-7, written as they are printed and taken over all pairs.
module direct_sums
   use kinds, only: dp
   use model, only: model_t
   use patches, only: points_t
   implicit none
   private

   public :: direct_t, sum_directly, diffuse_directly

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

   !> delta h c0 sum_j D_ij.grad W V_j with D_ij of eq. 6, of the own particles.
   pure function diffuse_directly(model, points, n, gradients) result(rate)
      type(model_t), intent(in) :: model
      type(points_t), intent(in) :: points       !! images included
      integer, intent(in) :: n                   !! own particles
      real(dp), intent(in) :: gradients(:, :)    !! (2, all points) G
      real(dp) :: rate(n), r_ji(2), d_ij(2)
      integer :: i, j

      rate = 0
      do i = 1, n
         do j = 1, size(points%x)
            r_ji = [points%x(j) - points%x(i), points%y(j) - points%y(i)]
            if (j == i .or. norm2(r_ji) >= 2*model%kernel%h) cycle
            d_ij = 2*((points%s(j) - points%s(i)) - dot_product(gradients(:, i) + gradients(:, j), r_ji)/2) &
                   *r_ji/dot_product(r_ji, r_ji)
            rate(i) = rate(i) + model%delta*model%kernel%h*model%c0*dot_product(d_ij, gradient(model, points, i, j))
         end do
      end do
   end function diffuse_directly

end module direct_sums
