!> The table of all input keys: group, name, unit, range, default, meaning, and the component that holds the value.
!!
!! A key's default is the initial value of its component in module `settings`.
module scene_keys
   use integrators, only: integrator_names
   use key_table, only: above, any_number, at_least, between, keys_t
   use kinds, only: dp
   use known_solutions, only: known_solutions_t
   use settings, only: body_settings, choice_length, domain_settings, exact_settings, fluid_settings, force_settings, &
                       gauge_settings, group_names, model_settings, name_length, output_settings, probe_settings, scene_settings, &
                       settings_t, time_settings
   implicit none
   private

   public :: list_keys, count_groups

   !> Least and largest d/dx: coarser has no meaning, finer surely is a slip.
   real(dp), parameter, public :: resolution_range(2) = [4.0_dp, 20000.0_dp]

   !> Largest Mach number that still may be called weakly compressible.
   real(dp), parameter, public :: largest_mach = 0.5_dp

   character(*), parameter :: side_choices(*) = [character(choice_length) :: 'free_slip', 'no_slip', 'periodic', 'open']

   !> What snapshots can hold.
   character(name_length), parameter :: field_names(*) = &
      [character(name_length) :: 'velocity', 'pressure', 'density', 'vorticity', 'alpha', 'delta', 'dissipation']

   !> A namelist group.
   type, public :: known_group_t
      character(8) :: name
      character(80) :: meaning
      logical :: required     !! the file must have one
      logical :: repeatable   !! it may have several
   end type known_group_t

   type(known_group_t), parameter, public :: groups(size(group_names)) = [ &
      known_group_t('scene', 'What the scene is called and how fine it is.', .true., .false.), &
      known_group_t('domain', 'The box the fluid moves in; its sides are walls or open.', .true., .false.), &
      known_group_t('fluid', "The fluid's constants. Give mach and reference_speed, or sound_speed.", .true., .false.), &
      known_group_t('force', 'What acts on the fluid besides gravity.', .false., .false.), &
      known_group_t('body', 'A block of fluid at the start.', .true., .true.), &
      known_group_t('model', 'The diffusive terms.', .false., .false.), &
      known_group_t('exact', 'The exact solution that the scene follows; errors are written to errors.dat.', .false., .false.), &
      known_group_t('time', 'The time step and the end of the run.', .true., .false.), &
      known_group_t('output', "What is written and how often: '10 steps', '0.05 time' or 'never'.", .false., .false.), &
      known_group_t('probe', 'A pressure sensor on a wall.', .false., .true.), &
      known_group_t('gauge', 'A line through the box, on which the end of the fluid is looked for.', .false., .true.)]

