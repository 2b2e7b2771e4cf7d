!> Poses of rigid bodies, and prescribed motions.
module motions
   use kinds, only: dp
   use smooth_tables, only: smooth_table_t
   implicit none
   private

   public :: pose_t, motion_t, move_point, turn

   integer, parameter, public :: at_rest = 0, uniform = 1, oscillating = 2, tabulated = 3, free = 4   !! kinds

   real(dp), parameter :: pi = acos(-1.0_dp)

   !> Where a rigid body is and how it moves: relative to where it is drawn, about its pivot.
   type :: pose_t
      real(dp) :: shift(2) = 0          !! [m]
      real(dp) :: angle = 0             !! [rad] counter-clockwise
      real(dp) :: velocity(2) = 0       !! [m/s] of the pivot
      real(dp) :: spin = 0              !! [rad/s]
      real(dp) :: acceleration(2) = 0   !! [m/s2] of the pivot
      real(dp) :: spin_rate = 0         !! [rad/s2]
   end type pose_t

   !> How a body moves; what its kind does not use does not matter. A free body is moved by forces: how it is at t = 0.
   !!
   !! Oscillating: amplitude and swing times R(t) sin(2 pi t/period + phase), where R rises from 0 at t = 0 to 1 with two
   !! continuous derivatives, or is 1.
   type :: motion_t
      integer :: kind = at_rest
      real(dp) :: velocity(2) = 0     !! uniform; free, at t = 0 [m/s]
      real(dp) :: spin = 0            !! uniform; free, at t = 0 [rad/s]
      real(dp) :: amplitude(2) = 0    !! oscillating [m]
      real(dp) :: swing = 0           !! oscillating [rad]
      real(dp) :: period = 1          !! oscillating, > 0 [s]
      real(dp) :: phase = 0           !! oscillating [rad]
      real(dp) :: ramp = 0            !! oscillating: how long R rises; 0: R = 1 [s]
      type(smooth_table_t) :: table   !! tabulated: x, y and angle [m, m, rad]
   contains
      procedure :: at => pose_at
      procedure :: moves
      procedure :: turns
      procedure :: largest_acceleration
      procedure :: largest_speed
   end type motion_t

