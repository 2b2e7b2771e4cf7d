!> Particle arrays: one slot a particle, own particles first, mirror images after them.
!!
!! Own slots are filled strip by strip (module `strips`), each strip padded to whole
!! groups of slots with dummies: far away, without volume, id 0.
module particles
   use kinds, only: dp, i8, sp
   use lanes, only: nl
   implicit none
   private

   public :: state_t, features_t, particles_t, allocate_particles, reserve_slots, swap_states, bytes_per_slot

   real(dp), parameter, public :: far_away = 1.0e30_dp   !! where dummies are, in any unit of length

   !> What the equations advance, for every slot; also the state of a Runge-Kutta stage.
   type :: state_t
      real(dp), allocatable :: x(:), y(:)   !! [m] (n_slots) position
      real(dp), allocatable :: u(:), v(:)   !! [m/s] (n_slots) velocity
      real(dp), allocatable :: s(:)         !! [kg/m3] (n_slots) rho - rho0, so that p = c0**2 s without cancellation
      real(dp), allocatable :: volume(:)    !! [m2] (n_slots) volume m/rho (area in two dimensions)
   end type state_t

   !> What particles carry only where a scene needs it.
   type :: features_t
      logical :: viscosity = .true.      !! frozen viscous acceleration
      logical :: diffusion = .true.      !! frozen density-diffusion rate and the gradient in it
      logical :: eddy = .false.          !! alpha_i and delta_i of the dynamic model
      logical :: no_slip = .false.       !! velocities of images at no-slip walls
      logical :: dissipation = .false.   !! dissipated energy of each particle
   end type features_t

   !> All particles of this process.
   type :: particles_t
      type(features_t) :: features
      integer :: n = 0          !! real particles
      integer :: n_own = 0      !! own slots, padding included: whole groups
      integer :: n_held = 0     !! own slots and copies of what other processes compute
      integer :: n_slots = 0    !! these and images
      integer :: capacity = 0   !! slots allocated
      integer :: bytes_per_slot = 0   !! in all arrays below
      type(state_t) :: base        !! state at the start of the step
      type(state_t) :: stage(2)    !! states of stages
      type(state_t) :: next        !! state at the end of the step; until then a stage's, or rates
      real(dp), allocatable :: m(:)               !! [kg/m] (n_slots) mass, own slots only
      integer, allocatable :: id(:)               !! (n_slots) 1..n for real particles, 0 for dummies
      integer, allocatable :: sorted_id(:)        !! (n_slots) scratch of the sort
      real(sp), allocatable :: sorted_u(:), sorted_v(:)   !! [m/s] (n_slots) velocity when the particles were sorted, own slots only
      real(dp), allocatable :: visc_x(:), visc_y(:)   !! [m/s2] (n_slots) frozen viscous acceleration
      real(dp), allocatable :: diff_s(:)          !! [kg/m3/s] (n_slots) frozen density-diffusion rate
      real(dp), allocatable :: grad_x(:), grad_y(:)   !! [kg/m4] (n_slots) G, renormalised gradient of rho
      real(dp), allocatable :: alpha(:), delta(:)     !! [1] (n_slots) alpha_i, delta_i; no-slip walls need alpha, if only 0
      real(dp), allocatable :: jump_u(:), jump_v(:)   !! [m/s] (n_slots) no-slip less free-slip velocity of an image
      real(dp), allocatable :: wall_u(:), wall_v(:)   !! [m/s] (n_slots) velocity of an image's no-slip wall
      real(dp), allocatable :: dissipated(:)          !! [J/m] (n_slots) energy, since the start
      real(dp), allocatable :: dissipating(:)         !! [W/m] (n_slots) power; scratch of the sort
   contains
      procedure :: bytes => particles_bytes
   end type particles_t

