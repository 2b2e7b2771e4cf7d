!> What a run tells its user: start box, closing table and summary.
module report
   use box, only: bottom_wall, is_wall, left_wall, no_slip_wall, periodic_side, right_wall, top_wall
   use budget, only: budget_t
   use build_info, only: build_type, git_id, version
   use cadence, only: cadence_t
   use communication, only: largest_of_all, library_words, n_processes, reductions, sums_of_all
   use cost, only: cost_t
   use errors, only: failure
   use exact_sum, only: exact_totals
   use kernel, only: k_2d
   use kinds, only: dp, i8
   use lanes, only: nl, root_name
   use limits, only: sound_speed_for_density, sound_speed_for_mach
   use model, only: model_t, terms_t
   use omp_lib, only: omp_get_max_threads
   use progress, only: duration_text
   use room, only: output_bytes
   use run_log, only: log_t
   use run_state, only: run_state_t
   use settings, only: settings_t
   use step_state, only: step_t
   use summary, only: summary_t
   use text, only: short, to_text
   use timers, only: timers_t
   use wave_motions, only: waves_text
   implicit none
   private

   public :: start_box, closing_table, write_summary_file

   character(*), parameter :: peak_names(4) = [character(24) :: 'time_kinetic_maximum', 'time_potential_maximum', &
                                               'time_kinetic_maximum_2', 'time_elastic_peak']

