!> Pair sums between the fluid and the ghosts of solids, for a block of clusters.
!!
!! Source: ours (docs/equations.md, Solid bodies). A ghost's pressure is a mean over the fluid with weights c; the same weights,
!! transposed, give the fluid the ghost's share of the divergence.
module solid_sums
   use box, only: box_t
   use candidates, only: acts, block_slots, gives, shared_candidates_t
   use image_laws, only: as_position, image_of, law_t
   use images, only: images_t
   use kernel, only: kernel_t, pair_with_value
   use kinds, only: dp
   use lanes, only: nl
   use particles, only: state_t
   use solid_ghosts, only: solid_ghosts_t
   implicit none
   private

   public :: ghost_sums_t, sum_ghosts, sum_solids

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
   pure subroutine sum_ghosts(kernel, ghosts, b, state, images, box, sums)
      type(kernel_t), intent(in) :: kernel
      type(solid_ghosts_t), intent(in) :: ghosts
      integer, intent(in) :: b                !! number of their block
      type(state_t), intent(in) :: state      !! of all slots
      type(images_t), intent(in) :: images    !! of the fluid
      type(box_t), intent(in) :: box          !! at the state's time
      type(ghost_sums_t), intent(inout) :: sums
      integer :: c, k, n, parts(2)

      associate (block => ghosts%fluid(b))
         do c = 1, block%n_clusters
            k = (c - 1)*nl
            n = block%first(c + 1) - block%first(c)
            parts = block%parts(c)
            call ghost_loop(n, block%slot(block%first(c):block%first(c + 1) - 1), parts(2) - parts(1) + 1, &
                            block%part(:, parts(1):parts(2)), &
                            size(state%x), state%x, state%y, state%u, state%v, state%s, state%volume, block%before + k, k, &
                            kernel%inverse_support, sums)
            call sum_images(kernel, ghosts, block, c, state, images, box, sums)
         end do
      end associate
   end subroutine sum_ghosts

   ! Over the fluid and its images, whose density is the hydrostatically continued one.
   pure subroutine ghost_loop(n_near, near, n_parts, part, n, x, y, u, v, s, volume, i0, k0, &
                              inverse_support, sums)
      integer, intent(in) :: n_near, near(n_near), n_parts, n, i0, k0
      real(dp), intent(in) :: part(nl, n_parts)
      real(dp), intent(in) :: x(n), y(n), u(n), v(n), s(n), volume(n), inverse_support
      type(ghost_sums_t), intent(inout) :: sums
      real(dp), dimension(nl) :: xi, yi, ui, vi, total, density, way_x, way_y, inflow, push_x, push_y, area_x, area_y
      real(dp) :: dx, dy, g, gx, gy, w
      integer :: k, j, l, m

      xi = x(i0 + 1:i0 + nl)
      yi = y(i0 + 1:i0 + nl)
      ui = u(i0 + 1:i0 + nl)
      vi = v(i0 + 1:i0 + nl)
      total = 0; density = 0; way_x = 0; way_y = 0; inflow = 0
      push_x = 0; push_y = 0; area_x = 0; area_y = 0
      do k = 1, n_near
         j = near(k)
         m = min(k, n_parts)
         !$omp simd private(dx, dy, g, gx, gy, w)
         do l = 1, nl
            dx = xi(l) - x(j)
            dy = yi(l) - y(j)
            call pair_with_value(dx, dy, inverse_support, g, w)
            g = max(0.0_dp, part(l, m) - gives)*g
            w = min(gives, part(l, m))*w*volume(j)
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

   ! `push` and `area` of images apart: `ghost_loop` has added them to the fluid's.
   pure subroutine sum_images(kernel, ghosts, block, c, state, images, box, sums)
      type(kernel_t), intent(in) :: kernel
      type(solid_ghosts_t), intent(in) :: ghosts
      type(shared_candidates_t), intent(in) :: block
      integer, intent(in) :: c                ! cluster
      type(state_t), intent(in) :: state
      type(images_t), intent(in) :: images
      type(box_t), intent(in) :: box
      type(ghost_sums_t), intent(inout) :: sums
      real(dp) :: way(2), g, w
      integer :: i, j, k, l, parts(2)

      parts = block%parts(c)
      sums%images(:, (c - 1)*nl + 1:c*nl) = 0
      do k = block%first_image(c), block%first(c + 1) - 1
         j = block%slot(k)
         do l = (c - 1)*nl + 1, c*nl
            i = block%before + l
            way = [state%x(i) - state%x(j), state%y(i) - state%y(j)]
            call pair_with_value(way(1), way(2), kernel%inverse_support, g, w)
            if (.not. g > 0) cycle
            if (block%part(l - (c - 1)*nl, min(k, parts(2))) < acts) cycle
            g = g*state%volume(j)
            sums%push_x(l) = sums%push_x(l) - g*state%s(j)*way(1)
            sums%push_y(l) = sums%push_y(l) - g*state%s(j)*way(2)
            sums%area_x(l) = sums%area_x(l) - g*way(1)
            sums%area_y(l) = sums%area_y(l) - g*way(2)
            call add_image(ghosts, state, images, box, i, j, g*way, sums, l)
         end do
      end do
   end subroutine sum_images

   ! An image of kind M acts on a ghost as its source, with its own density, does on the ghost's image of that kind, whose density
   ! is other by the hydrostatic difference. The force that the source feels is mirrored. Where the solid goes on beyond the wall,
   ! the ghost's image has its velocity U as it is, so that the image sees the ghost move with M U.
   pure subroutine add_image(ghosts, state, images, box, i, j, weight, sums, l)
      type(solid_ghosts_t), intent(in) :: ghosts
      type(state_t), intent(in) :: state
      type(images_t), intent(in) :: images
      type(box_t), intent(in) :: box
      integer, intent(in) :: i, j            ! slots of the ghost and of the image
      real(dp), intent(in) :: weight(2)      ! t**3 V_f r
      type(ghost_sums_t), intent(inout) :: sums
      integer, intent(in) :: l               ! place in the block
      type(law_t) :: law(2)
      real(dp) :: place(2), sign(2), pass(2), s
      integer :: kind

      law = [as_position(box, 1), as_position(box, 2)]
      kind = images%kind(j - images%n_held)
      place = [state%x(i), state%y(i)]
      s = state%s(images%source(j - images%n_held)) &
          + box%density_slope(1)*(image_of(law(1), kind, place(1)) - place(1)) &
          + box%density_slope(2)*(image_of(law(2), kind, place(2)) - place(2))
      sign = [law(1)%factor(kind), law(2)%factor(kind)]
      pass = ghosts%passes(i - ghosts%before, kind)
      sums%images(1:4, l) = sums%images(1:4, l) + [s*pass*weight, pass*weight]
      sums%images(5:8, l) = sums%images(5:8, l) + [s*sign*weight, sign*weight]
      sums%inflow(l) = sums%inflow(l) + (1 - pass(1))*state%u(i)*weight(1) + (1 - pass(2))*state%v(i)*weight(2)
   end subroutine add_image

   !> What solids add to the flow sums of a cluster of the fluid.
   pure subroutine sum_solids(kernel, ghosts, b, c, state, divergence, force_x, force_y)
      type(kernel_t), intent(in) :: kernel
      type(solid_ghosts_t), intent(in) :: ghosts
      integer, intent(in) :: b, c               !! numbers of its block, and of it there
      type(state_t), intent(in) :: state        !! of all slots
      real(dp), dimension(nl), intent(out) :: divergence, force_x, force_y
      integer :: parts(2)

      associate (block => ghosts%near(b))
         parts = block%parts(c)
         call lane_loop(block%first(c + 1) - block%first(c), block%slot(block%first(c):block%first(c + 1) - 1), &
                        parts(2) - parts(1) + 1, block%part(:, parts(1):parts(2)), &
                        size(state%x), state%x, state%y, state%u, state%v, state%s, state%volume, size(ghosts%exchange), &
                        ghosts%exchange, ghosts%before, block%before + (c - 1)*nl, kernel%inverse_support, &
                        divergence, force_x, force_y)
      end associate
   end subroutine sum_solids

   pure subroutine lane_loop(n_near, near, n_parts, part, n, x, y, u, v, s, volume, n_ghosts, exchange, before, i0, &
                             inverse_support, divergence, force_x, force_y)
      integer, intent(in) :: n_near, near(n_near), n_parts, n, n_ghosts, before, i0
      real(dp), intent(in) :: part(nl, n_parts)
      real(dp), intent(in) :: x(n), y(n), u(n), v(n), s(n), volume(n), exchange(n_ghosts), inverse_support
      real(dp), dimension(nl), intent(out) :: divergence, force_x, force_y
      real(dp), dimension(nl) :: xi, yi, ui, vi, si, div, fx, fy
      real(dp) :: dx, dy, g, gx, gy, w
      integer :: k, j, l, m

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
         m = min(k, n_parts)
         !$omp simd private(dx, dy, g, gx, gy, w)
         do l = 1, nl
            dx = x(j) - xi(l)
            dy = y(j) - yi(l)
            call pair_with_value(dx, dy, inverse_support, g, w)
            g = max(0.0_dp, part(l, m) - gives)*g
            w = min(gives, part(l, m))*w
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

end module solid_sums
