!> What the processes learn of each other in a step, in two reductions: what the first sums limit, and what all stages have come to.
module step_outcome
   use blocks, only: block_t
   use communication, only: combine, largest_of_all
   use exact_sum, only: exact_sum_t, exact_sums, integers_of, take_integers
   use integrators, only: most_stages
   use kinds, only: dp, i8
   use lanes, only: nl
   use model, only: model_t
   use neighbours, only: neighbours_t
   use rigid_bodies, only: rate_of
   use search_margins, only: lists_hold, overreach
   use solid_motion, only: lost_solid, solid_motion_t
   use step_state, only: n_of_solid, step_t, take_extremes
   use strips, only: extent_t, group_slots
   implicit none
   private

   public :: outcome_t, look_ahead, add_up, collect

   !> What the stages of a step have come to, in all processes.
   type :: outcome_t
      real(dp) :: work(4) = 0                  !! [J/m] as in block_t
      real(dp) :: moving_walls = 0             !! [W/m] of no-slip walls that move
      real(dp) :: solid_work = 0               !! [J/m] that the fluid got by the pressure of solids
      real(dp) :: sponge_work = 0              !! [J/m] that the fluid got by sponge layers
      real(dp), allocatable :: solids(:, :)    !! (n_of_solid, solids) as in step_t
      type(solid_motion_t) :: motion           !! of solids
      integer(i8) :: crossings = 0, singular = 0
      real(dp) :: speed_2 = 0, pressure = 0, largest_s = 0   !! as in block_t
      real(dp) :: limit = 0                    !! [s] step that would have been stable in each stage
      real(dp) :: advective_limit = 0          !! [s] by eq. 8 alone
      real(dp) :: overreach(most_stages) = 0   !! of the lists, in the state that a stage leads to; the result is void if not 0
      real(dp) :: mean_acceleration = 0, largest_acceleration = 0   !! of blocks
      type(extent_t) :: extent                 !! in x, and of velocities
      logical :: lost = .false.                !! a particle or a free solid left its range
      logical :: lasts = .false.               !! the lists serve for the next step
   contains
      procedure :: first_overreach
   end type outcome_t

