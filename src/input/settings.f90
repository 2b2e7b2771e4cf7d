!> What a scene consists of: one type per namelist group, and all of them together.
!!
!! The initial values below are the defaults of the input keys; module
!! `scene_keys` adds unit, range and meaning to each and calls some required.
module settings
   use kernel, only: k_2d
   use kinds, only: dp
   implicit none
   private

   public :: settings_t, scene_settings, domain_settings, fluid_settings, force_settings, body_settings
   public :: exact_settings, model_settings, time_settings, output_settings, probe_settings, gauge_settings, sponge_settings
   public :: motion_settings, solid_settings, tank_settings, number_list_t, is_wall

   integer, parameter, public :: max_fields = 12       !! names that &output fields can hold
   integer, parameter, public :: title_length = 120    !! characters of a scene's title
   integer, parameter, public :: name_length = 32      !! characters of names and cadences
   integer, parameter, public :: choice_length = 16    !! characters of a choice
   integer, parameter, public :: path_length = 240     !! characters of the path of a file that a scene names
   integer, parameter, public :: most_numbers = 8000   !! numbers that a key may list

   !> The namelist groups in the order in which they are written.
   character(6), parameter, public :: group_names(14) = [character(6) :: 'scene', 'domain', 'fluid', 'force', 'tank', 'body', &
                                                         'solid', 'sponge', 'model', 'exact', 'time', 'output', 'probe', 'gauge']

   !> The sides of the box in the order of `side_kinds`.
   character(6), parameter, public :: side_names(4) = [character(6) :: 'left', 'right', 'bottom', 'top']

   !> &scene: what it is called and how fine it is.
   type :: scene_settings
      character(title_length) :: title = ''
      real(dp) :: reference_length = 1.0_dp   !! depth d [m]
      real(dp) :: resolution = 0.0_dp         !! d/dx [-]
   end type scene_settings

   !> &domain: the box and what its four sides are.
   type :: domain_settings
      real(dp) :: lower(2) = [0.0_dp, 0.0_dp]   !! lower left corner [m]
      real(dp) :: upper(2) = [0.0_dp, 0.0_dp]   !! upper right corner [m]
      character(choice_length) :: left = 'free_slip'
      character(choice_length) :: right = 'free_slip'
      character(choice_length) :: bottom = 'free_slip'
      character(choice_length) :: top = 'open'
      real(dp) :: wall_speeds(4) = 0.0_dp   !! of no-slip sides left, right, bottom, top, along the side [m/s]
      character(choice_length) :: images = 'hydrostatic'   !! density of mirror images
   end type domain_settings

   !> &fluid: its constants; after reading, `sound_speed` and `viscosity` are those used.
   type :: fluid_settings
      real(dp) :: density = 1.0_dp           !! rho0, at zero pressure [kg/m3]
      real(dp) :: gravity = 1.0_dp           !! acts along -y [m/s2]
      real(dp) :: mach = 0.0_dp              !! 0: sound_speed was given instead [-]
      real(dp) :: reference_speed = 0.0_dp   !! U_ref; 0: not given, or found by a coarse run [m/s]
      logical :: find_reference_speed = .false.   !! reference_speed = 'auto'
      real(dp) :: sound_speed = 0.0_dp       !! c0 [m/s]
      real(dp) :: viscosity = 0.0_dp         !! dynamic viscosity mu [Pa s]
      real(dp) :: reynolds = 0.0_dp          !! rho0 U d/mu, instead of viscosity; 0: not given [-]
   end type fluid_settings

   !> &force: what acts on the fluid besides gravity.
   type :: force_settings
      real(dp) :: acceleration(2) = 0.0_dp   !! the same everywhere [m/s2]
      real(dp) :: central_rate = 0.0_dp      !! w of the central field -w**2 (r - centre) [1/s]
      real(dp) :: centre(2) = 0.0_dp         !! of the central field [m]
   end type force_settings

   !> &body: a block of fluid at t = 0. After reading, `lower` and `upper` enclose a disc too.
   type :: body_settings
      character(choice_length) :: shape = 'rectangle'
      character(choice_length) :: lattice = 'aligned'   !! how particles stand in a rectangle
      character(choice_length) :: packing = 'rings'     !! how particles stand in a disc
      real(dp) :: lower(2) = [0.0_dp, 0.0_dp]      !! lower left corner [m]
      real(dp) :: upper(2) = [0.0_dp, 0.0_dp]      !! upper right corner [m]
      real(dp) :: centre(2) = [0.0_dp, 0.0_dp]     !! of a disc [m]
      real(dp) :: radius = 0.0_dp                  !! of a disc [m]
      real(dp) :: velocity(2) = [0.0_dp, 0.0_dp]   !! [m/s]
      character(choice_length) :: flow = 'uniform'   !! velocity at the start
      character(choice_length) :: pressure = 'hydrostatic'
   end type body_settings

   !> As many numbers as a scene lists; a scene that lists none keeps none.
   type :: number_list_t
      real(dp), allocatable :: values(:)
   contains
      procedure :: n => numbers_there
   end type number_list_t

   !> How a solid or the tank moves. After reading, `table` holds what its file held, and `amplitude`, `swing` and `ramp` of a wave
   !! maker are those used.
   type :: motion_settings
      character(choice_length) :: motion = 'none'
      real(dp) :: pivot(2) = 0.0_dp                  !! about which it turns [m]
      real(dp) :: velocity(2) = 0.0_dp               !! of uniform motion; of a free body at t = 0 [m/s]
      real(dp) :: spin = 0.0_dp                      !! the same [degrees/s]
      real(dp) :: amplitude(2) = 0.0_dp              !! of an oscillation [m]
      real(dp) :: swing = 0.0_dp                     !! amplitude of its angle [degrees]
      real(dp) :: wave_height = 0.0_dp               !! that a wave maker is to make [m]
      real(dp) :: depth = 0.0_dp                     !! of the still water before it [m]
      real(dp) :: period = 0.0_dp                    !! [s]
      real(dp) :: phase = 0.0_dp                     !! [degrees]
      real(dp) :: ramp = 0.0_dp                      !! within which an oscillation sets in [s]
      character(choice_length) :: table_of = 'position'
      type(number_list_t) :: table                   !! t [s], shift in x and y [m], angle [degrees] of each row, or their
                                                     !! second derivatives
      character(path_length) :: table_file = ''      !! '' after reading
   end type motion_settings

   !> &tank: how the box moves. Its pivot is in the box's own coordinates.
   type, extends(motion_settings) :: tank_settings
   end type tank_settings

   !> &solid: a rigid body in the fluid. After reading, `vertices` holds what its file held, and `pivot`, about which it is also
   !! turned at first and moments are taken, is that used.
   type, extends(motion_settings) :: solid_settings
      character(name_length) :: name = ''
      character(choice_length) :: shape = 'polygon'
      type(number_list_t) :: vertices                !! of a polygon, counter-clockwise: x, y of each [m]
      character(path_length) :: vertices_file = ''   !! '' after reading
      real(dp) :: lower(2) = 0.0_dp                  !! lower left corner of a rectangle [m]
      real(dp) :: upper(2) = 0.0_dp                  !! its upper right corner [m]
      real(dp) :: centre(2) = 0.0_dp                 !! of a disc [m]
      real(dp) :: radius = 0.0_dp                    !! of a disc [m]
      real(dp) :: angle = 0.0_dp                     !! it is turned by, counter-clockwise [degrees]
      character(choice_length) :: surface = 'free_slip'
      character(choice_length) :: fluid = 'cut'      !! what to do with a body of fluid that overlaps it
      real(dp) :: mass = 0.0_dp                      !! of a free body [kg/m]
      real(dp) :: moment_of_inertia = 0.0_dp         !! about its pivot; after reading, that used [kg m]
      character(name_length) :: freedoms(3) = [character(name_length) :: 'x', 'y', 'angle']
      integer :: n_freedoms = 3                      !! entries of `freedoms` in use
      real(dp) :: stiffness(3) = 0.0_dp              !! of its springs [N/m2, N/m2, N]
      real(dp) :: damping(3) = 0.0_dp                !! of its dampers [N s/m2, N s/m2, N s]
   end type solid_settings

   !> &sponge: where waves end.
   type :: sponge_settings
      real(dp) :: lower(2) = 0.0_dp   !! lower left corner [m]
      real(dp) :: upper(2) = 0.0_dp   !! upper right corner [m]
      character(choice_length) :: towards = 'right'   !! the side at which it is strongest
      real(dp) :: rate = 0.0_dp       !! there [1/s]
   end type sponge_settings

   !> &exact: the exact solution that the scene follows.
   type :: exact_settings
      character(choice_length) :: solution = 'none'
      real(dp) :: amplitude = 0.0_dp   !! what it is of: docs/scenes.md
      integer :: waves = 1             !! wavelengths in the box
   end type exact_settings

   !> &model: the diffusive terms.
   type :: model_settings
      real(dp) :: smoothing_ratio = 2.0_dp   !! h/dx [-]
      character(choice_length) :: diffusion = 'dynamic'
      logical :: by_default = .true.   !! the scene does not say which
      real(dp) :: alpha = 0.01_dp   !! of the viscous term [-]
      real(dp) :: delta = 0.1_dp    !! of the density diffusion [-]
      real(dp) :: c_s = 0.12_dp     !! Smagorinsky's constant C_S of the dynamic model [-]
      real(dp) :: c_delta = 1.5_dp  !! C_delta of the dynamic model [-]
      real(dp) :: limit = 0.2_dp    !! of alpha_i and delta_i of the dynamic model [-]
      character(choice_length) :: limiter = 'coefficients'   !! what the limit clips
   end type model_settings

   !> &time: the step and the end of the run.
   type :: time_settings
      real(dp) :: cfl = 1.5_dp             !! dt (c0 + h max|pi|)/h [-]
      character(choice_length) :: beyond_limit = 'reduce'   !! what to do with a cfl that is not stable
      character(choice_length) :: integrator = 'rk4'
      character(choice_length) :: diffusion = 'frozen'      !! when its terms are computed
      real(dp) :: end_time = 0.0_dp        !! [s]
      integer :: max_steps = 0             !! 0: no limit
      real(dp) :: max_wall_time = 0.0_dp   !! 0: no limit [s of the clock on the wall]
      real(dp) :: balance_limit = 0.5_dp   !! share of the energy that the budget may miss; 0: no limit [-]
   end type time_settings

   !> &output: what is written and how often; cadences are read by module `cadence`.
   type :: output_settings
      character(name_length) :: energy = '10 steps'
      character(name_length) :: probes = '1 steps'
      character(name_length) :: errors = '10 steps'
      character(name_length) :: solids = '10 steps'
      character(name_length) :: walls = 'never'
      character(name_length) :: snapshots = '1 time'
      character(name_length) :: fields(max_fields) = &
         [character(name_length) :: 'velocity', 'pressure', '', '', '', '', '', '', '', '', '', '']
      integer :: n_fields = 2              !! entries of `fields` in use
      character(8) :: precision = 'single'
      character(name_length) :: checkpoint = '10 minutes'
   end type output_settings

   !> &probe: a pressure sensor on a wall or a solid.
   type :: probe_settings
      character(name_length) :: name = ''
      real(dp) :: position(2) = [0.0_dp, 0.0_dp]   !! centre [m]
      real(dp) :: diameter = 0.0_dp                !! of its disc; 0: not a disc [m]
      real(dp) :: length = 0.0_dp                  !! of its segment; 0: not a segment [m]
   end type probe_settings

   !> &gauge: a line on which the end of the fluid is looked for.
   type :: gauge_settings
      character(name_length) :: name = ''
      character(choice_length) :: along = 'y'      !! the axis it is parallel to
      real(dp) :: at = 0.0_dp                      !! its other coordinate [m]
      character(choice_length) :: measure = 'end'
   end type gauge_settings

   !> Everything a run needs to know.
   type :: settings_t
      type(scene_settings) :: scene
      type(domain_settings) :: domain
      type(fluid_settings) :: fluid
      type(force_settings) :: force
      type(tank_settings) :: tank
      type(exact_settings) :: exact
      type(model_settings) :: model
      type(time_settings) :: time
      type(output_settings) :: output
      type(body_settings), allocatable :: bodies(:)
      type(solid_settings), allocatable :: solids(:)
      type(sponge_settings), allocatable :: sponges(:)
      type(probe_settings), allocatable :: probes(:)
      type(gauge_settings), allocatable :: gauges(:)
   contains
      procedure :: spacing => particle_spacing
      procedure :: smoothing_length
      procedure :: margin
      procedure :: alpha_total
      procedure :: leans
      procedure :: side_kinds
      procedure :: has_acceleration
   end type settings_t

