!> Viscous pair sums between the fluid and the ghosts of solids, for a block of clusters, and what they add to the rate of strain.
!!
!! Source: ours (docs/equations.md, Viscosity at solids). As beyond walls, a ghost has the velocity that the face reflects: for
!! particle f 2 U - u_f where the fluid sticks to it, else u_f - 2 [(u_f - U).n] n. Of the pair's r and difference of velocity only
!! what the face reverses, P r and P u, acts: P = 1, or n (x) n. So each pair takes energy.
module solid_friction
   use box, only: box_t
   use candidates, only: acts, block_slots, gives
   use ghost_faces, only: ghost_faces_t
   use image_laws, only: as_position, law_t
   use images, only: images_t
   use kernel, only: kernel_t, pair
   use kinds, only: dp
   use lanes, only: nl
   use particles, only: particles_t, state_t
   use solid_ghosts, only: solid_ghosts_t
   implicit none
   private

   public :: reflected_sums_t, sum_solid_friction, sum_ghost_friction

   !> Sums of a block over ghosts, r = r_b - r_f, u = 2 (U_b - u_f), without the kernel's constant factor F = factor t**3.
   type :: reflected_sums_t
      real(dp) :: viscous_x(block_slots)    !! [m3/s] sum_b pi_fb P r t**3 V_b, pi_fb = P u.P r/r**2
      real(dp) :: viscous_y(block_slots)   !! [m3/s]
      real(dp) :: matrix_xx(block_slots)    !! [m4] sum_b r (x) r t**3 V_b: L**-1
      real(dp) :: matrix_xy(block_slots)   !! [m4]
      real(dp) :: matrix_yy(block_slots)   !! [m4]
      real(dp) :: u_x(block_slots)          !! [m4/s] sum_b P u (x) r t**3 V_b: the velocity gradient before L
      real(dp) :: u_y(block_slots)   !! [m4/s]
      real(dp) :: v_x(block_slots)   !! [m4/s]
      real(dp) :: v_y(block_slots)   !! [m4/s]
   end type reflected_sums_t

