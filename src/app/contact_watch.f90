!> A watch on moving solids: a warning where one leaves too narrow a gap, the end of the run where two collide or a free one leaves
!! the box.
module contact_watch
   use box, only: is_wall
   use errors, only: exit_numerics, failure
   use kinds, only: dp
   use model, only: model_t
   use run_log, only: log_t
   use settings, only: settings_t, side_names
   use solid_contacts, only: contact_t, contacts_t
   use solids, only: new_obstacle, obstacle_t
   use step_state, only: step_t
   use text, only: quoted, short
   implicit none
   private

   public :: watch_contacts

   real(dp), parameter :: wide_enough = 0.99_dp   ! of the least gap: discs are polygons whose corners stand out

contains

   !> Looks at all solids where the particles were sorted: often enough. All processes see the same.
   subroutine watch_contacts(contacts, log, scene, model, run, problem)
      type(contacts_t), intent(inout) :: contacts
      type(log_t), intent(inout) :: log
      type(settings_t), intent(in) :: scene
      type(model_t), intent(in) :: model
      type(step_t), intent(in) :: run
      type(failure), intent(inout) :: problem   !! exit_numerics: two collide
      type(contact_t), allocatable :: found(:)
      type(obstacle_t) :: obstacles(size(scene%solids))
      logical :: moves(size(scene%solids))
      integer :: i, k

      if (run%sorted == contacts%sort) return
      contacts%sort = run%sorted
      moves = [(model%solids(k)%motion%moves(), k=1, size(moves))]
      if (.not. any(moves)) return
      associate (box => model%box_at(run%time))
         do k = 1, size(moves)
            obstacles(k) = new_obstacle(model%solids(k), run%poses(k), box)
         end do
         call contacts%find(obstacles, moves, box, wide_enough*model%kernel%support, found)
         do k = 1, size(moves)
            if (.not. model%solids(k)%body%is_free()) cycle
            if (any(is_wall(box%kind) .and. [obstacles(k)%lower(1) < box%at(1), obstacles(k)%upper(1) > box%at(2), &
                                                 obstacles(k)%lower(2) < box%at(3), obstacles(k)%upper(2) > box%at(4)])) &
               call problem%raise(exit_numerics, '&solid '//quoted(scene%solids(k)%name)//' reaches a wall at t = ' &
                                  //short(run%time)//', and nothing holds a free body there: move the wall, or end the run before')
         end do
      end associate
      do i = 1, size(found)
         if (found(i)%collides) then
            call problem%raise(exit_numerics, words(found(i))//' collides with '//quoted(scene%solids(found(i)%other)%name) &
                               //moment(found(i))//': change their motions, or end the run before')
         else
            call log%warn('narrow gap', words(found(i))//' is only '//short(found(i)%gap)//' = ' &
                          //short(found(i)%gap/model%dx)//' dx from '//partner(found(i))//moment(found(i)) &
                          //'; fluid between them feels both below '//short(model%kernel%support/model%dx)//' dx')
         end if
      end do

   contains

      function words(contact)
         type(contact_t), intent(in) :: contact
         character(:), allocatable :: words

         words = '&solid '//quoted(scene%solids(contact%solid)%name)
      end function words

      ! What it is near to.
      function partner(contact)
         type(contact_t), intent(in) :: contact
         character(:), allocatable :: partner

         if (contact%other > 0) then
            partner = quoted(scene%solids(contact%other)%name)
         else
            partner = 'the '//trim(side_names(contact%side))//' wall'
         end if
      end function partner

      function moment(contact)
         type(contact_t), intent(in) :: contact
         character(:), allocatable :: moment

         moment = ' at t = '//short(run%time)//', ('//short(contact%place(1))//', '//short(contact%place(2))//')'
      end function moment

   end subroutine watch_contacts

end module contact_watch
