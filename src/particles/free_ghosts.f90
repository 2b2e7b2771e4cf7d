!> What there is of free solids beside their ghosts: what forces do to them, and how far lists follow where these lead.
!!
!! Source: ours (docs/equations.md, Free bodies).
module free_ghosts
   use kinds, only: dp
   use motions, only: pose_t
   use rigid_bodies, only: coasting
   use solids, only: solid_t
   implicit none
   private

   public :: free_ghosts_t, new_free_ghosts

   real(dp), parameter :: more = 2             ! times the acceleration that a free solid had
   real(dp), parameter :: least_way = 0.05_dp  ! that lists allow in any case [dx]

   !> By solid, or by slot, counted from the first ghost's.
   type :: free_ghosts_t
      real(dp), allocatable :: tilt(:, :)     !! [kg s2/m4] (2, n_slots) change of density by an acceleration of the ghost's face
      real(dp), allocatable :: push(:, :)     !! [N/m] (2, n_slots) force on the solid, whose power goes to the fluid
      real(dp), allocatable :: area(:, :)     !! [m3/s2] (2, n_slots) its change by density,
      real(dp), allocatable :: felt(:, :)     !! [m3/s2] (2, n_slots) and as the fluid feels it, images mirrored
      real(dp), allocatable :: load(:, :)     !! [N/m, N/m, N] (3, solids) force of pressure, and its moment about the pivot
      real(dp), allocatable :: drag(:, :)     !! (3, solids) and of friction
      real(dp), private :: width = 0          !! [m] of cells
      real(dp), private :: acceleration = 0   !! [m/s2] that is expected of them
      real(dp), private :: allowed = 0        !! [m] that lists allow them beside their way
      real(dp), private :: age = 0, time = 0  !! [s] of the sort's when lists were made; that lists cover
      type(pose_t), allocatable, private :: listed(:)   !! then
   contains
      procedure :: make_room
      procedure :: expect
      procedure :: allowance
      procedure :: take_lists
      procedure :: overreach
   end type free_ghosts_t

contains

   pure type(free_ghosts_t) function new_free_ghosts(n, width) result(self)
      integer, intent(in) :: n           !! solids
      real(dp), intent(in) :: width      !! of cells [m]

      self%width = width
      allocate (self%load(3, n), self%drag(3, n), source=0.0_dp)
   end function new_free_ghosts

   !> Arrays by slot.
   pure subroutine make_room(self, n)
      class(free_ghosts_t), intent(inout) :: self
      integer, intent(in) :: n

      if (allocated(self%tilt)) deallocate (self%tilt, self%push, self%area, self%felt)
      allocate (self%tilt(2, n), self%push(2, n), self%area(2, n), self%felt(2, n), source=0.0_dp)
   end subroutine make_room

   !> Takes the poses when ghosts are sorted: with them go the accelerations of the step before.
   pure subroutine expect(self, solids, poses)
      class(free_ghosts_t), intent(inout) :: self
      type(solid_t), intent(in) :: solids(:)
      type(pose_t), intent(in) :: poses(:)
      integer :: k

      self%acceleration = 0
      do k = 1, size(solids)
         if (.not. solids(k)%body%is_free()) cycle
         associate (pose => poses(k), radius => solids(k)%radius())
            self%acceleration = max(self%acceleration, more*(norm2(pose%acceleration) + radius*abs(pose%spin_rate) &
                                                             + radius*pose%spin**2))
         end associate
      end do
   end subroutine expect

   !> How far lists that cover a time allow ghosts to be beside their way [m].
   pure real(dp) function allowance(self, time)
      class(free_ghosts_t), intent(in) :: self
      real(dp), intent(in) :: time   !! [s]

      allowance = max(self%acceleration*time**2, least_way*self%width)
   end function allowance

   !> Takes what lists are made for; how far they shall allow ghosts to be beside their way [m].
   pure subroutine take_lists(self, poses, age, time, allowed)
      class(free_ghosts_t), intent(inout) :: self
      type(pose_t), intent(in) :: poses(:)      !! that lists are made for
      real(dp), intent(in) :: age               !! since the sort [s]
      real(dp), intent(in) :: time              !! between the base state and the ends of what lists cover, together [s]
      real(dp), intent(out) :: allowed

      self%listed = poses
      self%age = age
      self%time = time
      self%allowed = self%allowance(time)
      allowed = self%allowed
   end subroutine take_lists

   !> How far ghosts are beside their way if lists do not allow it, else 0 [m]; lists that are made anew will.
   pure subroutine overreach(self, solids, poses, age, farthest)
      class(free_ghosts_t), intent(inout) :: self
      type(solid_t), intent(in) :: solids(:)
      type(pose_t), intent(in) :: poses(:)
      real(dp), intent(in) :: age             !! of the poses since the sort [s]
      real(dp), intent(out) :: farthest
      type(pose_t) :: straight
      real(dp) :: time, way
      integer :: k

      farthest = 0
      time = age - self%age
      do k = 1, size(solids)
         if (.not. solids(k)%body%is_free()) cycle
         straight = coasting(self%listed(k), time)
         ! Points of a body that turns leave their straight way even if the spin stays.
         way = norm2(poses(k)%shift - straight%shift) &
               + solids(k)%radius()*(abs(poses(k)%angle - straight%angle) + (straight%spin*time)**2/2)
         if (way > self%allowed) farthest = max(farthest, way)
      end do
      if (farthest > 0) self%acceleration = max(self%acceleration, more*farthest/self%time**2)
   end subroutine overreach

end module free_ghosts