contains

   !> Of the first stage from where lists do not reach; those behind it are of lists that did not. 0 if they all reach.
   pure real(dp) function first_overreach(self)
      class(outcome_t), intent(in) :: self
      integer :: stage

      first_overreach = 0
      stage = findloc(self%overreach > 0, .true., 1)
      if (stage > 0) first_overreach = self%overreach(stage)
   end function first_overreach

   !> What the first sums tell all, in one reduction: the step of eq. 8 and the diffusive limits, and whether lists will be too
   !! short.
   subroutine look_ahead(model, near, expected, blocks, limit, farthest)
      type(model_t), intent(in) :: model
      type(neighbours_t), intent(in) :: near
      real(dp), intent(in) :: expected    !! length of the step
      type(block_t), intent(in) :: blocks(:)
      real(dp), intent(out) :: limit      !! its largest length
      real(dp), intent(out) :: farthest   !! overreach of the lists after the expected step
      real(dp) :: largest(4)

      largest = [for_step(blocks), overreach(near, expected, blocks%ahead)]
      call largest_of_all(size(largest), largest)
      limit = model%step_limit(largest(1), model%alpha + largest(2), largest(3))
      farthest = largest(4)
   end subroutine look_ahead

   !> What the blocks of all processes have come to, in one reduction. Sums are taken over each strip, and over these exactly:
   !! neither threads nor the order of strips matter.
   subroutine add_up(model, near, dt, blocks, all, notes)
      type(model_t), intent(in) :: model
      type(neighbours_t), intent(in) :: near
      real(dp), intent(in) :: dt
      type(block_t), intent(in) :: blocks(:)
      type(outcome_t), intent(inout) :: all   !! with the own overreach, and the motion of solids
      logical, intent(inout) :: notes(:)
      integer, parameter :: n_sums = 11
      real(dp), allocatable :: table(:, :)    ! sums of each strip
      real(dp), allocatable :: largest(:)
      type(exact_sum_t), allocatable :: sums(:)
      integer(i8), allocatable :: numbers(:)
      real(dp), allocatable :: totals(:)
      integer :: k

      allocate (table(n_sums, size(near%first_block) - 1))
      !$omp parallel do default(none) shared(near, blocks, table) schedule(dynamic, max(1, size(near%first_block)/256))
      do k = 1, size(table, 2)
         table(:7, k) = strip_powers(near, k, blocks)
         associate (first => near%first_block(k), last => near%first_block(k + 1) - 1)
            table(8:, k) = [real(sum(blocks(first:last)%crossings), dp), real(sum(blocks(first:last)%singular), dp), &
                            sum(near%margins(first:last)%next_acceleration), real(last - first + 1, dp)]
         end associate
      end do
      !$omp end parallel do
      allocate (sums(n_sums + size_of_solids(model)))
      sums(:n_sums) = exact_sums(table)
      if (model%has_solids()) sums(n_sums + 1:) = reshape(solid_sums(model, near, blocks), [size_of_solids(model)])
      numbers = integers_of(sums)
      associate (extent => blocks%extent)
         largest = [max(0.0_dp, [maxval(blocks%speed_2), maxval(blocks%pressure), maxval(blocks%largest_s), for_step(blocks), &
                                 maxval(near%margins(:near%n_blocks)%next_acceleration), all%overreach, &
                                 one_if(any(blocks%lost_slot > 0)), one_if(.not. lists_hold(near, dt)), one_if(notes)]), &
                    maxval(-extent%lower(1)), maxval(extent%upper(1)), maxval(-extent%slowest(1)), maxval(extent%fastest(1)), &
                    maxval(-extent%slowest(2)), maxval(extent%fastest(2))]
      end associate
      call combine(numbers, largest)
      call take_integers(numbers, sums)
      allocate (totals(size(sums)))
      do k = 1, size(sums)
         totals(k) = sums(k)%value()
      end do
      all%work = totals(:4)
      all%moving_walls = totals(5)
      all%solid_work = totals(6)
      all%sponge_work = totals(7)
      all%crossings = nint(totals(8), i8)
      all%singular = nint(totals(9), i8)
      if (totals(11) > 0) all%mean_acceleration = totals(10)/totals(11)
      if (model%has_solids()) all%solids = reshape(totals(n_sums + 1:), [n_of_solid, size(model%solids)])
      all%speed_2 = largest(1)
      all%pressure = largest(2)
      all%largest_s = largest(3)
      all%limit = model%step_limit(largest(4), model%alpha + largest(5), largest(6))
      all%advective_limit = model%advective_limit(largest(4))
      all%largest_acceleration = largest(7)
      all%overreach = largest(8:7 + most_stages)
      associate (others => largest(8 + most_stages:))
         all%lost = others(1) > 0 .or. all%motion%lost > 0
         all%lasts = .not. others(2) > 0
         notes = others(3:2 + size(notes)) > 0
         associate (span => others(3 + size(notes):))
            all%extent%lower(1) = -span(1)
            all%extent%upper(1) = span(2)
            all%extent%slowest = -span([3, 5])
            all%extent%fastest = span([4, 6])
         end associate
      end associate
   end subroutine add_up

   ! What limits a step, of this process.
   pure function for_step(blocks) result(largest)
      type(block_t), intent(in) :: blocks(:)
      real(dp) :: largest(3)

      largest = max(0.0_dp, [maxval(blocks%largest_pi), maxval(blocks%largest_alpha), maxval(blocks%largest_delta)])
   end function for_step

   elemental real(dp) function one_if(statement)
      logical, intent(in) :: statement

      one_if = merge(1.0_dp, 0.0_dp, statement)
   end function one_if

   ! How many sums there are of solids.
   pure integer function size_of_solids(model) result(n)
      type(model_t), intent(in) :: model

      n = 0
      if (model%has_solids()) n = n_of_solid*size(model%solids)
   end function size_of_solids

   ! What the own ghosts of each solid gave, and what its own particles that were put back did.
   function solid_sums(model, near, blocks) result(sums)
      type(model_t), intent(in) :: model
      type(neighbours_t), intent(in) :: near
      type(block_t), intent(in) :: blocks(:)
      type(exact_sum_t) :: sums(n_of_solid, size(model%solids))
      integer :: b, k, m, solid

      associate (ghosts => near%ghosts)
         do k = 1, ghosts%n_slots
            solid = ghosts%solid_of(k)
            if (solid == 0) cycle
            if (.not. near%computes(ghosts%x(k))) cycle
            call sums(1, solid)%add(ghosts%work(k))
            call sums(2, solid)%add(ghosts%rubbed(k))
         end do
      end associate
      do b = 1, size(blocks)
         if (.not. allocated(blocks(b)%struck)) cycle
         do solid = 1, size(model%solids)
            do m = 1, 4
               call sums(2 + m, solid)%add(blocks(b)%struck(m, solid))
            end do
         end do
      end do
   end function solid_sums

   ! The works and the wall power of a strip, group by group.
   pure function strip_powers(near, strip, blocks) result(powers)
      type(neighbours_t), intent(in) :: near
      integer, intent(in) :: strip   !! counted from the first own one
      type(block_t), intent(in) :: blocks(:)
      real(dp) :: powers(7)
      integer :: b, g

      powers = 0
      do b = near%first_block(strip), near%first_block(strip + 1) - 1
         do g = 1, nl*near%blocks(b)%n_clusters/group_slots
            powers = powers + [blocks(b)%work(g, :), blocks(b)%wall_power(g), blocks(b)%solid_work(g), &
                                blocks(b)%sponge_work(g)]
         end do
      end do
   end function strip_powers

   !> Takes over what a step has come to.
   subroutine collect(model, near, run, last_time, all, blocks)
      type(model_t), intent(in) :: model
      type(neighbours_t), intent(inout) :: near
      type(step_t), intent(inout) :: run
      real(dp), intent(in) :: last_time
      type(outcome_t), intent(in) :: all
      type(block_t), intent(in) :: blocks(:)
      real(dp) :: moving_walls, friction   ! work of walls that move along themselves, of solids by friction
      logical :: lasts                     ! lists serve for where solids are

      if (run%dt < all%advective_limit .and. run%time + run%dt < last_time) run%limited = run%limited + 1
      moving_walls = run%dt*all%moving_walls
      friction = 0
      lasts = .true.
      if (model%has_solids()) friction = sum(all%solids(2, :))
      run%work_alpha = run%work_alpha + all%work(1) - moving_walls - friction
      run%work_delta = run%work_delta + all%work(2)
      run%work_walls = run%work_walls + all%work(3) + moving_walls - all%solid_work
      if (model%has_solids()) call run%take_solids(all%solid_work, all%solids)
      run%work_force = run%work_force + all%work(4)
      if (model%has_solids()) call move_solids(model, near, run, all, lasts)
      if (allocated(model%sponges)) call run%take_sponges(all%sponge_work)
      run%crossings = run%crossings + all%crossings
      run%singular = run%singular + all%singular
      call take_extremes(model, all%speed_2, all%pressure, all%largest_s, run)
      run%lost_slot = max(0, maxval(blocks%lost_slot))
      run%lost_solid = all%motion%lost
      if (model%has_solids()) run%lost_solid = max(run%lost_solid, lost_solid(model, run%poses))
      run%lost = all%lost .or. run%lost_solid > 0
      near%lasts = all%lasts .and. lasts
      near%mean_acceleration = all%mean_acceleration
      near%largest_acceleration = all%largest_acceleration
      near%extent = all%extent
   end subroutine collect

   ! Solids at the end of the step. Free ones feel what they put back: its energy is known where both are.
   subroutine move_solids(model, near, run, all, lasts)
      type(model_t), intent(in) :: model
      type(neighbours_t), intent(inout) :: near
      type(step_t), intent(inout) :: run
      type(outcome_t), intent(in) :: all
      logical, intent(out) :: lasts
      real(dp) :: change(3), way
      integer :: k

      run%poses = all%motion%poses
      lasts = .true.
      if (.not. allocated(near%ghosts%free)) return
      run%work_force = run%work_force + all%motion%given
      run%work_damper = run%work_damper - all%motion%damped
      run%drag = near%ghosts%free%drag
      do k = 1, size(run%poses)
         associate (body => model%solids(k)%body, pose => run%poses(k), impulse => all%solids(3:5, k))
            if (.not. body%is_free()) cycle
            change = merge(impulse/body%masses(), 0.0_dp, body%moves)
            run%work_rebound = run%work_rebound + sum(body%masses()*change*(rate_of(pose) + change/2))
            pose%velocity = pose%velocity + change(:2)
            pose%spin = pose%spin + change(3)
         end associate
      end do
      call near%ghosts%free%overreach(model%solids, run%poses, near%age + run%dt, way)
      lasts = .not. way > 0
   end subroutine move_solids

end module step_outcome
