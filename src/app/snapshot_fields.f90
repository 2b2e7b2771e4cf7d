!> The arrays of a snapshot, by their names in &output fields.
module snapshot_fields
   use eddy, only: eddy_coefficients
   use equation_of_state, only: pressure_of
   use gradient_fields, only: gradient_fields_t, measure_gradients
   use kinds, only: dp
   use model, only: model_t
   use neighbours, only: neighbours_t
   use number_order, only: number_order_t
   use particles, only: particles_t
   use snapshot, only: snapshot_field
   implicit none
   private

   public :: fill_fields

contains

   !> Fills the fields named, in the order of the particles' numbers.
   subroutine fill_fields(names, model, p, near, order, fields)
      character(*), intent(in) :: names(:)
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      type(neighbours_t), intent(in) :: near
      type(number_order_t), intent(in) :: order   !! of the particles
      type(snapshot_field), allocatable, intent(out) :: fields(:)   !! one for each name
      type(gradient_fields_t) :: gradients
      integer :: k

      allocate (fields(size(names)))
      if (need_gradients(names, model)) call measure_gradients(model, p, near, gradients)
      do k = 1, size(names)
         fields(k)%name = trim(names(k))
         select case (names(k))
         case ('vorticity')
            fields(k)%unit = '1/time'
            fields(k)%long_name = 'vorticity dv/dx - du/dy'
            fields(k)%values = order%sorted(gradients%vorticity)
         case ('alpha', 'delta')
            call fill_coefficient(fields(k), model, gradients, order)
         case default
            call fill_state(fields(k), model, p, order)
         end select
      end do
   end subroutine fill_fields

   ! Whether a field takes the pass over all pairs.
   pure logical function need_gradients(names, model)
      character(*), intent(in) :: names(:)
      type(model_t), intent(in) :: model

      need_gradients = any(names == 'vorticity') .or. (model%dynamic .and. any(names == 'alpha' .or. names == 'delta'))
   end function need_gradients

   ! A field that is there with the particles.
   subroutine fill_state(field, model, p, order)
      type(snapshot_field), intent(inout) :: field   !! its name is set
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      type(number_order_t), intent(in) :: order

      select case (field%name)
      case ('velocity')
         field%unit = 'length/time'
         field%long_name = 'velocity of the particle'
         allocate (field%vectors(order%last - order%first + 1, 2))
         field%vectors(:, 1) = order%sorted(p%base%u)
         field%vectors(:, 2) = order%sorted(p%base%v)
      case ('pressure')
         field%unit = 'mass/(length time^2)'
         field%long_name = 'pressure, c0^2 (rho - rho0)'
         field%values = pressure_of(model%c0, order%sorted(p%base%s))
      case ('density')
         field%unit = 'mass/length^3'
         field%long_name = 'density'
         field%values = model%rho0 + order%sorted(p%base%s)
      case ('dissipation')
         field%unit = 'energy/width'
         field%long_name = 'energy dissipated by the particle since the start'
         field%values = order%sorted(p%dissipated)
      end select
   end subroutine fill_state

   ! alpha_i or delta_i; of constant coefficients the one that acts everywhere.
   subroutine fill_coefficient(field, model, gradients, order)
      type(snapshot_field), intent(inout) :: field   !! its name is set
      type(model_t), intent(in) :: model
      type(gradient_fields_t), intent(in) :: gradients   !! measured if the model is dynamic
      type(number_order_t), intent(in) :: order
      real(dp), allocatable :: alpha(:), delta(:)

      field%unit = '-'
      allocate (alpha(order%last - order%first + 1), source=model%alpha)
      allocate (delta(size(alpha)), source=model%delta)
      if (model%dynamic) call eddy_coefficients(model, order%sorted(gradients%strain), alpha, delta)
      if (field%name == 'alpha') then
         field%long_name = 'coefficient of the viscous term, viscosity included'
         if (model%dynamic) field%long_name = 'alpha_i of the dynamic model, viscosity not included'
         call move_alloc(alpha, field%values)
      else
         field%long_name = 'coefficient of the density diffusion'
         if (model%dynamic) field%long_name = 'delta_i of the dynamic model'
         call move_alloc(delta, field%values)
      end if
   end subroutine fill_coefficient

end module snapshot_fields
