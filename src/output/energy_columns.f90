!> Names and units of the columns of `energy.dat`, in their order.
module energy_columns
   implicit none
   private

   character(*), parameter, public :: energy_names(*) = [character(20) :: &
      'time', 'time_scaled', 'step', 'dt', &
      'E_K', 'E_P', 'E_C', 'E_M', 'Q_alpha', 'Q_delta', 'W_s', &
      'E_K/dE', '(E_P-E_P_rest)/dE', '(E_C-E_C_rest)/dE', '(E_M-E_M_rest)/dE', &
      'Q_alpha/dE', 'Q_delta/dE', 'W_s/dE', 'balance_error/dE', &
      'mach', 'density_variation', 'max_speed']

   character(*), parameter, public :: energy_units(*) = [character(44) :: &
      'time', 't sqrt(g/d)', '-', 'time', &
      'energy/width', 'energy/width', 'energy/width', 'energy/width', 'energy/width', 'energy/width', 'energy/width', &
      'share of dE_Mtot', 'share of dE_Mtot', 'share of dE_Mtot', 'share of dE_Mtot', &
      'share of dE_Mtot', 'share of dE_Mtot', 'share of dE_Mtot', 'share of dE_Mtot', &
      'max(|u|, sqrt(p/rho)) / c0', 'largest |rho - rho0| / rho0', 'length/time']
end module energy_columns
