!> Checks what is asked for as output: cadences, fields, probes, gauges.
module output_check
   use cadence, only: cadence_t
   use findings, only: findings_t
   use kinds, only: dp
   use namelist_document, only: document_t
   use settings, only: is_wall, name_length, settings_t
   use text, only: quoted, short, to_text
   implicit none
   private

   public :: check_output

   real(dp), parameter :: slack = 1.0e-9_dp   ! of lengths in units of d: rounding of the input

contains

   !> Runs all checks of &output, &probe and &gauge.
   subroutine check_output(document, setup, notes)
      type(document_t), intent(in) :: document
      type(settings_t), intent(in) :: setup
      type(findings_t), intent(inout) :: notes

      character(name_length) :: names(size(setup%probes) + size(setup%gauges))   ! of the columns
      integer :: i

      call check_cadence(document, 'energy', setup%output%energy, notes)
      call check_cadence(document, 'probes', setup%output%probes, notes)
      call check_cadence(document, 'errors', setup%output%errors, notes)
      call check_cadence(document, 'snapshots', setup%output%snapshots, notes)
      call check_fields(document, setup, notes)
      do i = 1, size(setup%probes)
         names(i) = setup%probes(i)%name
         call check_probe_place(document, setup, i, notes)
         call check_name(document, 'probe', i, names(:i), notes)
      end do
      do i = 1, size(setup%gauges)
         names(size(setup%probes) + i) = setup%gauges(i)%name
         call check_gauge_place(document, setup, i, notes)
         call check_name(document, 'gauge', i, names(:size(setup%probes) + i), notes)
      end do
   end subroutine check_output

   !> A cadence must be readable.
   subroutine check_cadence(document, key, phrase, notes)
      type(document_t), intent(in) :: document
      character(*), intent(in) :: key, phrase
      type(findings_t), intent(inout) :: notes

      type(cadence_t) :: parsed
      character(:), allocatable :: message

      call parsed%parse(phrase, message)
      if (message /= '') call notes%mistake(document%place_of('output', 1, key), 'output', '&output '//key//': '//message)
   end subroutine check_cadence

   !> alpha_i and delta_i are kept for the dynamic model alone.
   subroutine check_fields(document, setup, notes)
      type(document_t), intent(in) :: document
      type(settings_t), intent(in) :: setup
      type(findings_t), intent(inout) :: notes

      integer :: i

      if (.not. (notes%clean('output') .and. notes%clean('model')) .or. setup%model%diffusion == 'dynamic') return
      do i = 1, setup%output%n_fields
         associate (field => setup%output%fields(i))
            if (field /= 'alpha' .and. field /= 'delta') cycle
            call notes%mistake(document%place_of('output', 1, 'fields'), 'output', '&output fields: '//quoted(field) &
                               //' is the same everywhere with the constant model and not written; leave it out, ' &
                               //"or set &model diffusion = 'dynamic'")
         end associate
      end do
   end subroutine check_fields

   !> A probe must lie at a wall, all of it within the box.
   subroutine check_probe_place(document, setup, number, notes)
      type(document_t), intent(in) :: document
      type(settings_t), intent(in) :: setup
      integer, intent(in) :: number
      type(findings_t), intent(inout) :: notes

      real(dp) :: distance(4), margin
      logical :: walls(4)
      character(:), allocatable :: problem
      integer :: along

      if (.not. (notes%clean('probe') .and. notes%clean('scene') .and. notes%clean('domain'))) return
      associate (probe => setup%probes(number), domain => setup%domain)
         walls = is_wall([domain%left, domain%bottom, domain%right, domain%top])
         distance = [probe%position - domain%lower, domain%upper - probe%position]
         margin = slack*setup%scene%reference_length
         problem = ''
         if (.not. any(walls)) then
            problem = 'needs a wall, and all sides of &domain are open'
         else if (any(distance < -margin)) then
            problem = 'lies outside the box'
         else if (minval(distance, walls) > setup%spacing()/2 + margin) then
            problem = 'lies '//short(minval(distance, walls))//' m from the nearest wall, more than dx/2 = ' &
                      //short(setup%spacing()/2)//'; put it on the wall'
         else
            along = 2
            if (minval(distance([2, 4]), walls([2, 4])) < minval(distance([1, 3]), walls([1, 3]))) along = 1
            associate (room => 2*min(distance(along), distance(along + 2)))
               if (max(probe%diameter, probe%length) > room + 2*margin) problem = 'is nearer to the end of its wall than its own ' &
                  //'half; there a diameter or length of at most '//short(room)//' m fits'
            end associate
         end if
         if (problem /= '') call notes%mistake(document%place_of('probe', number, 'position'), 'probe', &
                                               '&probe position = '//to_text(probe%position)//' '//problem)
         if (probe%diameter > 0 .and. probe%length > 0) &
            call notes%mistake(document%place_of('probe', number, 'length'), 'probe', &
                               '&probe has a diameter and a length; it is either a disc or a segment: give one of them')
      end associate
   end subroutine check_probe_place

   !> A gauge must pass through the box.
   subroutine check_gauge_place(document, setup, number, notes)
      type(document_t), intent(in) :: document
      type(settings_t), intent(in) :: setup
      integer, intent(in) :: number
      type(findings_t), intent(inout) :: notes
      integer :: across

      if (.not. (notes%clean('gauge') .and. notes%clean('scene') .and. notes%clean('domain'))) return
      associate (gauge => setup%gauges(number), domain => setup%domain)
         across = merge(2, 1, gauge%along == 'x')
         if (gauge%at >= domain%lower(across) .and. gauge%at <= domain%upper(across)) return
         call notes%mistake(document%place_of('gauge', number, 'at'), 'gauge', '&gauge at = '//to_text(gauge%at) &
                            //' lies outside the box; a line along '//trim(gauge%along)//' is between ' &
                            //to_text(domain%lower(across))//' and '//to_text(domain%upper(across)))
      end associate
   end subroutine check_gauge_place

   !> The name of a probe or gauge heads a column: it must be one word and its own.
   subroutine check_name(document, group, number, names, notes)
      type(document_t), intent(in) :: document
      character(*), intent(in) :: group
      integer, intent(in) :: number
      character(*), intent(in) :: names(:)   !! of the columns so far, the last one its own
      type(findings_t), intent(inout) :: notes

      character(*), parameter :: allowed = &
                                 'abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-'
      character(:), allocatable :: problem

      if (.not. notes%clean(group)) return
      problem = ''
      associate (name => names(size(names)))
         if (verify(trim(name), allowed) > 0) then
            problem = ' may have letters, digits, _ and - only'
         else if (name == 'time' .or. name == 'time_scaled') then
            problem = ' is the name of another column of probes.dat; choose another'
         else if (findloc(names, name, dim=1) < size(names)) then
            problem = ' is the name of an earlier probe'
            if (group == 'gauge') problem = problem//' or gauge'
         end if
         if (problem /= '') call notes%mistake(document%place_of(group, number, 'name'), group, &
                                               '&'//group//' name = '//quoted(name)//problem)
      end associate
   end subroutine check_name

end module output_check
