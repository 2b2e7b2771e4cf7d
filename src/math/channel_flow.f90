!> Start-up of plane flow between two walls that the fluid sticks to: Couette and Poiseuille flow.
!!
!! Source: Morris, Fox & Zhu, J. Comput. Phys. 136 (1997), eqs. 21 and 23; Fourier series of du/dt = f + nu d2u/dy2, u = 0 at t = 0,
!! with the walls' speeds U_b at y = 0 and U_t at y = H:
!!
!!     u = U_b + (U_t - U_b) y/H + f y (H - y)/(2 nu) - sum_n b_n sin(n pi y/H) exp(-nu (n pi/H)**2 t)
!!     b_n = 2/(n pi) (U_b - (-1)**n U_t) + 4 f H**2/(nu (n pi)**3) for odd n, without the second part for even n
module channel_flow
   use kinds, only: dp
   implicit none
   private

   public :: channel_t

   real(dp), parameter :: pi = acos(-1.0_dp)

   !> A channel along x, from y = 0 to its height.
   type :: channel_t
      real(dp) :: height = 1                     !! H
      real(dp) :: bottom_speed = 0, top_speed = 0
      real(dp) :: acceleration = 0               !! f, along the channel
      real(dp) :: viscosity = 1                  !! kinematic, nu > 0
   contains
      procedure :: velocity
      procedure :: steady_velocity
      procedure :: steady_mode
      procedure :: mode
      procedure :: rate
      procedure :: fastest
   end type channel_t

contains

   !> Velocity along x at a distance from the lower wall.
   elemental real(dp) function velocity(self, y, time) result(u)
      class(channel_t), intent(in) :: self
      real(dp), intent(in) :: y, time
      integer, parameter :: most_terms = 20000
      real(dp), parameter :: negligible = 40   ! exp(-40) < 1e-17
      real(dp) :: damping
      integer :: n

      u = 0
      if (.not. time > 0) return
      u = self%steady_velocity(y)
      do n = 1, most_terms
         damping = self%rate(n)*time
         if (damping > negligible) exit
         u = u - self%steady_mode(n)*sin(n*pi*y/self%height)*exp(-damping)
      end do
   end function velocity

   !> Velocity that is left in the end.
   elemental real(dp) function steady_velocity(self, y) result(u)
      class(channel_t), intent(in) :: self
      real(dp), intent(in) :: y

      u = self%bottom_speed + (self%top_speed - self%bottom_speed)*y/self%height &
          + self%acceleration*y*(self%height - y)/(2*self%viscosity)
   end function steady_velocity

   !> b_n, coefficient of sin(n pi y/H) in the steady velocity.
   elemental real(dp) function steady_mode(self, n) result(b)
      class(channel_t), intent(in) :: self
      integer, intent(in) :: n

      b = 2/(n*pi)*(self%bottom_speed - merge(1, -1, mod(n, 2) == 0)*self%top_speed)
      if (mod(n, 2) == 1) b = b + 4*self%acceleration*self%height**2/(self%viscosity*(n*pi)**3)
   end function steady_mode

   !> Coefficient of sin(pi y/H), the slowest mode, at a time.
   elemental real(dp) function mode(self, time) result(b)
      class(channel_t), intent(in) :: self
      real(dp), intent(in) :: time

      b = self%steady_mode(1)*(1 - exp(-self%rate(1)*time))
   end function mode

   !> nu (n pi/H)**2, at which mode n approaches its steady value.
   elemental real(dp) function rate(self, n)
      class(channel_t), intent(in) :: self
      integer, intent(in) :: n

      rate = self%viscosity*(n*pi/self%height)**2
   end function rate

   !> Largest speed of the steady flow, walls included.
   elemental real(dp) function fastest(self) result(speed)
      class(channel_t), intent(in) :: self
      integer, parameter :: n = 200
      integer :: i

      speed = 0
      do i = 0, n
         speed = max(speed, abs(self%steady_velocity(self%height*i/n)))
      end do
   end function fastest

end module channel_flow
