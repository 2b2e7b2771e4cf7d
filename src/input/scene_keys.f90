!> The table of all input keys: group, name, unit, range, default, meaning, and the component that holds the value.
!!
!! A key's default is the initial value of its component in module `settings`.
module scene_keys
   use integrators, only: integrator_names
   use key_table, only: key_t, keys_t, not_negative, positive, range_t
   use kinds, only: dp
   use known_solutions, only: known_solutions_t
   use settings, only: body_settings, choice_length, group_names, motion_settings, settings_t, solid_settings
   implicit none
   private

   public :: list_keys, count_groups

   !> Least and largest d/dx: coarser has no meaning, finer surely is a slip.
   real(dp), parameter, public :: resolution_range(2) = [4.0_dp, 20000.0_dp]

   !> Largest Mach number that still may be called weakly compressible.
   real(dp), parameter, public :: largest_mach = 0.5_dp

   character(*), parameter :: side_choices(*) = [character(choice_length) :: 'free_slip', 'no_slip', 'periodic', 'open']

   character(*), parameter :: motion_choices(*) = &
      [character(choice_length) :: 'none', 'uniform', 'oscillation', 'table', 'piston', 'flap', 'free']

   !> What snapshots can hold.
   character(choice_length), parameter :: field_names(*) = &
      [character(choice_length) :: 'velocity', 'pressure', 'density', 'vorticity', 'alpha', 'delta', 'dissipation']

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
      known_group_t('tank', 'How the box moves; the scene is seen from it.', .false., .false.), &
      known_group_t('body', 'A block of fluid at the start.', .true., .true.), &
      known_group_t('solid', 'A rigid body in the fluid, at rest or moved.', .false., .true.), &
      known_group_t('sponge', 'A layer that slows the fluid down by -rate s**2 u, s from 0 to 1 across it.', .false., .true.), &
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
      type(keys_t), intent(inout) :: keys    !! in the place of what was there; values point into the scene

      keys%n = 0
      call keys%only_with('', .true.)
      call add_keys_of_fluid(scene, group, number, keys)
      call add_keys_of_method(scene, solutions, group, keys)
      call add_keys_of_output(scene, group, number, keys)
   end subroutine list_keys

   !> How many of a group a scene has.
   pure integer function count_groups(scene, group) result(n)
      type(settings_t), intent(in) :: scene
      character(*), intent(in) :: group

      n = 1
      if (group == 'body') n = size(scene%bodies)
      if (group == 'solid') n = size(scene%solids)
      if (group == 'sponge') n = 0
      if (group == 'sponge' .and. allocated(scene%sponges)) n = size(scene%sponges)
      if (group == 'probe') n = size(scene%probes)
      if (group == 'gauge') n = size(scene%gauges)
   end function count_groups

   ! What there is and what acts on it.
   subroutine add_keys_of_fluid(scene, group, number, keys)
      type(settings_t), intent(inout), target :: scene
      character(*), intent(in) :: group
      integer, intent(in) :: number
      type(keys_t), intent(inout) :: keys

      select case (group)
      case ('scene')
         call keys%add(key_t('title', 'What the run calls itself in its output.'), scene%scene%title)
         call keys%add(key_t('reference_length', 'Depth d that the resolution refers to.', 'm', positive, &
                             number=scene%scene%reference_length))
         call keys%add(key_t('resolution', 'Particles per reference length, d/dx.', '-', &
                             range_t(resolution_range(1), resolution_range(2)), .true., scene%scene%resolution))
      case ('domain')
         associate (domain => scene%domain)
            call keys%add(key_t('lower', 'Lower left corner of the box, x and y.', 'm', vector=domain%lower))
            call keys%add(key_t('upper', 'Upper right corner; need not be a multiple of dx.', 'm', required=.true., &
                                vector=domain%upper))
            call keys%add(key_t('left', 'What the side at the least x is.', choices=side_choices), domain%left)
            call keys%add(key_t('right', 'What the side at the largest x is.', choices=side_choices), domain%right)
            call keys%add(key_t('bottom', 'What the side at the least y is.', choices=side_choices), domain%bottom)
            call keys%add(key_t('top', 'What the side at the largest y is.', choices=side_choices), domain%top)
            call keys%add(key_t('wall_speeds', 'Speeds of the no-slip sides left, right, bottom and top, along themselves.', &
                                'm/s', vector=domain%wall_speeds))
            call keys%only_with('gravity or acceleration', scene%fluid%gravity > 0.0_dp .or. scene%has_acceleration())
            call keys%add(key_t('images', 'Density of the mirror images: with the hydrostatic difference, or copied.', &
                                choices=[character(choice_length) :: 'hydrostatic', 'mirror']), domain%images)
         end associate
      case ('fluid')
         associate (fluid => scene%fluid)
            call keys%add(key_t('density', 'Density at zero pressure.', 'kg/m3', positive, number=fluid%density))
            call keys%add(key_t('gravity', 'Gravity, which acts along -y.', 'm/s2', not_negative, number=fluid%gravity))
            call keys%add(key_t('mach', 'Mach number of reference_speed; above 0.1 the fluid is too compressible. 0: not given.', &
                                '-', range_t(0.0_dp, largest_mach), number=fluid%mach))
            call keys%add(key_t('reference_speed', 'Largest speed expected; sound_speed = reference_speed/mach. '// &
                                "'auto': a coarse run finds it first. 0: not given.", 'm/s', not_negative, &
                                number=fluid%reference_speed, choices=[character(choice_length) :: 'auto'], &
                                chosen=fluid%find_reference_speed))
            call keys%add(key_t('sound_speed', 'Sound speed, instead of mach. 0: not given.', 'm/s', not_negative, &
                                number=fluid%sound_speed))
            call keys%add(key_t('viscosity', 'Dynamic viscosity; acts in addition to alpha.', 'Pa s', not_negative, &
                                number=fluid%viscosity))
            call keys%add(key_t('reynolds', 'Reynolds number rho0 U d/mu instead of viscosity; U = sqrt(g d), without gravity '// &
                                'reference_speed. 0: not given.', '-', not_negative, number=fluid%reynolds))
         end associate
      case ('force')
         associate (force => scene%force)
            call keys%add(key_t('acceleration', 'The same everywhere; its work is W_f in the energy table.', 'm/s2', &
                                vector=force%acceleration))
            call keys%add(key_t('central_rate', 'w of a central field -w**2 (r - centre); it counts as potential energy.', &
                                '1/s', not_negative, number=force%central_rate))
            call keys%only_with('central_rate', force%central_rate > 0.0_dp)
            call keys%add(key_t('centre', 'Centre of the central field, x and y.', 'm', vector=force%centre))
         end associate
      case ('tank')
         call add_keys_of_motion(scene%tank, motion_choices([1, 3, 4]), keys)
         call keys%only_with('a motion', scene%tank%motion /= 'none')
         call keys%add(key_t('pivot', "Point it turns about, x and y in the box's own coordinates.", 'm', &
                             vector=scene%tank%pivot))
      case ('body')
         call add_keys_of_body(scene%bodies(number), keys)
      case ('solid')
         call add_keys_of_shape(scene%solids(number), keys)
         call add_keys_of_motion(scene%solids(number), motion_choices, keys)
         call add_keys_of_free_body(scene%solids(number), keys)
      case ('sponge')
         associate (sponge => scene%sponges(number))
            call keys%add(key_t('lower', 'Lower left corner, x and y.', 'm', required=.true., vector=sponge%lower))
            call keys%add(key_t('upper', 'Upper right corner, x and y.', 'm', required=.true., vector=sponge%upper))
            call keys%add(key_t('towards', 'The side at which it ends, and is strongest.', &
                                choices=[character(choice_length) :: 'left', 'right']), sponge%towards)
            call keys%add(key_t('rate', 'Rate at its end, at most half of c0/h; 4 pi/T is good for a layer of one wave length.', &
                                '1/s', positive, .true., sponge%rate))
         end associate
      end select
   end subroutine add_keys_of_fluid

   subroutine add_keys_of_body(body, keys)
      type(body_settings), intent(inout), target :: body
      type(keys_t), intent(inout) :: keys

      call keys%add(key_t('shape', 'Shape: a rectangle from lower to upper, or a disc around centre.', &
                          choices=[character(choice_length) :: 'rectangle', 'disc']), body%shape)
      call keys%only_with("shape = 'rectangle'", body%shape == 'rectangle')
      call keys%add(key_t('lower', 'Lower left corner, x and y.', 'm', required=.true., vector=body%lower))
      call keys%add(key_t('upper', 'Upper right corner, x and y.', 'm', required=.true., vector=body%upper))
      call keys%add(key_t('lattice', 'How its particles stand; turned by 31 degrees they bear strain along the axes '// &
                          '(periodic boxes).', choices=[character(choice_length) :: 'aligned', 'turned']), body%lattice)
      call keys%only_with("shape = 'disc'", body%shape == 'disc')
      call keys%add(key_t('centre', 'Centre, x and y.', 'm', vector=body%centre))
      call keys%add(key_t('radius', 'Radius.', 'm', positive, .true., body%radius))
      call keys%add(key_t('packing', 'How its particles stand: on rings, or on what the disc covers of a square lattice.', &
                          choices=[character(choice_length) :: 'rings', 'lattice']), body%packing)
      call keys%only_with('', .true.)
      call keys%add(key_t('flow', 'Velocity at the start: the same everywhere, or that of &exact solution.', &
                          choices=[character(choice_length) :: 'uniform', 'exact']), body%flow)
      call keys%only_with("flow = 'uniform'", body%flow == 'uniform')
      call keys%add(key_t('velocity', 'Velocity at the start, x and y.', 'm/s', vector=body%velocity))
      call keys%only_with('', .true.)
      call keys%add(key_t('pressure', 'Pressure at the start; incompressible: of a column that has just lost its gate.', &
                          choices=[character(choice_length) :: 'hydrostatic', 'incompressible', 'zero', 'exact']), body%pressure)
   end subroutine add_keys_of_body

   ! What a solid is, and how the fluid meets it.
   subroutine add_keys_of_shape(solid, keys)
      type(solid_settings), intent(inout), target :: solid
      type(keys_t), intent(inout) :: keys

      call keys%add(key_t('name', 'Name of its columns: letters, digits, _ and -.', required=.true.), solid%name)
      call keys%add(key_t('shape', 'Shape: a polygon, a rectangle from lower to upper, or a disc around centre.', &
                          choices=[character(choice_length) :: 'polygon', 'rectangle', 'disc']), solid%shape)
      call keys%only_with("shape = 'polygon'", solid%shape == 'polygon')
      call keys%add(key_t('vertices', 'Its 3 to 1000 vertices, x and y of each in turn, counter-clockwise.', 'm', &
                          numbers=solid%vertices))
      call keys%add(key_t('vertices_file', 'Instead of vertices: a text file with x and y of a vertex in each line; its path '// &
                          "from the scene's file on. It is read in as vertices."), solid%vertices_file)
      call keys%only_with("shape = 'rectangle'", solid%shape == 'rectangle')
      call keys%add(key_t('lower', 'Lower left corner, x and y.', 'm', required=.true., vector=solid%lower))
      call keys%add(key_t('upper', 'Upper right corner, x and y.', 'm', required=.true., vector=solid%upper))
      call keys%only_with("shape = 'disc'", solid%shape == 'disc')
      call keys%add(key_t('centre', 'Centre, x and y.', 'm', required=.true., vector=solid%centre))
      call keys%add(key_t('radius', 'Radius.', 'm', positive, .true., solid%radius))
      call keys%only_with('', .true.)
      call keys%add(key_t('angle', 'Angle it is turned by, counter-clockwise about pivot.', 'degrees', number=solid%angle))
      call keys%add(key_t('pivot', 'Point it is turned about and moments are taken about, x and y; by default the centroid '// &
                          'of the shape.', 'm', vector=solid%pivot, follows=.true.))
      call keys%add(key_t('surface', 'Whether the fluid slips along it.', &
                          choices=[character(choice_length) :: 'free_slip', 'no_slip']), solid%surface)
      call keys%add(key_t('fluid', 'Where a &body overlaps it: leave out the fluid that would be inside, or end.', &
                          choices=[character(choice_length) :: 'cut', 'refuse']), solid%fluid)
   end subroutine add_keys_of_shape

   ! How a solid or the tank moves.
   subroutine add_keys_of_motion(moved, choices, keys)
      class(motion_settings), intent(inout), target :: moved
      character(*), intent(in) :: choices(:)   ! of motions
      type(keys_t), intent(inout) :: keys
      character(:), allocatable :: meaning

      meaning = 'How it moves from where it is drawn: shifts, and turns about pivot.'
      if (any(choices == 'piston')) meaning = meaning//' A piston or a flap makes waves that run to the right; forces move '// &
                                                         'a free body.'
      call keys%add(key_t('motion', meaning, choices=choices), moved%motion)
      if (any(choices == 'uniform')) then
         call keys%only_with("motion = 'uniform' or 'free'", moved%motion == 'uniform' .or. moved%motion == 'free')
         call keys%add(key_t('velocity', 'Velocity, x and y; of a free body, at the start.', 'm/s', vector=moved%velocity))
         call keys%add(key_t('spin', 'Rate at which it turns, counter-clockwise about pivot.', 'degrees/s', number=moved%spin))
      end if
      call add_keys_of_oscillation(moved, any(choices == 'piston'), keys)
      call keys%only_with("motion = 'table'", moved%motion == 'table')
      call keys%add(key_t('table', 'Its way in 2 to 2000 rows of time [s], shift in x and y [m] and angle [degrees]; it rests '// &
                          'after the last.', 's, m, degrees', numbers=moved%table))
      call keys%add(key_t('table_of', 'Accelerations (per s2) act from rest.', &
                          choices=[character(choice_length) :: 'position', 'acceleration']), moved%table_of)
      call keys%add(key_t('table_file', 'Instead of table: a text file of its rows, the angle may lack; its path from the '// &
                          "scene's file on."), moved%table_file)
      call keys%only_with('', .true.)
   end subroutine add_keys_of_motion

   ! What forces move.
   subroutine add_keys_of_free_body(solid, keys)
      type(solid_settings), intent(inout), target :: solid
      type(keys_t), intent(inout) :: keys

      call keys%only_with("motion = 'free'", solid%motion == 'free')
      call keys%add(key_t('mass', 'Mass, per unit width; pivot is its centre.', 'kg/m', positive, .true., solid%mass))
      call keys%add(key_t('moment_of_inertia', 'Moment of inertia about pivot; by default as if it were homogeneous.', 'kg m', &
                          positive, number=solid%moment_of_inertia, follows=.true.))
      call keys%add(key_t('freedoms', 'What forces change; the rest is held.', &
                          choices=[character(choice_length) :: 'x', 'y', 'angle'], list=solid%freedoms, used=solid%n_freedoms))
      call keys%add(key_t('stiffness', 'Of springs to where it is drawn: along x, y, and of the angle, per radian.', &
                          'N/m2, N/m2, N', not_negative, vector=solid%stiffness))
      call keys%add(key_t('damping', 'Of dampers: along x, y, and of the angle, per radian.', 'N s/m2 (N s)', not_negative, &
                          vector=solid%damping))
      call keys%only_with('', .true.)
   end subroutine add_keys_of_free_body

   subroutine add_keys_of_oscillation(moved, may_make_waves, keys)
      class(motion_settings), intent(inout), target :: moved
      logical, intent(in) :: may_make_waves
      type(keys_t), intent(inout) :: keys
      character(:), allocatable :: motions, by_default   ! in words
      logical :: makes_waves

      motions = "motion = 'oscillation'"
      by_default = ''
      makes_waves = moved%motion == 'piston' .or. moved%motion == 'flap'
      call keys%only_with(motions, moved%motion == 'oscillation')
      call keys%add(key_t('amplitude', 'Amplitude of its shift, x and y.', 'm', vector=moved%amplitude))
      call keys%add(key_t('swing', 'Amplitude of its angle.', 'degrees', number=moved%swing))
      if (may_make_waves) then
         motions = motions//", 'piston' or 'flap'"
         by_default = '; by default 0, of wave makers a period'
         call keys%only_with("motion = 'piston' or 'flap'", makes_waves)
         call keys%add(key_t('wave_height', 'Height of the waves; the stroke follows by linear theory. The pivot of a flap is '// &
                             'its hinge on the floor.', 'm', positive, .true., moved%wave_height))
         call keys%add(key_t('depth', 'Depth of the still water before it.', 'm', positive, .true., moved%depth))
      end if
      call keys%only_with(motions, moved%motion == 'oscillation' .or. makes_waves)
      call keys%add(key_t('period', 'Period of the oscillation.', 's', positive, .true., moved%period))
      call keys%add(key_t('phase', 'Phase of the oscillation at t = 0; with 0 it begins in the middle.', 'degrees', &
                          number=moved%phase))
      call keys%add(key_t('ramp', 'Time within which the oscillation sets in'//by_default//'. 0: at once.', 's', not_negative, &
                          number=moved%ramp, follows=may_make_waves))
   end subroutine add_keys_of_oscillation

   ! How it is computed.
   subroutine add_keys_of_method(scene, solutions, group, keys)
      type(settings_t), intent(inout), target :: scene
      class(known_solutions_t), intent(in) :: solutions
      character(*), intent(in) :: group
      type(keys_t), intent(inout) :: keys
      character(choice_length), allocatable :: names(:)
      logical, allocatable :: has_amplitude(:), has_waves(:)

      select case (group)
      case ('model')
         associate (model => scene%model)
            call keys%add(key_t('smoothing_ratio', 'Smoothing length over particle spacing, h/dx.', '-', &
                                range_t(1.2_dp, 4.0_dp), number=model%smoothing_ratio))
            call keys%add(key_t('diffusion', 'How alpha and delta are chosen: the same everywhere (the default where one is '// &
                                'given), or from the rate of strain (eqs. 19-26).', &
                                choices=[character(choice_length) :: 'constant', 'dynamic']), model%diffusion)
            call keys%only_with("diffusion = 'constant'", model%diffusion == 'constant')
            call keys%add(key_t('alpha', 'Coefficient of the viscous term.', '-', not_negative, number=model%alpha))
            call keys%add(key_t('delta', 'Coefficient of the density diffusion.', '-', not_negative, number=model%delta))
            call keys%only_with("diffusion = 'dynamic'", model%diffusion == 'dynamic')
            call keys%add(key_t('c_s', 'Smagorinsky constant C_S of the dynamic model.', '-', not_negative, number=model%c_s))
            call keys%add(key_t('c_delta', 'Constant C_delta of the density diffusion of the dynamic model.', '-', not_negative, &
                                number=model%c_delta))
            call keys%add(key_t('limit', 'Largest alpha_i and delta_i of the dynamic model.', '-', positive, number=model%limit))
            call keys%add(key_t('limiter', 'What the limit clips: alpha_i and delta_i each, or ||D|| so that both keep their '// &
                                'ratio.', choices=[character(choice_length) :: 'coefficients', 'strain_rate']), model%limiter)
         end associate
      case ('exact')
         call solutions%list(names, has_amplitude, has_waves)
         associate (exact => scene%exact)
            call keys%add(key_t('solution', 'Which solution; docs/scenes.md says what each needs.', choices=names), exact%solution)
            call keys%only_with('a solution that has an amplitude', any(has_amplitude .and. names == exact%solution))
            call keys%add(key_t('amplitude', 'Wave height/depth, strain rate of the drop [1/s], speed [m/s], rotation [1/s] '// &
                                'or share of rho0.', 'of the solution', required=.true., number=exact%amplitude))
            call keys%only_with('a solution that has waves', any(has_waves .and. names == exact%solution))
            call keys%add(key_t('waves', 'Wavelengths in the box, of waves.', '-', range_t(1.0_dp), whole=exact%waves))
         end associate
      case ('time')
         associate (time => scene%time)
            call keys%add(key_t('cfl', 'Time step as a multiple of h/(c0 + h max|pi|), but never longer than is stable: by '// &
                                'default min(2.09, 0.264/delta, 0.5/alpha), alpha with viscosity.', '-', positive, number=time%cfl))
            call keys%add(key_t('beyond_limit', 'What to do with a cfl that is not stable: take the largest that is, with a '// &
                                'warning, or end.', choices=[character(choice_length) :: 'reduce', 'refuse']), time%beyond_limit)
            call keys%add(key_t('integrator', 'Runge-Kutta scheme; rk3 and rk2 are there to compare with '// &
                                '(docs/error_vs_time.md).', choices=[character(choice_length) :: integrator_names]), &
                          time%integrator)
            call keys%add(key_t('diffusion', 'When the diffusive terms are computed: once in a step, or in each of its stages.', &
                                choices=[character(choice_length) :: 'frozen', 'every_stage']), time%diffusion)
            call keys%add(key_t('end_time', 'Time at which the run ends.', 's', positive, .true., time%end_time))
            call keys%add(key_t('max_steps', 'Number of steps after which the run ends early. 0: no limit.', '-', not_negative, &
                                whole=time%max_steps))
            call keys%add(key_t('max_wall_time', 'Seconds of the clock on the wall after which the run stops; it can go on. '// &
                                '0: no limit.', 's', not_negative, number=time%max_wall_time))
            call keys%add(key_t('balance_limit', 'Share of the energy that the budget may miss; a run that misses more has '// &
                                'failed. 0: no limit.', '-', not_negative, number=time%balance_limit))
         end associate
      end select
   end subroutine add_keys_of_method

   ! What is written of it.
   subroutine add_keys_of_output(scene, group, number, keys)
      type(settings_t), intent(inout), target :: scene
      character(*), intent(in) :: group
      integer, intent(in) :: number
      type(keys_t), intent(inout) :: keys

      select case (group)
      case ('output')
         associate (output => scene%output)
            call keys%add(key_t('energy', 'How often a line of the energy table is written.'), output%energy)
            call keys%only_with('a &probe or &gauge group', size(scene%probes) + size(scene%gauges) > 0)
            call keys%add(key_t('probes', 'How often a line of the probe table is written.'), output%probes)
            call keys%only_with('an &exact solution', scene%exact%solution /= 'none')
            call keys%add(key_t('errors', 'How often a line of the error table is written.'), output%errors)
            call keys%only_with('a &solid group', size(scene%solids) > 0)
            call keys%add(key_t('solids', 'How often a line of the table of forces on solids is written.'), output%solids)
            call keys%only_with('', .true.)
            call keys%add(key_t('walls', 'How often a line of the table of forces on the walls of the box is written.'), &
                          output%walls)
            call keys%add(key_t('snapshots', 'How often all particles are written.'), output%snapshots)
            call keys%add(key_t('fields', 'What snapshots hold.', choices=field_names, list=output%fields, used=output%n_fields))
            call keys%add(key_t('precision', 'Precision of the fields in snapshots.', &
                                choices=[character(choice_length) :: 'single', 'double']), output%precision)
            call keys%add(key_t('checkpoint', "How often a checkpoint is written, also by the clock: '10 minutes' (seconds, "// &
                                "hours), '500 steps'; and at the end. 'never': only where the run is stopped."), output%checkpoint)
         end associate
      case ('probe')
         associate (probe => scene%probes(number))
            call keys%add(key_t('name', 'Name of its column: letters, digits, _ and -.', required=.true.), probe%name)
            call keys%add(key_t('position', 'Its centre on a wall, or on a solid where it is drawn, x and y.', 'm', &
                                required=.true., vector=probe%position))
            call keys%add(key_t('diameter', 'Diameter of its disc. 0: not a disc.', 'm', not_negative, number=probe%diameter))
            call keys%add(key_t('length', 'Length of its segment along that. 0: not a segment; without a diameter too, a '// &
                                'point.', 'm', not_negative, number=probe%length))
         end associate
      case ('gauge')
         associate (gauge => scene%gauges(number))
            call keys%add(key_t('name', 'Name of its column: letters, digits, _ and -.', required=.true.), gauge%name)
            call keys%add(key_t('along', 'The axis the line is parallel to: y for the height of a surface, x for the front of '// &
                                'a surge.', choices=[character(choice_length) :: 'x', 'y']), gauge%along)
            call keys%add(key_t('at', 'Where the line is: its x if it is along y, else its y.', 'm', required=.true., &
                                number=gauge%at))
            call keys%add(key_t('measure', 'The largest coordinate of the fluid on the line, the least, or how much of the '// &
                                'line is wet.', choices=[character(choice_length) :: 'end', 'start', 'wetted']), gauge%measure)
         end associate
      end select
   end subroutine add_keys_of_output

end module scene_keys
