!> A drop that oscillates in a central field of force.
!!
!! Source: Monaghan & Rafiee, Int. J. Numer. Methods Fluids 71 (2013); Antuono et al., CMAME 289 (2015). The field -w**2 r acts
!! on an incompressible ellipse with semi-axes a, b and the velocity A (x, -y). It stays an ellipse:
!!
!!     dA/dt = (A**2 + w**2) (b**2 - a**2)/(b**2 + a**2),   da/dt = A a,   db/dt = -A b,   a b = R**2
!!     p = rho (A**2 + w**2) a**2 b**2/(a**2 + b**2) (1 - x**2/a**2 - y**2/b**2)
!!
!! Energy keeps (A**2 + w**2) (a**2 + b**2) constant; hence a + b of the turning point, where A = 0.
module oscillating_drop
   use kinds, only: dp
   implicit none
   private

   public :: drop_t, new_drop

   real(dp), parameter :: longest_step = 2.0e-3_dp   ! times the fastest rate; RK4 is then good for 1e-10

   !> A drop and where it is in its oscillation.
   type :: drop_t
      real(dp) :: radius = 1          !! R of the disc at t = 0
      real(dp) :: rate = 1            !! w of the field
      real(dp) :: first_stretch = 0   !! A0
      real(dp) :: time = 0            !! that the three below belong to
      real(dp) :: a = 1, b = 1        !! semi-axes along x and y
      real(dp) :: stretch = 0         !! A
   contains
      procedure :: move_to
      procedure :: velocity
      procedure :: pressure
      procedure :: kinetic_energy
      procedure :: largest_axis
      procedure :: period
   end type drop_t

contains

   !> The disc at t = 0 with velocity A0 (x, -y).
   pure type(drop_t) function new_drop(radius, rate, stretch) result(self)
      real(dp), intent(in) :: radius    !! R
      real(dp), intent(in) :: rate      !! w
      real(dp), intent(in) :: stretch   !! A0

      self = drop_t(radius=radius, rate=rate, first_stretch=stretch, a=radius, b=radius, stretch=stretch)
   end function new_drop

   !> Integrates to a time, to 1e-10; from the start if that is past.
   pure subroutine move_to(self, time)
      class(drop_t), intent(inout) :: self
      real(dp), intent(in) :: time   !! >= 0
      integer :: n, k
      real(dp) :: dt

      if (time < self%time) then
         self%time = 0
         self%a = self%radius
         self%stretch = self%first_stretch
      end if
      n = ceiling((time - self%time)*fastest(self)/longest_step)
      if (n > 0) then
         dt = (time - self%time)/n
         do k = 1, n
            call step(self, dt)
         end do
      end if
      self%time = time
      self%b = self%radius**2/self%a
   end subroutine move_to

   ! Largest |A| and w.
   pure real(dp) function fastest(self)
      class(drop_t), intent(in) :: self

      fastest = max(self%rate, abs(self%first_stretch))
   end function fastest

   ! One step of RK4.
   pure subroutine step(self, dt)
      class(drop_t), intent(inout) :: self
      real(dp), intent(in) :: dt
      real(dp) :: state(2), k(2, 4)

      state = [self%a, self%stretch]
      k(:, 1) = rates(self, state)
      k(:, 2) = rates(self, state + dt/2*k(:, 1))
      k(:, 3) = rates(self, state + dt/2*k(:, 2))
      k(:, 4) = rates(self, state + dt*k(:, 3))
      state = state + dt/6*(k(:, 1) + 2*k(:, 2) + 2*k(:, 3) + k(:, 4))
      self%a = state(1)
      self%stretch = state(2)
   end subroutine step

   ! da/dt, dA/dt with b = R**2/a.
   pure function rates(self, state) result(rate)
      class(drop_t), intent(in) :: self
      real(dp), intent(in) :: state(2)   ! a, A
      real(dp) :: rate(2), squares(2)

      squares = [state(1)**2, (self%radius**2/state(1))**2]
      rate(1) = state(2)*state(1)
      rate(2) = (state(2)**2 + self%rate**2)*(squares(2) - squares(1))/(squares(2) + squares(1))
   end function rates

   !> Velocity at a place relative to the centre, at the drop's time.
   pure function velocity(self, x, y) result(u)
      class(drop_t), intent(in) :: self
      real(dp), intent(in) :: x, y
      real(dp) :: u(2)

      u = self%stretch*[x, -y]
   end function velocity

   !> p/rho at a place relative to the centre, at the drop's time.
   elemental real(dp) function pressure(self, x, y) result(p)
      class(drop_t), intent(in) :: self
      real(dp), intent(in) :: x, y

      associate (aa => self%a**2, bb => self%b**2)
         p = (self%stretch**2 + self%rate**2)*aa*bb/(aa + bb)*(1 - x**2/aa - y**2/bb)
      end associate
   end function pressure

   !> E_K/rho = pi R**2 A**2 (a**2 + b**2)/8 at the drop's time.
   pure real(dp) function kinetic_energy(self) result(energy)
      class(drop_t), intent(in) :: self
      real(dp), parameter :: pi = acos(-1.0_dp)

      energy = pi*self%radius**2*self%stretch**2*(self%a**2 + self%b**2)/8
   end function kinetic_energy

   !> Longer semi-axis at the turning point: a**2 + b**2 = 2 R**2 (1 + (A0/w)**2) there, a b = R**2.
   pure real(dp) function largest_axis(self) result(axis)
      class(drop_t), intent(in) :: self

      associate (half => 1 + (self%first_stretch/self%rate)**2)
         axis = self%radius*sqrt(half + sqrt(half**2 - 1))
      end associate
   end function largest_axis

   !> Time until everything repeats: four times from the disc to the turning point, where A = 0.
   pure real(dp) function period(self)
      class(drop_t), intent(in) :: self
      type(drop_t) :: drop
      real(dp) :: rate(2), dt
      integer :: k

      drop = new_drop(self%radius, self%rate, abs(self%first_stretch))
      dt = longest_step/fastest(self)
      do while (drop%stretch > 0)
         call step(drop, dt)
         drop%time = drop%time + dt
      end do
      ! Newton's method for the moment that A = 0
      do k = 1, 4
         rate = rates(drop, [drop%a, drop%stretch])
         dt = -drop%stretch/rate(2)
         call step(drop, dt)
         drop%time = drop%time + dt
      end do
      period = 4*drop%time
   end function period

end module oscillating_drop
