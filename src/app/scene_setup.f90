!> From the input to the model's constants and the particles at t = 0.
module scene_setup
   use body_particles, only: sites_t
   use box, only: bottom_wall, box_t, free_slip_wall, left_wall, no_slip_wall, open_side, periodic_side, right_wall, top_wall
   use communication, only: n_processes, this_process
   use equation_of_state, only: excess_density
   use errors, only: exit_input, failure
   use initial_pressure, only: pressure_at
   use integrators, only: new_integrator
   use kernel, only: k_2d, new_kernel
   use kinds, only: dp
   use linear_stability, only: margins_t, new_stability
   use model, only: model_t, terms_t
   use number_order, only: first_number
   use open_sites, only: count_open
   use particles, only: allocate_particles, features_t, particles_t
   use resting_fluid, only: held_force
   use settings, only: is_wall, settings_t
   use settled_sites, only: place_settled
   use solution, only: solution_t
   use solution_register, only: new_solution
   use solid_outlines, only: body_of, motion_of, solid_outline
   use solids, only: obstacle_t, obstacles_in, solid_t
   use sponges, only: sponge_t
   use square_lattice, only: lattice_crowd
   implicit none
   private

   public :: set_up_model, set_up_particles, count_particles, check_fluid, needed_features

contains

   !> The constants in paper symbols.
   pure type(model_t) function set_up_model(scene, margins) result(model)
      type(settings_t), intent(in) :: scene   !! checked input
      type(margins_t), intent(in), optional :: margins   !! of the step rule, other than the safe ones

      model%dx = scene%spacing()
      model%kernel = new_kernel(scene%smoothing_length())
      model%lattice_crowd = model%dx**2*lattice_crowd(scene%model%smoothing_ratio)
      model%c0 = scene%fluid%sound_speed
      model%rho0 = scene%fluid%density
      model%gravity = scene%fluid%gravity
      model%alpha = scene%alpha_total()
      model%acceleration = scene%force%acceleration
      model%central_rate = scene%force%central_rate
      model%tank = motion_of(scene%tank)
      model%tank_pivot = scene%tank%pivot
      model%centre = scene%force%centre
      model%viscosity = scene%fluid%viscosity
      model%box = set_up_box(scene)
      model%held_axes = merge(0.0_dp, 1.0_dp, [scene%domain%left, scene%domain%bottom] == 'periodic')
      if (allocated(scene%solids)) then
         allocate (model%solids(size(scene%solids)))
         model%solids(:) = set_up_solids(scene)
      end if
      if (has_sponges(scene)) model%sponges = set_up_sponges(scene)
      model%dynamic = scene%model%diffusion == 'dynamic'
      if (model%dynamic) then
         call set_up_dynamic(scene, model)
      else
         model%delta = scene%model%delta
      end if
      model%integrator = new_integrator(scene%time%integrator)
      model%frozen = scene%time%diffusion == 'frozen'
      model%stability = new_stability(model%integrator, model%frozen, scene%model%smoothing_ratio, &
                                      model%delta, model%alpha, margins)
      ! Eq. 8 shortens steps by a factor: it must start from what is stable.
      model%cfl = min(scene%time%cfl, model%stability%sound)
   end function set_up_model

   ! Eqs. 19-26: nu_T = (C_S l)**2 ||D||, alpha_i = K nu_T/(c0 h), nu_delta = (C_delta l)**2 ||D||,
   ! delta_i = nu_delta/(c0 h), with the filter length l = 2h.
   pure subroutine set_up_dynamic(scene, model)
      type(settings_t), intent(in) :: scene
      type(model_t), intent(inout) :: model

      associate (h => model%kernel%h, c0 => model%c0, input => scene%model)
         model%alpha_per_strain = k_2d*(input%c_s*2*h)**2/(c0*h)
         model%delta_per_strain = (input%c_delta*2*h)**2/(c0*h)
         model%limit = input%limit
         if (input%limiter == 'strain_rate') &
            model%largest_strain = input%limit/max(model%alpha_per_strain, model%delta_per_strain, tiny(1.0_dp))
      end associate
   end subroutine set_up_dynamic

   pure type(box_t) function set_up_box(scene) result(box)
      type(settings_t), intent(in) :: scene

      associate (domain => scene%domain, fluid => scene%fluid)
         box%kind = kind_of_side([domain%left, domain%right, domain%bottom, domain%top])
         box%at = [domain%lower(1), domain%upper(1), domain%lower(2), domain%upper(2)]
         box%velocity(2, [left_wall, right_wall]) = domain%wall_speeds([left_wall, right_wall])
         box%velocity(1, [bottom_wall, top_wall]) = domain%wall_speeds([bottom_wall, top_wall])
         if (domain%images == 'hydrostatic') box%density_slope = fluid%density/fluid%sound_speed**2*held_force(scene)
      end associate
   end function set_up_box

   pure function set_up_solids(scene) result(solids)
      type(settings_t), intent(in) :: scene
      type(solid_t) :: solids(size(scene%solids))
      real(dp), parameter :: degree = acos(-1.0_dp)/180
      integer :: k

      do k = 1, size(solids)
         associate (input => scene%solids(k))
            solids(k)%outline = solid_outline(scene, input)
            solids(k)%pivot = input%pivot
            solids(k)%angle = degree*input%angle
            solids(k)%no_slip = input%surface == 'no_slip'
            solids(k)%motion = motion_of(input)
            solids(k)%body = body_of(input)
         end associate
      end do
   end function set_up_solids

   pure logical function has_sponges(scene)
      type(settings_t), intent(in) :: scene

      has_sponges = .false.
      if (allocated(scene%sponges)) has_sponges = size(scene%sponges) > 0
   end function has_sponges

   pure function set_up_sponges(scene) result(sponges)
      type(settings_t), intent(in) :: scene
      type(sponge_t) :: sponges(size(scene%sponges))
      integer :: k

      do k = 1, size(sponges)
         associate (input => scene%sponges(k))
            sponges(k) = sponge_t(input%lower, input%upper, input%rate, input%towards == 'left')
         end associate
      end do
   end function set_up_sponges

   ! The solids where they are at t = 0.
   pure function obstacles_of(scene) result(obstacles)
      type(settings_t), intent(in) :: scene
      type(obstacle_t), allocatable :: obstacles(:)
      type(solid_t) :: solids(size(scene%solids))

      solids = set_up_solids(scene)
      obstacles = obstacles_in(solids, solids%motion%at(0.0_dp), set_up_box(scene))
   end function obstacles_of

   ! Of the input's words.
   elemental integer function kind_of_side(word) result(kind)
      character(*), intent(in) :: word

      select case (word)
      case ('free_slip')
         kind = free_slip_wall
      case ('no_slip')
         kind = no_slip_wall
      case ('periodic')
         kind = periodic_side
      case default
         kind = open_side
      end select
   end function kind_of_side

   !> What the scene's particles carry.
   pure type(features_t) function needed_features(scene, model) result(features)
      type(settings_t), intent(in) :: scene
      type(model_t), intent(in) :: model   !! of the scene
      type(terms_t) :: has

      has = model%terms()
      features = features_t(viscosity=has%viscosity, diffusion=has%diffusion, eddy=has%eddies, no_slip=has%no_slip, &
                            dissipation=any(scene%output%fields(:scene%output%n_fields) == 'dissipation'))
   end function needed_features

   !> Particles of the whole scene: what solids cover has none.
   pure integer function count_particles(scene) result(n)
      type(settings_t), intent(in) :: scene
      integer :: k

      n = 0
      do k = 1, size(scene%bodies)
         n = n + count_open(scene%bodies(k), scene%spacing(), obstacles_of(scene))
      end do
   end function count_particles

   !> Raises exit_input where solids leave no fluid.
   subroutine check_fluid(scene, problem)
      type(settings_t), intent(in) :: scene
      type(failure), intent(inout) :: problem

      if (count_particles(scene) > 0) return
      call problem%raise(exit_input, 'no fluid is left: the solids cover each &body; move one of them')
   end subroutine check_fluid

   !> Fills each body with particles.
   !!
   !! The state is left in `next`, from where the first step takes it. The mass is rho times the area that a particle has.
   subroutine set_up_particles(scene, model, p)
      type(settings_t), intent(in) :: scene
      type(model_t), intent(in) :: model
      type(particles_t), intent(out) :: p
      class(solution_t), allocatable :: solution
      type(sites_t) :: sites
      integer :: k, i, slot, before, span(2)
      real(dp) :: position(2), velocity(2), pressure

      call allocate_particles(p, count_particles(scene)/n_processes() + 1, needed_features(scene, model))
      p%n = count_particles(scene)
      call new_solution(scene, model, solution)
      ! Each process begins with a part of the numbers.
      span = [first_number(this_process(), p%n), first_number(this_process() + 1, p%n) - 1]
      slot = 0
      before = 0
      do k = 1, size(scene%bodies)
         associate (body => scene%bodies(k), last => count_open(scene%bodies(k), model%dx, obstacles_of(scene)))
            call place_settled(body, model%dx, model%kernel, set_up_solids(scene), obstacles_of(scene), max(1, span(1) - before), &
                               min(last, span(2) - before), sites)
            do i = lbound(sites%x, 1), ubound(sites%x, 1)
               slot = slot + 1
               position = [sites%x(i), sites%y(i)]
               velocity = body%velocity
               if (body%flow == 'exact') velocity = solution%velocity(position)
               pressure = pressure_at(scene, k, position)
               if (body%pressure == 'exact') pressure = solution%pressure(position)
               p%id(slot) = before + i
               p%next%x(slot) = position(1)
               p%next%y(slot) = position(2)
               p%next%u(slot) = velocity(1)
               p%next%v(slot) = velocity(2)
               p%next%s(slot) = excess_density(model%c0, pressure)
               p%next%volume(slot) = sites%area(i)
               p%m(slot) = (model%rho0 + p%next%s(slot))*sites%area(i)
            end do
            before = before + last
         end associate
      end do
      p%n_own = slot
      p%n_held = slot
   end subroutine set_up_particles

end module scene_setup
