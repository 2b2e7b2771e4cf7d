!> Pair sums between the fluid and the ghosts of solids, for a block of clusters.
!!
!! Source: ours (docs/equations.md, Solid bodies). A ghost's pressure is a mean over the fluid with weights c; the same weights,
!! transposed, give the fluid the ghost's share of the divergence.
module solid_sums
   use box, only: box_t
   use candidates, only: block_slots, candidates_t
   use flow_sums, only: flow_sums_t
   use image_laws, only: as_position, image_of, law_t
   use images, only: images_t
   use kernel, only: kernel_t, pair_with_value, squared_distance
   use kinds, only: dp
   use lanes, only: nl
   use particles, only: particles_t, state_t
   implicit none
   private

   public :: ghost_sums_t, sum_ghosts, sum_solids, sum_solid_friction, sum_ghost_friction

   !> Sums over the fluid near a block of ghosts, without the kernel's constant factors; r = r_b - r_f.
   type :: ghost_sums_t
      real(dp) :: weight(block_slots)     !! [m2] sum_f w V_f, W = factor w
      real(dp) :: density(block_slots)    !! [kg] sum_f w V_f s_f
      real(dp) :: way_x(block_slots)      !! [m3] sum_f w V_f r
      real(dp) :: way_y(block_slots)   !! [m3]
      real(dp) :: inflow(block_slots)     !! [m4/s] sum_f t**3 V_f (u_f - U).r
      real(dp) :: push_x(block_slots)     !! [kg] sum_f t**3 V_f r s_f
      real(dp) :: push_y(block_slots)   !! [kg]
      real(dp) :: area_x(block_slots)     !! [m3] sum_f t**3 V_f r
      real(dp) :: area_y(block_slots)   !! [m3]
      real(dp) :: images(8, block_slots)  !! of images alone: push and area, as the solid's power has them; as the fluid feels them
   end type ghost_sums_t

