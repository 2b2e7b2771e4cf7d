!> The pair loops of a step alone, with the lists of neighbours that a step has and with lists that leave no lane idle.
module pair_passes
   use candidates, only: block_slots, candidates_t
   use diffusion_sums, only: sum_diffusion
   use eddy_sums, only: eddy_sums_t, sum_eddy
   use first_sums, only: first_sums_t, sum_first
   use flow_sums, only: flow_sums_t, sum_flow
   use frozen_terms, only: first_pass
   use kinds, only: dp, i8
   use lanes, only: nl
   use model, only: model_t
   use neighbours, only: neighbours_t
   use particles, only: particles_t
   implicit none
   private

   public :: lanes_t, count_lanes, shorten_lists, all_passes

   !> What the lists of a state come to.
   type :: lanes_t
      real(dp) :: clusters = 0     !! that hold a particle
      real(dp) :: candidates = 0   !! slots listed
      real(dp) :: pairs = 0        !! of a particle and a slot within the support, itself among them
   end type lanes_t

contains

   !> Counts what is listed and what of it is near enough in the base state.
   subroutine count_lanes(model, p, near, counted)
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      type(neighbours_t), intent(in) :: near
      type(lanes_t), intent(out) :: counted
      integer :: b, c, listed

      do b = 1, near%n_blocks
         associate (block => near%blocks(b))
            do c = 1, block%n_clusters
               listed = block%first(c + 1) - block%first(c)
               if (listed > 0) counted%clusters = counted%clusters + 1
               counted%candidates = counted%candidates + listed
               counted%pairs = counted%pairs + pairs_of(model, p, block, c, block%before + (c - 1)*nl)
            end do
         end associate
      end do
   end subroutine count_lanes

   pure integer function pairs_of(model, p, block, c, i0) result(pairs)
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      type(candidates_t), intent(in) :: block
      integer, intent(in) :: c, i0
      integer :: k, l

      pairs = 0
      do k = block%first(c), block%first(c + 1) - 1
         associate (j => block%slot(k))
            do l = 1, nl
               if ((p%base%x(j) - p%base%x(i0 + l))**2 + (p%base%y(j) - p%base%y(i0 + l))**2 < model%kernel%support**2) &
                  pairs = pairs + 1
            end do
         end associate
      end do
   end function pairs_of

   !> Takes from each cluster's list so much that what is left would do for its pairs if every lane of each slot were one.
   !!
   !! A slot takes the same time whatever its lanes hold, so that the loops over such lists are the limit of their design.
   subroutine shorten_lists(model, p, near)
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      type(neighbours_t), intent(inout) :: near
      integer :: b, c, first, needed, place

      do b = 1, near%n_blocks
         associate (block => near%blocks(b))
            place = 1
            do c = 1, block%n_clusters
               first = block%first(c)
               needed = (pairs_of(model, p, block, c, block%before + (c - 1)*nl) + nl - 1)/nl
               block%slot(place:place + needed - 1) = block%slot(first:first + needed - 1)
               block%first(c) = place
               block%first_image(c) = place + needed
               place = place + needed
            end do
            block%first(block%n_clusters + 1) = place
         end associate
      end do
   end subroutine shorten_lists

   !> The sums over pairs of one step: two for the frozen terms, one for each later stage. `check` depends on all of them.
   subroutine all_passes(model, p, near, check)
      type(model_t), intent(in) :: model
      type(particles_t), intent(in) :: p
      type(neighbours_t), intent(in) :: near
      real(dp), intent(inout) :: check
      type(first_sums_t) :: first
      type(flow_sums_t) :: flow
      type(eddy_sums_t) :: eddy
      real(dp) :: diffusion(block_slots)
      integer :: b, i0, pass, stage

      pass = first_pass(model, p%features)
      do b = 1, near%n_blocks
         call sum_first(pass, model%kernel, near%blocks(b), p, near%images%source, near%blocks(b)%before, first)
         check = check + first%divergence(1)
      end do
      do b = 1, near%n_blocks
         i0 = near%blocks(b)%before
         if (model%dynamic) then
            call sum_eddy(model%kernel, near%blocks(b), p, model%alpha, i0, eddy)
            check = check + eddy%diffusion(1)
         else if (p%features%diffusion) then
            call sum_diffusion(model%kernel, near%blocks(b), p, i0, diffusion)
            check = check + diffusion(1)
         end if
      end do
      do stage = 2, model%integrator%stages
         do b = 1, near%n_blocks
            call sum_flow(model%kernel, near%blocks(b), p%base, near%blocks(b)%before, flow)
            check = check + flow%divergence(1)
         end do
      end do
   end subroutine all_passes

end module pair_passes
