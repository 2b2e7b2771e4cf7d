!> Before each sort: every process gets the particles of its own strips and copies of those beside them.
module migration
   use box, only: box_t, left_wall, right_wall
   use communication, only: any_process, exchange_counts, exchange_t, largest_of_all, n_processes, sums_of_all, this_process
   use division, only: cut, division_t, needed_by
   use kinds, only: dp, i8, sp
   use particles, only: particles_t, reserve_slots
   use strips, only: extent_t, strips_t, too_scattered
   implicit none
   private

   public :: migrate

   integer, parameter :: n_kept = 11       ! numbers that a particle consists of
   integer, parameter :: sorts_a_cut = 16  ! until cuts are looked at again

   !> The processes that need a place, but this one: those of place first + k - 1 are process(end(k) + 1:end(k + 1)).
   type :: needs_t
      integer(i8) :: first = 0
      integer, allocatable :: process(:), end(:)
   end type needs_t

contains

   !> Brings particles to where they are needed. `next` gets those of other processes behind its own slots, and has `n_points` then;
   !! `number` is 0 for those that are not needed here any more.
   subroutine migrate(self, sorts, strips, p, box, extent, reach, travel, n_points, number, scattered)
      type(division_t), intent(inout) :: self
      integer, intent(in) :: sorts               !! sorts before this one
      type(strips_t), intent(inout) :: strips    !! of the sort to come; on return with the own places
      type(particles_t), intent(inout) :: p      !! stage(1) has the positions that they are sorted by
      type(box_t), intent(in) :: box
      type(extent_t), intent(in) :: extent       !! of these positions, at least, and of the velocities of all processes
      real(dp), intent(in) :: reach              !! length at which two particles may matter for each other,
      real(dp), intent(in) :: travel             !! until or since this time
      integer, intent(out) :: n_points
      integer, allocatable, intent(out) :: number(:)   !! (n_points) of particles, for the sort
      logical, intent(out) :: scattered          !! the fluid is too long for strips
      type(needs_t) :: needs
      type(exchange_t) :: messages
      integer(i8) :: place(p%n_own), last_place, ends(2)
      real(dp) :: ends_x(2)
      integer :: i, mine

      n_points = p%n_own
      ends_x = [extent%lower(1), extent%upper(1)]
      scattered = too_scattered(strips, ends_x(1), ends_x(2), is_fluid=.true.)
      if (scattered) then
         call find_ends(p, ends_x)
         scattered = too_scattered(strips, ends_x(1), ends_x(2), is_fluid=.true.)
         if (scattered) return
      end if
      ends = strips%place_of(ends_x)
      last_place = ends(1)
      do i = 1, p%n_own
         if (p%id(i) > 0) last_place = strips%place_of(p%stage(1)%x(i))
         place(i) = last_place   ! dummies come behind particles
      end do
      ! Where a run goes on, the second sort is the first one of its state.
      if (sorts == 1 .or. mod(sorts, sorts_a_cut) == 0) call cut_anew(self, p%id(:p%n_own), place, ends)
      ! Images across a periodic side, probes and walls stand still, whatever the fluid does.
      self%margin = ceiling((reach + travel*(max(0.0_dp, extent%fastest(1)) - min(0.0_dp, extent%slowest(1))))/strips%width, i8)
      self%periodic = box%is_periodic(1)
      if (self%periodic) self%ends = strips%place_of(box%at([left_wall, right_wall]))
      strips%own_places = self%own_places()
      ends = [1, 0]
      if (p%n_own > 0) ends = [minval(place), maxval(place)]
      call find_needs(self, ends, needs)
      call pack_particles(p, place, needs, messages)
      call messages%start()
      number = p%id(:p%n_own)
      mine = this_process()
      do i = 1, p%n_own
         if (.not. needed_by(self, mine, place(i))) number(i) = 0
      end do
      call messages%finish()
      call unpack_particles(messages%incoming, p, n_points, number)
   end subroutine migrate

   ! From where to where the positions are that particles are sorted by.
   subroutine find_ends(p, ends)
      type(particles_t), intent(in) :: p
      real(dp), intent(out) :: ends(2)

      associate (x => p%stage(1)%x(:p%n_own), own => p%id(:p%n_own) > 0)
         ends = [maxval(-x, own), maxval(x, own)]
      end associate
      call largest_of_all(2, ends)
      ends(1) = -ends(1)
   end subroutine find_ends

   ! Cuts for as much time in each process, as its particles have taken since the last cuts; for as many particles in the beginning.
   subroutine cut_anew(self, id, place, ends)
      type(division_t), intent(inout) :: self
      integer, intent(in) :: id(:)
      integer(i8), intent(in) :: place(:), ends(2)   ! of each particle; of all
      integer(i8), allocatable :: loads(:)
      integer(i8) :: each, k
      integer :: i, n_here

      n_here = count(id > 0)
      each = 1
      if (.not. any_process(n_here > 0 .and. .not. self%busy > 0)) each = max(1_i8, nint(self%busy/max(1, n_here)*1.0e10_dp, i8))
      allocate (loads(ends(2) - ends(1) + 1), source=0_i8)
      do i = 1, size(id)
         if (id(i) == 0) cycle
         k = min(max(1_i8, place(i) - ends(1) + 1), size(loads, kind=i8))   ! bounds may be rounded otherwise
         loads(k) = loads(k) + each
      end do
      call sums_of_all(size(loads), loads)
      call cut(self, ends(1), loads)
      self%busy_before = self%busy_before + self%busy
      self%busy = 0
   end subroutine cut_anew

   subroutine find_needs(self, ends, needs)
      type(division_t), intent(in) :: self
      integer(i8), intent(in) :: ends(2)   ! places of the particles here
      type(needs_t), intent(out) :: needs
      integer(i8) :: place
      integer :: pass, process, n, mine, last

      mine = this_process()
      last = n_processes() - 1
      needs%first = ends(1)
      allocate (needs%end(max(0_i8, ends(2) - ends(1) + 1) + 1), source=0)
      do pass = 1, 2   ! counts, then writes
         n = 0
         do place = ends(1), ends(2)
            do process = 0, last
               if (process == mine) cycle
               if (.not. needed_by(self, process, place)) cycle
               n = n + 1
               if (pass == 2) needs%process(n) = process
            end do
            needs%end(place - ends(1) + 2) = n
         end do
         if (pass == 1) allocate (needs%process(n))
      end do
   end subroutine find_needs

   subroutine pack_particles(p, place, needs, messages)
      type(particles_t), intent(in) :: p
      integer(i8), intent(in) :: place(:)   ! (n_own)
      type(needs_t), intent(in) :: needs
      type(exchange_t), intent(inout) :: messages
      integer, allocatable :: out_end(:), in_end(:), here(:)
      integer :: i, j, k, n, pass, process

      n = n_processes()
      allocate (out_end(-1:n - 1), in_end(-1:n - 1), here(0:n - 1), source=0)
      do pass = 1, 2
         do i = 1, p%n_own
            if (p%id(i) == 0) cycle
            j = int(place(i) - needs%first) + 1
            do k = needs%end(j) + 1, needs%end(j + 1)
               process = needs%process(k)
               if (pass == 2) messages%outgoing(n_kept*here(process) + 1:n_kept*here(process) + n_kept) = numbers_of(p, i)
               here(process) = here(process) + 1
            end do
         end do
         if (pass == 2) exit
         call exchange_counts(here, in_end(0:))
         do process = 0, n - 1
            out_end(process) = out_end(process - 1) + here(process)
            in_end(process) = in_end(process - 1) + in_end(process)
         end do
         here = out_end(:n - 2)
         call messages%make_room(n_kept, out_end, in_end)
      end do
   end subroutine pack_particles

   subroutine unpack_particles(numbers, p, n_points, number)
      real(dp), intent(in) :: numbers(:)
      type(particles_t), intent(inout) :: p
      integer, intent(inout) :: n_points
      integer, allocatable, intent(inout) :: number(:)
      integer :: k, n

      n = size(numbers)/n_kept
      call reserve_slots(p, n_points + n)
      do k = 1, n
         call take_numbers(p, n_points + k, numbers(n_kept*(k - 1) + 1:n_kept*k))
      end do
      number = [number, p%id(n_points + 1:n_points + n)]
      n_points = n_points + n
   end subroutine unpack_particles

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
