!> Small seeded sets of particles that the tests of neighbours, sums and steps share.
module patches
   use communication, only: largest_of_all, n_processes, sums_of_all, this_process
   use box, only: bottom_wall, box_t, free_slip_wall, left_wall, no_slip_wall, open_side, periodic_side, right_wall, top_wall
   use integrators, only: new_integrator
   use kernel, only: new_kernel
   use kinds, only: dp, i8
   use lanes, only: nl
   use linear_stability, only: stability_t
   use model, only: model_t
   use neighbours, only: list_neighbours, neighbours_t, sort_particles
   use particles, only: allocate_particles, features_t, particles_t
   use square_lattice, only: lattice_crowd
   implicit none
   private

   public :: random_t, points_t, empty_points, open_model, tank_model, box_model, channel_model, make_dynamic
   public :: fill_patch, put_particles, deal, make_common
   public :: set_linear_density, find_neighbours, candidates_of, points_of, with_images, without_slip, scatter

   real(dp), parameter, public :: spacing = 0.05_dp                    !! dx of the models below
   real(dp), parameter, public :: tank_width = 0.6873_dp               !! no multiple of dx
   real(dp), parameter, public :: floor_at = -0.0217_dp                !! y of the tank's bottom

   real(dp), parameter, public :: box_height = 0.5519_dp               !! of the periodic box

   !> Minimal generator, so that every machine tests the same particles.
   type :: random_t
      integer(i8) :: state = 1
   contains
      procedure :: between
   end type random_t

   !> Particles in the order of their numbers, and perhaps all their images.
   type :: points_t
      real(dp), allocatable :: x(:), y(:), u(:), v(:), s(:), w(:), m(:)
      integer, allocatable :: owner(:)                !! number of the particle, or of the image's source
      real(dp), allocatable :: sign_x(:), sign_y(:)   !! -1 if mirrored in that direction
      integer, allocatable :: vertical(:), horizontal(:)   !! sides that an image is beyond; 0: none
   end type points_t

