!> Vorticity, rate of strain and eddy coefficients of the base state, measured only where something asks for them.
!!
!! Source: eqs. 21-23, 25 and 29 of the paper. The renormalised velocity gradient
!! du_a/dx_b = sum_j (u_j - u_i)_a (L_i grad W)_b V_j is exact for velocities linear in x and y; particles whose
!! matrix L is singular have none.
module gradient_fields
   use eddy, only: eddy_coefficients, strain_rate, velocity_gradient, velocity_gradient_t
   use first_sums, only: first_sums_t, pass_dynamic, sum_first
   use kinds, only: dp
   use lanes, only: nl
   use model, only: model_t
   use neighbours, only: neighbours_t
   use no_slip_sums, only: sum_jump_gradient
   use particles, only: particles_t
   use renormalisation, only: renormalise
   implicit none
   private

   public :: gradient_fields_t, measure_gradients, gradient_numbers_t, extent_t, sum_up

   integer, parameter :: sum_slots = 512   !! slots that a partial sum goes over, so that threads don't matter

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

   !> One pass over all pairs.
   subroutine measure_gradients(model, p, near, fields)
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      type(neighbours_t), intent(in) :: near   !! of the base state
      type(gradient_fields_t), intent(out) :: fields
      type(first_sums_t) :: sums
      integer :: b

      allocate (fields%vorticity(p%n_own), fields%strain(p%n_own))
      !$omp parallel do default(none) shared(model, p, near, fields) private(sums) schedule(dynamic)
      do b = 1, near%n_blocks
         associate (block => near%blocks(b), i0 => near%blocks(b)%before)
            call sum_first(pass_dynamic, model%kernel, block, p, near%images%source, i0, sums)
            if (p%features%no_slip) call sum_jump_gradient(model%kernel, block, p, i0, sums)
            call take_fields(model%kernel%gradient_factor, sums, nl*block%n_clusters, fields%vorticity(i0 + 1:), &
                             fields%strain(i0 + 1:))
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

   !> Sums and extremes over the particles, the same for any number of threads.
   subroutine sum_up(model, p, fields, numbers)
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      type(gradient_fields_t), intent(in) :: fields
      type(gradient_numbers_t), intent(out) :: numbers
      type(gradient_numbers_t), allocatable :: blocks(:)
      integer :: b, n_blocks

      n_blocks = (p%n_own + sum_slots - 1)/sum_slots
      allocate (blocks(n_blocks))
      !$omp parallel do default(none) shared(model, p, fields, blocks, n_blocks)
      do b = 1, n_blocks
         call sum_block(model, p, fields, (b - 1)*sum_slots + 1, min(b*sum_slots, p%n_own), blocks(b))
      end do
      !$omp end parallel do
      numbers%enstrophy = sum(blocks%enstrophy)
      numbers%alpha = extent_t(minval(blocks%alpha%least), sum(blocks%alpha%mean)/p%n, maxval(blocks%alpha%largest))
      numbers%delta = extent_t(minval(blocks%delta%least), sum(blocks%delta%mean)/p%n, maxval(blocks%delta%largest))
   end subroutine sum_up

   ! Of the slots first to last; the means are still sums.
   pure subroutine sum_block(model, p, fields, first, last, block)
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      type(gradient_fields_t), intent(in) :: fields
      integer, intent(in) :: first, last
      type(gradient_numbers_t), intent(out) :: block
      real(dp) :: alpha, delta
      integer :: i

      block%alpha%least = huge(1.0_dp)
      block%delta%least = huge(1.0_dp)
      do i = first, last
         if (p%id(i) == 0) cycle
         block%enstrophy = block%enstrophy + fields%vorticity(i)**2*p%base%volume(i)
         call eddy_coefficients(model, fields%strain(i), alpha, delta)
         call include_value(block%alpha, alpha)
         call include_value(block%delta, delta)
      end do
   end subroutine sum_block

   pure subroutine include_value(extent, value)
      type(extent_t), intent(inout) :: extent
      real(dp), intent(in) :: value

      extent%least = min(extent%least, value)
      extent%mean = extent%mean + value
      extent%largest = max(extent%largest, value)
   end subroutine include_value

end module gradient_fields
