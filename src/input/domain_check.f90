!> Checks the box: that it has an inside, and that its sides go together and with what acts on the fluid.
module domain_check
   use findings, only: findings_t
   use kinds, only: dp
   use namelist_document, only: document_t
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
   subroutine check_domain(document, setup, notes)
      type(document_t), intent(in) :: document
      type(settings_t), intent(in) :: setup
      type(findings_t), intent(inout) :: notes

      call check_pairs(document, setup, notes)
      call check_box(document, setup, notes)
      call check_falling(document, setup, notes)
      call check_wall_speeds(document, setup, notes)
      call check_no_slip(document, setup, notes)
      call check_images(document, setup, notes)
   end subroutine check_domain

   !> Periodic sides are one line: both of a pair must be.
   subroutine check_pairs(document, setup, notes)
      type(document_t), intent(in) :: document
      type(settings_t), intent(in) :: setup
      type(findings_t), intent(inout) :: notes

      character(choice_length) :: kinds_there(4)
      integer :: first, other, periodic

      if (.not. notes%clean('domain')) return
      kinds_there = setup%side_kinds()
      do first = 1, 3, 2
         if (count(kinds_there(first:first + 1) == 'periodic') /= 1) cycle
         periodic = findloc(kinds_there(first:first + 1), 'periodic', 1) + first - 1
         other = 2*first + 1 - periodic
         associate (name => side_names(periodic))
            call notes%mistake(document%place_of('domain', 1, trim(name)), 'domain', '&domain '//trim(name) &
                               //" = 'periodic' needs "//trim(side_names(other))//" = 'periodic' too, which is " &
                               //quoted(kinds_there(other))//': both are the same line')
         end associate
      end do
   end subroutine check_pairs

   !> The box must have an inside, and room between its sides.
   subroutine check_box(document, setup, notes)
      type(document_t), intent(in) :: document
      type(settings_t), intent(in) :: setup
      type(findings_t), intent(inout) :: notes

      character(choice_length) :: kinds_there(4)
      real(dp) :: extent(2), diameter
      integer :: axis

      if (.not. notes%clean('domain')) return
      extent = setup%domain%upper - setup%domain%lower
      if (any(extent <= 0.0_dp)) then
         call notes%mistake(document%place_of('domain', 1, 'upper'), 'domain', '&domain is empty: upper = ' &
                            //to_text(setup%domain%upper)//' must lie above and right of lower = '//to_text(setup%domain%lower))
         return
      end if
      if (.not. (notes%clean('scene') .and. notes%clean('model'))) return
      kinds_there = setup%side_kinds()
      diameter = 4.0_dp*setup%model%smoothing_ratio
      do axis = 1, 2
         associate (pair => kinds_there(2*axis - 1:2*axis))
            if (all(is_wall(pair))) call check_room(axis, extent(axis), wall_diameters*diameter + wall_room, &
                                                    'wall', document, setup, notes)
            if (all(pair == 'periodic')) call check_room(axis, extent(axis), period_diameters*diameter + period_room, &
                                                       'periodic side', document, setup, notes)
         end associate
      end do
   end subroutine check_box

   !> Two sides must lie some spacings apart.
   subroutine check_room(axis, extent, least, what, document, setup, notes)
      integer, intent(in) :: axis             !! 1: left and right, 2: bottom and top
      real(dp), intent(in) :: extent          !! [m]
      real(dp), intent(in) :: least           !! [dx]
      character(*), intent(in) :: what        !! kind of the sides, for the message
      type(document_t), intent(in) :: document
      type(settings_t), intent(in) :: setup
      type(findings_t), intent(inout) :: notes

      character(*), parameter :: words(2) = [character(8) :: 'narrower', 'lower']

      if (extent >= least*setup%spacing()*(1.0_dp - slack)) return
      call notes%mistake(document%place_of('domain', 1, 'upper'), 'domain', '&domain is '//trim(words(axis))//' than ' &
                         //rounded_up(least*setup%spacing())//', '//short(least)//' dx between ' &
                         //trim(side_names(2*axis - 1))//' and '//trim(side_names(2*axis))//' '//what &
                         //': raise the resolution or move them apart')
   end subroutine check_room

   !> Where bottom and top are one line, fluid with weight would fall for ever; a central field would jump there.
   subroutine check_falling(document, setup, notes)
      type(document_t), intent(in) :: document
      type(settings_t), intent(in) :: setup
      type(findings_t), intent(inout) :: notes

      character(choice_length) :: kinds_there(4)
      integer :: side

      if (.not. (notes%clean('domain') .and. notes%clean('fluid'))) return
      kinds_there = setup%side_kinds()
      if (kinds_there(3) == 'periodic' .and. setup%fluid%gravity > 0.0_dp) then
         call notes%mistake(document%place_of('domain', 1, 'bottom'), 'domain', "&domain bottom = 'periodic' needs &fluid " &
                            //'gravity = 0 (it is '//to_text(setup%fluid%gravity)//'): the fluid would fall for ever')
      end if
      if (setup%force%central_rate > 0.0_dp .and. any(kinds_there == 'periodic')) then
         side = findloc(kinds_there, 'periodic', 1)
         call notes%mistake(document%place_of('domain', 1, trim(side_names(side))), 'domain', '&domain '//trim(side_names(side)) &
                            //" = 'periodic' and &force central_rate exclude each other: the central field is not periodic")
      end if
   end subroutine check_falling

   !> Only no-slip sides take the fluid along.
   subroutine check_wall_speeds(document, setup, notes)
      type(document_t), intent(in) :: document
      type(settings_t), intent(in) :: setup
      type(findings_t), intent(inout) :: notes

      character(choice_length) :: kinds_there(4)
      integer :: side

      kinds_there = setup%side_kinds()
      do side = 1, 4
         if (kinds_there(side) == 'no_slip' .or. .not. abs(setup%domain%wall_speeds(side)) > 0.0_dp) cycle
         call notes%warning(document%place_of('domain', 1, 'wall_speeds'), '&domain wall_speeds: ' &
                            //to_text(setup%domain%wall_speeds(side))//' has no effect without '//trim(side_names(side)) &
                            //" = 'no_slip'; it is "//quoted(kinds_there(side)))
      end do
   end subroutine check_wall_speeds

   !> Without viscosity, no slip is free slip.
   subroutine check_no_slip(document, setup, notes)
      type(document_t), intent(in) :: document
      type(settings_t), intent(in) :: setup
      type(findings_t), intent(inout) :: notes

      integer :: side

      if (.not. (notes%clean('fluid') .and. notes%clean('model'))) return
      if (setup%fluid%viscosity > 0.0_dp .or. setup%model%diffusion /= 'constant' .or. setup%model%alpha > 0.0_dp) return
      side = findloc(setup%side_kinds(), 'no_slip', 1)
      if (side > 0) call notes%warning(document%place_of('domain', 1, trim(side_names(side))), '&domain '//trim(side_names(side)) &
                                       //" = 'no_slip' has no effect without viscosity: set &fluid viscosity or &model alpha")
   end subroutine check_no_slip

   !> Without a force, what is hydrostatic has no effect.
   subroutine check_images(document, setup, notes)
      type(document_t), intent(in) :: document
      type(settings_t), intent(in) :: setup
      type(findings_t), intent(inout) :: notes

      if (.not. document%given('domain', 1, 'images') .or. setup%domain%images /= 'hydrostatic') return
      if (.not. notes%clean('fluid') .or. setup%fluid%gravity > 0.0_dp .or. setup%has_acceleration()) return
      call notes%warning(document%place_of('domain', 1, 'images'), &
                         "&domain images = 'hydrostatic' has no effect: gravity is 0")
   end subroutine check_images

end module domain_check