contains

   !> Pose at a time, with derivatives of exactly that motion; of a free body, that at t = 0.
   elemental type(pose_t) function pose_at(self, time) result(pose)
      class(motion_t), intent(in) :: self
      real(dp), intent(in) :: time   !! [s]
      real(dp) :: value(3), slope(3), curvature(3), wave(0:2)

      select case (self%kind)
      case (uniform)
         pose%shift = self%velocity*time
         pose%angle = self%spin*time
         pose%velocity = self%velocity
         pose%spin = self%spin
      case (free)
         pose%velocity = self%velocity
         pose%spin = self%spin
      case (oscillating)
         wave = oscillation(self, time)
         pose%shift = self%amplitude*wave(0)
         pose%angle = self%swing*wave(0)
         pose%velocity = self%amplitude*wave(1)
         pose%spin = self%swing*wave(1)
         pose%acceleration = self%amplitude*wave(2)
         pose%spin_rate = self%swing*wave(2)
      case (tabulated)
         call self%table%look_up(time, value, slope, curvature)
         pose = pose_t(value(:2), value(3), slope(:2), slope(3), curvature(:2), curvature(3))
      end select
   end function pose_at

   !> Whether the body ever moves.
   pure logical function moves(self)
      class(motion_t), intent(in) :: self
      real(dp) :: speed, spin

      call bound_rates(self, speed, spin)
      moves = self%kind == free .or. speed > 0 .or. spin > 0
   end function moves

   !> Whether its angle ever changes.
   pure logical function turns(self)
      class(motion_t), intent(in) :: self
      real(dp) :: speed, spin

      call bound_rates(self, speed, spin)
      turns = self%kind == free .or. spin > 0
   end function turns

   !> Bound of the speed of any point of the body, at any time; of a free one, at t = 0 [m/s].
   pure real(dp) function largest_speed(self, radius)
      class(motion_t), intent(in) :: self
      real(dp), intent(in) :: radius   !! of the body about its pivot [m]
      real(dp) :: speed, spin

      call bound_rates(self, speed, spin)
      largest_speed = speed + radius*spin
   end function largest_speed

   !> Bound of the magnitude of the acceleration of any point of the body, at any time; 0 of a free one [m/s2].
   pure real(dp) function largest_acceleration(self, radius) result(bound)
      class(motion_t), intent(in) :: self
      real(dp), intent(in) :: radius   !! of the body about its pivot [m]
      real(dp) :: speed, spin, rates(2), curvatures(3)

      call bound_rates(self, speed, spin)
      bound = 0
      if (self%kind /= free) bound = radius*spin**2
      select case (self%kind)
      case (oscillating)
         rates = largest_rates(self)
         bound = bound + (norm2(self%amplitude) + radius*abs(self%swing))*rates(2)
      case (tabulated)
         curvatures = self%table%largest_curvature()
         bound = bound + norm2(curvatures(:2)) + radius*curvatures(3)
      end select
   end function largest_acceleration

   !> Where a point of the body is, and how it moves.
   pure subroutine move_point(pose, pivot, drawn, place, velocity, acceleration)
      type(pose_t), intent(in) :: pose
      real(dp), intent(in) :: pivot(2)           !! as drawn [m]
      real(dp), intent(in) :: drawn(2)           !! where the point is drawn [m]
      real(dp), intent(out) :: place(2)          !! [m]
      real(dp), intent(out) :: velocity(2)       !! [m/s]
      real(dp), intent(out) :: acceleration(2)   !! [m/s2]
      real(dp) :: arm(2), across(2)

      arm = turn(pose%angle, drawn - pivot)
      across = [-arm(2), arm(1)]
      ! From where it is drawn, so that a body at rest stays there exactly.
      place = drawn + (pose%shift + (arm - (drawn - pivot)))
      velocity = pose%velocity + pose%spin*across
      acceleration = pose%acceleration + pose%spin_rate*across - pose%spin**2*arm
   end subroutine move_point

   !> A vector turned counter-clockwise.
   pure function turn(angle, vector) result(turned)
      real(dp), intent(in) :: angle       !! [rad]
      real(dp), intent(in) :: vector(2)
      real(dp) :: turned(2)

      turned(1) = cos(angle)*vector(1) - sin(angle)*vector(2)
      turned(2) = sin(angle)*vector(1) + cos(angle)*vector(2)
   end function turn

   ! R(t) sin(2 pi t/period + phase) and its first two derivatives.
   pure function oscillation(motion, time) result(wave)
      class(motion_t), intent(in) :: motion
      real(dp), intent(in) :: time
      real(dp) :: wave(0:2), rise(0:2), swing(0:2), frequency, s

      frequency = 2*pi/motion%period
      swing(0) = sin(frequency*time + motion%phase)
      swing(1) = frequency*cos(frequency*time + motion%phase)
      swing(2) = -frequency**2*swing(0)
      rise = [1, 0, 0]
      if (motion%ramp > 0) then
         s = min(1.0_dp, max(0.0_dp, time/motion%ramp))
         rise(0) = s**3*(10 - 15*s + 6*s**2)
         rise(1) = 30*s**2*(1 - s)**2/motion%ramp
         rise(2) = 60*s*(1 - s)*(1 - 2*s)/motion%ramp**2
      end if
      wave(0) = rise(0)*swing(0)
      wave(1) = rise(1)*swing(0) + rise(0)*swing(1)
      wave(2) = rise(2)*swing(0) + 2*rise(1)*swing(1) + rise(0)*swing(2)
   end function oscillation

   ! Bounds of the magnitudes of those derivatives.
   pure function largest_rates(motion) result(rates)
      class(motion_t), intent(in) :: motion
      real(dp) :: rates(2), frequency, rise(2)

      frequency = 2*pi/abs(motion%period)
      rise = 0
      ! R' is largest in the middle of the ramp, R'' at (1 - 1/sqrt(3))/2 of it.
      if (motion%ramp > 0) rise = [1.875_dp/motion%ramp, 10/(sqrt(3.0_dp)*motion%ramp**2)]
      rates(1) = rise(1) + frequency
      rates(2) = rise(2) + 2*rise(1)*frequency + frequency**2
   end function largest_rates

   ! Bounds of the magnitudes of the pivot's velocity and of the spin.
   pure subroutine bound_rates(motion, speed, spin)
      class(motion_t), intent(in) :: motion
      real(dp), intent(out) :: speed, spin
      real(dp) :: rates(2), slopes(3)

      speed = 0
      spin = 0
      select case (motion%kind)
      case (uniform, free)
         speed = norm2(motion%velocity)
         spin = abs(motion%spin)
      case (oscillating)
         rates = largest_rates(motion)
         speed = norm2(motion%amplitude)*rates(1)
         spin = abs(motion%swing)*rates(1)
      case (tabulated)
         slopes = motion%table%largest_slope()
         speed = norm2(slopes(:2))
         spin = slopes(3)
      end select
   end subroutine bound_rates

end module motions
