!> Free bodies: what is heavy, springs and dampers, and how forces move them.
!!
!! Source: Newton's and Euler's laws (docs/equations.md, Free bodies). Vectors of three: x, y and angle.
module rigid_bodies
   use kinds, only: dp
   use motions, only: pose_t
   implicit none
   private

   public :: rigid_body_t, way_of, rate_of, acceleration_of, pose_from, coasting

   !> A body that forces move, per unit width; its pivot is its centre of mass. Springs pull it to where it is drawn.
   type :: rigid_body_t
      logical :: moves(3) = .false.      !! along x, along y, in its angle; what does not is held
      real(dp) :: mass = 1               !! [kg/m] > 0
      real(dp) :: inertia = 1            !! [kg m] > 0, about the centre of mass
      real(dp) :: stiffness(3) = 0       !! [N/m2, N/m2, N]
      real(dp) :: damping(3) = 0         !! [N s/m2, N s/m2, N s]
   contains
      procedure :: is_free
      procedure :: masses
      procedure :: pull_back
      procedure :: damped_power
      procedure :: energy => energy_of
   end type rigid_body_t

contains

   !> Whether forces move it at all.
   elemental logical function is_free(self)
      class(rigid_body_t), intent(in) :: self

      is_free = self%moves(1) .or. self%moves(2) .or. self%moves(3)
   end function is_free

   !> What resists acceleration [kg/m, kg/m, kg m].
   pure function masses(self)
      class(rigid_body_t), intent(in) :: self
      real(dp) :: masses(3)

      masses = [self%mass, self%mass, self%inertia]
   end function masses

   !> Force and moment of springs and dampers [N/m, N/m, N].
   pure function pull_back(self, pose) result(force)
      class(rigid_body_t), intent(in) :: self
      type(pose_t), intent(in) :: pose
      real(dp) :: force(3)

      force = -self%stiffness*way_of(pose) - self%damping*rate_of(pose)
   end function pull_back

   !> Power that dampers take, >= 0 [W/m].
   pure real(dp) function damped_power(self, pose)
      class(rigid_body_t), intent(in) :: self
      type(pose_t), intent(in) :: pose

      damped_power = sum(self%damping*rate_of(pose)**2)
   end function damped_power

   !> Kinetic energy, that of springs, and that in gravity above y = 0 [J/m].
   pure real(dp) function energy_of(self, pose, pivot, gravity) result(energy)
      class(rigid_body_t), intent(in) :: self
      type(pose_t), intent(in) :: pose
      real(dp), intent(in) :: pivot(2)   !! as drawn [m]
      real(dp), intent(in) :: gravity    !! along -y [m/s2]

      energy = sum(self%masses()*rate_of(pose)**2 + self%stiffness*way_of(pose)**2)/2 &
               + self%mass*gravity*(pivot(2) + pose%shift(2))
   end function energy_of

   !> How far it is from where it is drawn [m, m, rad].
   pure function way_of(pose) result(way)
      type(pose_t), intent(in) :: pose
      real(dp) :: way(3)

      way = [pose%shift, pose%angle]
   end function way_of

   !> [m/s, m/s, rad/s]
   pure function rate_of(pose) result(rate)
      type(pose_t), intent(in) :: pose
      real(dp) :: rate(3)

      rate = [pose%velocity, pose%spin]
   end function rate_of

   !> [m/s2, m/s2, rad/s2]
   pure function acceleration_of(pose) result(acceleration)
      type(pose_t), intent(in) :: pose
      real(dp) :: acceleration(3)

      acceleration = [pose%acceleration, pose%spin_rate]
   end function acceleration_of

   !> The pose of these.
   pure type(pose_t) function pose_from(way, rate, acceleration) result(pose)
      real(dp), intent(in) :: way(3), rate(3), acceleration(3)

      pose = pose_t(way(:2), way(3), rate(:2), rate(3), acceleration(:2), acceleration(3))
   end function pose_from

   !> Where it is some time later if nothing accelerates it.
   pure type(pose_t) function coasting(pose, time) result(later)
      type(pose_t), intent(in) :: pose
      real(dp), intent(in) :: time   !! [s]

      later%shift = pose%shift + time*pose%velocity
      later%angle = pose%angle + time*pose%spin
      later%velocity = pose%velocity
      later%spin = pose%spin
   end function coasting

end module rigid_bodies
