!> Solids in the fluid: pressure of their ghosts, forces on them, and what they add to the rates of the fluid.
!!
!! Source: ours (docs/equations.md, Solid bodies). The power that a solid gives to the fluid is -F.U, and what the hydrostatic
!! parts of its ghosts' pressure add.
module solid_terms
   use box, only: box_t
   use candidates, only: block_groups, block_slots
   use first_sums, only: first_sums_t
   use flow_sums, only: flow_sums_t
   use free_bodies, only: release
   use kinds, only: dp
   use lanes, only: nl
   use model, only: model_t
   use motions, only: pose_t
   use neighbours, only: neighbours_t
   use particles, only: particles_t, state_t
   use renormalisation, only: matrices_t, renormalise
   use solid_ghosts, only: mirror_ghosts, move_ghosts
   use solid_friction, only: reflected_sums_t, sum_ghost_friction
   use solid_shares, only: find_shares
   use solid_sums, only: ghost_sums_t, sum_ghosts, sum_solids
   use strips, only: group_slots
   implicit none
   private

   public :: meet_solids, add_solids, add_solid_strain, rub_solids, take_solid_work

   real(dp), parameter :: least_weight = 1.0e-9_dp   ! sum_f W V_f below which a ghost has no fluid

contains

   !> Moves the ghosts to the poses of the solids, and gives them the pressure of the fluid near them; the force on each, and its
   !! power.
   subroutine meet_solids(model, box, poses, near, state, later)
      type(model_t), intent(in) :: model
      type(box_t), intent(in) :: box               !! at the state's time
      type(pose_t), intent(in) :: poses(:)         !! (solids) then
      type(neighbours_t), intent(inout) :: near
      type(state_t), intent(inout) :: state        !! fluid and images are filled; the ghosts and theirs are set
      logical, intent(in), optional :: later       !! in a step: pairs act as they did at its begin
      type(ghost_sums_t) :: sums
      integer :: b

      if (.not. near%ghosts%exist()) return
      call move_ghosts(near%ghosts, model%solids, poses, box, state)
      if (near%ghosts%shared .and. .not. present(later)) then
         call mirror_ghosts(near%ghosts, box, state)   ! their images, too, are where they act from
         call find_shares(near%ghosts, near%n_blocks, state, box, model%kernel%support)
      end if
      !$omp parallel do default(none) shared(model, box, near, state) private(sums) schedule(dynamic)
      do b = 1, near%ghosts%n_blocks
         call sum_ghosts(model%kernel, near%ghosts, b, state, near%images, box, sums)
         call take_pressure(model, box, near, b, sums, state)
      end do
      !$omp end parallel do
      call release(model, box, near, state)
      call mirror_ghosts(near%ghosts, box, state)
   end subroutine meet_solids

   ! s_b = sum_f c_fb (s_f + rho0/c0**2 (g - (A.n) n).r), q_b, F_b and -F_b.U of a block of ghosts.
   subroutine take_pressure(model, box, near, b, sums, state)
      type(model_t), intent(in) :: model
      type(box_t), intent(in) :: box
      type(neighbours_t), intent(inout) :: near
      integer, intent(in) :: b                 ! number of the block
      type(ghost_sums_t), intent(in) :: sums
      type(state_t), intent(inout) :: state
      real(dp), dimension(block_slots) :: inertia_x, inertia_y, inverse, factor, x, y, felt_x, felt_y
      real(dp) :: scale, force(2), slope_x, slope_y
      integer :: i0, k, m0, n

      associate (block => near%ghosts%fluid(b), ghosts => near%ghosts)
         n = nl*block%n_clusters
         i0 = block%before
         m0 = i0 - ghosts%before
         force = model%acceleration - [0.0_dp, model%gravity]
         scale = model%rho0/model%c0**2
         inertia_x(:n) = 0
         inertia_y(:n) = 0
         do k = 1, merge(n, 0, box%inertia%acts())
            if (.not. sums%weight(k) > 0) cycle
            associate (a => box%inertia%at([state%x(i0 + k), state%y(i0 + k)], [state%u(i0 + k), state%v(i0 + k)]))
               inertia_x(k) = a(1)
               inertia_y(k) = a(2)
            end associate
         end do
         !$omp simd private(slope_x, slope_y)
         do k = 1, n
            slope_x = scale*(force(1) - ghosts%pull_x(m0 + k)) + scale*inertia_x(k)
            slope_y = scale*(force(2) - ghosts%pull_y(m0 + k)) + scale*inertia_y(k)
            inverse(k) = merge(1.0_dp, 0.0_dp, model%kernel%value_factor*sums%weight(k) > least_weight) &
                         /max(sums%weight(k), tiny(1.0_dp))
            state%s(i0 + k) = (sums%density(k) + slope_x*sums%way_x(k) + slope_y*sums%way_y(k))*inverse(k)
            ghosts%exchange(m0 + k) = state%volume(i0 + k)*sums%inflow(k)*inverse(k)
            factor(k) = model%c0**2*model%kernel%gradient_factor*state%volume(i0 + k)
            x(k) = sums%push_x(k) + state%s(i0 + k)*sums%area_x(k)
            y(k) = sums%push_y(k) + state%s(i0 + k)*sums%area_y(k)
            felt_x(k) = x(k)
            felt_y(k) = y(k)
         end do
         if (any(block%first_image(:block%n_clusters) < block%first(2:block%n_clusters + 1))) then
            do k = 1, n
               associate (of => sums%images(:, k), s_b => state%s(i0 + k))
                  x(k) = x(k) + of(1) + s_b*of(3)
                  y(k) = y(k) + of(2) + s_b*of(4)
                  felt_x(k) = felt_x(k) + of(5) + s_b*of(7)
                  felt_y(k) = felt_y(k) + of(6) + s_b*of(8)
               end associate
            end do
         end if
         do k = 1, n
            ghosts%force(1, m0 + k) = factor(k)*felt_x(k)
            ghosts%force(2, m0 + k) = factor(k)*felt_y(k)
            ghosts%power(m0 + k) = -factor(k)*x(k)*state%u(i0 + k) - factor(k)*y(k)*state%v(i0 + k)
         end do
         if (.not. allocated(ghosts%free)) return
         do k = 1, n
            ghosts%free%tilt(:, m0 + k) = -scale*inverse(k)*[sums%way_x(k), sums%way_y(k)]
            ghosts%free%push(:, m0 + k) = factor(k)*[x(k), y(k)]
            ghosts%free%area(:, m0 + k) = factor(k)*([sums%area_x(k), sums%area_y(k)] + sums%images(3:4, k))
            ghosts%free%felt(:, m0 + k) = factor(k)*([sums%area_x(k), sums%area_y(k)] + sums%images(7:8, k))
         end do
      end associate
   end subroutine take_pressure

   !> Adds what solids give to the flow sums of a block, and the power that the fluid gets by that.
   pure subroutine add_solids(model, near, state, b, sums, power)
      type(model_t), intent(in) :: model
      type(neighbours_t), intent(in) :: near
      type(state_t), intent(in) :: state                  !! that the sums are of
      integer, intent(in) :: b                            !! number of the block
      class(flow_sums_t), intent(inout) :: sums
      real(dp), intent(out) :: power(block_groups)        !! [W/m] of each group
      real(dp), dimension(nl) :: divergence, force_x, force_y, gain
      integer :: c, g, i, k, l

      power = 0
      if (.not. near%ghosts%meets(b)) return
      associate (block => near%ghosts%near(b))
         do c = 1, block%n_clusters
            if (block%first(c + 1) == block%first(c)) cycle
            call sum_solids(model%kernel, near%ghosts, b, c, state, divergence, force_x, force_y)
            k = (c - 1)*nl
            i = block%before + k
            !$omp simd
            do l = 1, nl
               sums%divergence(k + l) = sums%divergence(k + l) + divergence(l)
               sums%force_x(k + l) = sums%force_x(k + l) + force_x(l)
               sums%force_y(k + l) = sums%force_y(k + l) + force_y(l)
               gain(l) = state%volume(i + l)*(state%u(i + l)*force_x(l) + state%v(i + l)*force_y(l) + state%s(i + l)*divergence(l))
            end do
            g = 1 + k/group_slots
            power(g) = power(g) - model%c0**2*model%kernel%gradient_factor*sum(gain)
         end do
      end associate
   end subroutine add_solids

   !> Adds what solids reflect to the velocity gradient of a block and to L of that.
   pure subroutine add_solid_strain(model, n, reflected, sums, l)
      type(model_t), intent(in) :: model
      integer, intent(in) :: n                          !! slots of the block
      type(reflected_sums_t), intent(in) :: reflected
      type(first_sums_t), intent(inout) :: sums         !! u_x, u_y, v_x, v_y change
      type(matrices_t), intent(inout) :: l              !! becomes L of the fluid and the ghosts
      real(dp) :: unused
      integer :: k

      !$omp simd private(unused)
      do k = 1, n
         call renormalise(model%kernel%gradient_factor, sums%matrix_xx(k) + reflected%matrix_xx(k), &
                          sums%matrix_xy(k) + reflected%matrix_xy(k), sums%matrix_yy(k) + reflected%matrix_yy(k), &
                          l%xx(k), l%xy(k), l%yy(k), unused)
         sums%u_x(k) = sums%u_x(k) + reflected%u_x(k)
         sums%u_y(k) = sums%u_y(k) + reflected%u_y(k)
         sums%v_x(k) = sums%v_x(k) + reflected%v_x(k)
         sums%v_y(k) = sums%v_y(k) + reflected%v_y(k)
      end do
   end subroutine add_solid_strain

   !> The friction on each ghost, from the base state.
   subroutine rub_solids(model, box, near, p)
      type(model_t), intent(in) :: model
      type(box_t), intent(in) :: box
      type(neighbours_t), intent(inout) :: near
      type(particles_t), intent(in) :: p
      real(dp) :: sums(4, block_slots), factor
      integer :: b, k, m

      factor = -model%kernel%h*model%c0*model%kernel%gradient_factor*model%rho0
      !$omp parallel do default(none) shared(model, box, near, p, factor) private(k, m, sums) schedule(dynamic)
      do b = 1, near%ghosts%n_blocks
         associate (block => near%ghosts%fluid(b))
            call sum_ghost_friction(model%kernel, near%ghosts, b, p, near%images, box, model%alpha, sums)
            do k = 1, nl*block%n_clusters
               m = block%before + k - near%ghosts%before
               near%ghosts%friction(:, m) = factor*p%base%volume(block%before + k)*sums(:, k)
            end do
         end associate
      end do
      !$omp end parallel do
   end subroutine rub_solids

   !> Adds a stage's part to the work that each ghost gives to the fluid in a step; the first stage begins it.
   pure subroutine take_solid_work(near, state, weight, begins)
      type(neighbours_t), intent(inout) :: near
      type(state_t), intent(in) :: state     !! of the stage
      real(dp), intent(in) :: weight         !! [s] dt b_k
      logical, intent(in) :: begins
      real(dp) :: friction
      integer :: i, k

      if (.not. near%ghosts%exist()) return
      associate (ghosts => near%ghosts)
         if (begins) ghosts%work = 0
         if (begins) ghosts%rubbed = 0
         do k = 1, ghosts%n_slots
            i = ghosts%before + k
            friction = -ghosts%friction(3, k)*state%u(i) - ghosts%friction(4, k)*state%v(i)
            ghosts%work(k) = ghosts%work(k) + weight*(ghosts%power(k) + friction)
            ghosts%rubbed(k) = ghosts%rubbed(k) + weight*friction
         end do
      end associate
   end subroutine take_solid_work

end module solid_terms
