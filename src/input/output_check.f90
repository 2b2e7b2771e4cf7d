!> Checks what is asked for as output: cadences, fields, probes, gauges.
module output_check
   use cadence, only: cadence_t
   use draft, only: draft_t
   use kinds, only: dp
   use name_table, only: name_table_t
   use polygons, only: nearest_edge
   use scanner, only: letters
   use settings, only: gauge_settings, is_wall, probe_settings, settings_t
   use solid_outlines, only: solid_outline
   use text, only: quoted, short, to_text
   implicit none
   private

   public :: check_output

contains

   !> Runs all checks of &output, &probe and &gauge.
   subroutine check_output(draft)
      type(draft_t), intent(inout) :: draft
      type(name_table_t) :: columns   ! of probes.dat so far
      integer :: i

      associate (output => draft%scene%output, probes => draft%scene%probes, gauges => draft%scene%gauges)
         call check_cadence(draft, 'energy', output%energy)
         call check_cadence(draft, 'probes', output%probes)
         call check_cadence(draft, 'errors', output%errors)
         call check_cadence(draft, 'solids', output%solids)
         call check_cadence(draft, 'walls', output%walls)
         call check_cadence(draft, 'snapshots', output%snapshots)
         call check_cadence(draft, 'checkpoint', output%checkpoint)
         if (draft%notes%clean('output model') .and. draft%scene%model%diffusion /= 'dynamic') call check_fields(draft)
         do i = 1, size(probes)
            if (draft%notes%clean('probe scene domain solid')) call check_probe(draft, probes(i), i)
            call check_name(draft, 'probe', i, trim(probes(i)%name), columns)
         end do
         do i = 1, size(gauges)
            if (draft%notes%clean('gauge scene domain')) call check_gauge(draft, gauges(i), i)
            call check_name(draft, 'gauge', i, trim(gauges(i)%name), columns)
         end do
      end associate
   end subroutine check_output

   !> A cadence must be readable.
   subroutine check_cadence(draft, key, phrase)
      type(draft_t), intent(inout) :: draft
      character(*), intent(in) :: key, phrase
      type(cadence_t) :: parsed
      character(:), allocatable :: message

      call parsed%parse(phrase, message, by_clock=key == 'checkpoint')
      if (message /= '') call draft%mistake('output', 1, key, '&output '//key//': '//message)
   end subroutine check_cadence

   !> alpha_i and delta_i are kept for the dynamic model alone.
   subroutine check_fields(draft)
      type(draft_t), intent(inout) :: draft
      integer :: i

      do i = 1, draft%scene%output%n_fields
         associate (field => draft%scene%output%fields(i))
            if (field == 'alpha' .or. field == 'delta') &
               call draft%mistake('output', 1, 'fields', '&output fields: '//quoted(field) &
                                  //' is the same everywhere with the constant model and not written; leave it out, ' &
                                  //"or set &model diffusion = 'dynamic'")
         end associate
      end do
   end subroutine check_fields

   !> A probe must lie at a wall, all of it within the box, or on the face of a solid as drawn.
   subroutine check_probe(draft, probe, number)
      type(draft_t), intent(inout) :: draft
      type(probe_settings), intent(in) :: probe
      integer, intent(in) :: number
      real(dp) :: distance(4), gap(2), half_spacing, margin, room
      logical :: walls(4)
      character(:), allocatable :: problem
      integer :: along

      associate (domain => draft%scene%domain)
         walls = is_wall([domain%left, domain%bottom, domain%right, domain%top])
         distance = [probe%position - domain%lower, domain%upper - probe%position]
      end associate
      margin = draft%scene%margin()
      half_spacing = draft%scene%spacing()/2
      along = 2
      if (minval(distance([2, 4]), walls([2, 4])) < minval(distance([1, 3]), walls([1, 3]))) along = 1
      room = min(distance(along), distance(along + 2))   ! for half of it
      problem = ''
      gap = gaps_to_solids(draft%scene, probe)
      if (gap(1) < minval(distance, walls) .and. .not. any(distance < -margin)) then
         if (gap(1) > half_spacing + margin) then
            problem = 'lies '//short(gap(1))//' m from the nearest solid, more than dx/2 = '//short(half_spacing) &
                      //'; put it on the face of one, where it is drawn, or on a wall'
         else if (gap(2) > half_spacing + margin) then
            problem = 'reaches '//short(gap(2))//' m beside its solid; make it shorter'
         end if
      else if (.not. any(walls)) then
         problem = 'needs a wall, and all sides of &domain are open'
      else if (any(distance < -margin)) then
         problem = 'lies outside the box'
      else if (minval(distance, walls) > half_spacing + margin) then
         problem = 'lies '//short(minval(distance, walls))//' m from the nearest wall, more than dx/2 = ' &
                   //short(half_spacing)//'; put it on the wall'
      else if (max(probe%diameter, probe%length) > 2*room + 2*margin) then
         problem = 'is nearer to the end of its wall than its own half; there a diameter or length of at most '//short(2*room) &
                   //' m fits'
      end if
      if (problem /= '') &
         call draft%mistake('probe', number, 'position', '&probe position = '//to_text(probe%position)//' '//problem)
      if (probe%diameter > 0 .and. probe%length > 0) &
         call draft%mistake('probe', number, 'length', '&probe has a diameter and a length; it is either a disc or a segment: ' &
                            //'give one of them')
   end subroutine check_probe

   ! How far a probe is from the nearest solid as drawn, and the farther one of its ends from that; huge without solids.
   pure function gaps_to_solids(scene, probe) result(gaps)
      type(settings_t), intent(in) :: scene
      type(probe_settings), intent(in) :: probe
      real(dp) :: gaps(2), of_one(2)
      integer :: i

      gaps = huge(gaps)
      do i = 1, size(scene%solids)
         of_one = gaps_to(solid_outline(scene, scene%solids(i)), probe)
         if (of_one(1) < gaps(1)) gaps = of_one
      end do
   end function gaps_to_solids

   pure function gaps_to(outline, probe) result(gaps)
      real(dp), intent(in) :: outline(:, :)   ! (2, n)
      type(probe_settings), intent(in) :: probe
      real(dp) :: gaps(2), foot(2), normal(2), along(2), unused(4), gap
      logical :: counts(size(outline, 2))
      integer :: edge, k

      counts = .true.
      call nearest_edge(outline, counts, probe%position, edge, gaps(1), foot, normal)
      along = [-normal(2), normal(1)]*max(probe%diameter, probe%length)/2
      gaps(2) = 0
      do k = -1, 1, 2
         call nearest_edge(outline, counts, probe%position + k*along, edge, gap, unused(:2), unused(3:))
         gaps(2) = max(gaps(2), gap)
      end do
   end function gaps_to

   !> A gauge must pass through the box.
   subroutine check_gauge(draft, gauge, number)
      type(draft_t), intent(inout) :: draft
      type(gauge_settings), intent(in) :: gauge
      integer, intent(in) :: number
      integer :: across

      across = merge(2, 1, gauge%along == 'x')
      associate (lower => draft%scene%domain%lower(across), upper => draft%scene%domain%upper(across))
         if (gauge%at >= lower .and. gauge%at <= upper) return
         call draft%mistake('gauge', number, 'at', '&gauge at = '//to_text(gauge%at)//' lies outside the box; a line along ' &
                            //trim(gauge%along)//' is between '//to_text(lower)//' and '//to_text(upper))
      end associate
   end subroutine check_gauge

   !> The name of a probe or gauge heads a column: it must be one word and its own.
   subroutine check_name(draft, group, number, name, columns)
      type(draft_t), intent(inout) :: draft
      character(*), intent(in) :: group
      integer, intent(in) :: number
      character(*), intent(in) :: name
      type(name_table_t), intent(inout) :: columns   !! those before it; on return with its own
      character(:), allocatable :: problem

      problem = ''
      if (verify(name, letters//'0123456789_-') > 0) then
         problem = ' may have letters, digits, _ and - only'
      else if (name == 'time' .or. name == 'time_scaled') then
         problem = ' is the name of another column of probes.dat; choose another'
      else if (columns%find(name) > 0) then
         problem = ' is the name of an earlier probe'
         if (group == 'gauge') problem = problem//' or gauge'
      end if
      call columns%put(name, number)
      if (problem /= '' .and. draft%notes%clean(group)) &
         call draft%mistake(group, number, 'name', '&'//group//' name = '//quoted(name)//problem)
   end subroutine check_name

end module output_check
