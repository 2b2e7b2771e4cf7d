!> &fluid reference_speed = 'auto': coarse runs of the same scene find U_ref before the run proper.
!!
!! Source: what the authors did by hand; U_ref = max(|u|, sqrt(p/rho)) of eq. 4. Single particles, and sound waves
!! that an impact sends out, exceed what the flow as a whole does, so U_ref is a quantile over the particles and over
!! time. It depends weakly on the sound speed: a very coarse run with a guess comes first, then a finer one with what
!! the first one found (docs/equations.md).
module preliminary
   use derived_settings, only: set_reference_speed
   use communication, only: largest_of_all
   use equation_of_state, only: specific_pressure
   use errors, only: exit_input, exit_numerics, exit_stopped, failure
   use kinds, only: dp
   use model, only: model_t
   use neighbours, only: neighbours_t
   use particles, only: particles_t
   use omp_lib, only: omp_set_num_threads
   use progress, only: progress_t
   use quantiles, only: quantile, weighted_quantile
   use result_directory, only: result_directory_t
   use run_log, only: log_t
   use scene_keys, only: resolution_range
   use scene_setup, only: count_particles, set_up_model, set_up_particles
   use settings, only: is_wall, settings_t
   use sponge_check, only: largest_rate
   use step_check, only: check_step
   use step_state, only: step_t
   use stopping, only: stopping_t
   use text, only: short, to_text
   use threads, only: limit_threads
   use time_step, only: advance, refresh
   use timers, only: timers_t, wall_seconds
   implicit none
   private

   public :: find_reference_speed, coarse_scene, preliminary_text

   !> Shares of the resolution of the two runs; the sum of their cubes, 1.9 %, is that of the cost.
   real(dp), parameter, public :: coarse_share(2) = [0.15_dp, 0.25_dp]
   real(dp), parameter :: largest_cost = 0.02_dp       !! of the run, that is not mentioned
   real(dp), parameter :: least_across = 4             !! particles across the thinnest body
   real(dp), parameter :: particle_share = 0.995_dp    !! particles that are not faster than U_ref,
   real(dp), parameter :: time_share = 0.99_dp         !! and how much of the time
   !> What coarse particles do not see: they stand half a spacing from walls, where pressure is highest.
   real(dp), parameter :: margin = 1.05_dp
   real(dp), parameter :: good_enough = 0.2_dp         !! deviation from the Mach number asked for that is not repeated

   !> What a coarse run found.
   type :: finding_t
      real(dp) :: speed = 0      !! U_ref
      real(dp) :: briefly = 0    !! largest of the quantile over the particles
      real(dp) :: time = 0       !! when it was reached
      real(dp) :: fastest = 0    !! largest of a single particle
      real(dp), allocatable :: history(:)     !! (steps, with room for more) the quantile over the particles
      real(dp), allocatable :: durations(:)   !! (steps, with room for more)
      integer :: steps = 0
   end type finding_t

