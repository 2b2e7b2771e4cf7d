# Solids in the fluid: their work is exact, their forces are right, fluid stays out of them.

# stays(scene "at_most" "means" "rules for summary.txt" settings...): a whole run of tests/scenes or input, and what its tables
# hold: energy.dat by at_most, solids.dat by means.
function(a_solid scene path at_most means rules)
   set(settings "")
   foreach(setting IN LISTS ARGN)
      list(APPEND settings --set ${setting})
   endforeach()
   add_test(NAME solid_${scene}_runs COMMAND ${CMAKE_COMMAND} "-DCOMMAND=${with_one};--quiet;${settings};--output;solid_${scene};${path}"
      -DWORKING_DIRECTORY=${here} -DEXIT_STATUS=0 "-DREJECT=NaN" "-DCREATED=solid_${scene}" -P ${run_and_expect})
   set_tests_properties(solid_${scene}_runs PROPERTIES FIXTURES_SETUP solid_${scene}_result TIMEOUT 120)
   add_test(NAME solid_${scene}_energies COMMAND ${DYNSPH_AWK} -v "at_most=${at_most}" -f ${scenes}/check_columns.awk
      ${here}/solid_${scene}/energy.dat)
   add_test(NAME solid_${scene}_forces COMMAND ${DYNSPH_AWK} -v "means=${means}" -f ${scenes}/check_columns.awk
      ${here}/solid_${scene}/solids.dat)
   add_test(NAME solid_${scene}_summary COMMAND ${CMAKE_COMMAND} -DFILE=${here}/solid_${scene}/summary.txt "-DRULES=${rules}"
      -P ${scenes}/check_summary.cmake)
   set_tests_properties(solid_${scene}_energies solid_${scene}_forces solid_${scene}_summary PROPERTIES
      FIXTURES_REQUIRED solid_${scene}_result TIMEOUT 30)
endfunction()

# Water with rho0 = g = 1 and a sound speed of 10 weighs 1.005 half a unit deep: a block of 0.16 is lifted by 0.1608. What is
# symmetric stays so, but for rounding.
a_solid(still_block ${scenes}/still_block.nml "max_speed 0 1.5e-3 max_speed 8 4e-4 W_solid 0 0 W_stat 0 1e-5"
   "block.force_y 5 0.1600 0.1616 block.force_x 0 -1e-9 1e-9" "energy_balance_error|0|1e-6;wall_crossings|0|0")
# The same block, turned by 20 degrees: particles that have not settled beside it reach 1.4e-2 sqrt(gd), and lift it by 0.1596.
a_solid(turned_block ${scenes}/still_block.nml "max_speed 5 3e-3 W_stat 0 5e-6" "block.force_y 5 0.160 0.1616 block.force_x 5 -3e-4 3e-4"
   "energy_balance_error|0|1e-5" "solid.angle=20")
# On a slope of 30 degrees rests the water above it: 0.5 sideways, 0.866 downwards. Unsettled, particles reach 2.3e-2 sqrt(gd).
a_solid(still_slope ${scenes}/still_slope.nml "max_speed 5 8e-3 W_stat 0 2e-5" "slope.force_x 5 0.497 0.508 slope.force_y 5 -0.879 -0.861"
   "energy_balance_error|0|1e-5")
# Four particles of wall between water of 1 and 0.5: 0.375, with the compression 0.3768. None of it across the floor.
a_solid(still_wall ${scenes}/still_wall.nml "max_speed 2 3e-3 W_stat 0 1e-5" "wall.force_x 2 0.373 0.381 wall.force_y 0 -1e-9 1e-9"
   "energy_balance_error|0|1e-6;wall_crossings|0|0")
# The same with three, between the floor and the open top: no fluid comes round an end.
a_solid(thin_wall ${scenes}/still_wall.nml "max_speed 2 6e-3 W_stat 0 1e-5" "wall.force_x 2 0.373 0.381 wall.force_y 0 -1e-9 1e-9"
   "energy_balance_error|0|1e-6;wall_crossings|0|0" "solid.upper=1.025,1.7" "body(2).lower=1.025,0")
