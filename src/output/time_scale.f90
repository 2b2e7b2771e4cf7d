!> The unit that times are scaled with in tables.
module time_scale
   use kinds, only: dp
   use settings, only: settings_t
   implicit none
   private

   public :: time_scale_t, new_time_scale

   !> A time and what it is called.
   type :: time_scale_t
      real(dp) :: unit = 1               !! [s]
      character(16) :: name = 'time'     !! of a time divided by it
   end type time_scale_t

contains

   !> sqrt(d/g); 1/w in a central field; d/U_ref where there is neither.
   pure type(time_scale_t) function new_time_scale(scene) result(scale)
      type(settings_t), intent(in) :: scene

      associate (d => scene%scene%reference_length, fluid => scene%fluid, force => scene%force)
         if (fluid%gravity > 0) then
            scale = time_scale_t(sqrt(d/fluid%gravity), 't sqrt(g/d)')
         else if (force%central_rate > 0) then
            scale = time_scale_t(1/force%central_rate, 't w')
         else if (fluid%reference_speed > 0) then
            scale = time_scale_t(d/fluid%reference_speed, 't U/d')
         end if
      end associate
   end function new_time_scale

end module time_scale
