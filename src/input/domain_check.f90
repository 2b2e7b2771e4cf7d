!> Checks the box: that it has an inside, and that its sides go together and with what acts on the fluid.
module domain_check
   use draft, only: draft_t
   use kinds, only: dp
   use settings, only: choice_length, is_wall, settings_t, side_names
   use text, only: quoted, rounded_up, short, to_text
   implicit none
   private

   public :: check_domain

   ! Apart from this much of dx, in diameters of the kernel: images of walls reach half of one and have no images; between
   ! periodic sides a particle meets no other twice.
   real(dp), parameter :: wall_diameters = 0.5_dp, wall_room = 1.0_dp, period_diameters = 1.0_dp, period_room = 2.0_dp
   real(dp), parameter :: slack = 1.0e-9_dp   ! relative; rounding of the input

contains

   !> Runs all checks of &domain.
   subroutine check_domain(draft)
      type(draft_t), intent(inout) :: draft

      call check_pairs(draft)
      call check_box(draft)
      call check_falling(draft)
      call check_wall_speeds(draft)
      call check_no_slip(draft)
   end subroutine check_domain

   !> Periodic sides are one line: both of a pair must be.
   subroutine check_pairs(draft)
      type(draft_t), intent(inout) :: draft
      character(choice_length) :: kinds_there(4)
      integer :: first, other, periodic

      if (.not. draft%clean('domain')) return
      kinds_there = draft%scene%side_kinds()
      do first = 1, 3, 2
         if (count(kinds_there(first:first + 1) == 'periodic') /= 1) cycle
         periodic = findloc(kinds_there(first:first + 1), 'periodic', 1) + first - 1
         other = 2*first + 1 - periodic
         associate (name => side_names(periodic))
            call draft%mistake('domain', trim(name), '&domain '//trim(name) &
                               //" = 'periodic' needs "//trim(side_names(other))//" = 'periodic' too, which is " &
                               //quoted(kinds_there(other))//': both are the same line')
         end associate
      end do
   end subroutine check_pairs

   !> The box must have an inside, and room between its sides.
   subroutine check_box(draft)
      type(draft_t), intent(inout) :: draft
      character(choice_length) :: kinds_there(4)
      real(dp) :: extent(2), diameter
      integer :: axis

      if (.not. draft%clean('domain')) return
      extent = draft%scene%domain%upper - draft%scene%domain%lower
      if (any(extent <= 0.0_dp)) then
         call draft%mistake('domain', 'upper', '&domain is empty: upper = '//to_text(draft%scene%domain%upper) &
                            //' must lie above and right of lower = '//to_text(draft%scene%domain%lower))
         return
      end if
      if (.not. draft%clean('scene model')) return
      kinds_there = draft%scene%side_kinds()
      diameter = 4.0_dp*draft%scene%model%smoothing_ratio
      do axis = 1, 2
         associate (pair => kinds_there(2*axis - 1:2*axis))
            if (all(is_wall(pair))) call check_room(axis, extent(axis), wall_diameters*diameter + wall_room, &
                                                    'wall', draft)
            if (all(pair == 'periodic')) call check_room(axis, extent(axis), period_diameters*diameter + period_room, &
                                                       'periodic side', draft)
         end associate
      end do
   end subroutine check_box

   !> Two sides must lie some spacings apart.
   subroutine check_room(axis, extent, least, what, draft)
      integer, intent(in) :: axis             !! 1: left and right, 2: bottom and top
      real(dp), intent(in) :: extent          !! [m]
      real(dp), intent(in) :: least           !! [dx]
      character(*), intent(in) :: what        !! kind of the sides, for the message
      type(draft_t), intent(inout) :: draft
      character(*), parameter :: words(2) = [character(8) :: 'narrower', 'lower']

      if (extent >= least*draft%scene%spacing()*(1.0_dp - slack)) return
      call draft%mistake('domain', 'upper', '&domain is '//trim(words(axis))//' than ' &
                         //rounded_up(least*draft%scene%spacing())//', '//short(least)//' dx between ' &
                         //trim(side_names(2*axis - 1))//' and '//trim(side_names(2*axis))//' '//what &
                         //': raise the resolution or move them apart')
   end subroutine check_room

   !> Where bottom and top are one line, fluid with weight would fall for ever; a central field would jump there.
   subroutine check_falling(draft)
      type(draft_t), intent(inout) :: draft
      character(choice_length) :: kinds_there(4)
      integer :: side

      if (.not. draft%clean('domain fluid')) return
      kinds_there = draft%scene%side_kinds()
      if (kinds_there(3) == 'periodic' .and. draft%scene%fluid%gravity > 0.0_dp) then
         call draft%mistake('domain', 'bottom', "&domain bottom = 'periodic' needs &fluid " &
                            //'gravity = 0 (it is '//to_text(draft%scene%fluid%gravity)//'): the fluid would fall for ever')
      end if
      if (draft%scene%force%central_rate > 0.0_dp .and. any(kinds_there == 'periodic')) then
         side = findloc(kinds_there, 'periodic', 1)
         call draft%mistake('domain', trim(side_names(side)), '&domain '//trim(side_names(side)) &
                            //" = 'periodic' and &force central_rate exclude each other: the central field is not periodic")
      end if
   end subroutine check_falling

   !> Only no-slip sides take the fluid along.
   subroutine check_wall_speeds(draft)
      type(draft_t), intent(inout) :: draft
      character(choice_length) :: kinds_there(4)
      integer :: side

      kinds_there = draft%scene%side_kinds()
      do side = 1, 4
         if (kinds_there(side) == 'no_slip' .or. .not. abs(draft%scene%domain%wall_speeds(side)) > 0.0_dp) cycle
         call draft%warning('domain', 'wall_speeds', '&domain wall_speeds: ' &
                            //to_text(draft%scene%domain%wall_speeds(side))//' has no effect without '//trim(side_names(side)) &
                            //" = 'no_slip'; it is "//quoted(kinds_there(side)))
      end do
   end subroutine check_wall_speeds

   !> Without viscosity, no slip is free slip.
   subroutine check_no_slip(draft)
      type(draft_t), intent(inout) :: draft
      integer :: side

      if (.not. draft%clean('fluid model')) return
      associate (model => draft%scene%model)
         if (draft%scene%fluid%viscosity > 0.0_dp .or. model%diffusion /= 'constant' .or. model%alpha > 0.0_dp) return
      end associate
      side = findloc(draft%scene%side_kinds(), 'no_slip', 1)
      if (side > 0) call draft%warning('domain', trim(side_names(side)), '&domain '//trim(side_names(side)) &
                                       //" = 'no_slip' has no effect without viscosity: set &fluid viscosity or &model alpha")
   end subroutine check_no_slip

end module domain_check
