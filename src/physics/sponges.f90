!> Sponge layers: boxes in which the fluid is slowed down, more and more towards one side, so that waves end there.
!!
!! Source: ours: du/dt = -rate s**2 u, s from 0 at the layer's beginning to 1 at its end.
module sponges
   use kinds, only: dp
   implicit none
   private

   public :: sponge_t

   !> A layer.
   type :: sponge_t
      real(dp) :: lower(2) = 0            !! [m]
      real(dp) :: upper(2) = 0            !! [m]
      real(dp) :: rate = 0                !! at its end [1/s]
      logical :: ends_left = .false.      !! it ends at its left side, not at its right
   contains
      procedure :: rate_at
   end type sponge_t

contains

   !> rate s**2 at a place, 0 outside [1/s].
   elemental real(dp) function rate_at(self, x, y)
      class(sponge_t), intent(in) :: self
      real(dp), intent(in) :: x, y   !! [m]
      real(dp) :: s

      rate_at = 0
      if (x < self%lower(1) .or. x > self%upper(1) .or. y < self%lower(2) .or. y > self%upper(2)) return
      s = (x - self%lower(1))/(self%upper(1) - self%lower(1))
      if (self%ends_left) s = 1 - s
      rate_at = self%rate*s**2
   end function rate_at

end module sponges
