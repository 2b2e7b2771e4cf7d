!> Mirror images of particles behind free-slip walls.
!!
!! Source: Colagrossi & Landrini 2003. An image has its source's mass, volume, density and tangential velocity,
!! the opposite normal velocity, and stands at the mirrored position; near a corner there is a doubly mirrored one
!! too. By default density is corrected by the hydrostatic difference between image and source, and the
!! density gradient accordingly, so that a linear hydrostatic field is continued exactly (docs/equations.md).
module images
   use kinds, only: dp
   use particles, only: particles_t, state_t, reserve_slots
   use strips, only: strips_t, sort_into_strips
   implicit none
   private

   public :: walls_t, images_t, list_images, fill_images, fill_image_gradients, outside, reflect

   integer, parameter, public :: left_wall = 1, right_wall = 2, bottom_wall = 3, top_wall = 4

   !> Mirror planes and what is continued across them.
   type :: walls_t
      logical :: present(4) = .false.          !! left, right, bottom, top: a mirror plane, free slip or not
      logical :: no_slip(4) = .false.          !! tangential velocity is reversed in the viscous terms
      logical :: periodic(2) = .false.         !! left and right, bottom and top are the same line
      real(dp) :: at(4) = 0                    !! x of left and right, y of bottom and top
      real(dp) :: speed(4) = 0                 !! of a no-slip wall, along itself
      real(dp) :: density_slope(2) = 0         !! rho0 g/c0**2, the hydrostatic gradient of rho; 0 for the pure mirror
   end type walls_t

   !> The images of a step: slot `n_own + k` is an image of slot `source(k)`.
   type :: images_t
      integer :: n = 0
      integer, allocatable :: source(:)    !! (n) slot of the source
      integer, allocatable :: walls(:)     !! (n) index into the combinations below
      type(strips_t) :: strips             !! where to find them
      integer, allocatable, private :: unsorted_source(:), unsorted_walls(:), used(:)
      real(dp), allocatable, private :: x(:), y(:)
   end type images_t

   ! Which vertical and which horizontal wall mirrors: sides and corners; 0 for none.
   integer, parameter :: vertical(8) = [1, 2, 0, 0, 1, 2, 1, 2]
   integer, parameter :: horizontal(8) = [0, 0, 3, 4, 3, 3, 4, 4]

