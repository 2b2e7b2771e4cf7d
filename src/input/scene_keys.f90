!> The one description of all input keys: name, default, range, unit, meaning.
!!
!! A key's default is the initial value of its component in module `settings`.
module scene_keys
   use integrators, only: integrator_names
   use key_visitor, only: above, any_number, at_least, between, key_visitor_t
   use kinds, only: dp
   use known_solutions, only: known_solutions_t
   use settings, only: body_settings, choice_length, domain_settings, exact_settings, fluid_settings, force_settings, &
                       gauge_settings, model_settings, name_length, output_settings, probe_settings, scene_settings, &
                       settings_t, time_settings
   implicit none
   private

   public :: visit_keys

   !> Least and largest d/dx: coarser has no meaning, finer surely is a slip.
   real(dp), parameter, public :: resolution_range(2) = [4.0_dp, 20000.0_dp]

   !> Largest Mach number that still may be called weakly compressible.
   real(dp), parameter, public :: largest_mach = 0.5_dp

   character(*), parameter :: side_choices(*) = [character(choice_length) :: 'free_slip', 'no_slip', 'periodic', 'open']

   !> What snapshots can hold.
   character(name_length), parameter :: field_names(*) = &
      [character(name_length) :: 'velocity', 'pressure', 'density', 'vorticity', 'alpha', 'delta', 'dissipation']