contains

   !> What the ghosts near a block of the fluid give.
   pure subroutine sum_solid_friction(kernel, ghosts, b, state, sums)
      type(kernel_t), intent(in) :: kernel
      type(solid_ghosts_t), intent(in) :: ghosts
      integer, intent(in) :: b                  !! number of the block
      type(state_t), intent(in) :: state        !! of all slots
      type(reflected_sums_t), intent(inout) :: sums
      integer :: c, parts(2)

      associate (block => ghosts%near(b))
         do c = 1, block%n_clusters
            parts = block%parts(c)
            call fluid_loop(block%first(c + 1) - block%first(c), block%slot(block%first(c):block%first(c + 1) - 1), &
                            parts(2) - parts(1) + 1, block%part(:, parts(1):parts(2)), size(state%x), state%x, state%y, state%u, &
                            state%v, state%volume, ghosts%faces, ghosts%before, block%before + (c - 1)*nl, (c - 1)*nl, &
                            kernel%inverse_support, sums)
         end do
      end associate
   end subroutine sum_solid_friction

   pure subroutine fluid_loop(n_near, near, n_parts, part, n, x, y, u, v, volume, faces, before, i0, k0, inverse_support, sums)
      integer, intent(in) :: n_near, near(n_near), n_parts, n, before, i0, k0
      real(dp), intent(in) :: part(nl, n_parts), x(n), y(n), u(n), v(n), volume(n), inverse_support
      type(ghost_faces_t), intent(in) :: faces
      type(reflected_sums_t), intent(inout) :: sums
      real(dp), dimension(nl) :: xi, yi, ui, vi, ax, ay, mxx, mxy, myy, ux, uy, vx, vy
      real(dp) :: dx, dy, g, inverse_2, px, py, pu, pv, pi_ij, normal_x, normal_y, stick, slip, depth
      integer :: j, k, l, m

      xi = x(i0 + 1:i0 + nl)
      yi = y(i0 + 1:i0 + nl)
      ui = u(i0 + 1:i0 + nl)
      vi = v(i0 + 1:i0 + nl)
      ax = 0; ay = 0; mxx = 0; mxy = 0; myy = 0; ux = 0; uy = 0; vx = 0; vy = 0
      do k = 1, n_near
         j = near(k)
         m = min(k, n_parts)
         normal_x = faces%normal_x(j - before)
         normal_y = faces%normal_y(j - before)
         depth = faces%depth(j - before)
         stick = faces%stick(j - before)
         slip = 1 - stick
         !$omp simd private(dx, dy, g, inverse_2, px, py, pu, pv, pi_ij)
         do l = 1, nl
            dx = x(j) - xi(l)
            dy = y(j) - yi(l)
            call pair(dx, dy, inverse_support, volume(j), g, inverse_2)
            call reflect(stick, slip, normal_x, normal_y, dx, dy, px, py)
            call reflect(stick, slip, normal_x, normal_y, 2*(u(j) - ui(l)), 2*(v(j) - vi(l)), pu, pv)
            g = g*max(0.0_dp, part(l, m) - gives)*max(0.0_dp, sign(1.0_dp, -depth - (normal_x*dx + normal_y*dy)))
            pi_ij = g*(pu*px + pv*py)*inverse_2
            ax(l) = ax(l) + pi_ij*px
            ay(l) = ay(l) + pi_ij*py
            mxx(l) = mxx(l) + g*dx*dx
            mxy(l) = mxy(l) + g*dx*dy
            myy(l) = myy(l) + g*dy*dy
            ux(l) = ux(l) + pu*(g*dx)
            uy(l) = uy(l) + pu*(g*dy)
            vx(l) = vx(l) + pv*(g*dx)
            vy(l) = vy(l) + pv*(g*dy)
         end do
      end do
      sums%viscous_x(k0 + 1:k0 + nl) = ax
      sums%viscous_y(k0 + 1:k0 + nl) = ay
      sums%matrix_xx(k0 + 1:k0 + nl) = mxx
      sums%matrix_xy(k0 + 1:k0 + nl) = mxy
      sums%matrix_yy(k0 + 1:k0 + nl) = myy
      sums%u_x(k0 + 1:k0 + nl) = ux
      sums%u_y(k0 + 1:k0 + nl) = uy
      sums%v_x(k0 + 1:k0 + nl) = vx
      sums%v_y(k0 + 1:k0 + nl) = vy
   end subroutine fluid_loop

   ! P of a vector.
   elemental subroutine reflect(stick, slip, normal_x, normal_y, x, y, px, py)
      real(dp), intent(in) :: stick, slip          ! 1 and 0, or 0 and 1
      real(dp), intent(in) :: normal_x, normal_y
      real(dp), intent(in) :: x, y
      real(dp), intent(out) :: px, py
      real(dp) :: across

      across = slip*(normal_x*x + normal_y*y)
      px = stick*x + across*normal_x
      py = stick*y + across*normal_y
   end subroutine reflect

   !> The viscous sum from the side of the ghosts.
   pure subroutine sum_ghost_friction(kernel, ghosts, b, p, images, box, alpha, sums)
      type(kernel_t), intent(in) :: kernel
      type(solid_ghosts_t), intent(in) :: ghosts
      integer, intent(in) :: b                   !! number of their block
      type(particles_t), intent(in) :: p         !! base state, and alpha_i with the dynamic model
      type(images_t), intent(in) :: images       !! of the fluid
      type(box_t), intent(in) :: box
      real(dp), intent(in) :: alpha              !! [1] that acts everywhere
      real(dp), intent(out) :: sums(4, block_slots)   !! [m3/s] sum_f alpha_f pi_fb P r t**3 V_f, of images mirrored; as it is
      real(dp) :: dx, dy, g, inverse_2, alpha_j, sign(2), pass(2), way(2), change(2), f, slip
      type(law_t) :: law(2)
      integer :: c, i, j, k, kind, l, m, parts(2)

      sums = 0
      law = [as_position(box, 1), as_position(box, 2)]
      associate (block => ghosts%fluid(b), state => p%base, faces => ghosts%faces)
         do c = 1, block%n_clusters
            parts = block%parts(c)
            do k = block%first(c), block%first(c + 1) - 1
               j = block%slot(k)
               sign = 1
               kind = 0
               alpha_j = alpha
               if (p%features%eddy) alpha_j = alpha + p%alpha(j)
               if (k >= block%first_image(c)) then
                  kind = images%kind(j - images%n_held)
                  sign = [law(1)%factor(kind), law(2)%factor(kind)]
               end if
               do l = (c - 1)*nl + 1, c*nl
                  i = block%before + l
                  m = i - ghosts%before
                  dx = state%x(i) - state%x(j)
                  dy = state%y(i) - state%y(j)
                  if (.not. -faces%depth(m) - (faces%normal_x(m)*dx + faces%normal_y(m)*dy) >= 0) cycle
                  call pair(dx, dy, kernel%inverse_support, state%volume(j), g, inverse_2)
                  if (.not. g > 0) cycle
                  if (block%part(l - (c - 1)*nl, min(k, parts(2))) < acts) cycle
                  pass = 1
                  if (kind > 0) pass = ghosts%passes(m, kind)
                  slip = 1 - faces%stick(m)
                  call reflect(faces%stick(m), slip, faces%normal_x(m), faces%normal_y(m), dx, dy, way(1), way(2))
                  call reflect(faces%stick(m), slip, faces%normal_x(m), faces%normal_y(m), &
                               2*(pass(1)*state%u(i) - state%u(j)), 2*(pass(2)*state%v(i) - state%v(j)), change(1), change(2))
                  f = alpha_j*g*(change(1)*way(1) + change(2)*way(2))*inverse_2
                  sums(:, l) = sums(:, l) + f*[sign*way, pass*way]
               end do
            end do
         end do
      end associate
   end subroutine sum_ghost_friction

end module solid_friction
