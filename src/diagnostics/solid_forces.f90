!> What the fluid does to solids at the base state: forces, moments and power, per unit width.
module solid_forces
   use box, only: box_t
   use exact_sum, only: add_over_processes, exact_sum_t
   use gradient_fields, only: renew_coefficients
   use kinds, only: dp
   use model, only: model_t, terms_t
   use motions, only: pose_t
   use neighbours, only: neighbours_t
   use particles, only: particles_t
   use solid_terms, only: rub_solids
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

   integer, parameter :: n_sums = 6

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
      real(dp) :: totals(n_sums)
      integer :: k, m

      has = model%terms()
      if (has%sticky_solids .and. has%viscosity) then
         if (model%dynamic) call renew_coefficients(model, near, p)
         call rub_solids(model, box, near, p)
      end if
      call add_ghosts(model, box, near, p, sums)
      call add_over_processes(sums)
      do k = 1, size(forces)
         totals = [(sums(n_sums*(k - 1) + m)%value(), m=1, n_sums)]
         forces(k) = solid_force_t(totals(1:2), totals(3:4), totals(5), totals(6))
      end do
   end subroutine measure_solids

   ! Of the own ghosts of each solid.
   subroutine add_ghosts(model, box, near, p, sums)
      type(model_t), intent(in) :: model
      type(box_t), intent(in) :: box
      type(neighbours_t), intent(in) :: near
      type(particles_t), intent(in) :: p
      type(exact_sum_t), intent(inout) :: sums(:)
      real(dp) :: pivot(2, size(model%solids)), arm(2), force(2), parts(n_sums)
      type(pose_t) :: pose
      integer :: i, k, m, solid

      do k = 1, size(model%solids)
         pose = model%solids(k)%motion%at(box%time)
         pivot(:, k) = model%solids(k)%pivot + pose%shift
      end do
      associate (ghosts => near%ghosts)
         do k = 1, ghosts%n_slots
            solid = ghosts%solid_of(k)
            if (solid == 0) cycle
            if (.not. near%computes(ghosts%x(k))) cycle
            i = ghosts%before + k
            arm = [p%base%x(i), p%base%y(i)] - pivot(:, solid)
            force = ghosts%force(:, k) + ghosts%friction(1:2, k)
            parts = [ghosts%force(:, k), ghosts%friction(1:2, k), arm(1)*force(2) - arm(2)*force(1), &
                     ghosts%power(k) - ghosts%friction(3, k)*p%base%u(i) - ghosts%friction(4, k)*p%base%v(i)]
            do m = 1, n_sums
               call sums(n_sums*(solid - 1) + m)%add(parts(m))
            end do
         end do
      end associate
   end subroutine add_ghosts

end module solid_forces
