# The same numbers, whoever computes them: one or two threads, a run or its repetition.

# The same numbers, bit by bit, for any number of threads; step 300 is past the impact on the right wall.
foreach(threads IN ITEMS one two)
   add_test(NAME ${threads}_thread_runs COMMAND ${CMAKE_COMMAND}
      "-DCOMMAND=${with_${threads}};--quiet;--set;scene.resolution=20;--set;time.max_steps=300;--set;output.energy=1 steps;--set;output.snapshots=100 steps;--set;output.precision=double;--output;${threads}_thread;${dam_break}"
      -DWORKING_DIRECTORY=${here} -DEXIT_STATUS=0 "-DCREATED=${threads}_thread" -P ${run_and_expect})
   set_tests_properties(${threads}_thread_runs PROPERTIES FIXTURES_SETUP thread_results TIMEOUT 60)
endforeach()
set_tests_properties(two_thread_runs PROPERTIES PROCESSORS 2)
add_test(NAME threads_make_no_difference COMMAND ${CMAKE_COMMAND} -DFIRST=${here}/one_thread -DSECOND=${here}/two_thread
   "-DFILES=energy.dat;probes.dat;input_used.nml;snapshot_000000.vtkhdf;snapshot_000001.vtkhdf;snapshot_000002.vtkhdf;snapshot_000003.vtkhdf"
   -P ${scenes}/same_files.cmake)
set_tests_properties(threads_make_no_difference PROPERTIES FIXTURES_REQUIRED thread_results TIMEOUT 30)

# The same with the dynamic model, no-slip sides and all fields.
foreach(threads IN ITEMS one two)
   add_test(NAME ${threads}_thread_runs_dynamic COMMAND ${CMAKE_COMMAND}
      "-DCOMMAND=${with_${threads}};--quiet;--set;scene.resolution=20;--set;time.max_steps=300;--set;model.diffusion=dynamic;--set;fluid.viscosity=1e-4;--set;domain.right=no_slip;--set;domain.bottom=no_slip;--set;output.fields=velocity,pressure,density,vorticity,alpha,delta,dissipation;--set;output.snapshots=150 steps;--set;output.precision=double;--output;${threads}_thread_dynamic;${dam_break}"
      -DWORKING_DIRECTORY=${here} -DEXIT_STATUS=0 "-DREJECT=NaN;Infinity" "-DCREATED=${threads}_thread_dynamic" -P ${run_and_expect})
   set_tests_properties(${threads}_thread_runs_dynamic PROPERTIES FIXTURES_SETUP dynamic_thread_results TIMEOUT 60)
endforeach()
set_tests_properties(two_thread_runs_dynamic PROPERTIES PROCESSORS 2)
add_test(NAME threads_make_no_difference_dynamic COMMAND ${CMAKE_COMMAND} -DFIRST=${here}/one_thread_dynamic
   -DSECOND=${here}/two_thread_dynamic
   "-DFILES=energy.dat;probes.dat;input_used.nml;snapshot_000000.vtkhdf;snapshot_000001.vtkhdf;snapshot_000002.vtkhdf"
   -P ${scenes}/same_files.cmake)
set_tests_properties(threads_make_no_difference_dynamic PROPERTIES FIXTURES_REQUIRED dynamic_thread_results TIMEOUT 30)