contains

   !> Shows all groups and keys to a visitor, which may change their values.
   subroutine visit_keys(keys, solutions, setup)
      class(key_visitor_t), intent(inout) :: keys
      class(known_solutions_t), intent(in) :: solutions
      type(settings_t), intent(inout) :: setup   !! bodies, probes and gauges are allocated: one visit each

      integer :: i

      call keys%announce('scene', 'What the scene is called and how fine it is.', .true., .false.)
      call visit_scene(keys, setup%scene)
      call keys%announce('domain', 'The box the fluid moves in; its sides are walls or open.', .true., .false.)
      call visit_domain(keys, setup%domain, with_force=setup%fluid%gravity > 0.0_dp .or. setup%has_acceleration())
      call keys%announce('fluid', "The fluid's constants. Give mach and reference_speed, or sound_speed.", .true., .false.)
      call visit_fluid(keys, setup%fluid)
      call keys%announce('force', 'What acts on the fluid besides gravity.', .false., .false.)
      call visit_force(keys, setup%force)
      call keys%announce('body', 'A block of fluid at the start.', .true., .true.)
      do i = 1, size(setup%bodies)
         call visit_body(keys, setup%bodies(i), i)
      end do
      call keys%announce('model', 'The diffusive terms.', .false., .false.)
      call visit_model(keys, setup%model)
      call keys%announce('exact', 'The exact solution that the scene follows; errors are written to errors.dat.', .false., .false.)
      call visit_exact(keys, solutions, setup%exact)
      call keys%announce('time', 'The time step and the end of the run.', .true., .false.)
      call visit_time(keys, setup%time)
      call keys%announce('output', "What is written and how often: '10 steps', '0.05 time' or 'never'.", .false., .false.)
      call visit_output(keys, setup%output, with_probes=size(setup%probes) + size(setup%gauges) > 0, &
                        with_exact=setup%exact%solution /= 'none')
      call keys%announce('probe', 'A pressure sensor on a wall.', .false., .true.)
      do i = 1, size(setup%probes)
         call visit_probe(keys, setup%probes(i), i)
      end do
      call keys%announce('gauge', 'A line through the box, on which the end of the fluid is looked for.', .false., .true.)
      do i = 1, size(setup%gauges)
         call visit_gauge(keys, setup%gauges(i), i)
      end do
   end subroutine visit_keys

   !> Keys of &scene.
   subroutine visit_scene(keys, scene)
      class(key_visitor_t), intent(inout) :: keys
      type(scene_settings), intent(inout) :: scene

      call keys%enter('scene', 1)
      call keys%text_key('title', scene%title, 'What the run calls itself in its output.')
      call keys%real_key('reference_length', scene%reference_length, above(0.0_dp), 'm', &
                         'Depth d that the resolution refers to.')
      call keys%real_key('resolution', scene%resolution, between(resolution_range(1), resolution_range(2)), '-', &
                         'Particles per reference length, d/dx.', required=.true.)
      call keys%leave()
   end subroutine visit_scene

   !> Keys of &domain.
   subroutine visit_domain(keys, domain, with_force)
      class(key_visitor_t), intent(inout) :: keys
      type(domain_settings), intent(inout) :: domain
      logical, intent(in) :: with_force   !! something makes hydrostatic pressure; not known yet when read

      call keys%enter('domain', 1)
      call keys%vector_key('lower', domain%lower, any_number(), 'm', 'Lower left corner of the box, x and y.')
      call keys%vector_key('upper', domain%upper, any_number(), 'm', &
                           'Upper right corner; need not be a multiple of dx.', required=.true.)
      call keys%choice_key('left', domain%left, side_choices, 'What the side at the least x is.')
      call keys%choice_key('right', domain%right, side_choices, 'What the side at the largest x is.')
      call keys%choice_key('bottom', domain%bottom, side_choices, 'What the side at the least y is.')
      call keys%choice_key('top', domain%top, side_choices, 'What the side at the largest y is.')
      call keys%vector_key('wall_speeds', domain%wall_speeds, any_number(), 'm/s', &
                           'Speeds of the no-slip sides left, right, bottom and top, along themselves.')
      call keys%only_with('gravity or acceleration', with_force)
      call keys%choice_key('images', domain%images, [character(choice_length) :: 'hydrostatic', 'mirror'], &
                           'Density of the mirror images: with the hydrostatic difference, or copied.')
      call keys%leave()
   end subroutine visit_domain

   !> Keys of &fluid.
   subroutine visit_fluid(keys, fluid)
      class(key_visitor_t), intent(inout) :: keys
      type(fluid_settings), intent(inout) :: fluid

      call keys%enter('fluid', 1)
      call keys%real_key('density', fluid%density, above(0.0_dp), 'kg/m3', 'Density at zero pressure.')
      call keys%real_key('gravity', fluid%gravity, at_least(0.0_dp), 'm/s2', 'Gravity, which acts along -y.')
      call keys%real_key('mach', fluid%mach, between(0.0_dp, largest_mach), '-', &
                         'Mach number of reference_speed; above 0.1 the fluid is too compressible. 0: not given.')
      call keys%real_or_word_key('reference_speed', fluid%reference_speed, 'auto', fluid%find_reference_speed, &
                                 at_least(0.0_dp), 'm/s', 'Largest speed expected; sound_speed = reference_speed/mach. '// &
                                 "'auto': a coarse run finds it first. 0: not given.")
      call keys%real_key('sound_speed', fluid%sound_speed, at_least(0.0_dp), 'm/s', &
                         'Sound speed, instead of mach. 0: not given.')
      call keys%real_key('viscosity', fluid%viscosity, at_least(0.0_dp), 'Pa s', &
                         'Dynamic viscosity; acts in addition to alpha.')
      call keys%real_key('reynolds', fluid%reynolds, at_least(0.0_dp), '-', &
                         'Reynolds number rho0 U d/mu instead of viscosity; U = sqrt(g d), without gravity reference_speed. '// &
                         '0: not given.')
      call keys%leave()
   end subroutine visit_fluid

   !> Keys of &force.
   subroutine visit_force(keys, force)
      class(key_visitor_t), intent(inout) :: keys
      type(force_settings), intent(inout) :: force

      call keys%enter('force', 1)
      call keys%vector_key('acceleration', force%acceleration, any_number(), 'm/s2', &
                           'The same everywhere; its work is W_f in the energy table.')
      call keys%real_key('central_rate', force%central_rate, at_least(0.0_dp), '1/s', &
                         'w of a central field -w**2 (r - centre); it counts as potential energy.')
      call keys%only_with('central_rate', force%central_rate > 0.0_dp)
      call keys%vector_key('centre', force%centre, any_number(), 'm', 'Centre of the central field, x and y.')
      call keys%leave()
   end subroutine visit_force

   !> Keys of one &body.
   subroutine visit_body(keys, body, number)
      class(key_visitor_t), intent(inout) :: keys
      type(body_settings), intent(inout) :: body
      integer, intent(in) :: number

      call keys%enter('body', number)
      call keys%choice_key('shape', body%shape, [character(choice_length) :: 'rectangle', 'disc'], &
                           'Shape: a rectangle from lower to upper, or a disc around centre.')
      call keys%only_with("shape = 'rectangle'", body%shape == 'rectangle')
      call keys%vector_key('lower', body%lower, any_number(), 'm', 'Lower left corner, x and y.', required=.true.)
      call keys%vector_key('upper', body%upper, any_number(), 'm', 'Upper right corner, x and y.', required=.true.)
      call keys%choice_key('lattice', body%lattice, [character(choice_length) :: 'aligned', 'turned'], &
                           'How its particles stand; turned by 31 degrees they bear strain along the axes (periodic boxes).')
      call keys%only_with("shape = 'disc'", body%shape == 'disc')
      call keys%vector_key('centre', body%centre, any_number(), 'm', 'Centre, x and y.')
      call keys%real_key('radius', body%radius, above(0.0_dp), 'm', 'Radius.', required=.true.)
      call keys%choice_key('packing', body%packing, [character(choice_length) :: 'rings', 'lattice'], &
                           'How its particles stand: on rings, or on what the disc covers of a square lattice.')
      call keys%always()
      call keys%choice_key('flow', body%flow, [character(choice_length) :: 'uniform', 'exact'], &
                           'Velocity at the start: the same everywhere, or that of &exact solution.')
      call keys%only_with("flow = 'uniform'", body%flow == 'uniform')
      call keys%vector_key('velocity', body%velocity, any_number(), 'm/s', 'Velocity at the start, x and y.')
      call keys%always()
      call keys%choice_key('pressure', body%pressure, &
                           [character(choice_length) :: 'hydrostatic', 'incompressible', 'zero', 'exact'], &
                           'Pressure at the start; incompressible: of a column that has just lost its gate.')
      call keys%leave()
   end subroutine visit_body

   !> Keys of &model.
   subroutine visit_model(keys, model)
      class(key_visitor_t), intent(inout) :: keys
      type(model_settings), intent(inout) :: model

      call keys%enter('model', 1)
      call keys%real_key('smoothing_ratio', model%smoothing_ratio, between(1.2_dp, 4.0_dp), '-', &
                         'Smoothing length over particle spacing, h/dx.')
      call keys%choice_key('diffusion', model%diffusion, [character(choice_length) :: 'constant', 'dynamic'], &
                           'How alpha and delta are chosen: the same everywhere, or from the rate of strain (eqs. 19-26).')
      call keys%only_with("diffusion = 'constant'", model%diffusion == 'constant')
      call keys%real_key('alpha', model%alpha, at_least(0.0_dp), '-', 'Coefficient of the viscous term.')
      call keys%real_key('delta', model%delta, at_least(0.0_dp), '-', 'Coefficient of the density diffusion.')
      call keys%only_with("diffusion = 'dynamic'", model%diffusion == 'dynamic')
      call keys%real_key('c_s', model%c_s, at_least(0.0_dp), '-', 'Smagorinsky constant C_S of the dynamic model.')
      call keys%real_key('c_delta', model%c_delta, at_least(0.0_dp), '-', &
                         'Constant C_delta of the density diffusion of the dynamic model.')
      call keys%real_key('limit', model%limit, above(0.0_dp), '-', 'Largest alpha_i and delta_i of the dynamic model.')
      call keys%choice_key('limiter', model%limiter, [character(choice_length) :: 'coefficients', 'strain_rate'], &
                           'What the limit clips: alpha_i and delta_i each, or ||D|| so that both keep their ratio.')
      call keys%leave()
   end subroutine visit_model

   !> Keys of &exact.
   subroutine visit_exact(keys, solutions, exact)
      class(key_visitor_t), intent(inout) :: keys
      class(known_solutions_t), intent(in) :: solutions
      type(exact_settings), intent(inout) :: exact

      character(choice_length), allocatable :: names(:)
      logical, allocatable :: has_amplitude(:), has_waves(:)

      call solutions%list(names, has_amplitude, has_waves)
      call keys%enter('exact', 1)
      call keys%choice_key('solution', exact%solution, names, 'Which solution; docs/scenes.md says what each needs.')
      call keys%only_with('a solution that has an amplitude', any(has_amplitude .and. names == exact%solution))
      call keys%real_key('amplitude', exact%amplitude, any_number(), 'of the solution', &
                         'Wave height/depth, strain rate of the drop [1/s], speed [m/s], rotation [1/s] or share of rho0.', &
                         required=.true.)
      call keys%only_with('a solution that has waves', any(has_waves .and. names == exact%solution))
      call keys%integer_key('waves', exact%waves, at_least(1.0_dp), '-', 'Wavelengths in the box, of waves.')
      call keys%leave()
   end subroutine visit_exact

   !> Keys of &time.
   subroutine visit_time(keys, time)
      class(key_visitor_t), intent(inout) :: keys
      type(time_settings), intent(inout) :: time

      call keys%enter('time', 1)
      call keys%real_key('cfl', time%cfl, above(0.0_dp), '-', &
                         'Time step as a multiple of h/(c0 + h max|pi|), but never longer than is stable: by default '// &
                         'min(2.09, 0.264/delta, 0.5/alpha), alpha with viscosity.')
      call keys%choice_key('beyond_limit', time%beyond_limit, [character(choice_length) :: 'reduce', 'refuse'], &
                           'What to do with a cfl that is not stable: take the largest that is, with a warning, or end.')
      call keys%choice_key('integrator', time%integrator, [character(choice_length) :: integrator_names], &
                           "Runge-Kutta scheme; rk3 and rk2 are there to compare with (docs/error_vs_time.md).")
      call keys%choice_key('diffusion', time%diffusion, [character(choice_length) :: 'frozen', 'every_stage'], &
                           'When the diffusive terms are computed: once in a step, or in each of its stages.')
      call keys%real_key('end_time', time%end_time, above(0.0_dp), 's', 'Time at which the run ends.', required=.true.)
      call keys%integer_key('max_steps', time%max_steps, at_least(0.0_dp), '-', &
                            'Number of steps after which the run ends early. 0: no limit.')
      call keys%real_key('max_wall_time', time%max_wall_time, at_least(0.0_dp), 's', &
                         'Seconds of the clock on the wall after which the run ends early. 0: no limit.')
      call keys%leave()
   end subroutine visit_time

   !> Keys of &output.
   subroutine visit_output(keys, output, with_probes, with_exact)
      class(key_visitor_t), intent(inout) :: keys
      type(output_settings), intent(inout) :: output
      logical, intent(in) :: with_probes, with_exact   !! the scene has some

      call keys%enter('output', 1)
      call keys%text_key('energy', output%energy, 'How often a line of the energy table is written.')
      call keys%only_with('a &probe or &gauge group', with_probes)
      call keys%text_key('probes', output%probes, 'How often a line of the probe table is written.')
      call keys%only_with('an &exact solution', with_exact)
      call keys%text_key('errors', output%errors, 'How often a line of the error table is written.')
      call keys%always()
      call keys%text_key('snapshots', output%snapshots, 'How often all particles are written.')
      call keys%list_key('fields', output%fields, output%n_fields, field_names, 'What snapshots hold.')
      call keys%choice_key('precision', output%precision, [character(8) :: 'single', 'double'], &
                           'Precision of the fields in snapshots.')
      call keys%leave()
   end subroutine visit_output

   !> Keys of one &probe.
   subroutine visit_probe(keys, probe, number)
      class(key_visitor_t), intent(inout) :: keys
      type(probe_settings), intent(inout) :: probe
      integer, intent(in) :: number

      call keys%enter('probe', number)
      call keys%text_key('name', probe%name, 'Name of its column: letters, digits, _ and -.', required=.true.)
      call keys%vector_key('position', probe%position, any_number(), 'm', 'Its centre on a wall, x and y.', required=.true.)
      call keys%real_key('diameter', probe%diameter, at_least(0.0_dp), 'm', 'Diameter of its disc. 0: not a disc.')
      call keys%real_key('length', probe%length, at_least(0.0_dp), 'm', &
                         'Length of its segment along the wall. 0: not a segment; without a diameter too, a point.')
      call keys%leave()
   end subroutine visit_probe

   !> Keys of one &gauge.
   subroutine visit_gauge(keys, gauge, number)
      class(key_visitor_t), intent(inout) :: keys
      type(gauge_settings), intent(inout) :: gauge
      integer, intent(in) :: number

      call keys%enter('gauge', number)
      call keys%text_key('name', gauge%name, 'Name of its column: letters, digits, _ and -.', required=.true.)
      call keys%choice_key('along', gauge%along, [character(choice_length) :: 'x', 'y'], &
                           'The axis the line is parallel to: y for the height of a surface, x for the front of a surge.')
      call keys%real_key('at', gauge%at, any_number(), 'm', 'Where the line is: its x if it is along y, else its y.', &
                         required=.true.)
      call keys%choice_key('measure', gauge%measure, [character(choice_length) :: 'end', 'start', 'wetted'], &
                           'The largest coordinate of the fluid on the line, the least, or how much of the line is wet.')
      call keys%leave()
   end subroutine visit_gauge

end module scene_keys
