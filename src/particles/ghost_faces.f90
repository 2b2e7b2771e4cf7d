!> How the faces rub on the fluid that ghosts of solids stand behind.
!!
!! Source: ours (docs/equations.md, Viscosity at solids).
module ghost_faces
   use box, only: box_t
   use image_laws, only: as_position, law_t
   use kinds, only: dp, i8
   use motions, only: turn
   use solid_cells, only: cell_t
   use solids, only: solid_t
   implicit none
   private

   public :: ghost_faces_t

   real(dp), parameter :: large = 1.0e100_dp      ! [m]
   real(dp), parameter :: less = 1 - 1.0e-9_dp    ! of the depth: particles in the face's plane see it, whatever rounding does

   !> By slot, counted from the first ghost's, and behind all slots by image.
   type :: ghost_faces_t
      real(dp), allocatable :: stick(:)                   !! 1 where the fluid sticks to the face, else 0
      real(dp), allocatable :: normal_x(:), normal_y(:)   !! of the face, outwards
      !> [m] of the ghost behind the face: particles that are not farther before the ghost are not before the face, and do not see
      !! it. Large where none does, -large where all do.
      real(dp), allocatable :: depth(:)
      logical :: are_turned = .false.                     !! since there was room made
      integer, private :: n_slots = 0
      real(dp), allocatable, private :: drawn(:, :)       ! (2, n_slots) normals before the solids' motion
   contains
      procedure :: make_room
      procedure :: stand_behind
      procedure :: turn => turn_faces
      procedure :: copy
      procedure :: mirror
      procedure :: bytes
   end type ghost_faces_t

contains

   !> For ghosts and dummies, and for images of them.
   subroutine make_room(self, n_slots, n_images)
      class(ghost_faces_t), intent(inout) :: self
      integer, intent(in) :: n_slots, n_images

      if (allocated(self%stick)) deallocate (self%stick, self%normal_x, self%normal_y, self%depth, self%drawn)
      self%are_turned = .false.
      self%n_slots = n_slots
      associate (n => n_slots + n_images)
         allocate (self%stick(n), self%normal_x(n), self%normal_y(n), self%drawn(2, n_slots), source=0.0_dp)
         allocate (self%depth(n), source=large)
      end associate
   end subroutine make_room

   !> Takes the face of a ghost.
   pure subroutine stand_behind(self, k, solid, cell)
      class(ghost_faces_t), intent(inout) :: self
      integer, intent(in) :: k              !! slot
      type(solid_t), intent(in) :: solid
      type(cell_t), intent(in) :: cell      !! of the ghost

      self%stick(k) = merge(1, 0, solid%no_slip)
      self%depth(k) = less*cell%depth
      if (solid%no_slip) self%depth(k) = -large
      self%drawn(:, k) = cell%normal
   end subroutine stand_behind

   !> Turns the normals with their solids.
   pure subroutine turn_faces(self, angle, solid_of)
      class(ghost_faces_t), intent(inout) :: self
      real(dp), intent(in) :: angle(:)      !! (solids)
      integer, intent(in) :: solid_of(:)    !! (n_slots) 0 for dummies
      real(dp) :: axis(2, size(angle))      ! direction of x, as drawn
      integer :: k

      self%are_turned = .true.
      do k = 1, size(angle)
         axis(:, k) = turn(angle(k), [1.0_dp, 0.0_dp])
      end do
      do k = 1, self%n_slots
         if (solid_of(k) == 0) cycle
         associate (x => axis(1, solid_of(k)), y => axis(2, solid_of(k)), normal => self%drawn(:, k))
            self%normal_x(k) = x*normal(1) - y*normal(2)
            self%normal_y(k) = y*normal(1) + x*normal(2)
         end associate
      end do
   end subroutine turn_faces

   !> Gives images what their sources have, but the normals.
   pure subroutine copy(self, source)
      class(ghost_faces_t), intent(inout) :: self
      integer, intent(in) :: source(:)   !! (images) slots

      self%stick(self%n_slots + 1:) = self%stick(source)
      self%depth(self%n_slots + 1:) = self%depth(source)
   end subroutine copy

   !> Gives images the mirrored normals of their sources.
   pure subroutine mirror(self, box, kind, source)
      class(ghost_faces_t), intent(inout) :: self
      type(box_t), intent(in) :: box               !! at any time
      integer, intent(in) :: kind(:), source(:)    !! (images) kinds, slots
      type(law_t) :: law(2)

      law = [as_position(box, 1), as_position(box, 2)]
      self%normal_x(self%n_slots + 1:) = law(1)%factor(kind)*self%normal_x(source)
      self%normal_y(self%n_slots + 1:) = law(2)%factor(kind)*self%normal_y(source)
   end subroutine mirror

   !> Bytes that all arrays take.
   pure integer(i8) function bytes(self)
      class(ghost_faces_t), intent(in) :: self

      bytes = 0
      if (allocated(self%stick)) bytes = (4*size(self%stick, kind=i8) + size(self%drawn, kind=i8))*storage_size(self%stick)/8
   end function bytes

end module ghost_faces