contains

   !> Room for n particles and a first guess of padding and images; every slot a dummy.
   subroutine allocate_particles(self, n, features)
      type(particles_t), intent(out) :: self
      integer, intent(in) :: n   !! real particles
      type(features_t), intent(in), optional :: features   !! none if left out

      self%n = n
      if (present(features)) self%features = features
      call reserve_slots(self, n + n/20 + 64*nl)
   end subroutine allocate_particles

   !> Makes sure that there are at least `n_slots` slots. Keeps all contents.
   subroutine reserve_slots(self, n_slots)
      type(particles_t), intent(inout) :: self
      integer, intent(in) :: n_slots
      integer :: capacity, bytes, k

      if (n_slots <= self%capacity) return
      capacity = n_slots + n_slots/16
      capacity = nl*((capacity + nl - 1)/nl)
      bytes = 0
      call grow_state(self%base, capacity, bytes)
      call grow_state(self%next, capacity, bytes)
      do k = 1, 2
         call grow_state(self%stage(k), capacity, bytes)
      end do
      call grow(self%m, capacity, 0.0_dp, bytes)
      call grow_single(self%sorted_u, capacity, bytes)
      call grow_single(self%sorted_v, capacity, bytes)
      associate (features => self%features)
         if (features%viscosity) call grow_pair(self%visc_x, self%visc_y, capacity, bytes)
         if (features%diffusion) call grow(self%diff_s, capacity, 0.0_dp, bytes)
         if (features%diffusion .or. features%dissipation) call grow_pair(self%grad_x, self%grad_y, capacity, bytes)
         if (features%eddy .or. features%no_slip) call grow(self%alpha, capacity, 0.0_dp, bytes)
         if (features%eddy) call grow(self%delta, capacity, 0.0_dp, bytes)
         if (features%no_slip) call grow_pair(self%jump_u, self%jump_v, capacity, bytes)
         if (features%no_slip) call grow_pair(self%wall_u, self%wall_v, capacity, bytes)
         if (features%dissipation) call grow_pair(self%dissipated, self%dissipating, capacity, bytes)
      end associate
      call grow_integer(self%id, capacity, bytes)
      call grow_integer(self%sorted_id, capacity, bytes)
      self%capacity = capacity
      self%bytes_per_slot = bytes
   end subroutine reserve_slots

   !> Exchanges two states without copying them.
   pure subroutine swap_states(one, other)
      type(state_t), intent(inout) :: one, other

      call swap(one%x, other%x)
      call swap(one%y, other%y)
      call swap(one%u, other%u)
      call swap(one%v, other%v)
      call swap(one%s, other%s)
      call swap(one%volume, other%volume)
   end subroutine swap_states

   pure subroutine swap(one, other)
      real(dp), allocatable, intent(inout) :: one(:), other(:)
      real(dp), allocatable :: between(:)

      call move_alloc(one, between)
      call move_alloc(other, one)
      call move_alloc(between, other)
   end subroutine swap

   !> Bytes that all arrays take.
   pure integer(i8) function particles_bytes(self) result(bytes)
      class(particles_t), intent(in) :: self

      bytes = int(self%capacity, i8)*self%bytes_per_slot
   end function particles_bytes

   !> Bytes that a slot takes in the arrays of particles with these features.
   integer function bytes_per_slot(features)
      type(features_t), intent(in) :: features
      type(particles_t) :: none

      call allocate_particles(none, 0, features)
      bytes_per_slot = none%bytes_per_slot
   end function bytes_per_slot

   subroutine grow_state(state, capacity, bytes)
      type(state_t), intent(inout) :: state
      integer, intent(in) :: capacity
      integer, intent(inout) :: bytes   !! of a slot, as in all that follow: the array's are added

      call grow(state%x, capacity, far_away, bytes)
      call grow(state%y, capacity, far_away, bytes)
      call grow_pair(state%u, state%v, capacity, bytes)
      call grow_pair(state%s, state%volume, capacity, bytes)
   end subroutine grow_state

   subroutine grow_pair(first, second, capacity, bytes)
      real(dp), allocatable, intent(inout) :: first(:), second(:)
      integer, intent(in) :: capacity
      integer, intent(inout) :: bytes

      call grow(first, capacity, 0.0_dp, bytes)
      call grow(second, capacity, 0.0_dp, bytes)
   end subroutine grow_pair

   subroutine grow(array, capacity, filler, bytes)
      real(dp), allocatable, intent(inout) :: array(:)
      integer, intent(in) :: capacity
      real(dp), intent(in) :: filler
      integer, intent(inout) :: bytes
      real(dp), allocatable :: larger(:)
      integer :: old

      allocate (larger(capacity))
      old = 0
      if (allocated(array)) old = size(array)
      if (old > 0) larger(1:old) = array
      larger(old + 1:) = filler
      bytes = bytes + storage_size(larger)/8
      call move_alloc(larger, array)
   end subroutine grow

   subroutine grow_single(array, capacity, bytes)
      real(sp), allocatable, intent(inout) :: array(:)
      integer, intent(in) :: capacity
      integer, intent(inout) :: bytes
      real(sp), allocatable :: larger(:)
      integer :: old

      allocate (larger(capacity))
      old = 0
      if (allocated(array)) old = size(array)
      if (old > 0) larger(1:old) = array
      larger(old + 1:) = 0
      bytes = bytes + storage_size(larger)/8
      call move_alloc(larger, array)
   end subroutine grow_single

   subroutine grow_integer(array, capacity, bytes)
      integer, allocatable, intent(inout) :: array(:)
      integer, intent(in) :: capacity
      integer, intent(inout) :: bytes
      integer, allocatable :: larger(:)
      integer :: old

      allocate (larger(capacity))
      old = 0
      if (allocated(array)) old = size(array)
      if (old > 0) larger(1:old) = array
      larger(old + 1:) = 0
      bytes = bytes + storage_size(larger)/8
      call move_alloc(larger, array)
   end subroutine grow_integer

end module particles
