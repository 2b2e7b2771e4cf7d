!> What of the particles a run needs to go on: `next`, in the order of their numbers, which no other thing than they decides.
module kept_particles
   use archive, only: archive_t
   use kinds, only: dp, sp
   use number_order, only: find_order, number_order_t
   use particles, only: particles_t, reserve_slots
   implicit none
   private

   public :: archive_particles

contains

   !> Writes the particles, or takes them into the first slots, with the same number of particles and features.
   subroutine archive_particles(p, file)
      type(particles_t), intent(inout) :: p
      class(archive_t), intent(inout) :: file
      type(number_order_t) :: order
      integer :: i, n

      call find_order(p, order)
      n = order%last - order%first + 1
      if (file%reading) then
         call reserve_slots(p, n)
         p%id(:n) = [(i, i=order%first, order%last)]
         p%n_own = n
         p%n_held = n
         p%n_slots = n
      end if
      call file%part('particles')
      call keep_reals('x', p%next%x)
      call keep_reals('y', p%next%y)
      call keep_reals('u', p%next%u)
      call keep_reals('v', p%next%v)
      call keep_reals('s', p%next%s)
      call keep_reals('volume', p%next%volume)
      call keep_reals('m', p%m)
      call keep_singles('sorted_u', p%sorted_u)
      call keep_singles('sorted_v', p%sorted_v)
      if (p%features%dissipation) call keep_reals('dissipated', p%dissipated)

   contains

      subroutine keep_reals(name, values)
         character(*), intent(in) :: name
         real(dp), intent(inout) :: values(:)   !! (slots)
         real(dp) :: ordered(n)

         if (.not. file%reading) ordered = order%sorted(values)
         call file%keep_parts(name, order%first, order%total, ordered)
         if (file%reading) values(:n) = ordered
      end subroutine keep_reals

      subroutine keep_singles(name, values)
         character(*), intent(in) :: name
         real(sp), intent(inout) :: values(:)   !! (slots)
         real(sp) :: ordered(n)

         if (.not. file%reading) ordered = real(order%sorted(real(values, dp)), sp)
         call file%keep_single_parts(name, order%first, order%total, ordered)
         if (file%reading) values(:n) = ordered
      end subroutine keep_singles

   end subroutine archive_particles

end module kept_particles
