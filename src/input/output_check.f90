!> Checks what is asked for as output: cadences, fields, probes.
module output_check
   use cadence, only: cadence_t
   use findings, only: findings_t
   use kinds, only: dp
   use namelist_document, only: document_t
   use settings, only: is_wall, settings_t
   use text, only: quoted, short, to_text
   implicit none
   private

   public :: check_output

   real(dp), parameter :: slack = 1.0e-9_dp   ! of lengths in units of d: rounding of the input

contains

   !> Runs all checks of &output and &probe.
   subroutine check_output(document, setup, notes)
      type(document_t), intent(in) :: document
      type(settings_t), intent(in) :: setup
      type(findings_t), intent(inout) :: notes

      integer :: i

      call check_cadence(document, 'energy', setup%output%energy, notes)
      call check_cadence(document, 'probes', setup%output%probes, notes)
      call check_cadence(document, 'errors', setup%output%errors, notes)
      call check_cadence(document, 'snapshots', setup%output%snapshots, notes)
      call check_fields(document, setup, notes)
      do i = 1, size(setup%probes)
         call check_probe_place(document, setup, i, notes)
         call check_probe_name(document, setup, i, notes)
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

   !> A probe must lie at a wall.
   subroutine check_probe_place(document, setup, number, notes)
      type(document_t), intent(in) :: document
      type(settings_t), intent(in) :: setup
      integer, intent(in) :: number
      type(findings_t), intent(inout) :: notes

      real(dp) :: distance(4)
      logical :: walls(4)
      character(:), allocatable :: problem

      if (.not. (notes%clean('probe') .and. notes%clean('scene') .and. notes%clean('domain'))) return
      associate (at => setup%probes(number)%position, domain => setup%domain)
         walls = is_wall([domain%left, domain%bottom, domain%right, domain%top])
         distance = [at - domain%lower, domain%upper - at]
         problem = ''
         if (.not. any(walls)) then
            problem = 'needs a wall, and all sides of &domain are open'
         else if (any(distance < -slack*setup%scene%reference_length)) then
            problem = 'lies outside the box'
         else if (minval(distance, walls) > setup%smoothing_length()) then
            problem = 'lies '//short(minval(distance, walls))//' m from the nearest wall; put it on one'
         end if
         if (problem /= '') call notes%mistake(document%place_of('probe', number, 'position'), 'probe', &
                                               '&probe position = '//to_text(at)//' '//problem)
      end associate
   end subroutine check_probe_place

   !> A probe's name heads a column: it must be one word and its own.
   subroutine check_probe_name(document, setup, number, notes)
      type(document_t), intent(in) :: document
      type(settings_t), intent(in) :: setup
      integer, intent(in) :: number
      type(findings_t), intent(inout) :: notes

      character(*), parameter :: allowed = &
                                 'abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-'

      if (.not. notes%clean('probe')) return
      associate (name => setup%probes(number)%name)
         if (verify(trim(name), allowed) > 0) then
            call notes%mistake(document%place_of('probe', number, 'name'), 'probe', '&probe name = '//quoted(name) &
                               //' may have letters, digits, _ and - only')
         else if (name == 'time' .or. name == 'time_scaled') then
            call notes%mistake(document%place_of('probe', number, 'name'), 'probe', '&probe name = '//quoted(name) &
                               //' is the name of another column of probes.dat; choose another')
         else if (any(setup%probes(:number - 1)%name == name)) then
            call notes%mistake(document%place_of('probe', number, 'name'), 'probe', '&probe name = '//quoted(name) &
                               //' is the name of an earlier probe')
         end if
      end associate
   end subroutine check_probe_name

end module output_check
