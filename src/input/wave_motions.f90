!> Solids that make waves: how a wave's height and period become the motion of a piston or a flap, and which waves cannot be.
module wave_motions
   use draft, only: draft_t
   use kinds, only: dp
   use settings, only: is_wall, settings_t, solid_settings
   use text, only: quoted, short
   use wave_makers, only: breaking_height, flap_ratio, piston_ratio, wave_number
   implicit none
   private

   public :: makes_waves, resolve_wave_makers, waves_text

   real(dp), parameter :: pi = acos(-1.0_dp)

contains

   !> Whether a solid is a wave maker.
   elemental logical function makes_waves(solid)
      type(solid_settings), intent(in) :: solid

      makes_waves = solid%motion == 'piston' .or. solid%motion == 'flap'
   end function makes_waves

   !> Sets amplitude or swing of each wave maker, and its ramp where that is not given. A wave that cannot be is a mistake.
   subroutine resolve_wave_makers(draft)
      type(draft_t), intent(inout) :: draft   !! nothing is wrong with its solids
      integer :: i

      do i = 1, size(draft%scene%solids)
         if (.not. makes_waves(draft%scene%solids(i))) cycle
         call check_wave(draft, i)
         if (.not. draft%scene%fluid%gravity > 0.0_dp) cycle
         associate (solid => draft%scene%solids(i), scene => draft%scene)
            if (.not. draft%document%given('solid', i, 'ramp')) solid%ramp = solid%period
            solid%amplitude = 0.0_dp
            solid%swing = 0.0_dp
            if (solid%motion == 'piston') solid%amplitude(1) = stroke(scene, solid)/2
            ! Clockwise is forwards.
            if (solid%motion == 'flap') solid%swing = -atan(stroke(scene, solid)/(2*solid%depth))*180/pi
         end associate
      end do
   end subroutine resolve_wave_makers

   ! A wave needs gravity, and must not break at once; a flap needs a hinge, on the floor if there is one.
   subroutine check_wave(draft, number)
      type(draft_t), intent(inout) :: draft
      integer, intent(in) :: number
      character(:), allocatable :: what
      real(dp) :: highest, above

      associate (scene => draft%scene, solid => draft%scene%solids(number))
         what = '&solid '//quoted(solid%name)//' motion = '//quoted(solid%motion)
         if (solid%motion == 'flap' .and. .not. draft%document%given('solid', number, 'pivot')) &
            call draft%mistake('solid', number, 'motion', what//' needs pivot: its hinge on the floor')
         if (.not. scene%fluid%gravity > 0.0_dp) then
            call draft%mistake('solid', number, 'motion', what//' makes waves by gravity, and &fluid gravity is 0')
            return
         end if
         highest = breaking_height(k_of(scene, solid), solid%depth)
         if (solid%wave_height > highest) call draft%warning('solid', number, 'wave_height', '&solid '//quoted(solid%name) &
            //' wave_height = '//short(solid%wave_height)//': waves of this length break above '//short(highest))
         if (solid%motion /= 'flap' .or. .not. is_wall(scene%domain%bottom)) return
         above = solid%pivot(2) - scene%domain%lower(2)
         if (abs(above) > scene%spacing()) call draft%warning('solid', number, 'pivot', what//' is hinged '//short(abs(above)) &
            //trim(merge(' above', ' below', above > 0.0_dp))//' the floor; the height of its waves is that of a hinge on it')
      end associate
   end subroutine check_wave

   pure real(dp) function k_of(scene, solid)
      type(settings_t), intent(in) :: scene
      type(solid_settings), intent(in) :: solid

      k_of = wave_number(2*pi/solid%period, scene%fluid%gravity, solid%depth)
   end function k_of

   ! S of a wave maker, of a flap at the surface [m].
   pure real(dp) function stroke(scene, solid)
      type(settings_t), intent(in) :: scene
      type(solid_settings), intent(in) :: solid

      if (solid%motion == 'flap') then
         stroke = solid%wave_height/flap_ratio(k_of(scene, solid)*solid%depth)
      else
         stroke = solid%wave_height/piston_ratio(k_of(scene, solid)*solid%depth)
      end if
   end function stroke

   !> The waves of all wave makers, in words; '' if there are none.
   function waves_text(scene) result(words)
      type(settings_t), intent(in) :: scene
      character(:), allocatable :: words
      integer :: i

      words = ''
      do i = 1, size(scene%solids)
         associate (solid => scene%solids(i))
            if (.not. makes_waves(solid)) cycle
            if (words /= '') words = words//'; '
            words = words//trim(solid%name)//': length '//short(2*pi/k_of(scene, solid))//', kh ' &
                    //short(k_of(scene, solid)*solid%depth)//', H '//short(solid%wave_height) &
                    //', stroke '//short(stroke(scene, solid))
         end associate
      end do
   end function waves_text

end module wave_motions
