!> The outlines of solids in all snapshots of a run, for ParaView: an XDMF file that names where each is at which time.
!!
!! XDMF 2: a collection in time of collections of one line for each solid.
module outline_series
   use growing_text, only: growing_text_t
   use kinds, only: dp
   use result_directory, only: snapshot_name
   use snapshot, only: outlines_group
   use text, only: to_text
   implicit none
   private

   public :: outlines_as_xdmf

contains

   !> The whole file.
   function outlines_as_xdmf(times, names, corners) result(text)
      real(dp), intent(in) :: times(:)         !! of the snapshots, numbered from 0
      character(*), intent(in) :: names(:)     !! of the solids
      integer, intent(in) :: corners(:)        !! that each has
      character(:), allocatable :: text
      type(growing_text_t) :: lines
      character(32) :: number
      integer :: i, k

      call lines%add_line('<?xml version="1.0"?>')
      call lines%add_line('<Xdmf Version="2.0"><Domain><Grid Name="solids" GridType="Collection" CollectionType="Temporal">')
      do i = 1, size(times)
         write (number, '(es24.16e3)') times(i)
         call lines%add_line('<Grid Name="solids" GridType="Collection" CollectionType="Spatial"><Time Value="' &
                             //trim(adjustl(number))//'"/>')
         do k = 1, size(names)
            call add_line_of(snapshot_name(i - 1), trim(names(k)), to_text(corners(k) + 1), lines)
         end do
         call lines%add_line('</Grid>')
      end do
      call lines%add_line('</Grid></Domain></Xdmf>')
      text = lines%text()
   end function outlines_as_xdmf

   ! One solid in one snapshot.
   subroutine add_line_of(file, name, n, lines)
      character(*), intent(in) :: file, name
      character(*), intent(in) :: n            ! points
      type(growing_text_t), intent(inout) :: lines
      character(*), parameter :: item = '<DataItem Format="HDF" NumberType='
      character(:), allocatable :: place

      place = file//':'//outlines_group//'/'//name
      call lines%add_line('  <Grid Name="'//name//'">')
      call lines%add_line('    <Topology TopologyType="Polyline" NumberOfElements="1" NodesPerElement="'//n//'">' &
                          //item//'"Int" Dimensions="1 '//n//'">'//place//'/order</DataItem></Topology>')
      call lines%add_line('    <Geometry GeometryType="XYZ">' &
                          //item//'"Float" Precision="8" Dimensions="'//n//' 3">'//place//'/points</DataItem></Geometry>')
      call lines%add_line('  </Grid>')
   end subroutine add_line_of

end module outline_series