contains

   !> What the ghosts of a block have of the fluid near them.
   pure subroutine sum_ghosts(kernel, block, state, images, box, i0, sums)
      type(kernel_t), intent(in) :: kernel
      type(candidates_t), intent(in) :: block
      type(state_t), intent(in) :: state      !! of all slots
      type(images_t), intent(in) :: images    !! of the fluid
      type(box_t), intent(in) :: box          !! at the state's time
      integer, intent(in) :: i0               !! slot before the block's first
      type(ghost_sums_t), intent(inout) :: sums
      integer :: c, k, n

      do c = 1, block%n_clusters
         k = (c - 1)*nl
         n = block%first(c + 1) - block%first(c)
         call ghost_loop(n, block%slot(block%first(c):block%first(c + 1) - 1), size(state%x), state%x, state%y, state%u, state%v, &
                         state%s, state%volume, i0 + k, k, kernel%inverse_support, sums)
         call sum_images(kernel, block, c, state, images, box, i0, sums)
      end do
   end subroutine sum_ghosts

   ! Over the fluid and its images, whose density is the hydrostatically continued one.
   pure subroutine ghost_loop(n_near, near, n, x, y, u, v, s, volume, i0, k0, inverse_support, sums)
      integer, intent(in) :: n_near, near(n_near), n, i0, k0
      real(dp), intent(in) :: x(n), y(n), u(n), v(n), s(n), volume(n), inverse_support
      type(ghost_sums_t), intent(inout) :: sums
      real(dp), dimension(nl) :: xi, yi, ui, vi, total, density, way_x, way_y, inflow, push_x, push_y, area_x, area_y
      real(dp) :: dx, dy, g, gx, gy, w
      integer :: k, j, l

      xi = x(i0 + 1:i0 + nl)
      yi = y(i0 + 1:i0 + nl)
      ui = u(i0 + 1:i0 + nl)
      vi = v(i0 + 1:i0 + nl)
      total = 0; density = 0; way_x = 0; way_y = 0; inflow = 0
      push_x = 0; push_y = 0; area_x = 0; area_y = 0
      do k = 1, n_near
         j = near(k)
         !$omp simd private(dx, dy, g, gx, gy, w)
         do l = 1, nl
            dx = xi(l) - x(j)
            dy = yi(l) - y(j)
            call pair_with_value(dx, dy, inverse_support, g, w)
            w = w*volume(j)
            gx = g*volume(j)*dx
            gy = g*volume(j)*dy
            total(l) = total(l) + w
            density(l) = density(l) + w*s(j)
            way_x(l) = way_x(l) + w*dx
            way_y(l) = way_y(l) + w*dy
            inflow(l) = inflow(l) + (u(j) - ui(l))*gx + (v(j) - vi(l))*gy
            push_x(l) = push_x(l) + s(j)*gx
            push_y(l) = push_y(l) + s(j)*gy
            area_x(l) = area_x(l) + gx
            area_y(l) = area_y(l) + gy
         end do
      end do
      sums%weight(k0 + 1:k0 + nl) = total
      sums%density(k0 + 1:k0 + nl) = density
      sums%way_x(k0 + 1:k0 + nl) = way_x
      sums%way_y(k0 + 1:k0 + nl) = way_y
      sums%inflow(k0 + 1:k0 + nl) = inflow
      sums%push_x(k0 + 1:k0 + nl) = push_x
      sums%push_y(k0 + 1:k0 + nl) = push_y
      sums%area_x(k0 + 1:k0 + nl) = area_x
      sums%area_y(k0 + 1:k0 + nl) = area_y
   end subroutine ghost_loop

   ! Of images, `push` and `area` once more: an image of kind M acts on a ghost as its source, with its own density, does on the
   ! ghost's image of that kind, whose density is less by the hydrostatic difference. The force that the source feels is mirrored.
   pure subroutine sum_images(kernel, block, c, state, images, box, i0, sums)
      type(kernel_t), intent(in) :: kernel
      type(candidates_t), intent(in) :: block
      integer, intent(in) :: c                ! cluster
      type(state_t), intent(in) :: state
      type(images_t), intent(in) :: images
      type(box_t), intent(in) :: box
      integer, intent(in) :: i0
      type(ghost_sums_t), intent(inout) :: sums
      type(law_t) :: law(2)
      real(dp) :: dx, dy, g, w, s, plain(4), sign(4)
      integer :: k, j, l, kind

      sums%images(:, (c - 1)*nl + 1:c*nl) = 0
      if (block%first_image(c) >= block%first(c + 1)) return
      law = [as_position(box, 1), as_position(box, 2)]
      do k = block%first_image(c), block%first(c + 1) - 1
         j = block%slot(k)
         kind = images%kind(j - images%n_held)
         sign = [law(1)%factor(kind), law(2)%factor(kind), law(1)%factor(kind), law(2)%factor(kind)]
         do l = (c - 1)*nl + 1, c*nl
            associate (x => state%x(i0 + l), y => state%y(i0 + l))
               dx = x - state%x(j)
               dy = y - state%y(j)
               call pair_with_value(dx, dy, kernel%inverse_support, g, w)
               if (.not. g > 0) cycle
               g = g*state%volume(j)
               s = state%s(images%source(j - images%n_held)) + box%density_slope(1)*(image_of(law(1), kind, x) - x) &
                   + box%density_slope(2)*(image_of(law(2), kind, y) - y)
            end associate
            plain = g*[s*dx, s*dy, dx, dy]
            ! `ghost_loop` has taken the image's own density.
            sums%push_x(l) = sums%push_x(l) - g*state%s(j)*dx
            sums%push_y(l) = sums%push_y(l) - g*state%s(j)*dy
            sums%area_x(l) = sums%area_x(l) - g*dx
            sums%area_y(l) = sums%area_y(l) - g*dy
            sums%images(1:4, l) = sums%images(1:4, l) + plain
            sums%images(5:8, l) = sums%images(5:8, l) + sign*plain
         end do
      end do
   end subroutine sum_images

   !> What solids add to the flow sums of a block of the fluid.
   pure subroutine sum_solids(kernel, block, state, before, exchange, i0, sums)
      type(kernel_t), intent(in) :: kernel
      type(candidates_t), intent(in) :: block   !! ghosts and their images near each cluster
      type(state_t), intent(in) :: state        !! of all slots
      integer, intent(in) :: before             !! slots before the ghosts
      real(dp), intent(in) :: exchange(:)       !! (ghosts and images)
      integer, intent(in) :: i0                 !! slot before the block's first
      type(flow_sums_t), intent(inout) :: sums
      integer :: c, k

      do c = 1, block%n_clusters
         k = (c - 1)*nl
         call lane_loop(block%first(c + 1) - block%first(c), block%slot(block%first(c):block%first(c + 1) - 1), size(state%x), &
                        state%x, state%y, state%u, state%v, state%s, state%volume, size(exchange), exchange, before, i0 + k, &
                        kernel%inverse_support, sums%divergence(k + 1:k + nl), sums%force_x(k + 1:k + nl), &
                        sums%force_y(k + 1:k + nl))
      end do
   end subroutine sum_solids

   pure subroutine lane_loop(n_near, near, n, x, y, u, v, s, volume, n_ghosts, exchange, before, i0, inverse_support, divergence, &
                             force_x, force_y)
      integer, intent(in) :: n_near, near(n_near), n, n_ghosts, before, i0
      real(dp), intent(in) :: x(n), y(n), u(n), v(n), s(n), volume(n), exchange(n_ghosts), inverse_support
      real(dp), dimension(nl), intent(out) :: divergence, force_x, force_y
      real(dp), dimension(nl) :: xi, yi, ui, vi, si, div, fx, fy
      real(dp) :: dx, dy, g, gx, gy, w
      integer :: k, j, l

      xi = x(i0 + 1:i0 + nl)
      yi = y(i0 + 1:i0 + nl)
      ui = u(i0 + 1:i0 + nl)
      vi = v(i0 + 1:i0 + nl)
      si = s(i0 + 1:i0 + nl)
      div = 0
      fx = 0
      fy = 0
      do k = 1, n_near
         j = near(k)
         !$omp simd private(dx, dy, g, gx, gy, w)
         do l = 1, nl
            dx = x(j) - xi(l)
            dy = y(j) - yi(l)
            call pair_with_value(dx, dy, inverse_support, g, w)
            gx = g*volume(j)*dx
            gy = g*volume(j)*dy
            div(l) = div(l) + (u(j) - ui(l))*gx + (v(j) - vi(l))*gy - w*exchange(j - before)
            fx(l) = fx(l) + (s(j) + si(l))*gx
            fy(l) = fy(l) + (s(j) + si(l))*gy
         end do
      end do
      divergence = div
      force_x = fx
      force_y = fy
   end subroutine lane_loop

   !> The viscous sum over ghosts that the fluid sticks to: pi_ib with u_b - u_i = 2 (U - u_i), and alpha_i for both.
   pure subroutine sum_solid_friction(kernel, block, state, before, stick, i0, x, y)
      type(kernel_t), intent(in) :: kernel
      type(candidates_t), intent(in) :: block   !! ghosts and their images near each cluster
      type(state_t), intent(in) :: state
      integer, intent(in) :: before             !! slots before the ghosts
      real(dp), intent(in) :: stick(:)          !! (ghosts and images) 1 or 0
      integer, intent(in) :: i0
      real(dp), intent(out) :: x(block_slots)   !! [m3/s] sum_b pi_ib x_bi t**3 V_b
      real(dp), intent(out) :: y(block_slots)   !! [m3/s]
      real(dp) :: dx, dy, g, f, unused
      integer :: c, k, j, l

      x = 0
      y = 0
      do c = 1, block%n_clusters
         do k = block%first(c), block%first(c + 1) - 1
            j = block%slot(k)
            !$omp simd private(dx, dy, g, f, unused)
            do l = (c - 1)*nl + 1, c*nl
               dx = state%x(j) - state%x(i0 + l)
               dy = state%y(j) - state%y(i0 + l)
               call pair_with_value(dx, dy, kernel%inverse_support, g, unused)
               f = 2*((state%u(j) - state%u(i0 + l))*dx + (state%v(j) - state%v(i0 + l))*dy)/squared_distance(dx, dy)
               f = f*g*state%volume(j)*stick(j - before)
               x(l) = x(l) + f*dx
               y(l) = y(l) + f*dy
            end do
         end do
      end do
   end subroutine sum_solid_friction

   !> The same from the side of the ghosts.
   pure subroutine sum_ghost_friction(kernel, block, p, images, box, alpha, i0, sums)
      type(kernel_t), intent(in) :: kernel
      type(candidates_t), intent(in) :: block    !! fluid near each cluster of ghosts
      type(particles_t), intent(in) :: p         !! base state, and alpha_i with the dynamic model
      type(images_t), intent(in) :: images       !! of the fluid
      type(box_t), intent(in) :: box
      real(dp), intent(in) :: alpha              !! [1] that acts everywhere
      integer, intent(in) :: i0
      real(dp), intent(out) :: sums(4, block_slots)   !! [m3/s] sum_f alpha_f pi_fb r t**3 V_f, of images mirrored; as it is
      real(dp) :: dx, dy, g, f, unused, alpha_j, sign(2)
      type(law_t) :: law(2)
      integer :: c, k, j, l

      sums = 0
      law = [as_position(box, 1), as_position(box, 2)]
      do c = 1, block%n_clusters
         do k = block%first(c), block%first(c + 1) - 1
            j = block%slot(k)
            sign = 1
            alpha_j = 0
            if (p%features%eddy) alpha_j = p%alpha(j)
            if (k >= block%first_image(c)) sign = [law(1)%factor(images%kind(j - images%n_held)), &
                                                   law(2)%factor(images%kind(j - images%n_held))]
            do l = (c - 1)*nl + 1, c*nl
               dx = p%base%x(i0 + l) - p%base%x(j)
               dy = p%base%y(i0 + l) - p%base%y(j)
               call pair_with_value(dx, dy, kernel%inverse_support, g, unused)
               if (.not. g > 0) cycle
               f = 2*((p%base%u(i0 + l) - p%base%u(j))*dx + (p%base%v(i0 + l) - p%base%v(j))*dy)/squared_distance(dx, dy)
               f = (alpha + alpha_j)*f*g*p%base%volume(j)
               sums(:, l) = sums(:, l) + f*[sign(1)*dx, sign(2)*dy, dx, dy]
            end do
         end do
      end do
   end subroutine sum_ghost_friction

end module solid_sums
