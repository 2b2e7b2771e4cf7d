!> The columns of `energy.dat`: those that the scene has something to say about, and their values at a state.
module energy_columns
   use budget, only: budget_t
   use columns, only: columns_t
   use gradient_fields, only: extent_t, gradient_numbers_t
   use kinds, only: dp
   use step_state, only: step_t
   use time_scale, only: time_scale_t
   implicit none
   private

   public :: energy_row

   character(*), parameter :: energy = 'energy/width', share = 'share of dE_Mtot'

contains

   !> Names, units and values in one: what is not in the budget's terms has no column.
   pure type(columns_t) function energy_row(budget, gradients, run, scale) result(row)
      type(budget_t), intent(in) :: budget   !! as of the last update
      type(gradient_numbers_t), intent(in) :: gradients   !! looked at only with the dynamic model
      type(step_t), intent(in) :: run
      type(time_scale_t), intent(in) :: scale

      call row%add('time', 'time', run%time)
      call row%add('time_scaled', scale%name, run%time/scale%unit)
      call row%add('step', '-', real(run%step, dp))
      call row%add('dt', 'time', run%dt)
      call add_energies(budget, row)
      call add_shares(budget, row)
      call row%add('mach', 'max(|u|, sqrt(p/rho)) / c0', run%mach)
      call row%add('density_variation', 'largest |rho - rho0| / rho0', run%variation)
      call row%add('max_speed', 'length/time', run%speed)
      if (budget%has%rotation) then
         call row%add('Q_omega', energy, budget%q_omega)
         call row%add('Q_omega/dE', share, budget%q_omega/budget%normaliser)
      end if
      if (budget%has%eddies) then
         call add_extent('alpha', gradients%alpha, row)
         call add_extent('delta', gradients%delta, row)
      end if
   end function energy_row

   pure subroutine add_energies(budget, row)
      type(budget_t), intent(in) :: budget
      type(columns_t), intent(inout) :: row

      associate (b => budget, now => budget%now, has => budget%has)
         call row%add('E_K', energy, now%kinetic)
         if (has%potential) call row%add('E_P', energy, now%potential)
         call row%add('E_C', energy, now%elastic)
         call row%add('E_M', energy, now%total())
         if (has%viscosity) call row%add('Q_alpha', energy, b%q_alpha)
         if (has%diffusion) call row%add('Q_delta', energy, b%q_delta)
         if (has%walls) call row%add('W_s', energy, b%w_s)
         if (has%force) call row%add('W_f', energy, b%w_f)
         if (has%solids) call row%add('W_solid', energy, b%w_solid)
         if (has%solids) call row%add('W_stat', energy, b%w_stat)
         if (has%solids) call row%add('W_pen', energy, b%w_pen)
         if (has%sponges) call row%add('Q_sponge', energy, b%q_sponge)
         if (has%free_bodies) call row%add('E_body', energy, b%e_body)
         if (has%free_bodies) call row%add('Q_damper', energy, b%q_damper)
      end associate
   end subroutine add_energies

   ! The same as shares of Delta E_Mtot, above the rest state.
   pure subroutine add_shares(budget, row)
      type(budget_t), intent(in) :: budget
      type(columns_t), intent(inout) :: row

      associate (b => budget, now => budget%now, rest => budget%rest, de => budget%normaliser, has => budget%has)
         call row%add('E_K/dE', share, now%kinetic/de)
         if (has%potential) call row%add('(E_P-E_P_rest)/dE', share, (now%potential - rest%potential)/de)
         call row%add('(E_C-E_C_rest)/dE', share, (now%elastic - rest%elastic)/de)
         call row%add('(E_M-E_M_rest)/dE', share, (now%total() - rest%total())/de)
         if (has%viscosity) call row%add('Q_alpha/dE', share, b%q_alpha/de)
         if (has%diffusion) call row%add('Q_delta/dE', share, b%q_delta/de)
         if (has%walls) call row%add('W_s/dE', share, b%w_s/de)
         if (has%force) call row%add('W_f/dE', share, b%w_f/de)
         if (has%solids) call row%add('W_solid/dE', share, b%w_solid/de)
         if (has%solids) call row%add('W_stat/dE', share, b%w_stat/de)
         if (has%solids) call row%add('W_pen/dE', share, b%w_pen/de)
         if (has%sponges) call row%add('Q_sponge/dE', share, b%q_sponge/de)
         if (has%free_bodies) call row%add('(E_body-E_body_0)/dE', share, (b%e_body - b%e_body_at_start)/de)
         if (has%free_bodies) call row%add('Q_damper/dE', share, b%q_damper/de)
         call row%add('balance_error/dE', share, b%balance_error)
      end associate
   end subroutine add_shares

   pure subroutine add_extent(name, extent, row)
      character(*), intent(in) :: name
      type(extent_t), intent(in) :: extent
      type(columns_t), intent(inout) :: row

      call row%add(name//'_min', '-', extent%least)
      call row%add(name//'_mean', '-', extent%mean)
      call row%add(name//'_max', '-', extent%largest)
   end subroutine add_extent

end module energy_columns
