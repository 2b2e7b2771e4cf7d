!> Vorticity, rate of strain and eddy coefficients of the base state, measured only where something asks for them.
!!
!! Source: eqs. 21-23, 25 and 29 of the paper. The renormalised velocity gradient
!! du_a/dx_b = sum_j (u_j - u_i)_a (L_i grad W)_b V_j is exact for velocities linear in x and y; particles whose
!! matrix L is singular have none.
module gradient_fields
   use communication, only: largest_of_all
   use eddy, only: eddy_coefficients, strain_rate, velocity_gradient, velocity_gradient_t
   use exact_sum, only: exact_totals
   use first_sums, only: first_sums_t, pass_dynamic, sum_first
   use image_laws, only: as_scalar
   use images, only: fill_ghosts
   use kinds, only: dp
   use lanes, only: nl
   use model, only: model_t
   use neighbours, only: neighbours_t
   use no_slip_sums, only: sum_jump_gradient
   use particles, only: particles_t
   use renormalisation, only: matrices_t, renormalise
   use solid_friction, only: reflected_sums_t, sum_solid_friction
   use solid_terms, only: add_solid_strain
   use strips, only: group_slots
   implicit none
   private

   public :: gradient_fields_t, measure_gradients, gradient_numbers_t, extent_t, sum_up, renew_coefficients

   !> What follows from the velocity gradient, for every own slot.
   type :: gradient_fields_t
      real(dp), allocatable :: vorticity(:)   !! (n_own) dv/dx - du/dy
      real(dp), allocatable :: strain(:)      !! (n_own) ||D|| = sqrt(2 D:D)
   end type gradient_fields_t

   !> Of a quantity over the particles.
   type :: extent_t
      real(dp) :: least = 0, mean = 0, largest = 0
   end type extent_t

   !> Numbers of a state that follow from its gradients.
   type :: gradient_numbers_t
      real(dp) :: enstrophy = 0         !! int vorticity**2 dA
      type(extent_t) :: alpha, delta    !! alpha_i and delta_i of the dynamic model
   end type gradient_numbers_t

