!> Particles in the order of their numbers, in which files have them: each process has as many numbers in a row.
module number_order
   use communication, only: exchange, exchange_counts, n_processes, this_process
   use kinds, only: dp, i8
   use particles, only: particles_t
   implicit none
   private

   public :: number_order_t, find_order, first_number

   !> Where particles go to be in order.
   type :: number_order_t
      integer :: first = 1, last = 0            !! numbers that this process has then
      integer :: total = 0                      !! particles of all processes
      integer, allocatable, private :: slot(:)  !! (particles here) those of the first process first
      integer, allocatable, private :: place(:) !! (last-first+1) in the order of numbers, of what comes from the processes
      integer, allocatable, private :: out_end(:), in_end(:)   !! (-1:processes-1)
   contains
      procedure :: sorted
   end type number_order_t

contains

   ! Who has a number of n, where they are in order.
   integer function process_of(number, n) result(process)
      integer, intent(in) :: number, n

      process = int(((number - 1_i8)*n_processes())/n)
   end function process_of

   !> The first number that a process has.
   integer function first_number(process, n) result(number)
      integer, intent(in) :: process, n

      number = int((int(process, i8)*n + n_processes() - 1)/n_processes()) + 1
   end function first_number

   !> Of the particles as they are now.
   subroutine find_order(p, order)
      type(particles_t), intent(in) :: p
      type(number_order_t), intent(out) :: order
      integer, allocatable :: here(:)
      real(dp), allocatable :: numbers(:), incoming(:)
      integer :: i, k, n, process

      n = n_processes()
      order%total = p%n
      order%first = first_number(this_process(), p%n)
      order%last = first_number(this_process() + 1, p%n) - 1
      allocate (here(0:n - 1), source=0)
      do i = 1, p%n_own
         if (p%id(i) > 0) here(process_of(p%id(i), p%n)) = here(process_of(p%id(i), p%n)) + 1
      end do
      allocate (order%out_end(-1:n - 1), order%in_end(-1:n - 1), source=0)
      do process = 0, n - 1
         order%out_end(process) = order%out_end(process - 1) + here(process)
      end do
      call exchange_counts(here, order%in_end(0:))
      do process = 1, n - 1
         order%in_end(process) = order%in_end(process - 1) + order%in_end(process)
      end do
      allocate (order%slot(order%out_end(n - 1)), numbers(order%out_end(n - 1)), incoming(order%in_end(n - 1)))
      here = order%out_end(:n - 2)
      do i = 1, p%n_own
         if (p%id(i) == 0) cycle
         process = process_of(p%id(i), p%n)
         here(process) = here(process) + 1
         order%slot(here(process)) = i
      end do
      numbers = p%id(order%slot)
      call exchange(numbers, order%out_end, incoming, order%in_end)
      order%place = [(nint(incoming(k)) - order%first + 1, k=1, size(incoming))]
   end subroutine find_order

   !> Values of slots in the order of numbers.
   function sorted(self, values) result(ordered)
      class(number_order_t), intent(in) :: self
      real(dp), intent(in) :: values(:)   !! (slots)
      real(dp) :: ordered(self%last - self%first + 1)
      real(dp), allocatable :: outgoing(:), incoming(:)

      allocate (outgoing(size(self%slot)))
      outgoing(:) = values(self%slot)
      allocate (incoming(size(ordered)))
      call exchange(outgoing, self%out_end, incoming, self%in_end)
      ordered(self%place) = incoming
   end function sorted

end module number_order
