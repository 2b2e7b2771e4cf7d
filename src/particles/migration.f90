!> Before each sort: every process gets the particles of its own strips and copies of those beside them.
module migration
   use box, only: box_t, left_wall, right_wall
   use communication, only: exchange, exchange_counts, largest_of_all, n_processes, sums_of_all, this_process
   use division, only: cut, division_t, needed_by
   use kinds, only: dp, i8, sp
   use particles, only: particles_t, reserve_slots
   use strips, only: strips_t
   implicit none
   private

   public :: migrate

   integer, parameter :: n_kept = 11       ! numbers that a particle consists of
   integer, parameter :: sorts_a_cut = 64  ! until cuts are looked at again

contains

   !> Brings particles to where they are needed. `next` gets those of other processes behind its own slots, and `n_points` in all;
   !! `number` is 0 for those that are not needed here.
   subroutine migrate(self, sorts, strips, p, box, reach, travel, n_points, number, scattered)
      type(division_t), intent(inout) :: self
      integer, intent(in) :: sorts               !! sorts before this one
      type(strips_t), intent(inout) :: strips    !! of the sort to come: `own_places` is set
      type(particles_t), intent(inout) :: p      !! stage(1) has the positions that they are sorted by
      type(box_t), intent(in) :: box
      real(dp), intent(in) :: reach, travel      !! length of a pair, and time that it may come closer for
      integer, intent(out) :: n_points
      integer, allocatable, intent(out) :: number(:)
      logical, intent(out) :: scattered
      integer(i8), allocatable :: place(:), counts(:)
      integer, allocatable :: destination(:), destination_end(:)   ! processes that need a place
      integer, allocatable :: out_end(:), in_end(:), here(:)
      real(dp), allocatable :: outgoing(:), incoming(:)
      real(dp) :: extremes(4)   ! -least and largest of x and u
      integer(i8) :: first_place, last_place
      integer :: i, k, n, process

      n = n_processes()
      allocate (out_end(-1:n - 1), in_end(-1:n - 1), here(0:n - 1))
      n_points = p%n_own
      number = p%id(:p%n_own)
      extremes = -huge(1.0_dp)
      do i = 1, p%n_own
         if (p%id(i) == 0) cycle
         extremes = max(extremes, [-p%stage(1)%x(i), p%stage(1)%x(i), -p%next%u(i), p%next%u(i)])
      end do
      call largest_of_all(4, extremes)
      ! As in module strips.
      scattered = .not. (extremes(2) + extremes(1) < strips%width*4.0e6_dp .and. abs(extremes(1) + strips%origin) &
                         < strips%width*2.0_dp**52)
      if (scattered) return
      first_place = place_of(-extremes(1))
      last_place = place_of(extremes(2))
      place = [(place_of(p%stage(1)%x(i)), i=1, p%n_own)]
      if (mod(sorts, sorts_a_cut) == 0) then
         allocate (counts(last_place - first_place + 1), source=0_i8)
         do i = 1, p%n_own
            if (p%id(i) > 0) counts(place(i) - first_place + 1) = counts(place(i) - first_place + 1) + 1
         end do
         call sums_of_all(size(counts), counts)
         call cut(self, first_place, counts)
      end if
      self%margin = ceiling((reach + travel*max(0.0_dp, extremes(4) + extremes(3)))/strips%width, i8) + 1
      self%periodic = box%is_periodic(1)
      if (self%periodic) self%ends = [place_of(box%at(left_wall)), place_of(box%at(right_wall))]
      strips%own_places = self%own_places()

      call list_destinations(self, first_place, last_place, destination, destination_end)
      here = 0
      do i = 1, p%n_own
         if (p%id(i) == 0) cycle
         do k = destination_end(place(i) - first_place + 1) + 1, destination_end(place(i) - first_place + 2)
            here(destination(k)) = here(destination(k)) + 1
         end do
         if (.not. needed_by(self, this_process(), place(i))) number(i) = 0
      end do
      out_end(-1) = 0
      do process = 0, ubound(here, 1)
         out_end(process) = out_end(process - 1) + n_kept*here(process)
      end do
      allocate (outgoing(out_end(ubound(here, 1))))
      here = out_end(:ubound(here, 1) - 1)
      do i = 1, p%n_own
         if (p%id(i) == 0) cycle
         do k = destination_end(place(i) - first_place + 1) + 1, destination_end(place(i) - first_place + 2)
            process = destination(k)
            outgoing(here(process) + 1:here(process) + n_kept) = numbers_of(p, i)
            here(process) = here(process) + n_kept
         end do
      end do
      call exchange_counts(out_end(0:) - out_end(:ubound(out_end, 1) - 1), here)
      in_end(-1) = 0
      do process = 0, ubound(here, 1)
         in_end(process) = in_end(process - 1) + here(process)
      end do
      allocate (incoming(in_end(ubound(here, 1))))
      call exchange(outgoing, out_end, incoming, in_end)
      n = size(incoming)/n_kept
      n_points = p%n_own + n
      call reserve_slots(p, n_points)
      number = [number, (nint(incoming(n_kept*(k - 1) + 1)), k=1, n)]
      do k = 1, n
         call take_numbers(p, p%n_own + k, incoming(n_kept*(k - 1) + 1:n_kept*k))
      end do

   contains

      pure integer(i8) function place_of(x)
         real(dp), intent(in) :: x

         place_of = 0
         if (x < 1.0e29_dp) place_of = floor((x - strips%origin)/strips%width, i8)
      end function place_of

   end subroutine migrate

   ! Of each place those that need it, but this process.
   subroutine list_destinations(self, first_place, last_place, destination, destination_end)
      type(division_t), intent(in) :: self
      integer(i8), intent(in) :: first_place, last_place
      integer, allocatable, intent(out) :: destination(:), destination_end(:)
      integer(i8) :: place
      integer :: process

      destination = [integer ::]
      destination_end = [0]
      do place = first_place, last_place
         do process = 0, n_processes() - 1
            if (process == this_process()) cycle
            if (needed_by(self, process, place)) destination = [destination, process]
         end do
         destination_end = [destination_end, size(destination)]
      end do
   end subroutine list_destinations

   ! All that a particle is.
   pure function numbers_of(p, i) result(numbers)
      type(particles_t), intent(in) :: p
      integer, intent(in) :: i   !! slot
      real(dp) :: numbers(n_kept)

      numbers = [real(p%id(i), dp), p%next%x(i), p%next%y(i), p%next%u(i), p%next%v(i), p%next%s(i), p%next%volume(i), p%m(i), &
                 real(p%sorted_u(i), dp), real(p%sorted_v(i), dp), 0.0_dp]
      if (p%features%dissipation) numbers(n_kept) = p%dissipated(i)
   end function numbers_of

   subroutine take_numbers(p, i, numbers)
      type(particles_t), intent(inout) :: p
      integer, intent(in) :: i   !! slot
      real(dp), intent(in) :: numbers(n_kept)

      p%id(i) = nint(numbers(1))
      p%next%x(i) = numbers(2)
      p%next%y(i) = numbers(3)
      p%next%u(i) = numbers(4)
      p%next%v(i) = numbers(5)
      p%next%s(i) = numbers(6)
      p%next%volume(i) = numbers(7)
      p%m(i) = numbers(8)
      p%sorted_u(i) = real(numbers(9), sp)
      p%sorted_v(i) = real(numbers(10), sp)
      if (p%features%dissipation) p%dissipated(i) = numbers(n_kept)
   end subroutine take_numbers

end module migration
