!> What a scene lacks for its exact solution, gathered so that all of it can be told at once; and what several of them need.
module scene_needs
   use kinds, only: dp
   use settings, only: choice_length, name_length, settings_t, side_names
   use text, only: to_text
   implicit none
   private

   public :: needs_t, need_no_weight, need_open_sides, need_one_body, need_rest, need_water_on_floor, need_full_box, same

   real(dp), parameter, public :: slack = 1.0e-9_dp   !! of lengths in units of d: rounding of the input

   !> Something that the scene lacks, and the key to change.
   type :: need_t
      character(:), allocatable :: what
      character(name_length) :: group = '', key = ''
      integer :: number = 1
   end type need_t

   !> All that it lacks.
   type :: needs_t
      integer :: n = 0
      type(need_t) :: items(24)
   contains
      procedure :: unless
   end type needs_t

contains

   !> Adds a need unless it is met.
   subroutine unless(self, met, what, group, key, number)
      class(needs_t), intent(inout) :: self
      logical, intent(in) :: met
      character(*), intent(in) :: what, group, key
      integer, intent(in), optional :: number   !! of the group

      if (met) return
      self%n = self%n + 1
      associate (item => self%items(self%n))
         item%what = what
         item%group = group
         item%key = key
         if (present(number)) item%number = number
      end associate
   end subroutine unless

   !> Gravity must be 0.
   subroutine need_no_weight(scene, needs)
      type(settings_t), intent(in) :: scene
      type(needs_t), intent(inout) :: needs

      call needs%unless(.not. scene%fluid%gravity > 0.0_dp, 'gravity = 0 (it is '//to_text(scene%fluid%gravity)//')', &
                        'fluid', 'gravity')
   end subroutine need_no_weight

   !> All four sides must be open.
   subroutine need_open_sides(scene, needs)
      type(settings_t), intent(in) :: scene
      type(needs_t), intent(inout) :: needs

      character(choice_length) :: kinds_there(4)
      character(:), allocatable :: closed
      integer :: i

      kinds_there = scene%side_kinds()
      closed = ''
      do i = 4, 1, -1
         if (kinds_there(i) /= 'open') closed = trim(side_names(i))//', '//closed
      end do
      if (closed == '') return
      call needs%unless(.false., "open sides: set "//closed(:len_trim(closed) - 1)//" = 'open'", 'domain', &
                        closed(:index(closed, ',') - 1))
   end subroutine need_open_sides

   !> There must be one body, of a shape.
   subroutine need_one_body(scene, shape, needs)
      type(settings_t), intent(in) :: scene
      character(*), intent(in) :: shape
      type(needs_t), intent(inout) :: needs

      call needs%unless(size(scene%bodies) == 1, 'a single &body', 'body', '', 2)
      if (size(scene%bodies) /= 1) return
      call needs%unless(scene%bodies(1)%shape == shape, "&body shape = '"//shape//"'", 'body', 'shape')
   end subroutine need_one_body

   !> All bodies must be at rest.
   subroutine need_rest(scene, needs)
      type(settings_t), intent(in) :: scene
      type(needs_t), intent(inout) :: needs

      integer :: i

      call needs%unless(all([(norm2(scene%bodies(i)%velocity) <= 0.0_dp, i=1, size(scene%bodies))]), &
                        'fluid at rest: velocity = 0, 0', 'body', 'velocity')
   end subroutine need_rest

   !> There must be one rectangle, which lies on the floor from the left to the right side.
   subroutine need_water_on_floor(scene, needs)
      type(settings_t), intent(in) :: scene
      type(needs_t), intent(inout) :: needs

      call need_one_body(scene, 'rectangle', needs)
      if (size(scene%bodies) /= 1) return
      associate (body => scene%bodies(1), domain => scene%domain)
         call needs%unless(same(scene, body%lower(1), domain%lower(1)) .and. same(scene, body%upper(1), domain%upper(1)), &
                           'a body from side to side, from x = '//to_text(domain%lower(1))//' to '//to_text(domain%upper(1)), &
                           'body', 'upper')
         call needs%unless(same(scene, body%lower(2), domain%lower(2)), 'a body on the floor: lower(2) = ' &
                           //to_text(domain%lower(2)), 'body', 'lower')
      end associate
   end subroutine need_water_on_floor

   !> The body must fill the box.
   subroutine need_full_box(scene, needs)
      type(settings_t), intent(in) :: scene
      type(needs_t), intent(inout) :: needs

      if (size(scene%bodies) /= 1) return
      associate (body => scene%bodies(1), domain => scene%domain)
         call needs%unless(all(same(scene, [body%lower, body%upper], [domain%lower, domain%upper])), &
                           'a body that fills the box, from '//to_text(domain%lower)//' to '//to_text(domain%upper), &
                           'body', 'upper')
      end associate
   end subroutine need_full_box

   !> Equal but for the rounding of the input.
   elemental logical function same(scene, one, other)
      type(settings_t), intent(in) :: scene
      real(dp), intent(in) :: one, other   !! lengths [m]

      same = abs(one - other) <= slack*scene%scene%reference_length
   end function same

end module scene_needs