contains

   !> The box that a run starts with, and all that --check prints.
   subroutine start_box(log, scene, model, costs)
      type(log_t), intent(inout) :: log
      type(settings_t), intent(in) :: scene
      type(model_t), intent(in) :: model
      type(cost_t), intent(in) :: costs
      character(160) :: lines(12)
      character(:), allocatable :: waves

      lines(1) = 'particles     '//to_text(costs%particles)//', d/dx = '//short(scene%scene%resolution) &
                 //', h = '//short(model%kernel%h/model%dx)//' dx = '//short(model%kernel%h)
      lines(2) = 'fluid         c0 = '//short(model%c0)//', rho0 = '//short(model%rho0)//', g = '//short(model%gravity)
      lines(3) = 'diffusion     '//diffusion_text(scene, model)
      lines(4) = 'Reynolds      '//reynolds_text(scene, model)
      lines(5) = 'uses          '//used(scene, model)
      lines(6) = 'leaves out    '//left_out(model)
      lines(7) = 'step          dt <= '//short(costs%dt)//' (cfl '//short(costs%dt*model%c0/model%kernel%h)//'), about ' &
                 //short(anint(costs%steps))//' steps to t = '//short(scene%time%end_time)
      lines(8) = 'memory        about '//short(costs%bytes/1.0e6_dp)//' MB, '//short(anint(costs%bytes/costs%particles)) &
                 //' bytes a particle'
      lines(9) = 'run time      about '//duration_text(costs%seconds)//' on '//threads_text() &
                 //' (at '//short(anint(costs%ns))//' ns per particle-step and core)'
      lines(10) = 'output        '//output_text(scene)//', about '//short(output_bytes(scene, costs)/1.0e6_dp)//' MB'
      lines(11) = 'not written   '//not_written(scene)
      lines(12) = 'dynsph        '//version//' '//git_id//' '//build_type
      waves = waves_text(scene)
      if (waves == '') then
         call log%box(trim(scene%scene%title), lines)
      else
         call log%box(trim(scene%scene%title), [lines(:5), [character(160) :: 'waves         '//waves], lines(6:)])
      end if
   end subroutine start_box

   ! Of the viscosity that acts everywhere, over the reference length and over a particle.
   function reynolds_text(scene, model) result(words)
      type(settings_t), intent(in) :: scene
      type(model_t), intent(in) :: model
      character(:), allocatable :: words
      real(dp) :: speed, nu

      speed = reference_speed(scene)
      nu = model%alpha*model%kernel%h*model%c0/k_2d   ! eq. 16
      if (.not. nu > 0) then
         words = 'none: alpha = 0'
         if (model%dynamic) words = 'none: viscosity = 0'
      else if (.not. speed > 0) then
         words = 'unknown: reference_speed is not given'
      else
         words = 'Re = '//short(speed*scene%scene%reference_length/nu)//', Re_dx = '//short(speed*model%dx/nu) &
                 //' (U = '//short(speed)//')'
      end if
   end function reynolds_text

   ! What is written how often, of what the scene has.
   pure function output_text(scene) result(words)
      type(settings_t), intent(in) :: scene
      character(:), allocatable :: words

      associate (output => scene%output)
         words = 'energy '//trim(output%energy)
         if (size(scene%probes) + size(scene%gauges) > 0) words = words//', probes '//trim(output%probes)
         if (scene%exact%solution /= 'none') words = words//', errors '//trim(output%errors)
         if (size(scene%solids) > 0) words = words//', solids '//trim(output%solids)
         if (output%walls /= 'never') words = words//', walls '//trim(output%walls)
         words = words//', snapshots '//trim(output%snapshots)//', checkpoint '//trim(output%checkpoint)
      end associate
   end function output_text

   function threads_text() result(words)
      character(:), allocatable :: words

      words = to_text(omp_get_max_threads())//' threads'
      if (omp_get_max_threads() == 1) words = 'one thread'
      if (n_processes() > 1) words = to_text(n_processes())//' ranks of '//words
   end function threads_text

   ! sqrt(g d), or the speed given where there is no gravity.
   pure real(dp) function reference_speed(scene) result(speed)
      type(settings_t), intent(in) :: scene

      speed = sqrt(scene%fluid%gravity*scene%scene%reference_length)
      if (.not. speed > 0) speed = scene%fluid%reference_speed
   end function reference_speed

   function diffusion_text(scene, model) result(words)
      type(settings_t), intent(in) :: scene
      type(model_t), intent(in) :: model
      character(:), allocatable :: words

      if (.not. model%dynamic) then
         words = 'constant: alpha = '//short(model%alpha)//', delta = '//short(model%delta)
      else
         words = 'dynamic'
         if (scene%model%by_default) words = words//' (default)'
         words = words//': C_S = '//short(scene%model%c_s)//', C_delta = '//short(scene%model%c_delta)//', '
         if (scene%model%limiter == 'strain_rate') words = words//'||D|| clipped so that '
         words = words//'alpha_i, delta_i <= '//short(model%limit)//'; alpha = '//short(model%alpha)
      end if
   end function diffusion_text

   function used(scene, model) result(words)
      type(settings_t), intent(in) :: scene
      type(model_t), intent(in) :: model
      character(:), allocatable :: words, kind_of_images
      type(terms_t) :: has

      has = model%terms()
      words = 'RK'//model%integrator%name(3:)
      if (.not. model%frozen) words = words//', diffusion in every stage'
      if (has%gravity) words = words//', gravity'
      if (model%has_force()) words = words//', uniform force'
      if (has%tank) words = words//', moving tank'
      if (has%central) words = words//', central force'
      associate (kind => model%box%kind)
         kind_of_images = ', mirror'
         if (any(abs(model%box%density_slope) > 0)) kind_of_images = ', hydrostatic'
         if (has%walls) words = words//kind_of_images//' images ('//sides_text(is_wall(kind))//')'
         if (has%no_slip) words = words//', no slip ('//sides_text(kind == no_slip_wall)//')'
         if (has%periodic) words = words//', periodic ('//sides_text(kind == periodic_side)//')'
      end associate
      if (has%solids) words = words//', '//solids_text(model)
      if (has%sponges) words = words//', '//to_text(size(model%sponges))//trim(merge(' sponge ', ' sponges', &
                                                                                    size(model%sponges) == 1))
      if (has%eddies) words = words//', strain rate'
      if (has%viscosity) words = words//', viscosity'
      if (has%diffusion) words = words//', density diffusion'
      if (scene%exact%solution /= 'none') words = words//', exact solution'
      if (size(scene%probes) > 0) words = words//', '//to_text(size(scene%probes))//' probes'
      if (size(scene%gauges) > 0) words = words//', '//to_text(size(scene%gauges))//' gauges'
   end function used

   ! Of a model that has some.
   pure function solids_text(model) result(words)
      type(model_t), intent(in) :: model
      character(:), allocatable :: words
      integer :: k

      words = to_text(size(model%solids))//' solids'
      if (size(model%solids) == 1) words = '1 solid'
      if (any([(model%solids(k)%motion%moves(), k=1, size(model%solids))])) words = words//', moving solids'
      if (model%has_free_bodies()) words = words//', free bodies'
   end function solids_text

   ! Terms that the scene's steps neither compute nor have arrays for.
   function left_out(model) result(words)
      type(model_t), intent(in) :: model
      character(:), allocatable :: words
      type(terms_t) :: has

      has = model%terms()
      words = names_text([character(24) :: 'gravity', 'uniform force', 'central force', 'walls', 'no-slip', 'periodic sides', &
                          'solids', 'viscosity', 'density diffusion', 'dynamic coefficients'], &
                         .not. [has%gravity, model%has_force(), has%central, has%walls, has%no_slip, has%periodic, has%solids, &
                                has%viscosity, has%diffusion, has%eddies])
   end function left_out

   ! What is neither measured nor written.
   function not_written(scene) result(words)
      type(settings_t), intent(in) :: scene
      character(:), allocatable :: words, message
      type(cadence_t) :: energy, probes, errors, solids, snapshots, checkpoint

      ! The cadences' texts were checked with the input.
      call energy%parse(trim(scene%output%energy), message)
      call probes%parse(trim(scene%output%probes), message)
      call errors%parse(trim(scene%output%errors), message)
      call solids%parse(trim(scene%output%solids), message)
      call snapshots%parse(trim(scene%output%snapshots), message)
      call checkpoint%parse(trim(scene%output%checkpoint), message, by_clock=.true.)
      words = names_text([character(24) :: 'energies', 'probes', 'gauges', 'errors', 'forces on solids', &
                          'snapshots', 'checkpoints', 'dissipation field'], &
                         [energy%is_never(), size(scene%probes) == 0 .or. probes%is_never(), &
                          size(scene%gauges) == 0 .or. probes%is_never(), &
                          scene%exact%solution == 'none' .or. errors%is_never(), &
                          size(scene%solids) > 0 .and. solids%is_never(), snapshots%is_never(), &
                          checkpoint%is_never(), .not. any(scene%output%fields(:scene%output%n_fields) == 'dissipation')])
   end function not_written

   ! The names marked, parted by commas; 'nothing' if there is none.
   pure function names_text(names, marked) result(words)
      character(*), intent(in) :: names(:)
      logical, intent(in) :: marked(:)
      character(:), allocatable :: words
      integer :: k

      words = ''
      do k = 1, size(names)
         if (marked(k)) call append(words, trim(names(k)))
      end do
      if (words == '') words = 'nothing'
   end function names_text

   ! Adds an item to a list of words, behind a comma if it is not the first.
   pure subroutine append(words, item)
      character(:), allocatable, intent(inout) :: words
      character(*), intent(in) :: item

      if (len(words) > 0) words = words//', '
      words = words//item
   end subroutine append

   function sides_text(sides) result(words)
      logical, intent(in) :: sides(4)
      character(:), allocatable :: words

      words = ''
      if (sides(left_wall)) words = words//' left'
      if (sides(right_wall)) words = words//' right'
      if (sides(bottom_wall)) words = words//' bottom'
      if (sides(top_wall)) words = words//' top'
      words = trim(adjustl(words))
   end function sides_text

   !> Time by phase, budget and files.
   subroutine closing_table(log, timers, seconds, budget, run, path)
      type(log_t), intent(inout) :: log
      type(timers_t), intent(in) :: timers
      real(dp), intent(in) :: seconds       !! wall time of the run
      type(budget_t), intent(in) :: budget
      type(step_t), intent(in) :: run
      character(*), intent(in) :: path      !! result directory
      character(160) :: lines(5)
      integer :: n

      n = merge(5, 4, run%limited > 0)
      lines = [character(160) :: dissipation_text(budget), works_text(budget), &
               'largest Ma '//short(run%largest_mach)//', largest |rho - rho0|/rho0 '//short(run%largest_variation), &
               to_text(run%crossings)//' wall crossings, '//to_text(run%singular)//' particle-steps without gradient, ' &
               //to_text(run%repeated)//' steps repeated', &
               to_text(run%limited)//' of '//to_text(run%step)//' steps shorter than cfl asks for: diffusion would not be stable']
      call log%box('Budget', lines(:n))
      call log%box('Wall time', timers%table(seconds))
      call log%line('results in '//path//', what each file is: docs/files.md')
   end subroutine closing_table

   function dissipation_text(budget) result(words)
      type(budget_t), intent(in) :: budget
      character(:), allocatable :: words

      associate (b => budget, has => budget%has)
         words = ''
         if (has%viscosity) call append(words, 'Q_alpha '//short(b%q_alpha/b%normaliser))
         if (has%diffusion) call append(words, 'Q_delta '//short(b%q_delta/b%normaliser))
         if (has%viscosity .and. has%diffusion) call append(words, 'Q_total '//short((b%q_alpha + b%q_delta)/b%normaliser))
         words = words//' of dE_Mtot'
         if (.not. (has%viscosity .or. has%diffusion)) words = 'nothing dissipates'
      end associate
   end function dissipation_text

   function works_text(budget) result(words)
      type(budget_t), intent(in) :: budget
      character(:), allocatable :: words

      words = ''
      if (budget%has%walls) words = words//'wall work '//short(budget%w_s/budget%normaliser)//', '
      if (budget%has%force) words = words//'work of the force '//short(budget%w_f/budget%normaliser)//', '
      if (budget%has%solids) words = words//'work of solids ' &
         //short((budget%w_solid + budget%w_stat + budget%w_pen)/budget%normaliser)//' (W_solid + W_stat + W_pen), '
      if (budget%has%sponges) words = words//'taken by sponges '//short(budget%q_sponge/budget%normaliser)//', '
      if (budget%has%free_bodies) words = words//'gained by free bodies ' &
         //short((budget%e_body - budget%e_body_at_start)/budget%normaliser)//', '
      words = words//'largest balance error '//short(budget%largest_error)
   end function works_text

   !> The file of `key = value` lines.
   subroutine write_summary_file(path, status, reason, origin, state, seconds, problem)
      character(*), intent(in) :: path
      character(*), intent(in) :: status
      character(*), intent(in) :: reason      !! why it failed; '' if it did not
      character(*), intent(in) :: origin      !! where it was forked from; '' if it was not
      type(run_state_t), intent(in) :: state
      real(dp), intent(in) :: seconds
      type(failure), intent(inout) :: problem
      type(summary_t) :: file
      real(dp) :: rate
      integer(i8) :: bytes(1)

      associate (run => state%step, p => state%p)
         rate = real(p%n, dp)*(run%step - state%first_step)/max(seconds, tiny(1.0_dp))
         call file%add('status', status)
         if (reason /= '') call file%add('reason', reason)
         if (origin /= '') call file%add('forked_from', origin)
         call file%add('particles', p%n)
         bytes = p%bytes() + state%near%bytes()
         call sums_of_all(1, bytes)
         call file%add('bytes_per_particle', real(bytes(1), dp)/p%n)
         if (state%near%ghosts%exist()) call file%add('ghosts', state%near%ghosts%n)
         call file%add('steps', run%step)
         call file%add('time', run%time)
         call file%add('threads', omp_get_max_threads())
         if (library_words() /= '') call file%add('ranks', n_processes())
         call file%add('lanes', nl)
         call file%add('root', root_name)
         call file%add('run_seconds', seconds)
         call file%add('particle_steps_per_second', rate)
         if (rate > 0) call file%add('ns_per_particle_step_per_core', 1.0e9_dp*omp_get_max_threads()*n_processes()/rate)
         if (.not. rate > 0) call file%add('ns_per_particle_step_per_core', 'none')
         if (n_processes() > 1) call summarise_ranks(state, seconds, file)
         call summarise_budget(state%recorder%budget, file)
         call file%add('max_density_variation', run%largest_variation)
         call file%add('max_mach', run%largest_mach)
         call file%add('sound_speed_needed_density', sound_speed_for_density(state%recorder%head%sound_speed, run))
         call file%add('sound_speed_needed_mach', sound_speed_for_mach(state%recorder%head%sound_speed, run))
         call file%add('wall_crossings', run%crossings)
         call file%add('singular_gradients', run%singular)
         call file%add('times_sorted', run%sorted)
         call file%add('steps_repeated', run%repeated)
         call file%add('steps_limited', run%limited)
         call state%recorder%errors%add_to(file)
      end associate
      call file%write(path, problem)
   end subroutine write_summary_file

   ! What several ranks cost: how unlike their loads are, what they wait for copies, and what they send.
   subroutine summarise_ranks(state, seconds, file)
      type(run_state_t), intent(in) :: state
      real(dp), intent(in) :: seconds
      type(summary_t), intent(inout) :: file
      real(dp) :: largest(2), busy(1)
      integer(i8) :: sent(2), waits

      waits = reductions()
      associate (division => state%near%division, exchange => state%near%images%halo%exchange, &
                 steps => max(1, state%step%step - state%first_step))
         busy = division%busy_before + division%busy
         largest = [busy(1), division%waiting]
         sent = [exchange%messages, exchange%bytes]
         busy = exact_totals(reshape(busy, [1, 1]))
         call largest_of_all(2, largest)
         call sums_of_all(2, sent)
         call file%add('largest_load_over_mean', largest(1)*n_processes()/busy(1))
         call file%add('share_of_time_busy', busy(1)/n_processes()/seconds)
         call file%add('largest_share_of_time_waiting', largest(2)/seconds)
         call file%add('columns_of_copies', int(division%margin))
         call file%add('messages_a_step_and_rank', real(sent(1), dp)/steps/n_processes())
         call file%add('bytes_a_step_and_rank', real(sent(2), dp)/steps/n_processes())
         call file%add('reductions_a_step', real(waits, dp)/steps)
      end associate
   end subroutine summarise_ranks

   ! What is not in the budget's terms is left out, as in energy.dat.
   subroutine summarise_budget(budget, file)
      type(budget_t), intent(in) :: budget
      type(summary_t), intent(inout) :: file
      integer :: k

      associate (b => budget, has => budget%has, de => budget%normaliser)
         call file%add('dE_Mtot', de)
         call file%add('energy_balance_error', b%largest_error)
         if (has%walls) call file%add('wall_work', b%w_s/de)
         if (has%force) call file%add('force_work', b%w_f/de)
         if (has%solids) call file%add('W_solid', b%w_solid/de)
         if (has%solids) call file%add('W_stat', b%w_stat/de)
         if (has%solids) call file%add('W_pen', b%w_pen/de)
         if (has%sponges) call file%add('Q_sponge', b%q_sponge/de)
         if (has%free_bodies) call file%add('E_body_change', (b%e_body - b%e_body_at_start)/de)
         if (has%free_bodies) call file%add('Q_damper', b%q_damper/de)
         if (has%viscosity) call file%add('Q_alpha', b%q_alpha/de)
         if (has%diffusion) call file%add('Q_delta', b%q_delta/de)
         if (has%viscosity .or. has%diffusion) call file%add('Q_total', (b%q_alpha + b%q_delta)/de)
         if (has%rotation) call file%add('Q_omega', b%q_omega/de)
         do k = 1, size(peak_names)
            ! The maxima come in turn: without potential energy there is only the first.
            if (k > 1 .and. .not. has%potential) exit
            if (b%peak_time(k) < 0) call file%add(trim(peak_names(k)), 'none')
            if (.not. b%peak_time(k) < 0) call file%add(trim(peak_names(k)), b%peak_time(k))
         end do
      end associate
   end subroutine summarise_budget

end module report
