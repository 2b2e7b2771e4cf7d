!> Checks what no single key can tell: whether the values of a scene go together.
!!
!! Each check runs only if nothing was wrong in the groups it looks at, so that
!! one slip gives one message.
module settings_check
   use cadence, only: cadence_t
   use findings, only: findings_t
   use kinds, only: dp
   use namelist_document, only: document_t
   use scene_keys, only: largest_mach
   use settings, only: body_settings, is_wall, settings_t
   use text, only: quoted, short, to_text
   implicit none
   private

   public :: check_settings, resolve_sound_speed, largest_cfl

   ! Linear stability of RK4 with frozen diffusion on a square lattice, h = 2 dx.
   real(dp), parameter :: cfl_acoustic = 2.49_dp
   real(dp), parameter :: cfl_times_delta = 0.294_dp
   real(dp), parameter :: cfl_times_alpha = 0.932_dp

   real(dp), parameter :: least_gap = 5.0_dp         ! walls [dx]: images reach 4 dx and a little more, and have no images
   real(dp), parameter :: good_mach = 0.1_dp         ! eq. 4: density varies by 1 %
   real(dp), parameter :: most_particles = 2.0e8_dp  ! positions in the arrays stay below 2**31
   real(dp), parameter :: slack = 1.0e-9_dp          ! of lengths in units of d: rounding of the input