# A piston that starts at once: what it gives is the work of its force.
a_solid(piston ${scenes}/piston.nml "W_stat 0 3e-4 W_pen 0 1e-3" "piston.force_y 0 -1e-9 1e-9 piston.force_x 3 -0.75 -0.5"
   "energy_balance_error|0|1e-3;W_solid|0.2|0.24")
# Nothing is given by a step that stands still, however hard it is hit; a smaller cfl closes the budget at impacts.
a_solid(dam_break_step ${PROJECT_SOURCE_DIR}/input/dam_break_step.nml "W_solid 0 0 W_stat/dE 0 8e-3 W_pen/dE 0 2e-3"
   "step.force_x 5 0 0.15" "energy_balance_error|0|4e-4" scene.resolution=20 time.cfl=0.6)
a_solid(pushed_block ${PROJECT_SOURCE_DIR}/input/pushed_block.nml "W_stat/dE 0 1e-3 W_pen/dE 0 0.02" "block.force_x 1 -0.2 -0.05"
   "energy_balance_error|0|3e-3;W_solid|0.05|0.07" scene.resolution=20)
a_solid(belt ${scenes}/belt.nml "W_stat 0 1e-3" "belt.friction_x 0.2 -0.35 -0.18" "energy_balance_error|0|1e-4")

# Where the block is at each time: ParaView is led there, and pictures find it in the head of a table.
add_test(NAME paraview_finds_outlines COMMAND sh -c
   "/usr/bin/python3 -c 'import vtkmodules.vtkIOHDF, h5py' 2>/dev/null || { echo 'no python3 with vtk and h5py'; exit 77; }; exec /usr/bin/python3 '${PROJECT_SOURCE_DIR}/utils/check_paraview.py' snapshot_*.vtkhdf outlines.xdmf")
set_tests_properties(paraview_finds_outlines PROPERTIES WORKING_DIRECTORY ${here}/solid_pushed_block SKIP_RETURN_CODE 77
   FIXTURES_REQUIRED solid_pushed_block_result TIMEOUT 60)
add_test(NAME solid_outline_is_where_the_block_is COMMAND ${CMAKE_COMMAND}
   "-DCOMMAND=$<TARGET_FILE:dynsph-snapshot-to-text>;solid_pushed_block/snapshot_000010.vtkhdf"
   -DWORKING_DIRECTORY=${here} -DEXIT_STATUS=0
   "-DEXPECT=# outline of block:  2.3000000E.000  3.0000000E-001\n# outline of block:  2.7000000E.000  3.0000000E-001\n" -P ${run_and_expect})
set_tests_properties(solid_outline_is_where_the_block_is PROPERTIES FIXTURES_REQUIRED solid_pushed_block_result TIMEOUT 30)

# The flow above the belt's middle, in layers of 0.05: U erfc(y/sqrt(4 nu t)) at t = 0.5, to 1 % of U where the flow that returns from
# the ends (0.7 % of U) does not matter yet.
add_test(NAME solid_belt_snapshot COMMAND $<TARGET_FILE:dynsph-snapshot-to-text> ${here}/solid_belt/snapshot_000001.vtkhdf
   ${here}/solid_belt/last.txt)
set_tests_properties(solid_belt_snapshot PROPERTIES FIXTURES_REQUIRED solid_belt_result FIXTURES_SETUP solid_belt_text TIMEOUT 30)
add_test(NAME solid_belt_follows_exact COMMAND ${DYNSPH_AWK} -f ${scenes}/check_belt.awk ${here}/solid_belt/last.txt)
set_tests_properties(solid_belt_follows_exact PROPERTIES FIXTURES_REQUIRED solid_belt_text TIMEOUT 30)

