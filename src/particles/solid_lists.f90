!> Which ghosts of solids are near which of the fluid: listed as the fluid's own neighbours are, and as long good for.
module solid_lists
   use candidates, only: acts, block_groups, candidates_t, group_extent, list_group, shared_candidates_t, trim_lists
   use kinds, only: dp
   use lanes, only: nl
   use particles, only: particles_t, state_t
   use solid_ghosts, only: solid_ghosts_t
   use strip_extents, only: take_slack
   use strips, only: add_ranges, extent_t, group_slots, ranges_t, strips_t
   implicit none
   private

   public :: list_near_solids

contains

   !> Lists, for each block of the fluid, the ghosts that its clusters can reach, and for ghosts the fluid.
   subroutine list_near_solids(self, blocks, strips, images, p, predicted, age, times, support)
      type(solid_ghosts_t), intent(inout) :: self
      type(candidates_t), intent(in) :: blocks(:)   !! of the fluid
      type(strips_t), intent(in) :: strips, images  !! of the fluid and of its images
      type(particles_t), intent(in) :: p            !! base state of all slots
      type(state_t), intent(inout) :: predicted     !! positions of all slots, and slack in place of the volume but of the ghosts
      real(dp), intent(in) :: age                   !! of the base state since the sort
      real(dp), intent(in) :: times(2)              !! from the base state to the prediction; before and after it that lists last
      real(dp), intent(in) :: support
      real(dp) :: allowed
      integer :: b

      associate (first => self%before + 1, last => self%before + self%n_slots)
         ! A solid's velocity at `base` leads its ghosts to where they are predicted; beside that they go by their acceleration.
         predicted%volume(first:p%n_slots) = self%acceleration*(abs(times(1)) + times(2))**2 &
                                             + self%creep*(abs(times(1)) + times(2)) + merge(self%width, 0.0_dp, self%creep > 0)
         if (allocated(self%free)) then
            call self%free%take_lists(self%poses, age, abs(times(1)) + times(2), allowed)
            predicted%volume(first:p%n_slots) = predicted%volume(first:p%n_slots) + allowed
         end if
         call take_slack(self%strips, predicted%volume)
         call take_slack(self%images%strips, predicted%volume)
         call lay_out(self, size(blocks))
      end associate
      !$omp parallel default(none) shared(self, blocks, strips, images, p, predicted, times, support)
      !$omp do schedule(dynamic)
      do b = 1, size(blocks)
         self%near(b)%before = blocks(b)%before
         self%near(b)%n_clusters = blocks(b)%n_clusters
         call list_block(self%near(b)%candidates_t, self%strips, self%images%strips, p, predicted, times(2), support)
         self%meets(b) = self%near(b)%first(self%near(b)%n_clusters + 1) > 1
         if (self%shared) self%near(b)%all = self%near(b)%candidates_t
      end do
      !$omp end do
      !$omp do schedule(dynamic)
      do b = 1, self%n_blocks
         call list_block(self%fluid(b)%candidates_t, strips, images, p, predicted, times(2), support)
         if (self%shared) self%fluid(b)%all = self%fluid(b)%candidates_t
      end do
      !$omp end do
      !$omp end parallel
   end subroutine list_near_solids

   ! Blocks of ghosts, whatever their strip: no sum goes over one.
   subroutine lay_out(self, n_near)
      type(solid_ghosts_t), intent(inout) :: self
      integer, intent(in) :: n_near   ! blocks of the fluid
      integer :: b, n_groups

      n_groups = self%n_slots/group_slots
      self%n_blocks = (n_groups + block_groups - 1)/block_groups
      if (allocated(self%near)) then
         if (size(self%near) < n_near .or. size(self%fluid) < self%n_blocks) deallocate (self%near, self%fluid, self%meets)
      end if
      if (.not. allocated(self%near)) then
         allocate (self%near(n_near + n_near/8), self%fluid(self%n_blocks + 8), self%meets(n_near + n_near/8))
         call set_parts(self%near)
         call set_parts(self%fluid)
      end if
      do b = 1, self%n_blocks
         self%fluid(b)%before = self%before + (b - 1)*block_groups*group_slots
         self%fluid(b)%n_clusters = min(block_groups, n_groups - (b - 1)*block_groups)*group_slots/nl
      end do
   end subroutine lay_out

   ! All pairs act.
   elemental subroutine set_parts(block)
      type(shared_candidates_t), intent(inout) :: block

      allocate (block%part(nl, 0:0), source=acts)
   end subroutine set_parts

   ! The lists of a block's clusters.
   subroutine list_block(block, strips, images, p, predicted, travel, support)
      type(candidates_t), intent(inout) :: block
      type(strips_t), intent(in) :: strips, images
      type(particles_t), intent(in) :: p
      type(state_t), intent(in) :: predicted
      real(dp), intent(in) :: travel, support
      type(extent_t) :: group
      type(ranges_t) :: own, mirrored
      integer, allocatable :: found(:)
      integer :: g, i0, n_groups

      n_groups = nl*block%n_clusters/group_slots
      do g = 1, n_groups
         i0 = block%before + (g - 1)*group_slots
         group = group_extent(p%id, predicted, p%base, i0)
         own%n = 0
         mirrored%n = 0
         call add_ranges(strips, group, support, travel, own)
         call add_ranges(images, group, support, travel, mirrored)
         call list_group(block, g, own, mirrored, p%capacity, predicted%x, predicted%y, p%base%u, p%base%v, predicted%volume, i0, &
                         group, support, travel, found)
      end do
      call trim_lists(block)
   end subroutine list_block

end module solid_lists
