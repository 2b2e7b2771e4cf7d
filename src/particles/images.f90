!> Images of particles beyond the sides of the box: mirrored at walls, moved by a period at periodic sides.
!!
!! Source: Colagrossi & Landrini 2003. A mirror image has its source's mass, volume, density and tangential velocity,
!! the opposite normal velocity, and stands at the mirrored position; near a corner there is a doubly mirrored one
!! too. By default density is corrected by the hydrostatic difference between image and source, and the
!! density gradient accordingly, so that a linear hydrostatic field is continued exactly (docs/equations.md).
!! At no-slip walls the viscous terms see another tangential velocity: `fill_no_slip`.
module images
   use kinds, only: dp, i8
   use particles, only: particles_t, state_t, reserve_slots
   use strips, only: group_slots, strips_t, sort_into_strips
   implicit none
   private

   public :: walls_t, images_t, list_images, fill_images, fill_image_gradients, fill_image_copies, fill_no_slip

   integer, parameter, public :: left_wall = 1, right_wall = 2, bottom_wall = 3, top_wall = 4

   !> What the sides of the box are and what is continued across them.
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
   contains
      procedure :: bytes => images_bytes
   end type images_t

   !> A coordinate's image is sign*coordinate + offset, for each combination below.
   type :: mapping_t
      real(dp) :: sign_x(8), sign_y(8), offset_x(8), offset_y(8)
   end type mapping_t

   ! Which vertical and which horizontal side makes the image: sides and corners; 0 for none.
   integer, parameter :: vertical(8) = [1, 2, 0, 0, 1, 2, 1, 2]
   integer, parameter :: horizontal(8) = [0, 0, 3, 4, 3, 3, 4, 4]

