!> Checks the sponge layers: where they lie, and that the steps bear them.
module sponge_check
   use draft, only: draft_t
   use kinds, only: dp
   use settings, only: settings_t
   use text, only: short, to_text
   implicit none
   private

   public :: check_sponges, largest_rate

contains

   !> Runs all checks of each &sponge.
   subroutine check_sponges(draft)
      type(draft_t), intent(inout) :: draft
      integer :: i

      if (.not. draft%notes%clean('sponge scene model fluid domain')) return
      do i = 1, size(draft%scene%sponges)
         associate (sponge => draft%scene%sponges(i), domain => draft%scene%domain)
            if (any(sponge%upper <= sponge%lower)) then
               call draft%mistake('sponge', i, 'upper', '&sponge is empty: upper = '//to_text(sponge%upper) &
                                  //' must lie above and right of lower = '//to_text(sponge%lower))
            else if (any(sponge%lower >= domain%upper .or. sponge%upper <= domain%lower)) then
               call draft%warning('sponge', i, 'lower', '&sponge lies outside of the box of &domain and has no effect')
            end if
            if (sponge%rate > largest_rate(draft%scene)) call draft%mistake('sponge', i, 'rate', '&sponge rate = ' &
               //short(sponge%rate)//' may be unstable: at most '//short(largest_rate(draft%scene))//', half of c0/h')
         end associate
      end do
   end subroutine check_sponges

   !> Largest rate: with the longest steps, dt = 2.09 h/c0, rate*dt stays well within what the integrators bear [1/s].
   pure real(dp) function largest_rate(scene)
      type(settings_t), intent(in) :: scene   !! its sound speed is known

      largest_rate = 0.5_dp*scene%fluid%sound_speed/scene%smoothing_length()
   end function largest_rate

end module sponge_check