contains

   !> Finds the particles that are mirrored, and sorts their images into strips behind the own slots.
   !!
   !! Decides on the predicted positions that the strips were sorted by: a particle closer than `reach` to a wall
   !! gets an image.
   subroutine list_images(self, walls, p, tau, reach)
      type(images_t), intent(inout) :: self
      type(walls_t), intent(in) :: walls
      type(particles_t), intent(inout) :: p   !! n_slots is set; owner of the images too
      real(dp), intent(in) :: tau             !! time that positions are predicted ahead by
      real(dp), intent(in) :: reach
      real(dp) :: x, y
      integer :: i, c, k, n

      self%n = 0
      if (any(walls%present)) then
         do i = 1, p%n_own
            if (p%id(i) == 0) cycle
            x = p%base%x(i) + tau*p%base%u(i)
            y = p%base%y(i) + tau*p%base%v(i)
            if (.not. near_any(walls, x, y, reach)) cycle
            do c = 1, size(vertical)
               if (near(walls, vertical(c), x, reach) .and. near(walls, horizontal(c), y, reach)) &
                  call append(self, walls, i, c, x, y)
            end do
         end do
      end if
      n = self%n
      p%n_slots = p%n_own + n
      call reserve_slots(p, p%n_slots)
      if (n == 0) then
         self%strips%n = 0
         return
      end if
      call sort_into_strips(self%strips, n, self%used(1:n), self%x(1:n), self%y(1:n), p%n_own + 1, .false.)
      do k = 1, n
         i = self%strips%point_of(k)
         self%source(k) = self%unsorted_source(i)
         self%walls(k) = self%unsorted_walls(i)
         p%owner(p%n_own + k) = self%source(k)
      end do
   end subroutine list_images

   pure logical function near_any(walls, x, y, reach)
      type(walls_t), intent(in) :: walls
      real(dp), intent(in) :: x, y, reach

      near_any = (walls%present(1) .and. x - walls%at(1) < reach) .or. (walls%present(2) .and. walls%at(2) - x < reach) &
                 .or. (walls%present(3) .and. y - walls%at(3) < reach) .or. (walls%present(4) .and. walls%at(4) - y < reach)
   end function near_any

   ! Whether a coordinate is closer than reach to wall number `wall`; true for wall 0, which mirrors nothing.
   pure logical function near(walls, wall, coordinate, reach)
      type(walls_t), intent(in) :: walls
      integer, intent(in) :: wall
      real(dp), intent(in) :: coordinate, reach

      near = .true.
      if (wall == 0) return
      near = .false.
      if (walls%present(wall)) near = abs(coordinate - walls%at(wall)) < reach
   end function near

   subroutine append(self, walls, i, c, x, y)
      type(images_t), intent(inout) :: self
      type(walls_t), intent(in) :: walls
      integer, intent(in) :: i, c
      real(dp), intent(in) :: x, y
      integer :: n

      n = self%n + 1
      call make_room(self, n)
      self%unsorted_source(n) = i
      self%unsorted_walls(n) = c
      self%x(n) = x
      self%y(n) = y
      if (vertical(c) > 0) self%x(n) = 2*walls%at(vertical(c)) - x
      if (horizontal(c) > 0) self%y(n) = 2*walls%at(horizontal(c)) - y
      self%used(n) = 1
      self%n = n
   end subroutine append

   subroutine make_room(self, n)
      type(images_t), intent(inout) :: self
      integer, intent(in) :: n
      integer :: larger

      if (.not. allocated(self%source)) allocate (self%source(0), self%walls(0), self%unsorted_source(0), &
                                                  self%unsorted_walls(0), self%used(0), self%x(0), self%y(0))
      if (n <= size(self%source)) return
      larger = n + n/2 + 64
      self%source = [self%source, spread(0, 1, larger - size(self%source))]
      self%walls = [self%walls, spread(0, 1, larger - size(self%walls))]
      self%unsorted_source = [self%unsorted_source, spread(0, 1, larger - size(self%unsorted_source))]
      self%unsorted_walls = [self%unsorted_walls, spread(0, 1, larger - size(self%unsorted_walls))]
      self%used = [self%used, spread(0, 1, larger - size(self%used))]
      self%x = [self%x, spread(0.0_dp, 1, larger - size(self%x))]
      self%y = [self%y, spread(0.0_dp, 1, larger - size(self%y))]
   end subroutine make_room

   !> Gives every image the mirrored state of its source.
   subroutine fill_images(self, walls, n_own, state)
      type(images_t), intent(in) :: self
      type(walls_t), intent(in) :: walls
      integer, intent(in) :: n_own               !! own slots
      type(state_t), intent(inout) :: state
      real(dp) :: sign_x(8), sign_y(8), offset_x(8), offset_y(8)
      integer :: k, i, j, c

      call mirror_tables(walls, sign_x, sign_y, offset_x, offset_y)
      !$omp parallel do default(none) shared(self, walls, n_own, state, sign_x, sign_y, offset_x, offset_y) private(i, j, c)
      do k = 1, self%n
         i = self%source(k)
         j = n_own + k
         c = self%walls(k)
         state%x(j) = sign_x(c)*state%x(i) + offset_x(c)
         state%y(j) = sign_y(c)*state%y(i) + offset_y(c)
         state%u(j) = sign_x(c)*state%u(i)
         state%v(j) = sign_y(c)*state%v(i)
         state%s(j) = state%s(i) + walls%density_slope(1)*(state%x(j) - state%x(i)) &
                      + walls%density_slope(2)*(state%y(j) - state%y(i))
         state%w(j) = state%w(i)
      end do
      !$omp end parallel do
   end subroutine fill_images

   !> Gives every image its density gradient: reflected, the hydrostatic part kept.
   !!
   !! From rho_G(r_G) = rho(r) + slope.(r_G - r): normal component -G_n + 2 slope_n, tangential one unchanged.
   subroutine fill_image_gradients(self, walls, n_own, grad_x, grad_y)
      type(images_t), intent(in) :: self
      type(walls_t), intent(in) :: walls
      integer, intent(in) :: n_own
      real(dp), intent(inout) :: grad_x(:), grad_y(:)   !! (n_slots)
      real(dp) :: sign_x(8), sign_y(8), offset_x(8), offset_y(8)
      integer :: k, i, j, c

      call mirror_tables(walls, sign_x, sign_y, offset_x, offset_y)
      !$omp parallel do default(none) shared(self, walls, n_own, grad_x, grad_y, sign_x, sign_y) private(i, j, c)
      do k = 1, self%n
         i = self%source(k)
         j = n_own + k
         c = self%walls(k)
         grad_x(j) = sign_x(c)*grad_x(i) + (1 - sign_x(c))*walls%density_slope(1)
         grad_y(j) = sign_y(c)*grad_y(i) + (1 - sign_y(c))*walls%density_slope(2)
      end do
      !$omp end parallel do
   end subroutine fill_image_gradients

   ! Mirroring of a coordinate as sign*coordinate + offset, for each combination of walls.
   pure subroutine mirror_tables(walls, sign_x, sign_y, offset_x, offset_y)
      type(walls_t), intent(in) :: walls
      real(dp), intent(out) :: sign_x(8), sign_y(8), offset_x(8), offset_y(8)
      integer :: c

      sign_x = 1
      sign_y = 1
      offset_x = 0
      offset_y = 0
      do c = 1, 8
         if (vertical(c) > 0) then
            sign_x(c) = -1
            offset_x(c) = 2*walls%at(max(1, vertical(c)))
         end if
         if (horizontal(c) > 0) then
            sign_y(c) = -1
            offset_y(c) = 2*walls%at(max(1, horizontal(c)))
         end if
      end do
   end subroutine mirror_tables

   !> Whether a position is behind a wall.
   elemental logical function outside(walls, x, y)
      type(walls_t), intent(in) :: walls
      real(dp), intent(in) :: x, y

      outside = (walls%present(left_wall) .and. x < walls%at(left_wall)) &
                .or. (walls%present(right_wall) .and. x > walls%at(right_wall)) &
                .or. (walls%present(bottom_wall) .and. y < walls%at(bottom_wall)) &
                .or. (walls%present(top_wall) .and. y > walls%at(top_wall))
   end function outside

   !> Puts a particle that crossed a wall back inside, its normal velocity pointing inwards.
   !!
   !! Where it is lifted against gravity, its speed falls by what it gains in height, so that the crossing adds no
   !! energy; only a particle that is too slow even to reach the floor is put there.
   pure subroutine reflect(walls, gravity, x, y, u, v, crossed)
      type(walls_t), intent(in) :: walls
      real(dp), intent(in) :: gravity              !! along -y
      real(dp), intent(inout) :: x, y, u, v
      logical, intent(out) :: crossed
      real(dp) :: depth

      crossed = .false.
      if (walls%present(left_wall)) call mirror(x, u, walls%at(left_wall), 1.0_dp, crossed)
      if (walls%present(right_wall)) call mirror(x, u, walls%at(right_wall), -1.0_dp, crossed)
      if (walls%present(bottom_wall)) then
         depth = max(0.0_dp, walls%at(bottom_wall) - y)
         if (v**2 < 4*gravity*depth) then
            ! Too slow to rise as far above the floor as it is below: it gets as high as its energy takes it.
            y = walls%at(bottom_wall) + max(0.0_dp, v**2/(2*gravity) - depth)
            v = 0
            crossed = .true.
         else
            v = sign(sqrt(v**2 - 4*gravity*depth), v)
            call mirror(y, v, walls%at(bottom_wall), 1.0_dp, crossed)
         end if
      end if
      if (walls%present(top_wall)) then
         v = sign(sqrt(v**2 + 4*gravity*max(0.0_dp, y - walls%at(top_wall))), v)
         call mirror(y, v, walls%at(top_wall), -1.0_dp, crossed)
      end if
   end subroutine reflect

   pure subroutine mirror(coordinate, velocity, wall, inward, crossed)
      real(dp), intent(inout) :: coordinate, velocity
      real(dp), intent(in) :: wall, inward   !! inward = 1 or -1: towards the fluid
      logical, intent(inout) :: crossed

      if (.not. (wall - coordinate)*inward > 0) return
      coordinate = 2*wall - coordinate
      velocity = sign(velocity, inward)
      crossed = .true.
   end subroutine mirror

end module images