contains

   !> One pass over all pairs, or over those of blocks near solids.
   subroutine measure_gradients(model, p, near, fields, near_solids)
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      type(neighbours_t), intent(in) :: near   !! of the base state
      type(gradient_fields_t), intent(out) :: fields
      logical, intent(in), optional :: near_solids   !! there only: elsewhere the fields are not set
      type(first_sums_t) :: sums
      logical :: all_blocks
      integer :: b

      all_blocks = .true.
      if (present(near_solids)) all_blocks = .not. near_solids

      allocate (fields%vorticity(p%n_own), fields%strain(p%n_own))
      !$omp parallel do default(none) shared(model, p, near, fields, all_blocks) private(sums) schedule(dynamic)
      do b = 1, near%n_blocks
         if (.not. (all_blocks .or. near%ghosts%are_near(b))) cycle
         associate (block => near%blocks(b), i0 => near%blocks(b)%before)
            call sum_first(pass_dynamic, model%kernel, block, p, near%images%source, i0, sums)
            if (p%features%no_slip) call sum_jump_gradient(model%kernel, block, p, i0, sums)
            call take_fields(model%kernel%gradient_factor, sums, nl*block%n_clusters, fields%vorticity(i0 + 1:), &
                             fields%strain(i0 + 1:))
            if (near%ghosts%are_near(b)) call take_strain(model, near, b, p, sums, fields%strain(i0 + 1:))
         end associate
      end do
      !$omp end parallel do
   end subroutine measure_gradients

   ! Of a block from its sums.
   pure subroutine take_fields(factor, sums, n, vorticity, strain)
      real(dp), intent(in) :: factor            !! of the kernel's gradient
      type(first_sums_t), intent(in) :: sums
      integer, intent(in) :: n                  !! slots
      real(dp), intent(inout) :: vorticity(n), strain(n)
      type(velocity_gradient_t) :: gradient
      real(dp) :: l_xx, l_xy, l_yy, regular
      integer :: k

      do k = 1, n
         call renormalise(factor, sums%matrix_xx(k), sums%matrix_xy(k), sums%matrix_yy(k), l_xx, l_xy, l_yy, regular)
         gradient = velocity_gradient(factor, sums, k, l_xx, l_xy, l_yy)
         vorticity(k) = gradient%v_x - gradient%u_y
         strain(k) = strain_rate(gradient)
      end do
   end subroutine take_fields

   ! Near solids the rate of strain sees what these reflect.
   pure subroutine take_strain(model, near, b, p, sums, strain)
      type(model_t), intent(in) :: model
      type(neighbours_t), intent(in) :: near
      integer, intent(in) :: b                    ! number of the block
      type(particles_t), intent(in) :: p
      type(first_sums_t), intent(inout) :: sums   ! of the fluid; the velocity gradient changes
      real(dp), intent(inout) :: strain(:)        ! from the block's first slot on
      type(reflected_sums_t) :: reflected
      type(matrices_t) :: l
      integer :: k

      call sum_solid_friction(model%kernel, near%ghosts, b, p%base, reflected)
      call add_solid_strain(model, nl*near%blocks(b)%n_clusters, reflected, sums, l)
      do k = 1, nl*near%blocks(b)%n_clusters
         strain(k) = strain_rate(velocity_gradient(model%kernel%gradient_factor, sums, k, l%xx(k), l%xy(k), l%yy(k)))
      end do
   end subroutine take_strain

   !> alpha_i and delta_i of the dynamic model at the base state, of all slots, or of those in blocks near solids: those of the last
   !! step are of another one.
   subroutine renew_coefficients(model, near, p, near_solids)
      type(model_t), intent(in) :: model
      type(neighbours_t), intent(inout) :: near   !! of the base state
      type(particles_t), intent(inout) :: p       !! alpha and delta are set
      logical, intent(in) :: near_solids
      type(gradient_fields_t) :: fields
      integer :: b

      call measure_gradients(model, p, near, fields, near_solids)
      do b = 1, near%n_blocks
         if (near_solids .and. .not. near%ghosts%are_near(b)) cycle
         associate (i1 => near%blocks(b)%before + 1, i2 => near%blocks(b)%before + nl*near%blocks(b)%n_clusters)
            call eddy_coefficients(model, fields%strain(i1:i2), p%alpha(i1:i2), p%delta(i1:i2))
         end associate
      end do
      call fill_ghosts(near%images, as_scalar, p%alpha)
      call fill_ghosts(near%images, as_scalar, p%delta)
   end subroutine renew_coefficients

   !> Sums and extremes over the particles: exact sums over groups of slots, so that nothing but the particles matters.
   subroutine sum_up(model, p, fields, numbers)
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      type(gradient_fields_t), intent(in) :: fields
      type(gradient_numbers_t), intent(out) :: numbers
      real(dp), allocatable :: table(:, :)   ! of each group
      real(dp) :: extremes(4), totals(3), least(2), largest(2), coefficients(2)   ! of alpha_i and delta_i
      integer :: g, i, n_groups

      n_groups = p%n_own/group_slots
      allocate (table(3, n_groups), source=0.0_dp)
      least = huge(1.0_dp)
      largest = 0
      !$omp parallel do default(none) shared(model, p, fields, table, n_groups) private(i, coefficients) &
      !$omp reduction(min:least) reduction(max:largest)
      do g = 1, n_groups
         do i = (g - 1)*group_slots + 1, g*group_slots
            if (p%id(i) == 0) cycle
            call eddy_coefficients(model, fields%strain(i), coefficients(1), coefficients(2))
            table(:, g) = table(:, g) + [fields%vorticity(i)**2*p%base%volume(i), coefficients]
            least = min(least, coefficients)
            largest = max(largest, coefficients)
         end do
      end do
      !$omp end parallel do
      totals = exact_totals(table)
      extremes = [-least, largest]
      call largest_of_all(4, extremes)
      least = -extremes(1:2)
      largest = extremes(3:4)
      numbers%enstrophy = totals(1)
      numbers%alpha = extent_t(least(1), totals(2)/p%n, largest(1))
      numbers%delta = extent_t(least(2), totals(3)/p%n, largest(2))
   end subroutine sum_up

end module gradient_fields
