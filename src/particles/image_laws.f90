!> What an image has of its source: for each kind of image and each quantity, told here and nowhere else.
!!
!! Source: Colagrossi & Landrini 2003. A mirror image has its source's mass, volume, density and tangential velocity,
!! the opposite normal velocity (as a moving wall sees it), and stands at the mirrored position; near a corner there is a doubly
!! mirrored one too. Beyond a periodic side an image is its source, moved by the period. The gradient of density follows from
!! rho_G(r_G) = rho(r) + slope.(r_G - r): normal component -G_n + 2 slope_n, tangential one unchanged (docs/equations.md).
module image_laws
   use box, only: axis_of, box_t, no_slip_wall, opposite, periodic_side
   use kinds, only: dp
   implicit none
   private

   public :: law_t, image_of, as_position, as_velocity, as_gradient, as_slip, as_wall_velocity

   integer, parameter, public :: n_kinds = 8   !! of images
   !> The side across each axis that a kind of image is beyond; 0 for none. Sides, then corners.
   integer, parameter, public :: beyond(2, n_kinds) = reshape([1, 0, 2, 0, 0, 3, 0, 4, 1, 3, 2, 3, 1, 4, 2, 4], [2, n_kinds])

   !> An image of kind k has factor(k) times its source's value, and shift(k).
   type :: law_t
      real(dp) :: factor(n_kinds) = 1
      real(dp) :: shift(n_kinds) = 0
   end type law_t

   type(law_t), parameter, public :: as_scalar = law_t()   !! the source's own value

contains

   !> What an image has.
   elemental real(dp) function image_of(law, kind, value)
      type(law_t), intent(in) :: law
      integer, intent(in) :: kind
      real(dp), intent(in) :: value   !! the source's

      image_of = law%factor(kind)*value + law%shift(kind)
   end function image_of

   !> Of positions, along an axis.
   pure type(law_t) function as_position(box, axis) result(law)
      type(box_t), intent(in) :: box
      integer, intent(in) :: axis
      integer :: k

      law%factor = signs(box, axis)
      do k = 1, n_kinds
         associate (side => beyond(axis, k))
            if (side == 0) cycle
            if (box%kind(side) == periodic_side) then
               ! From the left side to beyond the right one, and so on.
               law%shift(k) = box%at(opposite(side)) - box%at(side)
            else
               law%shift(k) = 2*box%at(side)
            end if
         end associate
      end do
   end function as_position

   !> Of velocities, as all but the viscous terms see them.
   pure type(law_t) function as_velocity(box, axis) result(law)
      type(box_t), intent(in) :: box
      integer, intent(in) :: axis

      law%factor = signs(box, axis)
      law%shift = (1 - law%factor)*wall_velocity(box, axis, beyond(axis, :))
   end function as_velocity

   !> Of the gradient of density.
   pure type(law_t) function as_gradient(box, axis) result(law)
      type(box_t), intent(in) :: box
      integer, intent(in) :: axis

      law%factor = signs(box, axis)
      law%shift = (1 - law%factor)*box%density_slope(axis)
   end function as_gradient

   !> What the viscous terms see beyond a no-slip wall of velocity U, 2 U - u, less what all others do; of the source's velocity.
   pure type(law_t) function as_slip(box, axis) result(law)
      type(box_t), intent(in) :: box
      integer, intent(in) :: axis
      logical :: sticks(n_kinds)

      sticks = is_sticky(box, beyond(3 - axis, :))
      law%factor = merge(-2*signs(box, axis), 0.0_dp, sticks)
      law%shift = merge(2*wall_velocity(box, axis, beyond(3 - axis, :)), 0.0_dp, sticks)
   end function as_slip

   !> The velocity of the no-slip wall that an image is beyond.
   pure type(law_t) function as_wall_velocity(box, axis) result(law)
      type(box_t), intent(in) :: box
      integer, intent(in) :: axis

      law%factor = 0
      law%shift = merge(wall_velocity(box, axis, beyond(3 - axis, :)), 0.0_dp, is_sticky(box, beyond(3 - axis, :)))
   end function as_wall_velocity

   ! -1 for kinds that are mirrored along an axis, else 1.
   pure function signs(box, axis) result(sign)
      type(box_t), intent(in) :: box
      integer, intent(in) :: axis
      real(dp) :: sign(n_kinds)
      integer :: k

      sign = 1
      do k = 1, n_kinds
         associate (side => beyond(axis, k))
            if (side == 0) cycle
            if (box%kind(side) /= periodic_side) sign(k) = -1
         end associate
      end do
   end function signs

   ! Whether a side is a wall without slip; none is not.
   elemental logical function is_sticky(box, side)
      type(box_t), intent(in) :: box
      integer, intent(in) :: side

      is_sticky = .false.
      if (side > 0) is_sticky = box%kind(side) == no_slip_wall
   end function is_sticky

   ! A side's velocity along an axis; 0 for none.
   elemental real(dp) function wall_velocity(box, axis, side) result(velocity)
      type(box_t), intent(in) :: box
      integer, intent(in) :: axis, side

      velocity = 0
      if (side > 0) velocity = box%velocity(axis, side)
   end function wall_velocity

end module image_laws
