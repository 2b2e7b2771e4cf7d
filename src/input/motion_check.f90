!> Checks how solids and the tank move.
module motion_check
   use draft, only: draft_t
   use kinds, only: dp
   use text, only: quoted, short
   implicit none
   private

   public :: compare_with_sound, warn_of_rest

   real(dp), parameter :: fast = 0.3_dp   ! of the sound speed

contains

   !> What moves must be slower than sound.
   subroutine compare_with_sound(draft, group, number, what, speed)
      type(draft_t), intent(inout) :: draft
      character(*), intent(in) :: group
      integer, intent(in) :: number          !! of the group
      character(*), intent(in) :: what       !! moves, for the message
      real(dp), intent(in) :: speed          !! largest [m/s]
      character(*), parameter :: advice = 'slow it down or raise sound_speed (or lower mach)'
      character(:), allocatable :: words, place

      if (.not. draft%notes%clean('fluid')) return
      place = trim(merge('in it    ', 'before it', group == 'tank'))
      associate (c0 => draft%scene%fluid%sound_speed)
         words = what//' moves at up to '//short(speed)//', '//short(speed/c0)//' times the sound speed: '
         if (speed > c0) then
            call draft%mistake(group, number, 'motion', words//advice)
         else if (speed > fast*c0) then
            call draft%warning(group, number, 'motion', words//'the fluid '//place//' is compressed; '//advice)
         end if
      end associate
   end subroutine compare_with_sound

   !> Warns of a motion that is none, and says what of it is to be given.
   subroutine warn_of_rest(draft, group, number, what, motion)
      type(draft_t), intent(inout) :: draft
      character(*), intent(in) :: group
      integer, intent(in) :: number          !! of the group
      character(*), intent(in) :: what       !! rests, for the message
      character(*), intent(in) :: motion     !! its kind
      character(:), allocatable :: advice

      advice = 'give velocity or spin'
      if (motion == 'oscillation') advice = 'give amplitude or swing'
      if (motion == 'table') advice = 'its rows are all the same'
      call draft%warning(group, number, 'motion', what//' motion = '//quoted(motion)//' leaves it where it is: '//advice)
   end subroutine warn_of_rest

end module motion_check