# The same with solids and all tables, and for a run that goes on; and with solids carried through periodic sides.
foreach(case IN ITEMS solids through)
   set(path ${scenes}/moving_block.nml)
   set(tables "energy.dat;solids.dat;walls.dat;probes.dat")
   if(case STREQUAL through)
      set(path ${scenes}/periodic_solids.nml)
      set(tables "energy.dat;solids.dat;probes.dat")
   endif()
   foreach(threads IN ITEMS one two)
      add_test(NAME ${threads}_thread_runs_${case} COMMAND ${CMAKE_COMMAND}
         "-DCOMMAND=${with_${threads}};--quiet;--output;${threads}_thread_${case};${path}"
         -DWORKING_DIRECTORY=${here} -DEXIT_STATUS=0 "-DREJECT=NaN;Infinity" "-DCREATED=${threads}_thread_${case}" -P ${run_and_expect})
      set_tests_properties(${threads}_thread_runs_${case} PROPERTIES FIXTURES_SETUP ${case}_thread_results TIMEOUT 60)
   endforeach()
   set_tests_properties(two_thread_runs_${case} PROPERTIES PROCESSORS 2)
   add_test(NAME part_of_${case} COMMAND ${CMAKE_COMMAND}
      "-DCOMMAND=${with_one};--quiet;--set;time.max_steps=35;--output;part_of_${case};${path}"
      -DWORKING_DIRECTORY=${here} -DEXIT_STATUS=0 "-DCREATED=part_of_${case}" -P ${run_and_expect})
   add_test(NAME rest_of_${case} COMMAND ${CMAKE_COMMAND} "-DCOMMAND=${with_one};--quiet;--resume;part_of_${case};--set;time.max_steps=0"
      -DWORKING_DIRECTORY=${here} -DEXIT_STATUS=0 -P ${run_and_expect})
   set_tests_properties(part_of_${case} PROPERTIES FIXTURES_SETUP part_of_${case} TIMEOUT 60)
   set_tests_properties(rest_of_${case} PROPERTIES FIXTURES_REQUIRED part_of_${case} FIXTURES_SETUP rest_of_${case} TIMEOUT 60)
   foreach(other IN ITEMS two_thread_${case} part_of_${case})
      add_test(NAME ${other}_makes_no_difference COMMAND ${CMAKE_COMMAND} -DFIRST=${here}/one_thread_${case} -DSECOND=${here}/${other}
         "-DFILES=${tables};snapshot_000001.vtkhdf" -P ${scenes}/same_files.cmake)
      set_tests_properties(${other}_makes_no_difference PROPERTIES
         FIXTURES_REQUIRED "${case}_thread_results;part_of_${case};rest_of_${case}" TIMEOUT 30)
   endforeach()
endforeach()

# reference_speed = 'auto' is found before the run; the complete input has the number and repeats the run bit by bit.
add_test(NAME auto_run COMMAND ${CMAKE_COMMAND}
   "-DCOMMAND=${with_two};--set;fluid.reference_speed=auto;--set;scene.resolution=40;--set;time.end_time=1;--output;auto_run;${dam_break}"
   -DWORKING_DIRECTORY=${here} -DEXIT_STATUS=0 "-DEXPECT=preliminary run 2: d/dx = 10;reference_speed = 1..*c0 = 1..* for Ma 0.1"
   "-DCREATED=auto_run" -P ${run_and_expect})
set_tests_properties(auto_run PROPERTIES FIXTURES_SETUP auto_result PROCESSORS 2 TIMEOUT 60)
add_test(NAME auto_run_again COMMAND ${CMAKE_COMMAND}
   "-DCOMMAND=${with_one};--output;auto_again;auto_run/input_used.nml"
   -DWORKING_DIRECTORY=${here} -DEXIT_STATUS=0 "-DREJECT=preliminary" "-DCREATED=auto_again" -P ${run_and_expect})
set_tests_properties(auto_run_again PROPERTIES FIXTURES_REQUIRED auto_result FIXTURES_SETUP auto_results TIMEOUT 60)
add_test(NAME auto_run_is_repeatable COMMAND ${CMAKE_COMMAND} -DFIRST=${here}/auto_run -DSECOND=${here}/auto_again
   "-DFILES=energy.dat;probes.dat;input_used.nml;snapshot_000001.vtkhdf" -P ${scenes}/same_files.cmake)
set_tests_properties(auto_run_is_repeatable PROPERTIES FIXTURES_REQUIRED "auto_result;auto_results" TIMEOUT 30)
