!> What the fluid does to solids at the base state: forces, moments and power, per unit width.
!!
!! The force of pressure is that of the ghosts, whose power is exact. Where a solid reaches through a wall under fluid, ghosts
!! beside that wall have a force across it that belongs to no face: that component, and the moment, are then of the pressure on
!! the faces.
module solid_forces
   use box, only: axis_of, box_t, is_wall, way_back
   use exact_sum, only: add_over_processes, exact_sum_t
   use gradient_fields, only: renew_coefficients
   use kinds, only: dp
   use model, only: model_t, terms_t
   use neighbours, only: neighbours_t
   use particles, only: particles_t
   use point_sums, only: at_surface, sum_with_solids
   use polygons, only: edge_normal
   use solid_terms, only: rub_solids
   use solids, only: new_obstacle, obstacle_t, walls_crossed
   implicit none
   private

   public :: solid_force_t, measure_solids

   !> Of one solid.
   type :: solid_force_t
      real(dp) :: pressure(2) = 0   !! [N/m] force of pressure on it
      real(dp) :: friction(2) = 0   !! [N/m] and of friction
      real(dp) :: moment = 0        !! [N] of both about the pivot where it is now, counter-clockwise
      real(dp) :: power = 0         !! [W/m] that both give to the fluid
   end type solid_force_t

   integer, parameter :: n_sums = 12
   integer, parameter :: per_spacing = 2   ! points on a face

contains

   !> Pressure is that of the ghosts. Friction is measured here: since the step that it was frozen in, ghosts may have been sorted.
   subroutine measure_solids(model, box, near, p, forces)
      type(model_t), intent(in) :: model
      type(box_t), intent(in) :: box               !! at the time of the base state
      type(neighbours_t), intent(inout) :: near    !! friction of the ghosts is set
      type(particles_t), intent(inout) :: p        !! coefficients of the dynamic model are set
      type(solid_force_t), intent(out) :: forces(:)   !! (solids)
      type(exact_sum_t) :: sums(n_sums*size(forces))
      type(terms_t) :: has
      type(obstacle_t) :: obstacle
      real(dp) :: totals(n_sums)
      logical :: across(2, size(forces)), through(4)   ! it reaches through a wall across an axis; through a wall
      integer :: k, m

      has = model%terms()
      if (has%rubbing_solids) then
         if (model%dynamic) call renew_coefficients(model, near, p, near_solids=.true.)
         call rub_solids(model, box, near, p)
      end if
      call add_ghosts(model, near, p, sums)
      do k = 1, size(forces)
         obstacle = new_obstacle(model%solids(k), near%ghosts%poses(k), box)
         through = obstacle%reaches_through(box)
         across(:, k) = through([1, 3]) .or. through([2, 4])
         if (any(across(:, k))) call add_faces(model, obstacle, box, near, p, sums(n_sums*(k - 1) + 8:n_sums*k))
      end do
      call add_over_processes(sums)
      do k = 1, size(forces)
         totals = [(sums(n_sums*(k - 1) + m)%value(), m=1, n_sums)]
         across(:, k) = across(:, k) .and. totals(11:12) > 0
         if (any(across(:, k))) totals(5) = totals(10)
         where (across(:, k)) totals(1:2) = totals(8:9)
         forces(k) = solid_force_t(totals(1:2), totals(3:4), totals(5) + totals(6), totals(7))
      end do
   end subroutine measure_solids

   ! Force and moment of the pressure on what of the faces is in the box, by the middle rule; and how many wet points are beside
   ! walls across each axis.
   subroutine add_faces(model, obstacle, box, near, p, sums)
      type(model_t), intent(in) :: model
      type(obstacle_t), intent(in) :: obstacle
      type(box_t), intent(in) :: box
      type(neighbours_t), intent(in) :: near
      type(particles_t), intent(in) :: p
      type(exact_sum_t), intent(inout) :: sums(5)
      real(dp) :: along(2), place(2), force(2), arm(2), volume, pressure
      integer :: edge, k, n, side

      do edge = 1, size(obstacle%is_face)
         if (.not. obstacle%is_face(edge)) cycle
         along = obstacle%outline(:, mod(edge, size(obstacle%is_face)) + 1) - obstacle%outline(:, edge)
         n = max(1, ceiling(per_spacing*norm2(along)/model%dx))
         do k = 1, n
            place = obstacle%outline(:, edge) + along*((k - 0.5_dp)/n)
            arm = place - obstacle%pivot
            place = place + way_back(box, place)
            if (any(walls_crossed(box, place, place))) cycle
            if (.not. near%computes(place(1))) cycle
            call sum_with_solids(model, p, near, place(1), place(2), volume, pressure)
            force = -pressure/max(volume, at_surface)*norm2(along)/n*edge_normal(obstacle%outline, edge)
            call sums(1)%add(force(1))
            call sums(2)%add(force(2))
            call sums(3)%add(arm(1)*force(2) - arm(2)*force(1))
            do side = 1, 4
               if (is_wall(box%kind(side)) .and. volume > 0 .and. abs(place(axis_of(side)) - box%at(side)) < model%kernel%support) &
                  call sums(3 + axis_of(side))%add(1.0_dp)
            end do
         end do
      end do
   end subroutine add_faces

   ! Of the own ghosts of each solid.
   subroutine add_ghosts(model, near, p, sums)
      type(model_t), intent(in) :: model
      type(neighbours_t), intent(in) :: near
      type(particles_t), intent(in) :: p
      type(exact_sum_t), intent(inout) :: sums(:)
      real(dp) :: pivot(2, size(model%solids)), arm(2), parts(7)
      integer :: i, k, m, solid

      do k = 1, size(model%solids)
         pivot(:, k) = model%solids(k)%pivot + near%ghosts%poses(k)%shift
      end do
      associate (ghosts => near%ghosts)
         do k = 1, ghosts%n_slots
            solid = ghosts%solid_of(k)
            if (solid == 0) cycle
            if (.not. near%computes(ghosts%x(k))) cycle
            i = ghosts%before + k
            arm = [p%base%x(i), p%base%y(i)] - ghosts%way(:, k) - pivot(:, solid)
            parts = [ghosts%force(:, k), ghosts%friction(1:2, k), arm(1)*ghosts%force(2, k) - arm(2)*ghosts%force(1, k), &
                     arm(1)*ghosts%friction(2, k) - arm(2)*ghosts%friction(1, k), &
                     ghosts%power(k) - ghosts%friction(3, k)*p%base%u(i) - ghosts%friction(4, k)*p%base%v(i)]
            do m = 1, size(parts)
               call sums(n_sums*(solid - 1) + m)%add(parts(m))
            end do
         end do
      end associate
   end subroutine add_ghosts

end module solid_forces
