!> Checks that a scene is one that its exact solution holds for.
!!
!! What a solution needs is gathered first: all that a scene lacks is told at once, each at the key that is to be changed.
module exact_check
   use document, only: document_t
   use findings, only: findings_t
   use kinds, only: dp
   use scene_needs, only: needs_t, slack
   use settings, only: settings_t
   use solution, only: solution_t
   use text, only: to_text
   implicit none
   private

   public :: check_exact

contains

   !> Runs all checks of &exact.
   subroutine check_exact(solution, document, scene, notes)
      class(solution_t), allocatable, intent(in) :: solution   !! not allocated: there is none
      type(document_t), intent(in) :: document
      type(settings_t), intent(in) :: scene
      type(findings_t), intent(inout) :: notes

      type(needs_t) :: needs
      integer :: i

      if (.not. (notes%clean('exact') .and. notes%clean('body') .and. notes%clean('domain') .and. notes%clean('scene') &
                 .and. notes%clean('fluid') .and. notes%clean('force') .and. notes%clean('model'))) return
      call check_start(solution, document, scene, notes)
      if (.not. allocated(solution)) return
      call add_needs(solution, scene, needs)
      do i = 1, needs%n
         associate (need => needs%items(i))
            call notes%mistake(document%place_of(trim(need%group), need%number, trim(need%key)), 'exact', &
                               "&exact solution = '"//trim(solution%name)//"' needs "//need%what)
         end associate
      end do
   end subroutine check_exact

   !> Bodies can start with a solution's velocity or pressure if there is one.
   subroutine check_start(solution, document, scene, notes)
      class(solution_t), allocatable, intent(in) :: solution
      type(document_t), intent(in) :: document
      type(settings_t), intent(in) :: scene
      type(findings_t), intent(inout) :: notes

      character(:), allocatable :: key, why
      logical :: has_fields, has_pressure
      integer :: i

      has_fields = .false.
      has_pressure = .false.
      why = 'needs an &exact solution; docs/scenes.md says which there are'
      if (allocated(solution)) then
         has_fields = solution%has_fields
         has_pressure = solution%starts_with_pressure
         why = "is unknown to &exact solution = '"//trim(solution%name)//"', which has no fields; give velocity"
      end if
      do i = 1, size(scene%bodies)
         associate (body => scene%bodies(i))
            key = ''
            if (body%pressure == 'exact') key = 'pressure'
            if (body%flow == 'exact') key = 'flow'
            if (key /= '' .and. .not. has_fields) then
               call notes%mistake(document%place_of('body', i, key), 'exact', '&body '//key//" = 'exact' "//why)
            else if (has_pressure .and. body%pressure /= 'exact') then
               call notes%warning(document%place_of('body', i, 'pressure'), "&body starts without the pressure of &exact " &
                                  //"solution = '"//trim(solution%name)//"'; pressure = 'exact' would have it")
            end if
         end associate
      end do
   end subroutine check_start

   !> What the scene lacks: by what the solution is, then what it says itself.
   subroutine add_needs(solution, scene, needs)
      class(solution_t), intent(in) :: solution
      type(settings_t), intent(in) :: scene
      type(needs_t), intent(inout) :: needs

      if (solution%has_amplitude) then
         call needs%unless(abs(scene%exact%amplitude) > 0.0_dp, 'an amplitude that is not 0', 'exact', 'amplitude')
         call needs%unless(all(scene%bodies%flow == 'exact'), "&body flow = 'exact', or its motion is not there", 'body', 'flow')
      end if
      if (solution%has_waves) call need_long_waves(scene, needs)
      call solution%add_needs(scene, needs)
      if (.not. solution%in_central_field) call needs%unless(.not. scene%force%central_rate > 0.0_dp, &
                                                             'no central field: central_rate = 0', 'force', 'central_rate')
      if (.not. solution%by_acceleration) call needs%unless(.not. scene%has_acceleration(), &
                                                            'no acceleration: acceleration = 0, 0', 'force', 'acceleration')
   end subroutine add_needs

   ! Waves that particles can show.
   subroutine need_long_waves(scene, needs)
      type(settings_t), intent(in) :: scene
      type(needs_t), intent(inout) :: needs

      real(dp), parameter :: least_length = 4.0_dp   ! of a wave, in dx
      real(dp) :: most

      most = (scene%domain%upper(1) - scene%domain%lower(1))/(least_length*scene%spacing())
      call needs%unless(scene%exact%waves <= most*(1.0_dp + slack), 'at most '//to_text(int(min(most*(1.0_dp + slack), 1.0e9_dp))) &
                        //' waves in the box: shorter ones than 4 dx cannot be seen in particles', 'exact', 'waves')
   end subroutine need_long_waves

end module exact_check