contains

   !> Works out the sound speed from Mach number and reference speed unless it is given.
   subroutine resolve_sound_speed(document, setup, notes)
      type(document_t), intent(in) :: document
      type(settings_t), intent(inout) :: setup
      type(findings_t), intent(inout) :: notes

      if (.not. notes%clean('fluid')) return
      associate (fluid => setup%fluid)
         if (fluid%sound_speed > 0.0_dp) then
            if (fluid%mach > 0.0_dp) then
               call notes%warning(document%place_of('fluid', 1, 'mach'), '&fluid mach = '//to_text(fluid%mach) &
                                  //' has no effect: sound_speed is given; leave one of them out')
               fluid%mach = 0.0_dp
            end if
         else if (.not. fluid%mach > 0.0_dp) then
            call notes%mistake(document%place_of('fluid', 1, 'mach'), 'fluid', &
                               '&fluid needs mach and reference_speed, or sound_speed')
         else if (.not. fluid%reference_speed > 0.0_dp) then
            call notes%mistake(document%place_of('fluid', 1, 'reference_speed'), 'fluid', &
                               '&fluid mach needs a reference_speed above 0 to give the sound speed')
         else
            fluid%sound_speed = fluid%reference_speed/fluid%mach
         end if
      end associate
   end subroutine resolve_sound_speed

   !> Runs all checks. The sound speed must be resolved.
   subroutine check_settings(document, setup, notes)
      type(document_t), intent(in) :: document
      type(settings_t), intent(in) :: setup
      type(findings_t), intent(inout) :: notes

      integer :: i

      call check_box(document, setup, notes)
      call check_mach(document, setup, notes)
      call check_stability(document, setup, notes)
      call check_gravity(document, setup, notes)
      do i = 1, size(setup%bodies)
         call check_body(document, setup, i, notes)
         call check_body_pressure(document, setup, i, notes)
         call check_overlap(document, setup, i, notes)
      end do
      call check_particle_number(document, setup, notes)
      call check_output(document, setup, notes)
      do i = 1, size(setup%probes)
         call check_probe_place(document, setup, i, notes)
         call check_probe_name(document, setup, i, notes)
      end do
   end subroutine check_settings

   !> The box must have an inside.
   subroutine check_box(document, setup, notes)
      type(document_t), intent(in) :: document
      type(settings_t), intent(in) :: setup
      type(findings_t), intent(inout) :: notes

      if (.not. notes%clean('domain')) return
      if (any(setup%domain%upper <= setup%domain%lower)) then
         call notes%mistake(document%place_of('domain', 1, 'upper'), 'domain', '&domain is empty: upper = ' &
                            //to_text(setup%domain%upper)//' must lie above and right of lower = '//to_text(setup%domain%lower))
         return
      end if
      if (.not. notes%clean('scene')) return
      associate (domain => setup%domain, least => least_gap*setup%spacing())
         if (is_wall(domain%left) .and. is_wall(domain%right) .and. domain%upper(1) - domain%lower(1) < least) then
            call notes%mistake(document%place_of('domain', 1, 'upper'), 'domain', '&domain is narrower than ' &
                               //short(least)//', 5 dx between left and right wall: raise the resolution')
         end if
         if (is_wall(domain%bottom) .and. is_wall(domain%top) .and. domain%upper(2) - domain%lower(2) < least) then
            call notes%mistake(document%place_of('domain', 1, 'upper'), 'domain', '&domain is lower than ' &
                               //short(least)//', 5 dx between bottom and top wall: raise the resolution')
         end if
      end associate
   end subroutine check_box

   !> The fluid should be only weakly compressible.
   subroutine check_mach(document, setup, notes)
      type(document_t), intent(in) :: document
      type(settings_t), intent(in) :: setup
      type(findings_t), intent(inout) :: notes

      real(dp) :: mach
      character(:), allocatable :: key

      if (.not. notes%clean('fluid')) return
      mach = setup%fluid%reference_speed/setup%fluid%sound_speed
      if (notes%clean('body')) call check_speeds(document, setup, notes)
      key = 'mach'
      if (.not. setup%fluid%mach > 0.0_dp) key = 'sound_speed'
      if (mach > largest_mach*(1.0_dp + slack)) then
         call notes%mistake(document%place_of('fluid', 1, key), 'fluid', '&fluid: reference_speed/sound_speed = ' &
                            //to_text(mach)//' is a Mach number above '//to_text(largest_mach) &
                            //'; raise sound_speed, best to 10 times reference_speed')
      else if (mach > good_mach*(1.0_dp + slack)) then
         call notes%warning(document%place_of('fluid', 1, key), '&fluid: the Mach number '//to_text(mach) &
                            //' is above 0.1: the density will vary by more than 1 %')
      end if
   end subroutine check_mach

   ! What the bodies start with must be slower than sound: their velocities, and falling by their own height.
   subroutine check_speeds(document, setup, notes)
      type(document_t), intent(in) :: document
      type(settings_t), intent(in) :: setup
      type(findings_t), intent(inout) :: notes

      real(dp) :: speed
      integer :: i

      do i = 1, size(setup%bodies)
         associate (body => setup%bodies(i), c0 => setup%fluid%sound_speed)
            speed = max(norm2(body%velocity), sqrt(setup%fluid%gravity*max(0.0_dp, body%upper(2) - body%lower(2))))
            if (speed > 2*c0) then
               call notes%mistake(document%place_of('body', i, 'velocity'), 'body', '&body number '//to_text(i) &
                                  //': its speed, given or by falling its height, is '//short(speed/c0) &
                                  //' times the sound speed '//short(c0)//'; raise sound_speed (or lower mach)')
            else if (speed > largest_mach*c0) then
               call notes%warning(document%place_of('body', i, 'velocity'), '&body number '//to_text(i) &
                                  //': its speed, given or by falling its height, is '//short(speed/c0)//' times the sound speed')
            end if
         end associate
      end do
   end subroutine check_speeds

   !> Largest CFL number at which the frozen diffusion stays stable.
   !! Source: linear stability analysis of the scheme on a square lattice with h = 2 dx.
   pure real(dp) function largest_cfl(delta, alpha)
      real(dp), intent(in) :: delta   !! [-]
      real(dp), intent(in) :: alpha   !! model and viscosity together [-]

      largest_cfl = cfl_acoustic
      if (delta*cfl_acoustic > cfl_times_delta) largest_cfl = cfl_times_delta/delta
      if (alpha*largest_cfl > cfl_times_alpha) largest_cfl = cfl_times_alpha/alpha
   end function largest_cfl

   !> The time step must be stable.
   subroutine check_stability(document, setup, notes)
      type(document_t), intent(in) :: document
      type(settings_t), intent(in) :: setup
      type(findings_t), intent(inout) :: notes

      real(dp) :: alpha, limit
      character(:), allocatable :: advice

      if (.not. (notes%clean('time') .and. notes%clean('model') .and. notes%clean('fluid') .and. notes%clean('scene'))) return
      alpha = setup%alpha_total()
      associate (cfl => setup%time%cfl, delta => setup%model%delta)
         limit = largest_cfl(delta, alpha)
         if (cfl > limit*(1.0_dp + slack)) then
            advice = 'lower cfl'
            if (cfl <= cfl_acoustic .and. cfl*delta > cfl_times_delta) &
               advice = advice//', or delta to '//rounded_down(cfl_times_delta/cfl)
            if (cfl <= cfl_acoustic .and. cfl*alpha > cfl_times_alpha) advice = advice//', or alpha (with the viscosity) to ' &
                                                                                //rounded_down(cfl_times_alpha/cfl)
            call notes%mistake(document%place_of('time', 1, 'cfl'), 'time', '&time cfl = '//to_text(cfl) &
                               //' is unstable with delta = '//to_text(delta)//' and alpha = '//short(alpha) &
                               //': at most '//rounded_down(limit)//' = min(2.49, 0.294/delta, 0.932/alpha); '//advice)
         end if
      end associate
      if (setup%fluid%viscosity > 0.0_dp .and. setup%model%alpha > 0.0_dp) then
         call notes%warning(document%place_of('fluid', 1, 'viscosity'), '&fluid viscosity and &model alpha = ' &
                            //to_text(setup%model%alpha)//' both act, alpha = '//short(alpha) &
                            //' in all; set alpha = 0 for the viscosity alone')
      end if
   end subroutine check_stability

   !> A number rounded down to four digits, so that a limit can be copied from a message.
   pure function rounded_down(number) result(words)
      real(dp), intent(in) :: number
      character(:), allocatable :: words

      real(dp) :: digit

      digit = 10.0_dp**(floor(log10(max(number, tiny(number)))) - 3)
      words = to_text(0.0_dp)
      if (number > 0.0_dp) words = trimmed_number(floor(number/digit + slack)*digit)
   end function rounded_down

   !> A number to four digits, as text.
   pure function trimmed_number(number) result(words)
      real(dp), intent(in) :: number
      character(:), allocatable :: words

      character(24) :: buffer
      real(dp) :: rounded

      write (buffer, '(es24.3e3)') number
      read (buffer, *) rounded
      words = to_text(rounded)
   end function trimmed_number

   !> Without gravity, what is hydrostatic has no effect.
   subroutine check_gravity(document, setup, notes)
      type(document_t), intent(in) :: document
      type(settings_t), intent(in) :: setup
      type(findings_t), intent(inout) :: notes

      character(*), parameter :: why = " = 'hydrostatic' has no effect: gravity is 0"
      integer :: i

      if (.not. notes%clean('fluid') .or. setup%fluid%gravity > 0.0_dp) return
      if (document%given('domain', 1, 'images') .and. setup%domain%images == 'hydrostatic') then
         call notes%warning(document%place_of('domain', 1, 'images'), '&domain images'//why)
      end if
      do i = 1, size(setup%bodies)
         if (setup%bodies(i)%pressure == 'hydrostatic' .and. document%given('body', i, 'pressure')) then
            call notes%warning(document%place_of('body', i, 'pressure'), '&body pressure'//why)
         end if
      end do
   end subroutine check_gravity

   !> A body must have particles and stay behind the walls.
   subroutine check_body(document, setup, number, notes)
      type(document_t), intent(in) :: document
      type(settings_t), intent(in) :: setup
      integer, intent(in) :: number
      type(findings_t), intent(inout) :: notes

      real(dp) :: extent(2), margin
      character(:), allocatable :: side

      if (.not. (notes%clean('body') .and. notes%clean('scene') .and. notes%clean('domain'))) return
      associate (body => setup%bodies(number), dx => setup%spacing(), domain => setup%domain)
         margin = slack*setup%scene%reference_length
         extent = body%upper - body%lower
         if (any(extent < dx - margin)) then
            call notes%mistake(document%place_of('body', number, 'upper'), 'body', '&body is '//to_text(extent) &
                               //' wide and high; it must be at least one particle, dx = '//short(dx)//', each way')
            return
         end if
         side = ''
         if (is_wall(domain%top) .and. body%upper(2) > domain%upper(2) + margin) side = 'top'
         if (is_wall(domain%bottom) .and. body%lower(2) < domain%lower(2) - margin) side = 'bottom'
         if (is_wall(domain%right) .and. body%upper(1) > domain%upper(1) + margin) side = 'right'
         if (is_wall(domain%left) .and. body%lower(1) < domain%lower(1) - margin) side = 'left'
         if (side /= '') call notes%mistake(document%place_of('body', number, 'lower'), 'body', '&body from ' &
                                            //to_text(body%lower)//' to '//to_text(body%upper)//' lies beyond the ' &
                                            //side//' wall of &domain; move the body or the wall')
         if (any(abs(extent/dx - anint(extent/dx)) > 1.0e-6_dp)) then
            call notes%warning(document%place_of('body', number, 'upper'), '&body is '//to_text(extent) &
                               //' wide and high, no multiple of dx = '//short(dx)//': particles will not end at its edges')
         end if
      end associate
   end subroutine check_body

   !> The series of the incompressible pressure holds for a column in a corner with one free side.
   subroutine check_body_pressure(document, setup, number, notes)
      type(document_t), intent(in) :: document
      type(settings_t), intent(in) :: setup
      integer, intent(in) :: number
      type(findings_t), intent(inout) :: notes

      character(*), parameter :: what = "&body pressure = 'incompressible' needs "
      character(*), parameter :: instead = "; choose 'hydrostatic' or 'zero'"
      real(dp) :: margin
      character(:), allocatable :: need

      if (setup%bodies(number)%pressure /= 'incompressible') return
      if (.not. (notes%clean('body') .and. notes%clean('scene') .and. notes%clean('domain') .and. notes%clean('fluid'))) return
      associate (body => setup%bodies(number), domain => setup%domain)
         margin = slack*setup%scene%reference_length
         need = ''
         if (count(setup%leans(body)) /= 1) need = 'one side at a wall and the other free'
         if (.not. is_wall(domain%bottom) .or. abs(body%lower(2) - domain%lower(2)) > margin) then
            need = 'a body that stands on the floor'
         end if
         if (.not. setup%fluid%gravity > 0.0_dp) need = 'gravity above 0'
      end associate
      if (need /= '') call notes%mistake(document%place_of('body', number, 'pressure'), 'body', what//need//instead)
   end subroutine check_body_pressure

   !> Bodies must not lie on each other.
   subroutine check_overlap(document, setup, number, notes)
      type(document_t), intent(in) :: document
      type(settings_t), intent(in) :: setup
      integer, intent(in) :: number
      type(findings_t), intent(inout) :: notes

      real(dp) :: overlap(2)
      integer :: other

      if (.not. (notes%clean('body') .and. notes%clean('scene'))) return
      associate (body => setup%bodies(number))
         do other = 1, number - 1
            overlap = min(body%upper, setup%bodies(other)%upper) - max(body%lower, setup%bodies(other)%lower)
            if (all(overlap > slack*setup%scene%reference_length)) then
               call notes%mistake(document%place_of('body', number, 'lower'), 'body', '&body number '//to_text(number) &
                                  //' overlaps number '//to_text(other)//' by '//to_text(overlap)//'; move one of them')
            end if
         end do
      end associate
   end subroutine check_overlap

   !> All particles must fit.
   subroutine check_particle_number(document, setup, notes)
      type(document_t), intent(in) :: document
      type(settings_t), intent(in) :: setup
      type(findings_t), intent(inout) :: notes

      real(dp) :: particles
      integer :: i

      if (.not. (notes%clean('body') .and. notes%clean('scene'))) return
      particles = 0.0_dp
      do i = 1, size(setup%bodies)
         particles = particles + product((setup%bodies(i)%upper - setup%bodies(i)%lower)/setup%spacing())
      end do
      if (particles >= most_particles) then
         call notes%mistake(document%place_of('scene', 1, 'resolution'), 'scene', '&scene resolution = ' &
                            //to_text(setup%scene%resolution)//' makes about '//rounded_down(particles)//' particles; at most ' &
                            //to_text(most_particles)//' are possible: lower it')
      end if
   end subroutine check_particle_number

   !> Cadences must be readable, and something must be there to be written.
   subroutine check_output(document, setup, notes)
      type(document_t), intent(in) :: document
      type(settings_t), intent(in) :: setup
      type(findings_t), intent(inout) :: notes

      call check_cadence(document, 'energy', setup%output%energy, notes)
      call check_cadence(document, 'probes', setup%output%probes, notes)
      call check_cadence(document, 'snapshots', setup%output%snapshots, notes)
      if (size(setup%probes) == 0 .and. document%given('output', 1, 'probes')) then
         call notes%warning(document%place_of('output', 1, 'probes'), '&output probes has no effect: there is no &probe')
      end if
   end subroutine check_output

   !> A cadence must be readable.
   subroutine check_cadence(document, key, phrase, notes)
      type(document_t), intent(in) :: document
      character(*), intent(in) :: key, phrase
      type(findings_t), intent(inout) :: notes

      type(cadence_t) :: parsed
      character(:), allocatable :: message

      call parsed%parse(phrase, message)
      if (message /= '') call notes%mistake(document%place_of('output', 1, key), 'output', '&output '//key//': '//message)
   end subroutine check_cadence

   !> A probe must lie at a wall.
   subroutine check_probe_place(document, setup, number, notes)
      type(document_t), intent(in) :: document
      type(settings_t), intent(in) :: setup
      integer, intent(in) :: number
      type(findings_t), intent(inout) :: notes

      real(dp) :: distance(4)
      logical :: walls(4)
      character(:), allocatable :: problem

      if (.not. (notes%clean('probe') .and. notes%clean('scene') .and. notes%clean('domain'))) return
      associate (at => setup%probes(number)%position, domain => setup%domain)
         walls = is_wall([domain%left, domain%bottom, domain%right, domain%top])
         distance = [at - domain%lower, domain%upper - at]
         problem = ''
         if (.not. any(walls)) then
            problem = 'needs a wall, and all sides of &domain are open'
         else if (any(distance < -slack*setup%scene%reference_length)) then
            problem = 'lies outside the box'
         else if (minval(distance, walls) > setup%smoothing_length()) then
            problem = 'lies '//short(minval(distance, walls))//' m from the nearest wall; put it on one'
         end if
         if (problem /= '') call notes%mistake(document%place_of('probe', number, 'position'), 'probe', &
                                               '&probe position = '//to_text(at)//' '//problem)
      end associate
   end subroutine check_probe_place

   !> A probe's name heads a column: it must be one word and its own.
   subroutine check_probe_name(document, setup, number, notes)
      type(document_t), intent(in) :: document
      type(settings_t), intent(in) :: setup
      integer, intent(in) :: number
      type(findings_t), intent(inout) :: notes

      character(*), parameter :: allowed = &
                                 'abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-'

      if (.not. notes%clean('probe')) return
      associate (name => setup%probes(number)%name)
         if (verify(trim(name), allowed) > 0) then
            call notes%mistake(document%place_of('probe', number, 'name'), 'probe', '&probe name = '//quoted(name) &
                               //' may have letters, digits, _ and - only')
         else if (name == 'time' .or. name == 'time_scaled') then
            call notes%mistake(document%place_of('probe', number, 'name'), 'probe', '&probe name = '//quoted(name) &
                               //' is the name of another column of probes.dat; choose another')
         else if (any(setup%probes(:number - 1)%name == name)) then
            call notes%mistake(document%place_of('probe', number, 'name'), 'probe', '&probe name = '//quoted(name) &
                               //' is the name of an earlier probe')
         end if
      end associate
   end subroutine check_probe_name

end module settings_check