contains

   !> Initial particle spacing dx = d/resolution [m].
   pure real(dp) function particle_spacing(self)
      class(settings_t), intent(in) :: self

      particle_spacing = self%scene%reference_length/self%scene%resolution
   end function particle_spacing

   !> Smoothing length h [m], 2 dx by default. Source: Sec. 2 of the paper.
   pure real(dp) function smoothing_length(self)
      class(settings_t), intent(in) :: self

      smoothing_length = self%model%smoothing_ratio*self%spacing()
   end function smoothing_length

   !> How far places may lie apart that are meant to be one [m]: they are given in decimals.
   pure real(dp) function margin(self)
      class(settings_t), intent(in) :: self

      margin = 1.0e-9_dp*self%scene%reference_length
   end function margin

   !> The alpha that acts everywhere: the constant model's and the fluid's viscosity together [-].
   !! Source: eq. 16, mu = alpha h c0 rho0/K.
   pure real(dp) function alpha_total(self)
      class(settings_t), intent(in) :: self

      associate (fluid => self%fluid)
         alpha_total = k_2d*fluid%viscosity/(fluid%sound_speed*self%smoothing_length()*fluid%density)
         if (self%model%diffusion == 'constant') alpha_total = alpha_total + self%model%alpha
      end associate
   end function alpha_total

   !> Whether a body's left and right edges lie on walls.
   pure function leans(self, body) result(on_wall)
      class(settings_t), intent(in) :: self
      type(body_settings), intent(in) :: body
      logical :: on_wall(2)   !! left, right

      on_wall = is_wall([self%domain%left, self%domain%right]) .and. &
                abs([body%lower(1) - self%domain%lower(1), body%upper(1) - self%domain%upper(1)]) <= self%margin()
   end function leans

   !> What the left, right, bottom and top side of the box are.
   pure function side_kinds(self) result(kinds_there)
      class(settings_t), intent(in) :: self
      character(choice_length) :: kinds_there(4)

      kinds_there = [self%domain%left, self%domain%right, self%domain%bottom, self%domain%top]
   end function side_kinds

   !> Whether a uniform force acts besides gravity.
   pure logical function has_acceleration(self)
      class(settings_t), intent(in) :: self

      has_acceleration = any(abs(self%force%acceleration) > 0.0_dp)
   end function has_acceleration

   !> How many numbers are listed.
   pure integer function numbers_there(self)
      class(number_list_t), intent(in) :: self

      numbers_there = 0
      if (allocated(self%values)) numbers_there = size(self%values)
   end function numbers_there

   !> True for a side of the box that holds the fluid back.
   elemental logical function is_wall(side)
      character(*), intent(in) :: side   !! one of &domain left, right, bottom, top

      is_wall = side == 'free_slip' .or. side == 'no_slip'
   end function is_wall

end module settings
