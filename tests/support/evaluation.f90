!> One evaluation of all right-hand sides by the code's own procedures, in the order of the particles' numbers.
module evaluation
   use box, only: box_t
   use candidates, only: block_slots
   use communication, only: sums_of_all
   use first_sums, only: first_sums_t, pass_constant, sum_first
   use flow, only: flow_rates, rates_t
   use flow_sums, only: flow_sums_t, sum_flow
   use frozen_terms, only: begin_frozen_terms, complete_frozen_terms
   use image_laws, only: as_gradient
   use images, only: fill_ghosts
   use kinds, only: dp, i8
   use lanes, only: nl
   use model, only: model_t
   use neighbours, only: neighbours_t
   use particles, only: particles_t, state_t
   use patches, only: make_common, points_of, points_t
   use blocks, only: block_t
   implicit none
   private

   public :: evaluation_t, evaluate

   !> Sums with the kernel's factor, and the rates made of them; (n) or (2, n).
   type :: evaluation_t
      type(points_t) :: at                                  !! the state that all this belongs to
      real(dp), allocatable :: divergence(:), force(:, :)   !! by module flow_sums
      real(dp), allocatable :: first_divergence(:), first_force(:, :)   !! by module first_sums
      real(dp), allocatable :: matrix(:, :), density(:, :), density_0(:), kernel(:, :), viscous(:, :), largest_pi(:)
      real(dp), allocatable :: acceleration(:, :), rate(:)  !! inviscid du/dt without gravity, drho/dt
      real(dp), allocatable :: viscosity(:, :)              !! frozen acceleration
      real(dp), allocatable :: gradient(:, :)               !! G
      real(dp), allocatable :: diffusion(:)                 !! frozen density-diffusion rate
      integer :: singular = 0
   end type evaluation_t

contains

   !> Evaluates at the base state.
   subroutine evaluate(model, p, near, found, gradient_box)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      type(neighbours_t), intent(inout) :: near
      type(evaluation_t), intent(out) :: found
      type(box_t), intent(in), optional :: gradient_box     !! for the images' gradients, if not the model's
      type(box_t) :: box
      type(block_t), allocatable :: blocks(:)
      type(state_t) :: next
      integer(i8) :: singular(1)
      integer :: b, l, i0, n

      found%at = points_of(p)
      next = p%next   ! it takes the first stage's rates
      associate (n => p%n)
         allocate (found%divergence(n), found%force(2, n), found%first_divergence(n), found%first_force(2, n), &
                   found%matrix(3, n), found%density(2, n), found%density_0(n), found%kernel(2, n), found%viscous(2, n), &
                   found%largest_pi(n), found%acceleration(2, n), found%rate(n), found%viscosity(2, n), &
                   found%gradient(2, n), found%diffusion(n))
      end associate
      allocate (blocks(near%n_blocks))
      do b = 1, near%n_blocks
         call begin_frozen_terms(model, p, near, b, blocks(b))
         call evaluate_block(model, p, near, b, found)
      end do
      singular = sum(blocks%singular)
      call sums_of_all(1, singular)
      found%singular = int(singular(1))
      box = model%box
      if (present(gradient_box)) box = gradient_box
      call fill_ghosts(near%images, as_gradient(box, 1), p%grad_x)
      call fill_ghosts(near%images, as_gradient(box, 2), p%grad_y)
      do b = 1, near%n_blocks
         i0 = near%blocks(b)%before
         n = nl*near%blocks(b)%n_clusters
         call complete_frozen_terms(model, p, near, b, blocks(b))
         do l = 1, n
            if (p%id(i0 + l) > 0) found%diffusion(p%id(i0 + l)) = p%diff_s(i0 + l)
         end do
      end do
      p%next = next
      call tell_each_other(p, found)
   end subroutine evaluate

   ! What each process has found of its particles.
   subroutine tell_each_other(p, found)
      type(particles_t), intent(in) :: p
      type(evaluation_t), intent(inout) :: found
      logical :: known(p%n)
      integer :: i, k

      known = .false.
      do i = 1, p%n_own
         if (p%id(i) > 0) known(p%id(i)) = .true.
      end do
      call make_common(known, found%divergence)
      call make_common(known, found%first_divergence)
      call make_common(known, found%density_0)
      call make_common(known, found%largest_pi)
      call make_common(known, found%rate)
      call make_common(known, found%diffusion)
      do k = 1, 2
         call make_common(known, found%force(k, :))
         call make_common(known, found%first_force(k, :))
         call make_common(known, found%density(k, :))
         call make_common(known, found%kernel(k, :))
         call make_common(known, found%viscous(k, :))
         call make_common(known, found%acceleration(k, :))
         call make_common(known, found%viscosity(k, :))
         call make_common(known, found%gradient(k, :))
      end do
      do k = 1, 3
         call make_common(known, found%matrix(k, :))
      end do
   end subroutine tell_each_other

   ! All that needs no gradient of a neighbour; the frozen terms of the block have begun.
   subroutine evaluate_block(model, p, near, b, found)
      type(model_t), intent(in) :: model
      type(particles_t), intent(inout) :: p
      type(neighbours_t), intent(in) :: near
      integer, intent(in) :: b                !! number of the block
      type(evaluation_t), intent(inout) :: found
      type(first_sums_t) :: sums
      type(flow_sums_t) :: flow
      type(rates_t) :: rates
      integer :: i, i0, l, n

      i0 = near%blocks(b)%before
      n = nl*near%blocks(b)%n_clusters
      call sum_first(pass_constant, model%kernel, near%blocks(b), p, near%images%source, i0, sums)
      call sum_flow(model%kernel, near%blocks(b), p%base, i0, flow)
      call flow_rates(model, p%base, i0, n, flow, rates)
      associate (f => model%kernel%gradient_factor)
         do l = 1, n
            i = p%id(i0 + l)
            if (i == 0) cycle
            found%divergence(i) = f*flow%divergence(l)
            found%force(:, i) = f*[flow%force_x(l), flow%force_y(l)]
            found%first_divergence(i) = f*sums%divergence(l)
            found%first_force(:, i) = f*[sums%force_x(l), sums%force_y(l)]
            found%matrix(:, i) = f*[sums%matrix_xx(l), sums%matrix_xy(l), sums%matrix_yy(l)]
            found%density(:, i) = f*[sums%density_x(l), sums%density_y(l)]
            found%density_0(i) = f*sums%density_0(l)
            found%kernel(:, i) = f*[sums%kernel_x(l), sums%kernel_y(l)]
            found%viscous(:, i) = f*[sums%viscous_x(l), sums%viscous_y(l)]
            found%largest_pi(i) = sums%largest_pi(l)
            found%acceleration(:, i) = [rates%u(l), rates%v(l)]
            found%rate(i) = rates%s(l)
            found%viscosity(:, i) = [p%visc_x(i0 + l), p%visc_y(i0 + l)]
            found%gradient(:, i) = [p%grad_x(i0 + l), p%grad_y(i0 + l)]
         end do
      end associate
   end subroutine evaluate_block

end module evaluation
