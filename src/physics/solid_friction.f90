!> Friction at solids that the fluid sticks to: viscous pair sums between the fluid and the ghosts, for a block of clusters.
!!
!! Source: ours (docs/equations.md, Solid bodies): as at no-slip walls, a ghost has the velocity 2 U - u_f for particle f.
module solid_friction
   use box, only: box_t
   use candidates, only: acts, block_slots
   use image_laws, only: as_position, law_t
   use images, only: images_t
   use kernel, only: kernel_t, pair_with_value, squared_distance
   use kinds, only: dp
   use lanes, only: nl
   use particles, only: particles_t, state_t
   use solid_ghosts, only: solid_ghosts_t
   implicit none
   private

   public :: sum_solid_friction, sum_ghost_friction

contains

   !> The viscous sum over ghosts that the fluid sticks to: pi_ib with u_b - u_i = 2 (U - u_i), and alpha_i for both.
   pure subroutine sum_solid_friction(kernel, ghosts, b, state, x, y)
      type(kernel_t), intent(in) :: kernel
      type(solid_ghosts_t), intent(in) :: ghosts
      integer, intent(in) :: b                  !! number of the block
      type(state_t), intent(in) :: state
      real(dp), intent(out) :: x(block_slots)   !! [m3/s] sum_b pi_ib x_bi t**3 V_b
      real(dp), intent(out) :: y(block_slots)   !! [m3/s]
      real(dp) :: way(2), g, f, unused
      integer :: c, i, j, k, l, parts(2)

      x = 0
      y = 0
      associate (block => ghosts%near(b))
         do c = 1, block%n_clusters
            parts = block%parts(c)
            do k = block%first(c), block%first(c + 1) - 1
               j = block%slot(k)
               if (.not. ghosts%stick(j - ghosts%before) > 0) cycle
               do l = (c - 1)*nl + 1, c*nl
                  i = block%before + l
                  way = [state%x(j) - state%x(i), state%y(j) - state%y(i)]
                  call pair_with_value(way(1), way(2), kernel%inverse_support, g, unused)
                  if (.not. g > 0) cycle
                  if (block%part(l - (c - 1)*nl, min(k, parts(2))) < acts) cycle
                  f = 2*((state%u(j) - state%u(i))*way(1) + (state%v(j) - state%v(i))*way(2))/squared_distance(way(1), way(2))
                  f = f*g*state%volume(j)
                  x(l) = x(l) + f*way(1)
                  y(l) = y(l) + f*way(2)
               end do
            end do
         end do
      end associate
   end subroutine sum_solid_friction

   !> The same from the side of the ghosts.
   pure subroutine sum_ghost_friction(kernel, ghosts, b, p, images, box, alpha, sums)
      type(kernel_t), intent(in) :: kernel
      type(solid_ghosts_t), intent(in) :: ghosts
      integer, intent(in) :: b                   !! number of their block
      type(particles_t), intent(in) :: p         !! base state, and alpha_i with the dynamic model
      type(images_t), intent(in) :: images       !! of the fluid
      type(box_t), intent(in) :: box
      real(dp), intent(in) :: alpha              !! [1] that acts everywhere
      real(dp), intent(out) :: sums(4, block_slots)   !! [m3/s] sum_f alpha_f pi_fb r t**3 V_f, of images mirrored; as it is
      real(dp) :: way(2), g, f, unused, alpha_j, sign(2), pass(2)
      type(law_t) :: law(2)
      integer :: c, i, j, k, kind, l, parts(2)

      sums = 0
      law = [as_position(box, 1), as_position(box, 2)]
      associate (block => ghosts%fluid(b), state => p%base)
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
                  if (.not. ghosts%stick(i - ghosts%before) > 0) cycle
                  way = [state%x(i) - state%x(j), state%y(i) - state%y(j)]
                  call pair_with_value(way(1), way(2), kernel%inverse_support, g, unused)
                  if (.not. g > 0) cycle
                  if (block%part(l - (c - 1)*nl, min(k, parts(2))) < acts) cycle
                  pass = 1
                  if (kind > 0) pass = ghosts%passes(i - ghosts%before, kind)
                  f = 2*((pass(1)*state%u(i) - state%u(j))*way(1) + (pass(2)*state%v(i) - state%v(j))*way(2)) &
                      /squared_distance(way(1), way(2))
                  f = alpha_j*f*g*state%volume(j)
                  sums(:, l) = sums(:, l) + f*[sign*way, pass*way]
               end do
            end do
         end do
      end associate
   end subroutine sum_ghost_friction

end module solid_friction