contains

   !> Finds the particles that are mirrored, and sorts their images into strips behind the own slots.
   !!
   !! Decides on the predicted positions that the strips were sorted by: a particle that may come closer than `reach` to a wall
   !! within `travel` before or after that time gets an image.
   subroutine list_images(self, walls, p, tau, travel, reach)
      type(images_t), intent(inout) :: self
      type(walls_t), intent(in) :: walls
      type(particles_t), intent(inout) :: p   !! n_slots is set
      real(dp), intent(in) :: tau             !! time that positions are predicted ahead by
      real(dp), intent(in) :: travel          !! time
      real(dp), intent(in) :: reach(4)        !! of each side
      integer, parameter :: chunk = 1024   ! slots that a thread looks at at a time
      integer, allocatable :: begin(:)     ! images before those of a chunk
      integer :: b, i, k, n, n_chunks

      self%n = 0
      n_chunks = (p%n_own + chunk - 1)/chunk
      if (any(has_images(walls))) then
         allocate (begin(n_chunks + 1), source=0)
         !$omp parallel do default(none) shared(self, walls, p, tau, travel, reach, n_chunks, begin) schedule(static)
         do b = 1, n_chunks
            call look_at(self, walls, p, tau, travel, reach, (b - 1)*chunk + 1, min(b*chunk, p%n_own), .false., begin(b + 1))
         end do
         !$omp end parallel do
         do b = 1, n_chunks
            begin(b + 1) = begin(b) + begin(b + 1)
         end do
         self%n = begin(n_chunks + 1)
      end if
      call make_room(self, self%n)
      n = self%n
      p%n_slots = p%n_own + n
      call reserve_slots(p, p%n_slots + group_slots)   ! module candidates looks at whole groups
      if (n == 0) then
         self%strips%n = 0
         return
      end if
      !$omp parallel do default(none) shared(self, walls, p, tau, travel, reach, n_chunks, begin) private(k) schedule(static)
      do b = 1, n_chunks
         k = begin(b)
         call look_at(self, walls, p, tau, travel, reach, (b - 1)*chunk + 1, min(b*chunk, p%n_own), .true., k)
      end do
      !$omp end parallel do
      call sort_into_strips(self%strips, n, self%used(1:n), self%x(1:n), self%y(1:n), p%n_own + 1, .false.)
      !$omp parallel do default(none) shared(self, n) private(i)
      do k = 1, n
         i = self%strips%point_of(k)
         self%source(k) = self%unsorted_source(i)
         self%walls(k) = self%unsorted_walls(i)
      end do
      !$omp end parallel do
   end subroutine list_images

   ! Counts the images of the slots first to last, and if there is room for them writes them behind the first `n`.
   subroutine look_at(self, walls, p, tau, travel, reach, first, last, write_them, n)
      type(images_t), intent(inout) :: self
      type(walls_t), intent(in) :: walls
      type(particles_t), intent(in) :: p
      real(dp), intent(in) :: tau, travel, reach(4)
      integer, intent(in) :: first, last
      logical, intent(in) :: write_them
      integer, intent(inout) :: n
      type(mapping_t) :: map
      real(dp) :: x, y, reaches(4)
      integer :: i, c
      logical :: sides(4)

      sides = has_images(walls)
      map = mappings(walls)
      do i = first, last
         if (p%id(i) == 0) cycle
         x = p%base%x(i) + tau*p%base%u(i)
         y = p%base%y(i) + tau*p%base%v(i)
         reaches = reach + travel*abs([p%base%u(i), p%base%u(i), p%base%v(i), p%base%v(i)])
         if (.not. near_any(walls, sides, x, y, reaches)) cycle
         do c = 1, size(vertical)
            if (.not. near(walls, sides, vertical(c), x, reaches)) cycle
            if (.not. near(walls, sides, horizontal(c), y, reaches)) cycle
            n = n + 1
            if (write_them) call put(self, n, i, c, map%sign_x(c)*x + map%offset_x(c), map%sign_y(c)*y + map%offset_y(c))
         end do
      end do
   end subroutine look_at

   ! The sides that there are images beyond.
   pure function has_images(walls) result(sides)
      type(walls_t), intent(in) :: walls
      logical :: sides(4)

      sides = walls%present .or. walls%periodic([1, 1, 2, 2])
   end function has_images

   pure logical function near_any(walls, sides, x, y, reach)
      type(walls_t), intent(in) :: walls
      logical, intent(in) :: sides(4)
      real(dp), intent(in) :: x, y, reach(4)

      near_any = (sides(1) .and. x - walls%at(1) < reach(1)) .or. (sides(2) .and. walls%at(2) - x < reach(2)) &
                 .or. (sides(3) .and. y - walls%at(3) < reach(3)) .or. (sides(4) .and. walls%at(4) - y < reach(4))
   end function near_any

   ! Whether a coordinate is closer than reach to side number `side`; true for 0, which makes no image.
   pure logical function near(walls, sides, side, coordinate, reach)
      type(walls_t), intent(in) :: walls
      logical, intent(in) :: sides(4)
      integer, intent(in) :: side
      real(dp), intent(in) :: coordinate, reach(4)

      near = .true.
      if (side == 0) return
      near = .false.
      if (sides(side)) near = abs(coordinate - walls%at(side)) < reach(side)
   end function near

   subroutine put(self, n, i, c, x, y)
      type(images_t), intent(inout) :: self
      integer, intent(in) :: n, i, c
      real(dp), intent(in) :: x, y   !! of the image

      self%unsorted_source(n) = i
      self%unsorted_walls(n) = c
      self%x(n) = x
      self%y(n) = y
      self%used(n) = 1
   end subroutine put

   ! The numbers that there are need not be kept.
   subroutine make_room(self, n)
      type(images_t), intent(inout) :: self
      integer, intent(in) :: n
      integer :: larger

      if (allocated(self%source)) then
         if (n <= size(self%source)) return
         deallocate (self%source, self%walls, self%unsorted_source, self%unsorted_walls, self%used, self%x, self%y)
      end if
      larger = n + n/8
      allocate (self%source(larger), self%walls(larger), self%unsorted_source(larger), self%unsorted_walls(larger), &
                self%used(larger), self%x(larger), self%y(larger))
   end subroutine make_room

   !> Bytes that all arrays take.
   pure integer(i8) function images_bytes(self) result(bytes)
      class(images_t), intent(in) :: self

      bytes = self%strips%bytes()
      if (allocated(self%source)) bytes = bytes &
         + size(self%source, kind=i8)*(5*storage_size(self%source) + 2*storage_size(self%x))/8
   end function images_bytes

   !> Gives every image the mirrored or moved state of its source.
   subroutine fill_images(self, walls, n_own, state)
      type(images_t), intent(in) :: self
      type(walls_t), intent(in) :: walls
      integer, intent(in) :: n_own               !! own slots
      type(state_t), intent(inout) :: state
      type(mapping_t) :: map
      integer :: k, i, j, c

      if (self%n == 0) return
      map = mappings(walls)
      !$omp parallel do default(none) shared(self, walls, n_own, state, map) private(i, j, c)
      do k = 1, self%n
         i = self%source(k)
         j = n_own + k
         c = self%walls(k)
         state%x(j) = map%sign_x(c)*state%x(i) + map%offset_x(c)
         state%y(j) = map%sign_y(c)*state%y(i) + map%offset_y(c)
         state%u(j) = map%sign_x(c)*state%u(i)
         state%v(j) = map%sign_y(c)*state%v(i)
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
      type(mapping_t) :: map
      integer :: k, i, j, c

      if (self%n == 0) return
      map = mappings(walls)
      !$omp parallel do default(none) shared(self, walls, n_own, grad_x, grad_y, map) private(i, j, c)
      do k = 1, self%n
         i = self%source(k)
         j = n_own + k
         c = self%walls(k)
         grad_x(j) = map%sign_x(c)*grad_x(i) + (1 - map%sign_x(c))*walls%density_slope(1)
         grad_y(j) = map%sign_y(c)*grad_y(i) + (1 - map%sign_y(c))*walls%density_slope(2)
      end do
      !$omp end parallel do
   end subroutine fill_image_gradients

   !> Gives every image its source's value of two scalars: alpha_i and delta_i.
   subroutine fill_image_copies(self, n_own, first, second)
      type(images_t), intent(in) :: self
      integer, intent(in) :: n_own
      real(dp), intent(inout) :: first(:), second(:)   !! (n_slots)
      integer :: k

      !$omp parallel do default(none) shared(self, n_own, first, second)
      do k = 1, self%n
         first(n_own + k) = first(self%source(k))
         second(n_own + k) = second(self%source(k))
      end do
      !$omp end parallel do
   end subroutine fill_image_copies

   !> Gives every image the difference between its no-slip and its free-slip velocity, and its walls' velocity.
   !!
   !! Beyond a no-slip wall that moves along itself with speed U the tangential velocity is 2 U - u, not u.
   subroutine fill_no_slip(self, walls, p)
      type(images_t), intent(in) :: self
      type(walls_t), intent(in) :: walls
      type(particles_t), intent(inout) :: p   !! base state is filled; jump and wall velocities of the images are set
      integer :: k, j, h, v

      do k = 1, self%n
         j = p%n_own + k
         h = horizontal(self%walls(k))
         v = vertical(self%walls(k))
         p%jump_u(j) = 0
         p%jump_v(j) = 0
         p%wall_u(j) = 0
         p%wall_v(j) = 0
         if (h > 0) then
            if (walls%no_slip(h)) then
               p%wall_u(j) = walls%speed(h)
               p%jump_u(j) = 2*(walls%speed(h) - p%base%u(j))
            end if
         end if
         if (v > 0) then
            if (walls%no_slip(v)) then
               p%wall_v(j) = walls%speed(v)
               p%jump_v(j) = 2*(walls%speed(v) - p%base%v(j))
            end if
         end if
      end do
   end subroutine fill_no_slip

   ! How each combination of sides maps a coordinate.
   pure type(mapping_t) function mappings(walls) result(map)
      type(walls_t), intent(in) :: walls
      integer :: c

      do c = 1, size(vertical)
         call map_side(walls, vertical(c), walls%periodic(1), map%sign_x(c), map%offset_x(c))
         call map_side(walls, horizontal(c), walls%periodic(2), map%sign_y(c), map%offset_y(c))
      end do
   end function mappings

   pure subroutine map_side(walls, side, periodic, sign, offset)
      type(walls_t), intent(in) :: walls
      integer, intent(in) :: side
      logical, intent(in) :: periodic
      real(dp), intent(out) :: sign, offset
      integer :: other

      sign = 1
      offset = 0
      if (side == 0) return
      if (periodic) then
         ! From the left side to beyond the right one, and so on.
         other = side + 1
         if (side == right_wall .or. side == top_wall) other = side - 1
         offset = walls%at(other) - walls%at(side)
      else
         sign = -1
         offset = 2*walls%at(side)
      end if
   end subroutine map_side

end module images