contains

   !> Finds the reference speed, and with it sets the sound speed for the Mach number asked for.
   subroutine find_reference_speed(scene, stop, directory, log, problem)
      type(settings_t), intent(inout) :: scene   !! find_reference_speed is .true., sound_speed a guess
      type(stopping_t), intent(inout) :: stop
      type(result_directory_t), intent(inout) :: directory   !! of the run proper
      type(log_t), intent(inout) :: log
      type(failure), intent(inout) :: problem    !! exit_numerics: a coarse run failed; exit_stopped; exit_input: no time for them
      type(settings_t) :: coarse
      type(finding_t) :: found
      real(dp) :: started, cost
      integer :: pass

      started = wall_seconds()
      cost = 0
      call log%line(preliminary_text(scene))
      do pass = 1, 2
         coarse = coarse_scene(scene, coarse_share(pass)*scene%scene%resolution)
         call run_coarse(coarse, stop, directory, log, found, problem)
         if (stop%reason /= '' .and. .not. problem%raised()) call say_that_it_was_stopped(scene, stop%reason, problem)
         if (.not. (problem%raised() .or. found%speed > 0)) call problem%raise(exit_numerics, &
            "&fluid reference_speed = 'auto': nothing moved in the preliminary run; give it a number")
         if (problem%raised()) return
         cost = cost + share_of_cost(scene, coarse)
         call log%line('preliminary run '//to_text(pass)//': d/dx = '//short(coarse%scene%resolution)//', c0 = ' &
                       //short(coarse%fluid%sound_speed)//', U_ref = '//short(found%speed)//'; briefly '//short(found%briefly) &
                       //' (t = '//short(found%time)//'), fastest particle '//short(found%fastest))
         if (is_enough(scene, coarse, found)) exit
         scene%fluid%sound_speed = found%speed/scene%fluid%mach
      end do
      call set_reference_speed(scene, three_digits(found%speed))
      call report(scene, cost, wall_seconds() - started, log)
   end subroutine find_reference_speed

   ! Whether the first run need not be followed by a second: it was as fine and had the Mach number asked for.
   pure logical function is_enough(scene, coarse, found)
      type(settings_t), intent(in) :: scene, coarse
      type(finding_t), intent(in) :: found
      type(settings_t) :: second

      second = coarse_scene(scene, coarse_share(2)*scene%scene%resolution)
      associate (mach => scene%fluid%mach)
         is_enough = coarse%scene%resolution >= second%scene%resolution &
                     .and. abs(found%speed/coarse%fluid%sound_speed - mach) <= good_enough*mach
      end associate
   end function is_enough

   !> The same scene with fewer particles, but as many as still show what the flow does.
   pure type(settings_t) function coarse_scene(scene, resolution) result(coarse)
      type(settings_t), intent(in) :: scene
      real(dp), intent(in) :: resolution   !! wanted
      real(dp) :: least, extent(2)
      real(dp) :: least_between   ! spacings between opposite sides
      integer :: k

      coarse = scene
      coarse%output%n_fields = 0
      ! With rk2 the viscosity, weaker in units of larger particles, may not damp sound at any step.
      coarse%time%integrator = 'rk4'
      associate (domain => scene%domain, d => scene%scene%reference_length)
         least = resolution_range(1)
         do k = 1, size(scene%bodies)
            least = max(least, least_across*d/minval(scene%bodies(k)%upper - scene%bodies(k)%lower))
         end do
         extent = domain%upper - domain%lower
         least_between = 4*scene%model%smoothing_ratio + 2
         if (closed(domain%left, domain%right)) least = max(least, least_between*d/extent(1))
         if (closed(domain%bottom, domain%top)) least = max(least, least_between*d/extent(2))
         coarse%scene%resolution = min(max(resolution, least), scene%scene%resolution)
      end associate
      ! Its steps are longer.
      if (allocated(coarse%sponges)) coarse%sponges%rate = min(coarse%sponges%rate, largest_rate(coarse))
      ! The run proper may end early, and then the flow must not be asked what it does later.
      if (scene%time%max_steps > 0) &
         coarse%time%end_time = min(scene%time%end_time, scene%time%max_steps*longest_step(scene))
   end function coarse_scene

   ! Opposite sides have images of the same fluid.
   pure logical function closed(side, other)
      character(*), intent(in) :: side, other

      closed = (is_wall(side) .and. is_wall(other)) .or. side == 'periodic'
   end function closed

   pure real(dp) function longest_step(scene)
      type(settings_t), intent(in) :: scene
      type(model_t) :: model

      model = set_up_model(scene)
      longest_step = model%longest_step()
   end function longest_step

   !> What will be done, in a line.
   function preliminary_text(scene) result(words)
      type(settings_t), intent(in) :: scene
      character(:), allocatable :: words
      type(settings_t) :: first, second

      first = coarse_scene(scene, coarse_share(1)*scene%scene%resolution)
      second = coarse_scene(scene, coarse_share(2)*scene%scene%resolution)
      words = short(first%scene%resolution)
      if (second%scene%resolution > first%scene%resolution) words = words//' and '//short(second%scene%resolution)
      words = "reference_speed = 'auto': c0 = "//short(scene%fluid%sound_speed)//' is a guess; preliminary runs at d/dx = ' &
              //words//' find it, for about ' &
              //short(100*(share_of_cost(scene, first) + share_of_cost(scene, second)))//' % of the cost of the run'
   end function preliminary_text

   ! Of a coarse run, in parts of the run proper: particles times steps.
   pure real(dp) function share_of_cost(scene, coarse) result(share)
      type(settings_t), intent(in) :: scene, coarse

      share = real(count_particles(coarse), dp)/count_particles(scene)*longest_step(scene)/longest_step(coarse)
   end function share_of_cost

   ! Runs the coarse scene to its end, with the largest speeds for its only result.
   subroutine run_coarse(scene, stop, directory, log, found, problem)
      type(settings_t), intent(in) :: scene
      type(stopping_t), intent(inout) :: stop   !! it ends earlier where there is a reason to
      type(result_directory_t), intent(inout) :: directory
      type(log_t), intent(inout) :: log
      type(finding_t), intent(out) :: found
      type(failure), intent(inout) :: problem
      type(model_t) :: model
      type(particles_t) :: p
      type(neighbours_t) :: near
      type(step_t) :: run
      type(timers_t) :: timers
      type(progress_t) :: progress
      type(failure) :: trouble
      integer :: threads_before
      logical :: stops(1)

      call timers%initialise([character(24) :: 'sort', 'gradients', 'diffusion', 'stages'])
      model = set_up_model(scene)
      call set_up_particles(scene, model, p)
      call limit_threads(p%n, threads_before)
      call progress%start(0.0_dp, scene%time%end_time, 0, p%n)
      call refresh(model, p, near, run, timers)
      do while (.not. run%scattered)
         call watch_speeds(model, p, run, found)
         call stop%watch(directory)
         if (run%time >= scene%time%end_time) exit
         stops = stop%reason /= ''
         call advance(model, p, near, run, scene%time%end_time, timers, stops)
         if (stops(1)) exit
         call check_step(model, p, run, scene%time%end_time, trouble)
         if (trouble%raised()) exit
         call refresh(model, p, near, run, timers)
         call progress%update(log, run%time, run%dt, run%step)
      end do
      call stop%agree()
      call omp_set_num_threads(threads_before)
      if (run%scattered .and. .not. trouble%raised()) call check_step(model, p, run, scene%time%end_time, trouble)
      if (trouble%raised()) call problem%raise(exit_numerics, "the preliminary run for &fluid reference_speed = 'auto' (d/dx = " &
         //short(scene%scene%resolution)//', c0 = '//short(model%c0)//') failed; give reference_speed a number.' &
         //new_line('a')//trouble%message)
      if (found%steps > 0) found%speed = margin &
         *weighted_quantile(found%history(:found%steps), found%durations(:found%steps), time_share)
   end subroutine run_coarse

   ! Coarse runs are not kept. Where their time is over already, beginning again would come to the same end.
   subroutine say_that_it_was_stopped(scene, reason, problem)
      type(settings_t), intent(in) :: scene
      character(*), intent(in) :: reason
      type(failure), intent(inout) :: problem
      character(*), parameter :: where = "the preliminary runs for &fluid reference_speed = 'auto'"

      if (reason == 'max_wall_time') then
         call problem%raise(exit_input, '&time max_wall_time = '//short(scene%time%max_wall_time)//' s was over in '//where &
                            //'; give more time, or reference_speed a number')
      else
         call problem%raise(exit_stopped, 'stopped in '//where//', of which nothing is kept: '//reason &
                            //'. The same command begins again')
      end if
   end subroutine say_that_it_was_stopped

   ! Takes the base state's speeds; they count for as long as the step that led to them.
   subroutine watch_speeds(model, p, run, found)
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      type(step_t), intent(in) :: run
      type(finding_t), intent(inout) :: found
      real(dp), allocatable :: speeds(:)

      call speeds_of(model, p, speeds)
      call largest_of_all(size(speeds), speeds)   ! those of other processes are 0; coarse runs are small
      found%fastest = max(found%fastest, maxval(speeds))
      if (.not. allocated(found%history)) allocate (found%history(1024), found%durations(1024))
      if (found%steps == size(found%history)) then
         found%history = [found%history, found%history]
         found%durations = [found%durations, found%durations]
      end if
      found%steps = found%steps + 1
      found%history(found%steps) = quantile(speeds, particle_share)
      found%durations(found%steps) = run%dt
      if (found%history(found%steps) > found%briefly) then
         found%briefly = found%history(found%steps)
         found%time = run%time
      end if
   end subroutine watch_speeds

   ! max(|u|, sqrt(p/rho)) of each particle, eq. 4.
   pure subroutine speeds_of(model, p, speeds)
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      real(dp), allocatable, intent(out) :: speeds(:)   !! (n)
      integer :: i

      allocate (speeds(p%n), source=0.0_dp)
      do i = 1, p%n_own
         if (p%id(i) == 0) cycle
         associate (u => p%base%u(i), v => p%base%v(i), s => p%base%s(i))
            speeds(p%id(i)) = sqrt(max(u**2 + v**2, specific_pressure(model%c0, model%rho0, s)))
         end associate
      end do
   end subroutine speeds_of

   ! No more digits than it is worth; and then the last ones of the machine do not matter.
   pure real(dp) function three_digits(number) result(rounded)
      real(dp), intent(in) :: number
      character(16) :: buffer

      write (buffer, '(es16.2)') number
      read (buffer, *) rounded
   end function three_digits

   subroutine report(scene, cost, seconds, log)
      type(settings_t), intent(in) :: scene   !! with the speed found
      real(dp), intent(in) :: cost            !! of the preliminary runs, in parts of the run proper
      real(dp), intent(in) :: seconds
      type(log_t), intent(inout) :: log

      call log%line('reference_speed = '//short(scene%fluid%reference_speed)//', '//short(margin)//' times what ' &
                    //short(100*particle_share)//' % of the particles stay below for '//short(100*time_share) &
                    //' % of the time; c0 = '//short(scene%fluid%sound_speed)//' for Ma '//short(scene%fluid%mach))
      call log%line('this took '//short(seconds)//' s, about '//short(100*cost)//' % of the cost of the run')
      if (cost > largest_cost) call log%line('that is more than '//short(100*largest_cost) &
                                             //' %: still fewer particles would not show what this flow does')
   end subroutine report

end module preliminary
