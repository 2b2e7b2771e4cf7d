!> Checks the box: that it has an inside, and that its sides go together and with what acts on the fluid.
module domain_check
   use draft, only: draft_t
   use kinds, only: dp
   use settings, only: choice_length, is_wall, side_names
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
      character(choice_length) :: sides(4)

      sides = draft%scene%side_kinds()
      if (draft%notes%clean('domain')) call check_pairs(draft, sides)
      if (draft%notes%clean('domain')) call check_box(draft, sides)
      if (draft%notes%clean('domain fluid')) call check_falling(draft, sides)
      call check_wall_speeds(draft, sides)
      if (draft%notes%clean('fluid model')) call check_no_slip(draft, sides)
   end subroutine check_domain

   !> Periodic sides are one line: both of a pair must be.
   subroutine check_pairs(draft, sides)
      type(draft_t), intent(inout) :: draft
      character(*), intent(in) :: sides(4)   !! what they are
      integer :: first, other, periodic

      do first = 1, 3, 2
         if (count(sides(first:first + 1) == 'periodic') /= 1) cycle
         periodic = findloc(sides(first:first + 1), 'periodic', 1) + first - 1
         other = 2*first + 1 - periodic
         call draft%mistake('domain', 1, trim(side_names(periodic)), '&domain '//trim(side_names(periodic)) &
                            //" = 'periodic' needs "//trim(side_names(other))//" = 'periodic' too, which is " &
                            //quoted(sides(other))//': both are the same line')
      end do
   end subroutine check_pairs

   !> The box must have an inside, and room between its sides.
   subroutine check_box(draft, sides)
      type(draft_t), intent(inout) :: draft
      character(*), intent(in) :: sides(4)
      character(*), parameter :: too_small(2) = [character(8) :: 'narrower', 'lower']
      character(13) :: what   ! kind of the sides
      real(dp) :: diameter, extent(2), least
      integer :: axis, first

      extent = draft%scene%domain%upper - draft%scene%domain%lower
      if (any(extent <= 0.0_dp)) then
         call draft%mistake('domain', 1, 'upper', '&domain is empty: upper = '//to_text(draft%scene%domain%upper) &
                            //' must lie above and right of lower = '//to_text(draft%scene%domain%lower))
         return
      end if
      if (.not. draft%notes%clean('scene model')) return
      do axis = 1, 2
         first = 2*axis - 1
         diameter = 4.0_dp*draft%scene%model%smoothing_ratio   ! [dx]
         what = 'wall'
         least = wall_diameters*diameter + wall_room
         if (all(sides(first:first + 1) == 'periodic')) then
            what = 'periodic side'
            least = period_diameters*diameter + period_room
         else if (.not. all(is_wall(sides(first:first + 1)))) then
            cycle
         end if
         if (extent(axis) >= least*draft%scene%spacing()*(1.0_dp - slack)) cycle
         call draft%mistake('domain', 1, 'upper', '&domain is '//trim(too_small(axis))//' than ' &
                            //rounded_up(least*draft%scene%spacing())//', '//short(least)//' dx between ' &
                            //trim(side_names(first))//' and '//trim(side_names(first + 1))//' '//trim(what) &
                            //': raise the resolution or move them apart')
      end do
   end subroutine check_box

   !> Where bottom and top are one line, fluid with weight would fall for ever; a central field would jump there.
   subroutine check_falling(draft, sides)
      type(draft_t), intent(inout) :: draft
      character(*), intent(in) :: sides(4)
      character(:), allocatable :: name

      if (sides(3) == 'periodic' .and. draft%scene%fluid%gravity > 0.0_dp) &
         call draft%mistake('domain', 1, 'bottom', "&domain bottom = 'periodic' needs &fluid gravity = 0 (it is " &
                            //to_text(draft%scene%fluid%gravity)//'): the fluid would fall for ever')
      if (.not. draft%scene%force%central_rate > 0.0_dp .or. all(sides /= 'periodic')) return
      name = trim(side_names(findloc(sides, 'periodic', 1)))
      call draft%mistake('domain', 1, name, '&domain '//name//" = 'periodic' and &force central_rate exclude each other: " &
                         //'the central field is not periodic')
   end subroutine check_falling

   !> Only no-slip sides take the fluid along.
   subroutine check_wall_speeds(draft, sides)
      type(draft_t), intent(inout) :: draft
      character(*), intent(in) :: sides(4)
      integer :: i

      do i = 1, 4
         if (sides(i) == 'no_slip' .or. .not. abs(draft%scene%domain%wall_speeds(i)) > 0.0_dp) cycle
         call draft%warning('domain', 1, 'wall_speeds', '&domain wall_speeds: '//to_text(draft%scene%domain%wall_speeds(i)) &
                            //' has no effect without '//trim(side_names(i))//" = 'no_slip'; it is "//quoted(sides(i)))
      end do
   end subroutine check_wall_speeds

   !> Without viscosity, no slip is free slip.
   subroutine check_no_slip(draft, sides)
      type(draft_t), intent(inout) :: draft
      character(*), intent(in) :: sides(4)
      character(:), allocatable :: name

      associate (model => draft%scene%model)
         if (draft%scene%fluid%viscosity > 0.0_dp .or. model%diffusion /= 'constant' .or. model%alpha > 0.0_dp) return
      end associate
      if (all(sides /= 'no_slip')) return
      name = trim(side_names(findloc(sides, 'no_slip', 1)))
      call draft%warning('domain', 1, name, '&domain '//name//" = 'no_slip' has no effect without viscosity: set &fluid " &
                         //'viscosity or &model alpha')
   end subroutine check_no_slip

end module domain_check
