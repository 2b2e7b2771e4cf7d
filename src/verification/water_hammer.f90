!> Water hammer: a column of fluid that moves as a whole meets a wall.
!!
!! A shock runs back from the wall with speed D; the fluid is at rest behind it and still has the speed U before it. Mass and
!! momentum through the shock, seen from it, with p = c0**2 (rho - rho0):
!!
!!     rho0 (U + D) = rho D,   p = rho0 (U + D) U,   hence D (U + D) = c0**2:
!!     D = (sqrt(U**2 + 4 c0**2) - U)/2,   p = rho0 c0**2 U/D
!!
!! To first order in U/c0 that is p = rho0 c0 U: Joukowsky, Mem. Acad. Imp. Sci. St. Petersbourg 9 (1898). Of a column of length L
!! the free end meets the shock at t = L/(D + U), where the solution ends.
module water_hammer
   use columns, only: columns_t
   use equation_of_state, only: pressure_of
   use fitting, only: line_fit
   use kinds, only: dp
   use model, only: model_t
   use scene_needs, only: need_no_weight, need_one_body, needs_t, same, slack
   use settings, only: choice_length, settings_t, side_names
   use solution, only: n_sums, solution_t
   use solution_results, only: history_t, last, result_t, time_mean
   use text, only: rounded_down, to_text
   implicit none
   private

   public :: shock_speed, shock_pressure, water_hammer_solution_t

   !> The scene's body, which moves to one of the walls.
   type, extends(solution_t) :: water_hammer_solution_t
      real(dp) :: start(2) = 0     !! velocity of the column [m/s]
      integer :: axis = 1          !! that it moves along
      real(dp) :: width = 1        !! across [m]
      real(dp) :: shock = 0        !! D [m/s]
      real(dp) :: least_way = 0    !! that the shock must have gone for results [m]
   contains
      procedure :: add_needs
      procedure :: set_up
      procedure :: velocity
      procedure :: pressure
      procedure :: terms
      procedure :: add_columns
      procedure :: results
   end type water_hammer_solution_t

