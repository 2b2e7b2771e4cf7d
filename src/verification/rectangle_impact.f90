!> The energy that two rectangles of fluid lose when they hit each other.
!!
!! Source: Marrone, Colagrossi, Di Mascio & Le Touze, J. Fluids Struct. 54 (2015): "Prediction of energy losses in water impacts
!! using incompressible and weakly compressible models". Two blocks, each L wide and H thick, meet along L with the speeds
!! +U and -U. The pressure impulse P solves Laplace's equation with P = 0 on the free sides and dP/dn = rho U at the contact;
!! it takes U/2 int P dx of each block's energy rho U**2 L H/2.
module rectangle_impact
   use columns, only: columns_t
   use energy, only: elastic_energy
   use kinds, only: dp
   use model, only: model_t
   use scene_needs, only: need_no_weight, need_open_sides, needs_t, same, slack
   use settings, only: settings_t
   use solution, only: n_sums, solution_t
   use solution_results, only: history_t, known, last, result_t, time_mean
   use text, only: to_text
   implicit none
   private

   public :: lost_share, impact_solution_t, impact_solution

   !> Times over which the loss is averaged, in c0 t/H with H along the motion; why these: docs/scenes.md.
   real(dp), parameter, public :: impact_window(2) = [10.0_dp, 20.0_dp]

   !> Of the scene's two bodies. It has no fields, only the loss.
   type, extends(solution_t) :: impact_solution_t
      real(dp) :: lost_share = 0
   contains
      procedure :: add_needs
      procedure :: set_up
      procedure :: terms
      procedure :: add_columns
      procedure :: results
   end type impact_solution_t