contains

   !> A number between the two; the next one at each call.
   real(dp) function between(self, lower, upper)
      class(random_t), intent(inout) :: self
      real(dp), intent(in) :: lower, upper

      self%state = mod(16807_i8*self%state, 2147483647_i8)
      between = lower + (upper - lower)*(real(self%state, dp)/2147483647.0_dp)
   end function between

   !> Constants that differ from 1 where they could hide a missing factor; no box, no gravity.
   type(model_t) function open_model() result(model)
      model%kernel = new_kernel(2*spacing)
      model%dx = spacing
      model%lattice_crowd = spacing**2*lattice_crowd(2.0_dp)
      model%c0 = 10
      model%rho0 = 1.3_dp
      model%alpha = 0.03_dp
      model%delta = 0.1_dp
      model%cfl = 1.5_dp
      model%integrator = new_integrator('rk4')
      model%stability = stability_t(sound=2.37_dp, times_delta=0.294_dp, times_alpha=0.5_dp)
   end function open_model

   !> The same with gravity, a floor and walls left and right, and hydrostatic images.
   type(model_t) function tank_model() result(model)
      model = open_model()
      model%gravity = 0.9_dp
      model%box%kind([left_wall, right_wall, bottom_wall]) = free_slip_wall
      model%box%at = [0.0_dp, tank_width, floor_at, 0.0_dp]
      model%box%density_slope = [0.0_dp, -model%rho0*model%gravity/model%c0**2]
   end function tank_model

   !> No box, no gravity, and all four sides of a box periodic.
   type(model_t) function box_model() result(model)
      model = open_model()
      model%box%kind = periodic_side
      model%box%at = [0.0_dp, tank_width, floor_at, floor_at + box_height]
   end function box_model

   !> A floor and a lid, free slip, between periodic sides; no gravity.
   type(model_t) function channel_model() result(model)
      model = box_model()
      model%box%kind([left_wall, right_wall]) = periodic_side
      model%box%kind([bottom_wall, top_wall]) = free_slip_wall
   end function channel_model

   !> Puts the paper's dynamic model in the place of constant delta; the model's alpha is then that of a real viscosity.
   pure subroutine make_dynamic(model)
      type(model_t), intent(inout) :: model

      model%dynamic = .true.
      model%delta = 0
      model%alpha_per_strain = 0.4608_dp*model%kernel%h/model%c0
      model%delta_per_strain = 9*model%kernel%h/model%c0
      model%limit = 0.2_dp
   end subroutine make_dynamic

   !> A disordered block of n(1) x n(2) particles from `lower` to `upper`, left in `next` as by the scene set-up.
   subroutine fill_patch(model, p, lower, upper, n, seed, speed, features)
      type(model_t), intent(in) :: model
      type(particles_t), intent(out) :: p
      real(dp), intent(in) :: lower(2), upper(2)
      integer, intent(in) :: n(2), seed
      real(dp), intent(in) :: speed   !! of each component at most
      type(features_t), intent(in), optional :: features
      type(points_t) :: points
      type(random_t) :: random
      real(dp) :: cell(2)
      integer :: i, j, k

      random%state = seed
      points = empty_points(product(n))
      cell = (upper - lower)/n
      do j = 1, n(2)
         do i = 1, n(1)
            k = (j - 1)*n(1) + i
            points%x(k) = lower(1) + cell(1)*(i - 0.5_dp + random%between(-0.4_dp, 0.4_dp))
            points%y(k) = lower(2) + cell(2)*(j - 0.5_dp + random%between(-0.4_dp, 0.4_dp))
            points%u(k) = random%between(-speed, speed)
            points%v(k) = random%between(-speed, speed)
            points%s(k) = model%rho0*random%between(-0.01_dp, 0.01_dp)
            points%w(k) = product(cell)*random%between(0.8_dp, 1.2_dp)
         end do
      end do
      points%m = (model%rho0 + points%s)*points%w
      call put_particles(points, p, features)
   end subroutine fill_patch

   !> Particles with these states in `next`; the mass is taken as given.
   subroutine put_particles(points, p, features)
      type(points_t), intent(in) :: points
      type(particles_t), intent(out) :: p
      type(features_t), intent(in), optional :: features
      integer :: n, i

      n = size(points%x)
      call allocate_particles(p, n, features)
      p%n_own = n
      p%id(1:n) = [(i, i=1, n)]
      p%m(1:n) = points%m
      p%next%x(1:n) = points%x
      p%next%y(1:n) = points%y
      p%next%u(1:n) = points%u
      p%next%v(1:n) = points%v
      p%next%s(1:n) = points%s
      p%next%volume(1:n) = points%w
   end subroutine put_particles

   !> Where there are several processes, all of which have all particles, each keeps its share of them for the sort to come.
   subroutine deal(p)
      type(particles_t), intent(inout) :: p
      integer(i8) :: held(1)
      integer :: i

      if (n_processes() == 1) return
      held = count(p%id(:p%n_own) > 0)
      call sums_of_all(1, held)
      if (held(1) == p%n) return   ! they were dealt before
      do i = 1, p%n_own
         if (mod(i, n_processes()) /= this_process()) p%id(i) = 0
      end do
   end subroutine deal

   !> rho - rho0 = constant + slope.r, in `next`; volumes stay and masses follow.
   subroutine set_linear_density(model, p, constant, slope)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      real(dp), intent(in) :: constant, slope(2)

      associate (n => p%n_own)
         p%next%s(1:n) = constant + slope(1)*p%next%x(1:n) + slope(2)*p%next%y(1:n)
         p%m(1:n) = (model%rho0 + p%next%s(1:n))*p%next%volume(1:n)
      end associate
   end subroutine set_linear_density

   !> Sorts into `base`, mirrors and lists, as each step does.
   subroutine find_neighbours(model, p, near, step_ahead, slack)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      type(neighbours_t), intent(inout) :: near
      real(dp), intent(in) :: step_ahead
      real(dp), intent(in), optional :: slack
      logical :: scattered

      near%slack = 0.02_dp*model%dx
      if (present(slack)) near%slack = slack
      call deal(p)
      call sort_particles(near, p, model%kernel, model%box, model%dx, step_ahead, scattered, model%solids, &
                          model%poses_at(0.0_dp))
      if (scattered) error stop 'the test''s particles are too far from each other'
      call list_neighbours(near, p, model%kernel, 2*near%tau)
   end subroutine find_neighbours

   !> The slots that a cluster is to visit; clusters are counted through all blocks.
   pure function candidates_of(near, cluster) result(slots)
      type(neighbours_t), intent(in) :: near
      integer, intent(in) :: cluster
      integer, allocatable :: slots(:)
      integer :: b

      b = count(near%blocks(:near%n_blocks)%before <= nl*(cluster - 1))
      associate (block => near%blocks(b), c => cluster - near%blocks(b)%before/nl)
         slots = block%slot(block%first(c):block%first(c + 1) - 1)
      end associate
   end function candidates_of

   !> The base state in the order of the particles' numbers.
   type(points_t) function points_of(p) result(points)
      type(particles_t), intent(in) :: p

      points = empty_points(p%n)
      call scatter(p, p%base%x, points%x)
      call scatter(p, p%base%y, points%y)
      call scatter(p, p%base%u, points%u)
      call scatter(p, p%base%v, points%v)
      call scatter(p, p%base%s, points%s)
      call scatter(p, p%base%volume, points%w)
      call scatter(p, p%m, points%m)
   end function points_of

   !> Brings an array over slots, of all processes, into the order of the particles' numbers.
   subroutine scatter(p, by_slot, by_id)
      type(particles_t), intent(in) :: p
      real(dp), intent(in) :: by_slot(:)
      real(dp), intent(inout) :: by_id(:)   !! (n)
      logical :: known(size(by_id))
      integer :: i

      known = .false.
      do i = 1, p%n_own
         if (p%id(i) == 0) cycle
         by_id(p%id(i)) = by_slot(i)
         known(p%id(i)) = .true.
      end do
      call make_common(known, by_id)
   end subroutine scatter

   !> All processes get what is known to one of them.
   subroutine make_common(known, values)
      logical, intent(in) :: known(:)          !! (n) here
      real(dp), intent(inout) :: values(:)     !! (n)
      real(dp) :: told(size(values))

      if (n_processes() == 1) return
      told = merge(values, -huge(1.0_dp), known)
      call largest_of_all(size(told), told)
      values = told
   end subroutine make_common

   !> The particles and all images that they could have, however far away: written from the definition.
   type(points_t) function with_images(points, box) result(both)
      type(points_t), intent(in) :: points
      type(box_t), intent(in) :: box
      integer :: wall, side
      logical :: there(4)

      there = box%kind /= open_side
      both = points
      do wall = 1, 4
         if (there(wall)) call append(both, image_at(points, box, wall))
      end do
      do side = left_wall, right_wall
         do wall = bottom_wall, top_wall
            if (there(side) .and. there(wall)) call append(both, image_at(image_at(points, box, side), box, wall))
         end do
      end do
   end function with_images

   ! The points mirrored at one wall, or moved beyond one periodic side.
   type(points_t) function image_at(points, box, wall) result(image)
      type(points_t), intent(in) :: points
      type(box_t), intent(in) :: box
      integer, intent(in) :: wall

      image = points
      select case (wall)
      case (left_wall, right_wall)
         image%vertical = wall
         if (box%is_periodic(1)) then
            image%x = points%x + merge(-1, 1, wall == left_wall)*(box%at(right_wall) - box%at(left_wall))
            return
         end if
         image%x = box%at(wall) - (points%x - box%at(wall))
         image%u = -points%u
         image%sign_x = -points%sign_x
      case default
         image%horizontal = wall
         if (box%is_periodic(2)) then
            image%y = points%y + merge(-1, 1, wall == bottom_wall)*(box%at(top_wall) - box%at(bottom_wall))
            return
         end if
         image%y = box%at(wall) - (points%y - box%at(wall))
         image%v = -points%v
         image%sign_y = -points%sign_y
      end select
      image%s = points%s + box%density_slope(1)*(image%x - points%x) + box%density_slope(2)*(image%y - points%y)
   end function image_at

   !> The same points as viscosity sees them: beyond a no-slip wall of speed U, the velocity along it is 2 U - u.
   type(points_t) function without_slip(points, box) result(viscous)
      type(points_t), intent(in) :: points   !! with images
      type(box_t), intent(in) :: box
      integer :: j

      viscous = points
      do j = 1, size(points%x)
         associate (v => points%vertical(j), h => points%horizontal(j))
            if (h > 0) then
               if (box%kind(h) == no_slip_wall) viscous%u(j) = 2*box%velocity(1, h) - points%u(j)
            end if
            if (v > 0) then
               if (box%kind(v) == no_slip_wall) viscous%v(j) = 2*box%velocity(2, v) - points%v(j)
            end if
         end associate
      end do
   end function without_slip

   subroutine append(points, more)
      type(points_t), intent(inout) :: points
      type(points_t), intent(in) :: more

      points%x = [points%x, more%x]
      points%y = [points%y, more%y]
      points%u = [points%u, more%u]
      points%v = [points%v, more%v]
      points%s = [points%s, more%s]
      points%w = [points%w, more%w]
      points%m = [points%m, more%m]
      points%owner = [points%owner, more%owner]
      points%sign_x = [points%sign_x, more%sign_x]
      points%sign_y = [points%sign_y, more%sign_y]
      points%vertical = [points%vertical, more%vertical]
      points%horizontal = [points%horizontal, more%horizontal]
   end subroutine append

   !> n particles that are still to be filled in; masses too.
   type(points_t) function empty_points(n) result(points)
      integer, intent(in) :: n
      integer :: i

      allocate (points%x(n), points%y(n), points%u(n), points%v(n), points%s(n), points%w(n), points%m(n), source=0.0_dp)
      allocate (points%sign_x(n), points%sign_y(n), source=1.0_dp)
      allocate (points%vertical(n), points%horizontal(n), source=0)
      points%owner = [(i, i=1, n)]
   end function empty_points

end module patches