# A solid far from the fluid changes no bit of it.
set(far_away "${here}/far.nml")
file(READ ${dam_break} text)
file(WRITE ${far_away} "${text}\n&solid name = 'far', shape = 'rectangle', lower = 3.0, 2.2, upper = 3.6, 2.8 /\n")
foreach(case IN ITEMS near far)
   set(path ${dam_break})
   if(case STREQUAL far)
      set(path ${far_away})
   endif()
   add_test(NAME solid_${case}_dam_runs COMMAND ${CMAKE_COMMAND}
      "-DCOMMAND=${with_one};--quiet;--set;scene.resolution=20;--set;time.end_time=1;--set;output.energy=1 steps;--set;output.snapshots=never;--output;solid_${case}_dam;${path}"
      -DWORKING_DIRECTORY=${here} -DEXIT_STATUS=0 -DCREATED=solid_${case}_dam -P ${run_and_expect})
   set_tests_properties(solid_${case}_dam_runs PROPERTIES FIXTURES_SETUP solid_dams TIMEOUT 60)
endforeach()
add_test(NAME a_far_solid_changes_no_bit COMMAND ${DYNSPH_AWK} -v "names=time E_K E_P E_C Q_alpha Q_delta W_s max_speed dt"
   -f ${scenes}/check_same_columns.awk ${here}/solid_near_dam/energy.dat ${here}/solid_far_dam/energy.dat)
set_tests_properties(a_far_solid_changes_no_bit PROPERTIES FIXTURES_REQUIRED solid_dams TIMEOUT 30)

# A block that rose through the floor is lifted by the weight of its water, 0.8 (waves and 6 dx of height: 0.86), and fluid stays out
# of the face that was hidden. (While that had no ghosts there were 3847 crossings.)
a_solid(risen_block ${scenes}/risen_block.nml "W_pen 0 0.01" "block.force_y 6 0.75 0.95" "energy_balance_error|0|1e-3;wall_crossings|0|400"
   time.end_time=16)

# A block falls freely until it touches water, dives, and heaves about where half of it is under water, 1.027 (waves, which lift it:
# 1.06); it stays in the middle.
a_solid(falling_block ${scenes}/falling_block.nml "W_solid 0 0 W_stat/dE 0 8e-3 W_pen/dE 0 1e-3" "block.y 3 1.00 1.10"
   "energy_balance_error|0|2e-4;E_body_change|-0.06|-0.03" time.cfl=0.6 time.end_time=10)
add_test(NAME solid_falling_block_falls_freely COMMAND ${DYNSPH_AWK} -v name=block -v gravity=1 -v until=1
   -f ${scenes}/check_free_fall.awk ${here}/solid_falling_block/solids.dat)
set_tests_properties(solid_falling_block_falls_freely PROPERTIES FIXTURES_REQUIRED solid_falling_block_result TIMEOUT 30)

# A cylinder that floats and heaves: 2 % of its height apart from linear theory, with 20 particles across.
a_solid(heave_decay ${PROJECT_SOURCE_DIR}/input/heave_decay.nml "W_solid 0 0 W_stat/dE 0 1e-5" "cylinder.angle 0 -1e-9 1e-9"
   "energy_balance_error|0|1e-6" scene.resolution=10 time.end_time=8)
add_test(NAME solid_heave_decay_follows_theory COMMAND ${DYNSPH_AWK} -v name=cylinder -v height=0.1895
   -v rest=0.0105 -v until=8 -v most=0.03 -f ${PROJECT_SOURCE_DIR}/utils/studies/heave.awk ${PROJECT_SOURCE_DIR}/input/reference/heave_decay.csv
   ${here}/solid_heave_decay/solids.dat)
set_tests_properties(solid_heave_decay_follows_theory PROPERTIES FIXTURES_REQUIRED solid_heave_decay_result TIMEOUT 30)

# What cannot be is refused.
add_test(NAME refuses_solids_that_leave_no_fluid COMMAND ${CMAKE_COMMAND}
   "-DCOMMAND=${with_one};--set;solid.lower=-1,-1;--set;solid.upper=5,1.4;--output;no_fluid;${scenes}/still_block.nml"
   -DWORKING_DIRECTORY=${here} -DEXIT_STATUS=1 "-DEXPECT=no fluid is left: the solids cover each &body" -P ${run_and_expect})