contains

   !> Share of the kinetic energy, (8 L/(pi**3 H)) sum_{n odd} tanh(n pi H/L)/n**3.
   elemental real(dp) function lost_share(slenderness) result(share)
      real(dp), intent(in) :: slenderness   !! H/L, > 0
      real(dp), parameter :: pi = acos(-1.0_dp)
      real(dp), parameter :: zeta = 1.0517997902646450_dp   ! sum_{n odd} n**-3 = 7/8 zeta(3)
      real(dp) :: deficit
      integer :: n

      ! tanh = 1 - 2/(exp(2z) + 1): what is left to sum falls off exponentially.
      deficit = 0
      do n = 1, 100001, 2
         associate (z => n*pi*slenderness)
            if (z > 20) exit
            deficit = deficit + 2/((exp(2*z) + 1)*real(n, dp)**3)
         end associate
      end do
      share = 8/(pi**3*slenderness)*(zeta - deficit)
   end function lost_share

   pure type(impact_solution_t) function impact_solution() result(self)
      self%has_fields = .false.
      self%lasts = .false.
   end function impact_solution

   ! Two equal rectangles that touch along a whole edge and move towards each other.
   subroutine add_needs(self, scene, needs)
      class(impact_solution_t), intent(in) :: self
      type(settings_t), intent(in) :: scene
      type(needs_t), intent(inout) :: needs
      integer :: across, along
      real(dp) :: gap, towards(2)

      call need_no_weight(scene, needs)
      call need_open_sides(scene, needs)
      call needs%unless(size(scene%bodies) == 2, 'two bodies, not '//to_text(size(scene%bodies)), 'body', '', &
                        min(3, size(scene%bodies)))
      if (size(scene%bodies) /= 2) return
      call needs%unless(all(scene%bodies%shape == 'rectangle'), "bodies of shape = 'rectangle'", 'body', 'shape')
      if (.not. all(scene%bodies%shape == 'rectangle')) return
      associate (one => scene%bodies(1), other => scene%bodies(2))
         across = 2
         if (abs(one%velocity(1)) > abs(one%velocity(2))) across = 1
         along = 3 - across
         call needs%unless(all(same(scene, one%upper - one%lower, other%upper - other%lower)), &
                           'two bodies of one size: '//to_text(one%upper - one%lower), 'body', 'upper', 2)
         gap = max(other%lower(across) - one%upper(across), one%lower(across) - other%upper(across))
         call needs%unless(same(scene, gap, 0.0_dp) .and. same(scene, one%lower(along), other%lower(along)), &
                           'bodies that touch along a whole edge, across which they move', 'body', 'lower', 2)
         ! from the first to the second body
         towards = 0.0_dp
         towards(across) = sign(1.0_dp, other%lower(across) - one%lower(across))
         call needs%unless(dot_product(one%velocity, towards) > 0.0_dp, 'bodies that move towards each other', 'body', 'velocity')
         call needs%unless(norm2(one%velocity + other%velocity) <= slack*norm2(one%velocity), 'opposite velocities: ' &
                           //to_text(0.0_dp - one%velocity), 'body', 'velocity', 2)
         call needs%unless(.not. abs(one%velocity(along)) > 0.0_dp, 'velocities along one axis', 'body', 'velocity')
      end associate
   end subroutine add_needs

   subroutine set_up(self, scene, model)
      class(impact_solution_t), intent(inout) :: self
      type(settings_t), intent(in) :: scene
      type(model_t), intent(in) :: model
      real(dp) :: approach(2)

      associate (body => scene%bodies(1))
         self%extent = body%upper - body%lower
         approach = body%velocity - scene%bodies(size(scene%bodies))%velocity
         self%speed_scale = norm2(approach)/2
         ! H/L with H along the motion
         if (abs(approach(1)) > abs(approach(2))) self%extent = self%extent([2, 1])
         self%lost_share = lost_share(self%extent(2)/self%extent(1))
      end associate
   end subroutine set_up

   ! Kinetic and elastic energy.
   pure function terms(self, r, u, s, w, m)
      class(impact_solution_t), intent(in) :: self
      real(dp), intent(in) :: r(2), u(2), s, w, m
      real(dp) :: terms(n_sums)

      terms = 0
      terms(1:2) = m*[dot_product(u, u)/2, self%c0**2*elastic_energy(s/self%rho0)]
   end function terms

   ! Sound has on average as much kinetic as elastic energy: E_K - E_C is that of the flow without the sound.
   subroutine add_columns(self, now, first, fastest, row)
      class(impact_solution_t), intent(in) :: self
      real(dp), intent(in) :: now(n_sums), first(n_sums), fastest
      type(columns_t), intent(inout) :: row
      character(*), parameter :: unit = 'share of E_K at t = 0'

      call row%add('lost_kinetic', unit, 1 - now(1)/first(1))
      call row%add('lost_flow', unit, 1 - (now(1) - now(2))/first(1))
      call row%add('lost_mechanical', unit, 1 - (now(1) + now(2))/(first(1) + first(2)))
      call row%add('lost_exact', unit, self%lost_share)
   end subroutine add_columns

   ! The loss right after the impact: averages over the window, while the flow is still that of the impact.
   function results(self, history)
      class(impact_solution_t), intent(in) :: self
      type(history_t), intent(in) :: history
      type(result_t), allocatable :: results(:)
      real(dp) :: scaled(size(history%times)), flow(size(history%times)), mechanical(size(history%times)), loss(2)
      logical :: inside(size(history%times)), found

      associate (times => history%times)
         scaled = times*self%c0/self%extent(2)
         inside = scaled >= impact_window(1) .and. scaled <= impact_window(2)
         flow = history%column('lost_flow')
         mechanical = history%column('lost_mechanical')
         ! The window counts when the run goes through all of it.
         found = count(inside) >= 2 .and. last(scaled) >= impact_window(2)*(1 - 1.0e-9_dp)
         loss = 0
         if (found) loss = [time_mean(pack(times, inside), pack(flow, inside)), &
                            time_mean(pack(times, inside), pack(mechanical, inside))]
      end associate
      results = [result_t('impact_loss', loss(1), found), &
                 result_t('impact_loss_error', loss(1) - self%lost_share, found), &
                 result_t('impact_loss_mechanical', loss(2), found), &
                 known('impact_loss_exact', self%lost_share)]
   end function results

end module rectangle_impact
