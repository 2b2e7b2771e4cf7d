!> Completes the lists of numbers of each &solid and of &tank: reads them from the files that hold them, and looks how many there
!! are.
module solid_files
   use draft, only: draft_t
   use findings, only: place_t
   use kinds, only: dp
   use number_files, only: read_rows
   use settings, only: motion_settings, number_list_t, solid_settings
   use text, only: quoted, to_text
   implicit none
   private

   public :: complete_lists

   integer, parameter, public :: vertices_range(2) = [3, 1000]   !! vertices of a polygon, fewest and most
   integer, parameter, public :: rows_range(2) = [2, 2000]       !! rows of a table, fewest and most
   integer, parameter :: in_vertex = 2, in_row = 4               ! numbers
   real(dp), parameter :: most = 1.0e30_dp, least = 1.0e-30_dp   ! numbers, and times above 0, within reason

contains

   !> Reads the files of all solids and of the tank. Afterwards a polygon has vertices, what follows a table has it, and no file
   !! is named; what cannot be is a mistake.
   subroutine complete_lists(draft)
      type(draft_t), intent(inout) :: draft
      character(*), parameter :: out_of_reason = ': all its numbers must be below 1e30, and times above 1e-30: choose other units'
      logical :: sure
      integer :: at, i

      ! Where a key or a choice was refused, what lacks may be a consequence.
      sure = draft%notes%clean('solid')
      do i = 1, size(draft%scene%solids)
         associate (solid => draft%scene%solids(i))
            if (draft%document%groups(draft%document%index_of('solid', i))%unsure) cycle
            if (solid%shape == 'polygon') call complete_vertices(draft, i, solid, sure)
            if (solid%motion == 'table') call complete_table(draft, 'solid', i, solid, sure)
            if (has_wild_shape(solid) .or. has_wild_motion(solid)) &
               call draft%mistake('solid', i, '', '&solid '//quoted(solid%name)//out_of_reason)
         end associate
      end do
      at = draft%document%index_of('tank', 1)
      if (at == 0) return
      associate (tank => draft%scene%tank)
         if (draft%document%groups(at)%unsure) return
         if (tank%motion == 'table') call complete_table(draft, 'tank', 1, tank, draft%notes%clean('tank'))
         if (has_wild_motion(tank)) call draft%mistake('tank', 1, '', '&tank'//out_of_reason)
      end associate
   end subroutine complete_lists

   ! Whether products of the numbers of a shape could be none.
   pure logical function has_wild_shape(solid) result(wild)
      type(solid_settings), intent(in) :: solid

      wild = maxval(abs([solid%lower, solid%upper, solid%centre, solid%radius, solid%angle])) > most
      if (solid%vertices%n() > 0) wild = wild .or. maxval(abs(solid%vertices%values)) > most
   end function has_wild_shape

   ! Whether products of the numbers of a motion could be none.
   pure logical function has_wild_motion(moved) result(wild)
      class(motion_settings), intent(in) :: moved
      real(dp) :: times(2), steps(max(0, moved%table%n()/in_row - 1))
      integer :: k

      times = [moved%period, moved%ramp]   ! 0 where there are none
      wild = maxval(abs([moved%pivot, moved%velocity, moved%spin, moved%amplitude, moved%swing, moved%phase, times])) > most &
             .or. any(times > 0.0_dp .and. times < least)
      if (moved%table%n() < 2*in_row) return
      steps = [(moved%table%values(in_row*k + 1) - moved%table%values(in_row*(k - 1) + 1), k=1, size(steps))]
      wild = wild .or. maxval(abs(moved%table%values)) > most .or. any(steps > 0.0_dp .and. steps < least)
   end function has_wild_motion

   ! The vertices of a polygon.
   subroutine complete_vertices(draft, number, solid, sure)
      type(draft_t), intent(inout) :: draft
      integer, intent(in) :: number
      type(solid_settings), intent(inout) :: solid
      logical, intent(in) :: sure   ! nothing else is wrong
      real(dp), allocatable :: rows(:, :)
      integer :: n

      if (.not. has_one(draft, 'solid', number, 'vertices', solid%vertices_file, sure)) return
      if (solid%vertices_file /= '') then
         call read_file(draft, 'solid', number, 'vertices_file', [in_vertex, in_vertex], vertices_range(2), &
                        solid%vertices_file, rows)
         if (size(rows) == 0) return
         call fill(solid%vertices, rows)
      end if
      n = solid%vertices%n()
      if (n == 0) return   ! its numbers were refused
      if (modulo(n, in_vertex) /= 0) then
         call draft%mistake('solid', number, 'vertices', '&solid vertices has '//to_text(n) &
                            //' numbers; x and y of each vertex are wanted')
      else if (n/in_vertex < vertices_range(1) .or. n/in_vertex > vertices_range(2)) then
         call draft%mistake('solid', number, list_key(solid%vertices_file, 'vertices'), '&solid vertices: ' &
                            //to_text(n/in_vertex)//' vertices are given; '//to_text(vertices_range(1))//' to ' &
                            //to_text(vertices_range(2))//' are possible')
      end if
      solid%vertices_file = ''
   end subroutine complete_vertices

   ! The way of a solid or the tank.
   subroutine complete_table(draft, group, number, moved, sure)
      type(draft_t), intent(inout) :: draft
      character(*), intent(in) :: group
      integer, intent(in) :: number
      class(motion_settings), intent(inout) :: moved
      logical, intent(in) :: sure   ! nothing else is wrong
      real(dp), allocatable :: rows(:, :), full(:, :)
      character(:), allocatable :: problem
      integer :: n

      if (.not. has_one(draft, group, number, 'table', moved%table_file, sure)) return
      if (moved%table_file /= '') then
         call read_file(draft, group, number, 'table_file', [in_row - 1, in_row], rows_range(2), moved%table_file, rows)
         if (size(rows) == 0) return
         allocate (full(in_row, size(rows, 2)), source=0.0_dp)   ! angles where there are none
         full(:size(rows, 1), :) = rows
         call fill(moved%table, full)
      end if
      n = moved%table%n()
      if (n == 0) return
      problem = ''
      if (modulo(n, in_row) /= 0) then
         problem = ' has '//to_text(n)//' numbers; rows of time, x, y and angle are wanted'
      else if (n/in_row < rows_range(1) .or. n/in_row > rows_range(2)) then
         problem = ': '//to_text(n/in_row)//trim(merge(' row is  ', ' rows are', n == in_row))//' given; '// &
                   to_text(rows_range(1))//' to '//to_text(rows_range(2))//' are possible'
      else if (draft%notes%clean(group)) then
         problem = what_is_no_way(moved%table%values(1::in_row))
      end if
      if (problem /= '') call draft%mistake(group, number, list_key(moved%table_file, 'table'), '&'//group//' table'//problem)
      moved%table_file = ''
   end subroutine complete_table

   ! Why nothing can move so; '' if it can.
   pure function what_is_no_way(times) result(problem)
      real(dp), intent(in) :: times(:)   ! of a table [s]
      character(:), allocatable :: problem
      integer :: k

      problem = ''
      do k = 2, size(times)
         if (times(k) > times(k - 1)) cycle
         problem = ': its times must grow, and '//to_text(times(k))//' in row '//to_text(k)//' follows '//to_text(times(k - 1))
         return
      end do
   end function what_is_no_way

   ! The key that has given a list.
   pure function list_key(file, key) result(name)
      character(*), intent(in) :: file, key
      character(:), allocatable :: name

      name = key
      if (file /= '') name = key//'_file'
   end function list_key

   ! Whether either a list or a file of it is given; both or none are a mistake. A list that was refused is one that was given.
   logical function has_one(draft, group, number, key, file, sure)
      type(draft_t), intent(inout) :: draft
      character(*), intent(in) :: group
      integer, intent(in) :: number
      character(*), intent(in) :: key     ! of the list
      character(*), intent(in) :: file
      logical, intent(in) :: sure
      logical :: listed

      listed = draft%document%given(group, number, key)
      has_one = listed .neqv. file /= ''
      if (has_one) return
      if (listed) then
         call draft%mistake(group, number, key//'_file', '&'//group//' '//key//' and '//key//'_file are both given; leave one ' &
                            //'of them out')
      else if (sure) then
         call draft%mistake(group, number, '', '&'//group//' needs '//key//' or '//key//'_file'//other_choice(key))
      end if
   end function has_one

   ! What else there may be.
   pure function other_choice(key) result(words)
      character(*), intent(in) :: key
      character(:), allocatable :: words

      words = ", or another shape: 'rectangle', 'disc'"
      if (key == 'table') words = ', or another motion'
   end function other_choice

   ! The rows of a file, none after a mistake.
   subroutine read_file(draft, group, number, key, columns, most_rows, path, rows)
      type(draft_t), intent(inout) :: draft
      character(*), intent(in) :: group
      integer, intent(in) :: number
      character(*), intent(in) :: key          ! that names it
      integer, intent(in) :: columns(2), most_rows
      character(*), intent(in) :: path
      real(dp), allocatable, intent(out) :: rows(:, :)
      character(:), allocatable :: message

      call read_rows(whole_path(draft%document%place_of(group, number, key), draft%notes%file, trim(path)), columns, &
                     most_rows, rows, message)
      if (message == '') return
      call draft%mistake(group, number, key, '&'//group//' '//key//': '//message)
      deallocate (rows)
      allocate (rows(0, 0))
   end subroutine read_file

   ! A path as seen from the working directory. The scene's file names it from its own place on; the command line, and a scene
   ! that comes through a pipe, from the working directory.
   pure function whole_path(place, scene_file, path) result(whole)
      type(place_t), intent(in) :: place       ! that names it
      character(*), intent(in) :: scene_file, path
      character(:), allocatable :: whole

      whole = path
      if (index(path, '/') == 1 .or. allocated(place%option) .or. index(scene_file, '/dev/') == 1) return
      whole = scene_file(:index(scene_file, '/', back=.true.))//path
   end function whole_path

   ! Lists the numbers of rows one after the other.
   pure subroutine fill(list, rows)
      type(number_list_t), intent(inout) :: list
      real(dp), intent(in) :: rows(:, :)

      if (allocated(list%values)) deallocate (list%values)
      allocate (list%values(size(rows)))
      list%values(:) = reshape(rows, [size(rows)])
   end subroutine fill

end module solid_files