contains

   !> The keys of a group. A change of the scene makes the table old: which keys are active is seen when it is made.
   subroutine list_keys(scene, solutions, group, number, keys)
      type(settings_t), intent(inout), target :: scene
      class(known_solutions_t), intent(in) :: solutions
      character(*), intent(in) :: group
      integer, intent(in) :: number          !! of the group, where it may be repeated
      type(keys_t), intent(out) :: keys      !! values point into the scene

      select case (group)
      case ('scene')
         call add_scene_keys(keys, scene%scene)
      case ('domain')
         call add_domain_keys(keys, scene%domain, with_force=scene%fluid%gravity > 0.0_dp .or. scene%has_acceleration())
      case ('fluid')
         call add_fluid_keys(keys, scene%fluid)
      case ('force')
         call add_force_keys(keys, scene%force)
      case ('body')
         call add_body_keys(keys, scene%bodies(number))
      case ('model')
         call add_model_keys(keys, scene%model)
      case ('exact')
         call add_exact_keys(keys, solutions, scene%exact)
      case ('time')
         call add_time_keys(keys, scene%time)
      case ('output')
         call add_output_keys(keys, scene%output, with_probes=size(scene%probes) + size(scene%gauges) > 0, &
                              with_exact=scene%exact%solution /= 'none')
      case ('probe')
         call add_probe_keys(keys, scene%probes(number))
      case ('gauge')
         call add_gauge_keys(keys, scene%gauges(number))
      end select
   end subroutine list_keys

   !> How many of a group a scene has.
   pure integer function count_groups(scene, group) result(n)
      type(settings_t), intent(in) :: scene
      character(*), intent(in) :: group

      n = 1
      if (group == 'body') n = size(scene%bodies)
      if (group == 'probe') n = size(scene%probes)
      if (group == 'gauge') n = size(scene%gauges)
   end function count_groups

   ! Keys of &scene.
   subroutine add_scene_keys(keys, scene)
      type(keys_t), intent(inout) :: keys
      type(scene_settings), intent(inout), target :: scene

      call keys%text_key('title', scene%title, 'What the run calls itself in its output.')
      call keys%real_key('reference_length', scene%reference_length, above(0.0_dp), 'm', &
                         'Depth d that the resolution refers to.')
      call keys%real_key('resolution', scene%resolution, between(resolution_range(1), resolution_range(2)), '-', &
                         'Particles per reference length, d/dx.', required=.true.)
   end subroutine add_scene_keys

   ! Keys of &domain.
   subroutine add_domain_keys(keys, domain, with_force)
      type(keys_t), intent(inout) :: keys
      type(domain_settings), intent(inout), target :: domain
      logical, intent(in) :: with_force   ! something makes hydrostatic pressure

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
   end subroutine add_domain_keys

   ! Keys of &fluid.
   subroutine add_fluid_keys(keys, fluid)
      type(keys_t), intent(inout) :: keys
      type(fluid_settings), intent(inout), target :: fluid

      call keys%real_key('density', fluid%density, above(0.0_dp), 'kg/m3', 'Density at zero pressure.')
      call keys%real_key('gravity', fluid%gravity, at_least(0.0_dp), 'm/s2', 'Gravity, which acts along -y.')
      call keys%real_key('mach', fluid%mach, between(0.0_dp, largest_mach), '-', &
                         'Mach number of reference_speed; above 0.1 the fluid is too compressible. 0: not given.')
      call keys%real_key('reference_speed', fluid%reference_speed, at_least(0.0_dp), 'm/s', &
                         'Largest speed expected; sound_speed = reference_speed/mach. '// &
                         "'auto': a coarse run finds it first. 0: not given.", word='auto', chosen=fluid%find_reference_speed)
      call keys%real_key('sound_speed', fluid%sound_speed, at_least(0.0_dp), 'm/s', &
                         'Sound speed, instead of mach. 0: not given.')
      call keys%real_key('viscosity', fluid%viscosity, at_least(0.0_dp), 'Pa s', &
                         'Dynamic viscosity; acts in addition to alpha.')
      call keys%real_key('reynolds', fluid%reynolds, at_least(0.0_dp), '-', &
                         'Reynolds number rho0 U d/mu instead of viscosity; U = sqrt(g d), without gravity reference_speed. '// &
                         '0: not given.')
   end subroutine add_fluid_keys

   ! Keys of &force.
   subroutine add_force_keys(keys, force)
      type(keys_t), intent(inout) :: keys
      type(force_settings), intent(inout), target :: force

      call keys%vector_key('acceleration', force%acceleration, any_number(), 'm/s2', &
                           'The same everywhere; its work is W_f in the energy table.')
      call keys%real_key('central_rate', force%central_rate, at_least(0.0_dp), '1/s', &
                         'w of a central field -w**2 (r - centre); it counts as potential energy.')
      call keys%only_with('central_rate', force%central_rate > 0.0_dp)
      call keys%vector_key('centre', force%centre, any_number(), 'm', 'Centre of the central field, x and y.')
   end subroutine add_force_keys

   ! Keys of one &body.
   subroutine add_body_keys(keys, body)
      type(keys_t), intent(inout) :: keys
      type(body_settings), intent(inout), target :: body

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
   end subroutine add_body_keys

   ! Keys of &model.
   subroutine add_model_keys(keys, model)
      type(keys_t), intent(inout) :: keys
      type(model_settings), intent(inout), target :: model

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
   end subroutine add_model_keys

   ! Keys of &exact.
   subroutine add_exact_keys(keys, solutions, exact)
      type(keys_t), intent(inout) :: keys
      class(known_solutions_t), intent(in) :: solutions
      type(exact_settings), intent(inout), target :: exact
      character(choice_length), allocatable :: names(:)
      logical, allocatable :: has_amplitude(:), has_waves(:)

      call solutions%list(names, has_amplitude, has_waves)
      call keys%choice_key('solution', exact%solution, names, 'Which solution; docs/scenes.md says what each needs.')
      call keys%only_with('a solution that has an amplitude', any(has_amplitude .and. names == exact%solution))
      call keys%real_key('amplitude', exact%amplitude, any_number(), 'of the solution', &
                         'Wave height/depth, strain rate of the drop [1/s], speed [m/s], rotation [1/s] or share of rho0.', &
                         required=.true.)
      call keys%only_with('a solution that has waves', any(has_waves .and. names == exact%solution))
      call keys%whole_key('waves', exact%waves, at_least(1.0_dp), '-', 'Wavelengths in the box, of waves.')
   end subroutine add_exact_keys

   ! Keys of &time.
   subroutine add_time_keys(keys, time)
      type(keys_t), intent(inout) :: keys
      type(time_settings), intent(inout), target :: time

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
      call keys%whole_key('max_steps', time%max_steps, at_least(0.0_dp), '-', &
                            'Number of steps after which the run ends early. 0: no limit.')
      call keys%real_key('max_wall_time', time%max_wall_time, at_least(0.0_dp), 's', &
                         'Seconds of the clock on the wall after which the run ends early. 0: no limit.')
   end subroutine add_time_keys

   ! Keys of &output.
   subroutine add_output_keys(keys, output, with_probes, with_exact)
      type(keys_t), intent(inout) :: keys
      type(output_settings), intent(inout), target :: output
      logical, intent(in) :: with_probes, with_exact   ! the scene has some

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
   end subroutine add_output_keys

   ! Keys of one &probe.
   subroutine add_probe_keys(keys, probe)
      type(keys_t), intent(inout) :: keys
      type(probe_settings), intent(inout), target :: probe

      call keys%text_key('name', probe%name, 'Name of its column: letters, digits, _ and -.', required=.true.)
      call keys%vector_key('position', probe%position, any_number(), 'm', 'Its centre on a wall, x and y.', required=.true.)
      call keys%real_key('diameter', probe%diameter, at_least(0.0_dp), 'm', 'Diameter of its disc. 0: not a disc.')
      call keys%real_key('length', probe%length, at_least(0.0_dp), 'm', &
                         'Length of its segment along the wall. 0: not a segment; without a diameter too, a point.')
   end subroutine add_probe_keys

   ! Keys of one &gauge.
   subroutine add_gauge_keys(keys, gauge)
      type(keys_t), intent(inout) :: keys
      type(gauge_settings), intent(inout), target :: gauge

      call keys%text_key('name', gauge%name, 'Name of its column: letters, digits, _ and -.', required=.true.)
      call keys%choice_key('along', gauge%along, [character(choice_length) :: 'x', 'y'], &
                           'The axis the line is parallel to: y for the height of a surface, x for the front of a surge.')
      call keys%real_key('at', gauge%at, any_number(), 'm', 'Where the line is: its x if it is along y, else its y.', &
                         required=.true.)
      call keys%choice_key('measure', gauge%measure, [character(choice_length) :: 'end', 'start', 'wetted'], &
                           'The largest coordinate of the fluid on the line, the least, or how much of the line is wet.')
   end subroutine add_gauge_keys

end module scene_keys