contains

   !> D, at which the shock runs away from the wall [m/s].
   elemental real(dp) function shock_speed(speed, c0) result(d)
      real(dp), intent(in) :: speed   !! U of the column [m/s]
      real(dp), intent(in) :: c0      !! [m/s]

      d = (sqrt(speed**2 + 4*c0**2) - speed)/2
   end function shock_speed

   !> p behind the shock [Pa].
   elemental real(dp) function shock_pressure(speed, c0, rho0) result(p)
      real(dp), intent(in) :: speed      !! U of the column [m/s]
      real(dp), intent(in) :: c0, rho0   !! [m/s], [kg/m3]

      p = rho0*c0**2*speed/shock_speed(speed, c0)
   end function shock_pressure

   ! The axis that a column moves along, and the sides before and behind it.
   pure subroutine find_way(velocity, axis, wall, free)
      real(dp), intent(in) :: velocity(2)
      integer, intent(out) :: axis, wall, free

      axis = maxloc(abs(velocity), 1)
      wall = merge(2*axis - 1, 2*axis, velocity(axis) < 0)
      free = merge(2*axis, 2*axis - 1, velocity(axis) < 0)
   end subroutine find_way

   ! A rectangle that moves straight to a wall and touches it, between side walls or periodic sides, with a free end.
   subroutine add_needs(self, scene, needs)
      class(water_hammer_solution_t), intent(in) :: self
      type(settings_t), intent(in) :: scene
      type(needs_t), intent(inout) :: needs
      character(choice_length) :: kinds_there(4)
      real(dp) :: body_at(4), box_at(4)
      integer :: axis, wall, free, one

      call need_no_weight(scene, needs)
      call need_one_body(scene, 'rectangle', needs)
      if (size(scene%bodies) /= 1) return
      associate (body => scene%bodies(1), box => scene%domain)
         call needs%unless(body%flow == 'uniform', "flow = 'uniform' and a velocity", 'body', 'flow')
         if (body%flow /= 'uniform') return
         call needs%unless(count(abs(body%velocity) > 0.0_dp) == 1, 'a velocity straight to a wall: velocity = -1, 0', &
                           'body', 'velocity')
         if (count(abs(body%velocity) > 0.0_dp) /= 1) return
         call find_way(body%velocity, axis, wall, free)
         body_at = [body%lower(1), body%upper(1), body%lower(2), body%upper(2)]
         box_at = [box%lower(1), box%upper(1), box%lower(2), box%upper(2)]
      end associate
      kinds_there = scene%side_kinds()
      call needs%unless(kinds_there(wall) == 'free_slip', name_of(wall)//" = 'free_slip': the wall that the column meets", &
                        'domain', name_of(wall))
      call needs%unless(same(scene, body_at(wall), box_at(wall)), 'a body that touches the '//name_of(wall)//' side', &
                        'body', 'lower')
      call needs%unless(kinds_there(free) == 'open', name_of(free)//" = 'open' beyond its free end", 'domain', name_of(free))
      one = 5 - 2*axis   ! first of the sides across
      call needs%unless(all(kinds_there(one:one + 1) == 'free_slip') .or. all(kinds_there(one:one + 1) == 'periodic'), &
                        name_of(one)//' and '//name_of(one + 1)//" both 'free_slip' or 'periodic'", 'domain', name_of(one))
      call needs%unless(all(same(scene, body_at(one:one + 1), box_at(one:one + 1))), 'a body from the '//name_of(one)//' to the ' &
                        //name_of(one + 1)//' side, '//to_text(box_at(one:one + 1)), 'body', 'upper')
      call need_an_end(scene, axis, needs)
   end subroutine add_needs

   pure function name_of(side) result(name)
      integer, intent(in) :: side
      character(:), allocatable :: name

      name = trim(side_names(side))
   end function name_of

   ! The run must end before the shock is at the free end. With a sound speed that is a guess: when it is known.
   subroutine need_an_end(scene, axis, needs)
      type(settings_t), intent(in) :: scene
      integer, intent(in) :: axis
      type(needs_t), intent(inout) :: needs
      real(dp) :: speed, longest

      if (scene%fluid%find_reference_speed) return
      associate (body => scene%bodies(1))
         speed = norm2(body%velocity)
         longest = (body%upper(axis) - body%lower(axis))/(shock_speed(speed, scene%fluid%sound_speed) + speed)
      end associate
      call needs%unless(scene%time%end_time <= longest*(1.0_dp + slack), 'end_time = '//rounded_down(longest) &
                        //' at most: then the shock is at the free end', 'time', 'end_time')
   end subroutine need_an_end

   subroutine set_up(self, scene, model)
      class(water_hammer_solution_t), intent(inout) :: self
      type(settings_t), intent(in) :: scene
      type(model_t), intent(in) :: model
      integer :: wall, free

      associate (body => scene%bodies(1))
         self%start = body%velocity
         call find_way(self%start, self%axis, wall, free)
         self%extent = body%upper - body%lower
         self%origin = body%lower
         if (self%start(self%axis) > 0) self%origin(self%axis) = body%upper(self%axis)
      end associate
      self%width = self%extent(3 - self%axis)
      self%speed_scale = norm2(self%start)
      self%shock = shock_speed(self%speed_scale, self%c0)
      self%pressure_scale = shock_pressure(self%speed_scale, self%c0, self%rho0)
      self%least_way = 10*model%kernel%h
   end subroutine set_up

   pure function velocity(self, position) result(u)
      class(water_hammer_solution_t), intent(in) :: self
      real(dp), intent(in) :: position(2)
      real(dp) :: u(2)

      u = 0
      if (.not. behind(self, position)) u = self%start
   end function velocity

   pure real(dp) function pressure(self, position) result(p)
      class(water_hammer_solution_t), intent(in) :: self
      real(dp), intent(in) :: position(2)

      p = 0
      if (behind(self, position)) p = self%pressure_scale
   end function pressure

   ! Whether the shock has passed a place.
   pure logical function behind(self, position)
      class(water_hammer_solution_t), intent(in) :: self
      real(dp), intent(in) :: position(2)

      behind = abs(position(self%axis) - self%origin(self%axis)) < self%shock*self%time
   end function behind

   ! The volume at rest; volume, pressure and its square in the middle half of what the shock has passed.
   pure function terms(self, r, u, s, w, m)
      class(water_hammer_solution_t), intent(in) :: self
      real(dp), intent(in) :: r(2), u(2), s, w, m
      real(dp) :: terms(n_sums), p

      terms = 0
      terms(1) = w*(1 - dot_product(u, self%start)/self%speed_scale**2)
      if (abs(abs(r(self%axis)) - self%shock*self%time/2) < self%shock*self%time/4) then
         p = pressure_of(self%c0, s)
         terms(2:4) = w*[1.0_dp, p, (p - self%pressure_scale)**2]
      end if
   end function terms

   subroutine add_columns(self, now, first, fastest, row)
      class(water_hammer_solution_t), intent(in) :: self
      real(dp), intent(in) :: now(n_sums), first(n_sums), fastest
      type(columns_t), intent(inout) :: row
      real(dp) :: volume

      ! At first no particle is in the middle half: 0.
      volume = max(now(2), tiny(1.0_dp))
      call row%add('front', 'length', now(1)/self%width)
      call row%add('front_exact', 'length', self%shock*self%time)
      call row%add('plateau', 'pressure', now(3)/volume)
      call row%add('plateau_exact', 'pressure', self%pressure_scale)
      call row%add('plateau_scatter', 'share of plateau_exact', sqrt(now(4)/volume)/self%pressure_scale)
   end subroutine add_columns

   ! Speed of the shock and pressure behind it in the second half of the time.
   function results(self, history)
      class(water_hammer_solution_t), intent(in) :: self
      type(history_t), intent(in) :: history
      type(result_t), allocatable :: results(:)
      real(dp) :: front(size(history%times)), plateau(size(history%times)), scatter(size(history%times))
      real(dp) :: offset, speed, mean(2)
      logical :: late(size(history%times)), found

      front = history%column('front')
      plateau = history%column('plateau')
      scatter = history%column('plateau_scatter')
      associate (times => history%times)
         late = times >= last(times)/2
         call line_fit(pack(times, late), pack(front, late), offset, speed, found)
         found = found .and. self%shock*last(times) >= self%least_way
         mean = [time_mean(pack(times, late), pack(plateau, late)), time_mean(pack(times, late), pack(scatter, late))]
      end associate
      results = [result_t('water_hammer_speed', speed, found), &
                 result_t('water_hammer_speed_error', speed/self%shock - 1, found), &
                 result_t('water_hammer_pressure', mean(1), found), &
                 result_t('water_hammer_pressure_error', mean(1)/self%pressure_scale - 1, found), &
                 result_t('water_hammer_scatter', mean(2), found)]
   end function results

end module water_hammer