set_tests_properties(refuses_solids_that_leave_no_fluid PROPERTIES TIMEOUT 30)

# Solids that come too near, once; the run ends where they collide, and keeps what it has.
file(READ ${scenes}/still_block.nml text)
file(WRITE ${here}/collision.nml "${text}\n&solid name = 'ram', shape = 'rectangle', lower = 0.2, 0.2, upper = 0.4, 0.6, motion = 'uniform', velocity = 0.3, 0 /\n")
add_test(NAME solid_collision_ends_the_run COMMAND ${CMAKE_COMMAND}
   "-DCOMMAND=${with_one};--quiet;--overwrite;--set;output.snapshots=never;--output;collision;${here}/collision.nml" -DWORKING_DIRECTORY=${here}
   -DEXIT_STATUS=2 "-DEXPECT=warning: &solid 'ram' is only .* dx from 'block' at t = .*;&solid 'ram' collides with 'block' at t = .* change their motions, or end the run before. The state is in the last snapshot"
   "-DREJECT=further warnings" "-DCREATED=collision/snapshot_000000.vtkhdf;collision/solids.dat" -P ${run_and_expect})
set_tests_properties(solid_collision_ends_the_run PROPERTIES TIMEOUT 60)
add_test(NAME refuses_solids_that_meet_themselves COMMAND ${CMAKE_COMMAND}
   "-DCOMMAND=${with_one};--set;domain.left=periodic;--set;domain.right=periodic;--set;solid.motion=uniform;--set;solid.velocity=0.5,0;--set;solid.upper=2.65,0.7;--output;through;${scenes}/still_block.nml"
   -DWORKING_DIRECTORY=${here} -DEXIT_STATUS=1 "-DEXPECT=and is 1.85 = 37 dx long: leave 4 dx between its ends" -P ${run_and_expect})
set_tests_properties(refuses_solids_that_leave_no_fluid refuses_solids_that_meet_themselves PROPERTIES TIMEOUT 30)

# Across periodic sides a block is lifted as anywhere else,
a_solid(block_across ${scenes}/still_block.nml "max_speed 0 1.5e-3 W_solid 0 0 W_stat 0 1e-5"
   "block.force_y 1 0.1600 0.1616 block.force_x 0 -1e-9 1e-9" "energy_balance_error|0|1e-6;wall_crossings|0|0"
   domain.left=periodic domain.right=periodic "solid.lower=1.8,0.3" "solid.upper=2.2,0.7" time.end_time=3)
# and a thin one that is carried through them meets what it would meet elsewhere.
foreach(case IN ITEMS here through)
   set(lower 0.8,0.3)
   set(upper 1.05,0.7)
   if(case STREQUAL through)
      set(lower 1.6,0.3)
      set(upper 1.85,0.7)
   endif()
   add_test(NAME solid_${case}_runs COMMAND ${CMAKE_COMMAND}
      "-DCOMMAND=${with_one};--quiet;--set;domain.left=periodic;--set;domain.right=periodic;--set;solid.motion=uniform;--set;solid.velocity=0.5,0;--set;solid.lower=${lower};--set;solid.upper=${upper};--set;time.end_time=1.5;--output;solid_${case};${scenes}/still_block.nml"
      -DWORKING_DIRECTORY=${here} -DEXIT_STATUS=0 -DCREATED=solid_${case} -P ${run_and_expect})
   set_tests_properties(solid_${case}_runs PROPERTIES FIXTURES_SETUP solid_ways TIMEOUT 60)
endforeach()
add_test(NAME solid_finds_the_same_beyond_a_side COMMAND ${DYNSPH_AWK} -v tolerance=1e-9 -v "names=time E_K E_P E_C W_solid W_pen max_speed dt"
   -f ${scenes}/check_same_columns.awk ${here}/solid_here/energy.dat ${here}/solid_through/energy.dat)
set_tests_properties(solid_finds_the_same_beyond_a_side PROPERTIES FIXTURES_REQUIRED solid_ways TIMEOUT 30)
