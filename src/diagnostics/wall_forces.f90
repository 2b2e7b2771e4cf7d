!> Forces of the fluid on the walls of the box at the base state, per unit width: the other side of what images do to the fluid.
!!
!! Pressure: sum over particles i and images j beyond a wall of V_i V_j F_ij (p_i + p_j) (r_j - r_i), its component across the
!! wall. Friction: the component along it of the viscous sum over the jumps of no-slip images. An image beyond a corner counts for
!! both of its sides.
module wall_forces
   use box, only: is_wall, no_slip_wall
   use exact_sum, only: exact_totals
   use gradient_fields, only: renew_coefficients
   use harmonic_means, only: mean_coefficients
   use image_laws, only: beyond
   use kernel, only: pair, squared_distance
   use kinds, only: dp
   use lanes, only: nl
   use model, only: model_t, terms_t
   use neighbours, only: neighbours_t
   use particles, only: particles_t
   use strips, only: group_slots
   implicit none
   private

   public :: wall_forces_t, measure_walls

   !> On each side, in the order of the box; 0 on what is no wall, or has no friction.
   type :: wall_forces_t
      real(dp) :: pressure(4) = 0   !! [N/m] x component of left and right, y component of bottom and top
      real(dp) :: friction(4) = 0   !! [N/m] y component of left and right, x component of bottom and top
   end type wall_forces_t

contains

   !> One pass over the pairs with images.
   subroutine measure_walls(model, near, p, forces)
      type(model_t), intent(in) :: model
      type(neighbours_t), intent(inout) :: near    !! of the base state
      type(particles_t), intent(inout) :: p        !! coefficients of the dynamic model are set
      type(wall_forces_t), intent(out) :: forces
      real(dp), allocatable :: table(:, :)         ! of each group: a part of a strip, whatever blocks there are
      real(dp) :: totals(8)
      type(terms_t) :: has
      logical :: rubs
      integer :: b

      has = model%terms()
      rubs = has%no_slip .and. has%viscosity
      if (rubs .and. model%dynamic) call renew_coefficients(model, near, p, near_solids=.false.)
      allocate (table(8, p%n_own/group_slots), source=0.0_dp)
      !$omp parallel do default(none) shared(model, near, p, rubs, table) schedule(dynamic)
      do b = 1, near%n_blocks
         call add_block(model, near, p, b, rubs, table)
      end do
      !$omp end parallel do
      totals = exact_totals(table)
      forces%pressure = merge(totals(:4), 0.0_dp, is_wall(model%box%kind))
      forces%friction = merge(totals(5:), 0.0_dp, model%box%kind == no_slip_wall)
   end subroutine measure_walls

   ! Adds to each group what its particles do to the walls. Images out of reach add exactly 0.
   pure subroutine add_block(model, near, p, b, rubs, table)
      type(model_t), intent(in) :: model
      type(neighbours_t), intent(in) :: near
      type(particles_t), intent(in) :: p
      integer, intent(in) :: b
      logical, intent(in) :: rubs
      real(dp), intent(inout) :: table(:, :)
      real(dp) :: of_one(8), push(2), rub(2)
      integer :: axis, c, i, k, l, side

      associate (block => near%blocks(b), images => near%images)
         do c = 1, block%n_clusters
            do l = 1, nl
               i = block%before + (c - 1)*nl + l
               if (p%id(i) == 0) cycle
               of_one = 0
               do k = block%first_image(c), block%first(c + 1) - 1
                  call act(model, p, rubs, i, block%slot(k), push, rub)
                  do axis = 1, 2
                     side = beyond(axis, images%kind(block%slot(k) - images%n_held))
                     if (side == 0) cycle
                     of_one(side) = of_one(side) + push(axis)
                     of_one(4 + side) = of_one(4 + side) + rub(3 - axis)
                  end do
               end do
               associate (sums => table(:, (i - 1)/group_slots + 1))
                  sums = sums + of_one
               end associate
            end do
         end do
      end associate
   end subroutine add_block

   ! What particle i does to what is beyond the walls by its image j.
   pure subroutine act(model, p, rubs, i, j, push, rub)
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      logical, intent(in) :: rubs
      integer, intent(in) :: i, j
      real(dp), intent(out) :: push(2), rub(2)   ! [N/m] of pressure, of friction
      real(dp) :: way(2), weight, inverse_2, alpha, unused

      rub = 0
      way = [p%base%x(j) - p%base%x(i), p%base%y(j) - p%base%y(i)]
      call pair(way(1), way(2), model%kernel%inverse_support, p%base%volume(j), weight, inverse_2)
      weight = model%kernel%gradient_factor*p%base%volume(i)*weight
      push = model%c0**2*(p%base%s(i) + p%base%s(j))*weight*way
      if (.not. rubs) return
      call mean_coefficients(p%alpha(i), p%alpha(j), 1.0_dp, 1.0_dp, squared_distance(way(1), way(2)), alpha, unused, inverse_2)
      rub = -(model%alpha + alpha)*model%kernel%h*model%c0*model%rho0*(p%jump_u(j)*way(1) + p%jump_v(j)*way(2))*inverse_2 &
            *weight*way
   end subroutine act

end module wall_forces
