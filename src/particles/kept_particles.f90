!> What of the particles a run needs to go on: `next`, in the order of their numbers, which no other thing than they decides.
module kept_particles
   use archive, only: archive_t
   use kinds, only: dp, sp
   use particles, only: particles_t
   implicit none
   private

   public :: archive_particles

contains

   !> Writes the particles, or takes them into the first slots, with the same number of particles and features.
   subroutine archive_particles(p, file)
      type(particles_t), intent(inout) :: p
      class(archive_t), intent(inout) :: file
      integer, allocatable :: slot(:)   ! of each number
      integer :: i

      allocate (slot(p%n))
      if (file%reading) then
         slot = [(i, i=1, p%n)]
         p%id(:p%n) = slot
         p%n_own = p%n
         p%n_held = p%n
         p%n_slots = p%n
      else
         do i = 1, p%n_own
            if (p%id(i) > 0) slot(p%id(i)) = i
         end do
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
         real(dp), allocatable :: ordered(:)

         allocate (ordered(p%n))
         ordered(:) = values(slot)
         call file%keep(name, ordered)
         if (file%reading) values(:p%n) = ordered
      end subroutine keep_reals

      subroutine keep_singles(name, values)
         character(*), intent(in) :: name
         real(sp), intent(inout) :: values(:)   !! (slots)
         real(sp), allocatable :: ordered(:)

         allocate (ordered(p%n))
         ordered(:) = values(slot)
         call file%keep(name, ordered)
         if (file%reading) values(:p%n) = ordered
      end subroutine keep_singles

   end subroutine archive_particles

end module kept_particles
