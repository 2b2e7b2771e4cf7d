!> Checks what is asked for as output: cadences, fields, probes, gauges.
module output_check
   use cadence, only: cadence_t
   use draft, only: draft_t
   use kinds, only: dp
   use name_table, only: name_table_t
   use settings, only: is_wall
   use text, only: quoted, short, to_text
   implicit none
   private

   public :: check_output

   real(dp), parameter :: slack = 1.0e-9_dp   ! of lengths in units of d: rounding of the input

contains

   !> Runs all checks of &output, &probe and &gauge.
   subroutine check_output(draft)
      type(draft_t), intent(inout) :: draft
      type(name_table_t) :: columns   ! of probes.dat so far
      integer :: i

      associate (output => draft%scene%output)
         call check_cadence(draft, 'energy', output%energy)
         call check_cadence(draft, 'probes', output%probes)
         call check_cadence(draft, 'errors', output%errors)
         call check_cadence(draft, 'snapshots', output%snapshots)
      end associate
      call check_fields(draft)
      do i = 1, size(draft%scene%probes)
         call check_probe_place(draft, i)
         call check_name(draft, 'probe', i, trim(draft%scene%probes(i)%name), columns)
      end do
      do i = 1, size(draft%scene%gauges)
         call check_gauge_place(draft, i)
         call check_name(draft, 'gauge', i, trim(draft%scene%gauges(i)%name), columns)
      end do
   end subroutine check_output

   !> A cadence must be readable.
   subroutine check_cadence(draft, key, phrase)
      type(draft_t), intent(inout) :: draft
      character(*), intent(in) :: key, phrase
      type(cadence_t) :: parsed
      character(:), allocatable :: message

      call parsed%parse(phrase, message)
      if (message /= '') call draft%mistake('output', key, '&output '//key//': '//message)
   end subroutine check_cadence

   !> alpha_i and delta_i are kept for the dynamic model alone.
   subroutine check_fields(draft)
      type(draft_t), intent(inout) :: draft
      integer :: i

      if (.not. draft%clean('output model') .or. draft%scene%model%diffusion == 'dynamic') return
      do i = 1, draft%scene%output%n_fields
         associate (field => draft%scene%output%fields(i))
            if (field /= 'alpha' .and. field /= 'delta') cycle
            call draft%mistake('output', 'fields', '&output fields: '//quoted(field) &
                               //' is the same everywhere with the constant model and not written; leave it out, ' &
                               //"or set &model diffusion = 'dynamic'")
         end associate
      end do
   end subroutine check_fields

   !> A probe must lie at a wall, all of it within the box.
   subroutine check_probe_place(draft, number)
      type(draft_t), intent(inout) :: draft
      integer, intent(in) :: number
      real(dp) :: distance(4), margin
      logical :: walls(4)
      character(:), allocatable :: problem
      integer :: along

      if (.not. draft%clean('probe scene domain')) return
      associate (probe => draft%scene%probes(number), domain => draft%scene%domain)
         walls = is_wall([domain%left, domain%bottom, domain%right, domain%top])
         distance = [probe%position - domain%lower, domain%upper - probe%position]
         margin = slack*draft%scene%scene%reference_length
         problem = ''
         if (.not. any(walls)) then
            problem = 'needs a wall, and all sides of &domain are open'
         else if (any(distance < -margin)) then
            problem = 'lies outside the box'
         else if (minval(distance, walls) > draft%scene%spacing()/2 + margin) then
            problem = 'lies '//short(minval(distance, walls))//' m from the nearest wall, more than dx/2 = ' &
                      //short(draft%scene%spacing()/2)//'; put it on the wall'
         else
            along = 2
            if (minval(distance([2, 4]), walls([2, 4])) < minval(distance([1, 3]), walls([1, 3]))) along = 1
            associate (room => 2*min(distance(along), distance(along + 2)))
               if (max(probe%diameter, probe%length) > room + 2*margin) problem = 'is nearer to the end of its wall than its own ' &
                  //'half; there a diameter or length of at most '//short(room)//' m fits'
            end associate
         end if
         if (problem /= '') &
            call draft%mistake('probe', 'position', '&probe position = '//to_text(probe%position)//' '//problem, number)
         if (probe%diameter > 0 .and. probe%length > 0) &
            call draft%mistake('probe', 'length', '&probe has a diameter and a length; it is either a disc or a segment: ' &
                               //'give one of them', number)
      end associate
   end subroutine check_probe_place

   !> A gauge must pass through the box.
   subroutine check_gauge_place(draft, number)
      type(draft_t), intent(inout) :: draft
      integer, intent(in) :: number
      integer :: across

      if (.not. draft%clean('gauge scene domain')) return
      associate (gauge => draft%scene%gauges(number), domain => draft%scene%domain)
         across = merge(2, 1, gauge%along == 'x')
         if (gauge%at >= domain%lower(across) .and. gauge%at <= domain%upper(across)) return
         call draft%mistake('gauge', 'at', '&gauge at = '//to_text(gauge%at) &
                            //' lies outside the box; a line along '//trim(gauge%along)//' is between ' &
                            //to_text(domain%lower(across))//' and '//to_text(domain%upper(across)), number)
      end associate
   end subroutine check_gauge_place

   !> The name of a probe or gauge heads a column: it must be one word and its own.
   subroutine check_name(draft, group, number, name, columns)
      type(draft_t), intent(inout) :: draft
      character(*), intent(in) :: group
      integer, intent(in) :: number
      character(*), intent(in) :: name
      type(name_table_t), intent(inout) :: columns   !! those before it; on return with its own
      character(*), parameter :: allowed = &
                                 'abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-'
      character(:), allocatable :: problem

      problem = ''
      if (verify(name, allowed) > 0) then
         problem = ' may have letters, digits, _ and - only'
      else if (name == 'time' .or. name == 'time_scaled') then
         problem = ' is the name of another column of probes.dat; choose another'
      else if (columns%find(name) > 0) then
         problem = ' is the name of an earlier probe'
         if (group == 'gauge') problem = problem//' or gauge'
      end if
      call columns%put(name, number)
      if (problem /= '' .and. draft%clean(group)) &
         call draft%mistake(group, 'name', '&'//group//' name = '//quoted(name)//problem, number)
   end subroutine check_name

end module output_check
