!> Checks how the box moves, and that its sides and the exact solution bear it.
module tank_check
   use derived_settings, only: tank_speed
   use draft, only: draft_t
   use kinds, only: dp
   use motion_check, only: compare_with_sound, warn_of_rest
   use motions, only: motion_t, pose_t
   use settings, only: choice_length, side_names
   use solid_outlines, only: motion_of
   use text, only: quoted
   implicit none
   private

   public :: check_tank

   character(*), parameter :: moving_solution = 'sloshing'   ! what is known of a box that moves

contains

   !> Runs all checks of &tank.
   subroutine check_tank(draft)
      type(draft_t), intent(inout) :: draft
      type(motion_t) :: motion
      type(pose_t) :: pose

      if (.not. draft%notes%clean('tank domain')) return
      if (draft%scene%tank%motion == 'none') return
      motion = motion_of(draft%scene%tank)
      pose = motion%at(0.0_dp)
      ! Gravity has another direction in a box that is held at an angle.
      if (.not. motion%moves() .and. .not. abs(pose%angle) > 0.0_dp) then
         call warn_of_rest(draft, 'tank', 1, '&tank', draft%scene%tank%motion)
         return
      end if
      call compare_with_sound(draft, 'tank', 1, '&tank', tank_speed(draft%scene))
      if (motion%turns()) call check_sides(draft)
      if (any(abs(draft%scene%domain%wall_speeds) > 0.0_dp)) &
         call draft%mistake('tank', 1, 'motion', '&tank moves, and &domain wall_speeds are of walls of a box at rest; leave one ' &
                            //'of them out')
      if (.not. draft%notes%clean('exact')) return
      associate (solution => draft%scene%exact%solution)
         if (solution == 'none' .or. solution == moving_solution) return
         call draft%mistake('tank', 1, 'motion', '&tank moves, and &exact solution = '//quoted(solution)//' is that of a box at ' &
                            //'rest; leave one of them out')
      end associate
   end subroutine check_tank

   ! In a box that turns, what acts on the fluid differs from place to place.
   subroutine check_sides(draft)
      type(draft_t), intent(inout) :: draft
      character(choice_length) :: sides(4)
      integer :: side

      sides = draft%scene%side_kinds()
      side = findloc(sides, 'periodic', 1)
      if (side == 0) return
      call draft%mistake('tank', 1, 'motion', '&tank turns, and turning needs walls: &domain '//trim(side_names(side)) &
                         //" = 'periodic'; make it a wall, or let the tank shift only")
   end subroutine check_sides

end module tank_check
