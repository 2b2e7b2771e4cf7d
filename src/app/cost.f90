!> What a run will cost: a few steps of the scene are timed, and a coarse run of the same flow says how long its steps will be.
!!
!! Both together take less than a second, and a small part of what a short run takes.
module cost
   use communication, only: any_process, n_processes
   use errors, only: failure
   use kinds, only: dp
   use model, only: model_t
   use neighbours, only: neighbours_t
   use omp_lib, only: omp_get_max_threads, omp_set_num_threads
   use particles, only: bytes_per_slot, particles_t
   use preliminary, only: coarse_scene
   use scene_setup, only: count_particles, needed_features, set_up_model, set_up_particles
   use settings, only: settings_t
   use step_check, only: check_step
   use step_state, only: step_t
   use threads, only: limit_threads
   use time_step, only: advance, refresh
   use timers, only: timers_t, wall_seconds
   implicit none
   private

   public :: cost_t, estimate_cost

   real(dp), parameter :: coarse_particles = 300, timed_particles = 50000   !! at most, about
   real(dp), parameter :: longest_trial = 0.4_dp   !! of each of the two [s]
   real(dp), parameter :: trial_share = 0.02_dp    !! of the run's time, for each of the two
   real(dp), parameter :: guessed_ns = 600.0_dp    !! per particle-step and core, to begin with
   real(dp), parameter :: guessed_step_share = 0.8_dp
   !> Steps of a flow that has lost the order it starts with take longer: the particles are sorted more often, and no longer lie
   !! in rows. Measured (docs/results.md).
   real(dp), parameter :: disorder = 1.1_dp

   !> What a run will cost, roughly.
   type :: cost_t
      integer :: particles = 0
      real(dp) :: dt = 0        !! largest step
      real(dp) :: steps = 0
      real(dp) :: ns = guessed_ns   !! per particle-step and core
      real(dp) :: seconds = 0   !! of wall time
      real(dp) :: bytes = 0
   end type cost_t

contains

   !> Steps, time and memory of a scene on the threads that there are.
   type(cost_t) function estimate_cost(scene, model, particles) result(found)
      type(settings_t), intent(in) :: scene
      type(model_t), intent(in) :: model
      integer, intent(in) :: particles

      found%particles = particles
      found%dt = model%longest_step()
      ! Slots of padding and images, neighbour lists and sorting besides the particles' own.
      found%bytes = particles*(1.25_dp*bytes_per_slot(needed_features(scene, model)) + 150)
      found%steps = steps_of(scene, guessed_step_share*found%dt)
      call reckon(found)
      found%ns = timed_ns(scene, min(longest_trial, trial_share*found%seconds))
      found%steps = steps_of(scene, step_share(scene, min(longest_trial, trial_share*found%seconds))*found%dt)
      call reckon(found)
   end function estimate_cost

   pure real(dp) function steps_of(scene, dt) result(steps)
      type(settings_t), intent(in) :: scene
      real(dp), intent(in) :: dt

      steps = scene%time%end_time/dt
      if (scene%time%max_steps > 0) steps = min(steps, real(scene%time%max_steps, dp))
   end function steps_of

   subroutine reckon(found)
      type(cost_t), intent(inout) :: found

      found%seconds = found%steps*found%particles*found%ns*1.0e-9_dp/cores()
   end subroutine reckon

   ! That all processes compute on.
   integer function cores()
      cores = omp_get_max_threads()*n_processes()
   end function cores

   ! ns per particle-step and core of the scene's first steps, or of those of a coarser one if it is large, in a disordered flow.
   real(dp) function timed_ns(scene, seconds) result(ns)
      type(settings_t), intent(in) :: scene
      real(dp), intent(in) :: seconds   !! to spend
      type(step_t) :: run
      real(dp) :: taken
      integer :: particles

      call run_for(coarse_scene(scene, scene%scene%resolution*sqrt(timed_particles/count_particles(scene))), 1, seconds, &
                   particles, run, taken)
      ns = guessed_ns
      if (run%step > 0) ns = disorder*taken*cores()*1.0e9_dp/(real(run%step, dp)*particles)
   end function timed_ns

   ! Mean step over the largest, in a coarse run of the scene.
   real(dp) function step_share(scene, seconds) result(share)
      type(settings_t), intent(in) :: scene
      real(dp), intent(in) :: seconds
      type(settings_t) :: coarse
      type(model_t) :: model
      type(step_t) :: run
      real(dp) :: taken
      integer :: particles

      coarse = coarse_scene(scene, scene%scene%resolution*sqrt(coarse_particles/count_particles(scene)))
      call run_for(coarse, 0, seconds, particles, run, taken)
      share = guessed_step_share
      model = set_up_model(coarse)
      if (run%step > 0) share = run%time/(run%step*model%longest_step())
   end function step_share

   ! Runs a scene for a time of the wall clock or to its end, on no more threads than it has work for.
   subroutine run_for(scene, left_out, seconds, particles, run, taken)
      type(settings_t), intent(in) :: scene
      integer, intent(in) :: left_out     !! steps at the start that are not counted
      real(dp), intent(in) :: seconds
      integer, intent(out) :: particles
      type(step_t), intent(out) :: run    !! steps and time counted
      real(dp), intent(out) :: taken      !! wall time of these steps [s]
      type(model_t) :: model
      type(particles_t) :: p
      type(neighbours_t) :: near
      type(timers_t) :: timers
      type(failure) :: trouble
      real(dp) :: started
      integer :: before, first
      logical :: over

      call timers%initialise([character(8) :: 'sort', 'first', 'second', 'stages'])
      model = set_up_model(scene)
      call set_up_particles(scene, model, p)
      call limit_threads(p%n, before)
      particles = p%n
      call refresh(model, p, near, run, timers)
      started = wall_seconds()
      first = 0
      taken = 0
      do
         over = run%scattered .or. run%time >= scene%time%end_time .or. taken >= seconds
         if (any_process(over)) exit
         call advance(model, p, near, run, scene%time%end_time, timers)
         call check_step(model, p, run, scene%time%end_time, trouble)
         if (trouble%raised()) exit
         call refresh(model, p, near, run, timers)
         if (run%step <= left_out) then
            started = wall_seconds()
            first = run%step
         end if
         taken = wall_seconds() - started
      end do
      run%step = run%step - first
      call omp_set_num_threads(before)
   end subroutine run_for

end module cost
