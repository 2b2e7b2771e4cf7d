# What dynsph refuses, how a run ends before its time, and what is left behind then.

# Refusals. refused(name status lines "files before" "message" arguments...)
function(refused name status lines files message)
   set(test refuses_${name})
   add_test(NAME ${test} COMMAND ${CMAKE_COMMAND} "-DCOMMAND=$<TARGET_FILE:dynsph>;${ARGN}"
      -DWORKING_DIRECTORY=${here}/${test} -DEXIT_STATUS=${status} -DLINES=${lines} "-DFILES=${files}" "-DEXPECT=${message}"
      "-DREJECT=Backtrace;At line;STOP" -P ${leave_nothing})
   set_tests_properties(${test} PROPERTIES TIMEOUT 30)
endfunction()

refused(unknown_key 1 1 "" "unknown_key.nml:16: &model has no key 'alpa'. did you mean 'alpha'" ${scenes}/unknown_key.nml)
refused(unknown_set_key 1 1 "" "--set model.alpa=0.1: &model has no key 'alpa'. did you mean 'alpha'"
   --set model.alpa=0.1 ${dam_break})
refused(wrong_value 1 1 "" "wrong_value.nml:7: .*'ajar'" ${scenes}/wrong_value.nml)
refused(wrong_set_value 1 1 "" "&scene resolution: 'fine' is not a number" --set scene.resolution=fine ${dam_break})
refused(two_mistakes 1 2 "" "scene.resolution=-5.*out of range;has no key 'alpa'"
   --set scene.resolution=-5 --set model.alpa=0.1 ${dam_break})
refused(missing_file 3 1 "" "nowhere.nml: there is no such file" nowhere.nml)
refused(unusable_output 3 1 "file" "cannot make the directory 'file/below'.*--output DIR" --output file/below ${dam_break})
refused(output_that_is_a_file 3 1 "file" "cannot write results to 'file'.*not a directory" --output file ${dam_break})
refused(negative_resolution 1 1 "" "&scene resolution = -5.0 is out of range: 4 to 20000" --set scene.resolution=-5 ${dam_break})
refused(delta_of_one 1 1 "" "unstable: with delta = 1.0 the limit is 0.264.*lower cfl, or delta to 0.176"
   --set time.beyond_limit=refuse --set model.delta=1 ${dam_break})
refused(cfl_of_ten 1 1 "" "cfl = 10.0 is unstable: the limit of rk4 is 2.09" --set time.beyond_limit=refuse --set time.cfl=10 --set model.delta=0.01 ${dam_break})
refused(fast_auto 1 1 "" "reference_speed=fast: &fluid reference_speed = 'fast' is unknown. write a number or 'auto'"
   --set fluid.reference_speed=fast ${dam_break})
refused(cfl_that_auto_makes_unstable 1 1 "" "cfl = 1.5 is unstable: with alpha = 0.366" --quiet --set time.beyond_limit=refuse
   --set fluid.reference_speed=auto --set scene.resolution=30 --set time.end_time=2 --set time.max_steps=20
   --set fluid.viscosity=0.03 --set model.alpha=0 ${dam_break})
refused(one_periodic_side 1 1 "" "left = 'periodic' needs right = 'periodic' too" --set domain.left=periodic ${dam_break})
refused(drop_with_weight 1 1 "" "&exact solution = 'oscillating_drop' needs gravity = 0" --set fluid.gravity=1
   ${PROJECT_SOURCE_DIR}/input/oscillating_drop.nml)
refused(eddy_field_of_constant_model 1 1 "" "'alpha' is the same everywhere" --set output.fields=alpha ${dam_break})
refused(narrow_tank 1 1 "" "narrower than 0.25" --set domain.upper=0.2,1.5 --set body.upper=0.2,1 ${scenes}/still_tank.nml)
refused(supersonic_body 1 1 "" "is 6 times the sound speed" --set body.velocity=60,0 ${dam_break})
refused(supersonic_fall 1 1 "" "its speed, given or by the forces on it, is 1.414E.* times the sound speed" --set force.acceleration=1e200,0
   ${dam_break})
refused(probe_off_its_wall 1 1 "" "lies 0.03 m from the nearest wall, more than dx/2 = 0.025" --set "probe(1).position=5.336666666666667,0.2"
   --set scene.resolution=20 ${dam_break})
refused(probe_named_time 1 1 "" "name of another column" --set "probe(1).name=time" ${dam_break})
refused(fluid_far_apart 2 any "" "more than 4 million strips of width h long: move the bodies closer in x" --set domain.upper=1000002,1.5
   --set domain.right=open --set "body(1).lower=1e6,0.6" --set "body(1).upper=1000001,1" ${scenes}/still_layers.nml)
refused(images_far_apart 2 any "" "more than 4 million strips of width h long" --set domain.upper=399999.9,1.5
   --set "body(1).lower=399999.8,0" --set "body(1).upper=399999.9,0.1" --set output.energy=never ${scenes}/still_layers.nml)
refused(existing_result 1 1 "old/run.log" "'old' already holds a result .run.log.*--overwrite" --output old ${dam_break})
refused(unknown_option 1 1 "" "no option --chek. did you mean '--check'" --chek ${dam_break})
refused(no_scene 1 1 "" "which scene")

# A run that ends before its end_time says so, and its directory has the name that was given.
add_test(NAME ends_early COMMAND ${CMAKE_COMMAND} "-DCOMMAND=${with_one};--set;time.max_steps=2;--set;output.snapshots=1 steps;--output; it's blank;${scenes}/still_layers.nml"
   -DWORKING_DIRECTORY=${here} -DEXIT_STATUS=0 "-DEXPECT=the run ended at t = 0.01.* of end_time = 4: &time max_steps = 2"
   "-DCREATED= it's blank" "-DNOT_CREATED=it's blank" -P ${run_and_expect})
add_test(NAME ends_early_in_its_log COMMAND ${CMAKE_COMMAND} "-DCOMMAND=grep;the run ended;${here}/ it's blank/run.log"
   -DWORKING_DIRECTORY=${here} -DEXIT_STATUS=0 -P ${run_and_expect})
set_tests_properties(ends_early PROPERTIES FIXTURES_SETUP early_result TIMEOUT 30)
set_tests_properties(ends_early_in_its_log PROPERTIES FIXTURES_REQUIRED early_result TIMEOUT 30)

# A run that does not fit into memory is refused before anything is allocated, and leaves nothing behind.
add_test(NAME too_much_memory COMMAND ${CMAKE_COMMAND}
   "-DCOMMAND=sh;-c;ulimit -v 4000000 && OMP_NUM_THREADS=1 exec $<TARGET_FILE:dynsph> --output large --set scene.resolution=3000 ${dam_break}"
   -DWORKING_DIRECTORY=${here} -DEXIT_STATUS=3 "-DEXPECT=memory  *about 8;the run needs about 8.* GB of memory, and .* are free: lower"
   "-DNOT_CREATED=large" -P ${run_and_expect})
set_tests_properties(too_much_memory PROPERTIES TIMEOUT 30)

# A stack that is too small is raised or refused, and so many threads as no machine has are not made:
# limited(name status "limits of the shell" "message").
function(limited name status limits message)
   add_test(NAME ${name} COMMAND ${CMAKE_COMMAND}
      "-DCOMMAND=sh;-c;${limits} exec $<TARGET_FILE:dynsph> --quiet --overwrite --output ${name} --set scene.resolution=40 --set time.max_steps=2 ${dam_break}"
      -DWORKING_DIRECTORY=${here} -DEXIT_STATUS=${status} "-DEXPECT=${message}" -P ${run_and_expect})
   set_tests_properties(${name} PROPERTIES TIMEOUT 60)
endfunction()
set(small_stack "ulimit -S -s 64 && OMP_NUM_THREADS=2")
limited(tiny_stack 3 "ulimit -s 64 &&" "the stack is limited to 64 kB, and dynsph needs 512: say 'ulimit -s 8192'")
limited(tiny_stack_of_threads 3 "OMP_STACKSIZE=16k" "a stack of OMP_STACKSIZE = '16k', which is too small: .* 512k or more")
limited(tiny_stack_that_can_be_raised 0 "${small_stack}" "max_steps = 2")
limited(tiny_stack_of_spinning_threads 0 "${small_stack} GOMP_SPINCOUNT=1000" "max_steps = 2")
limited(absurdly_many_threads 0 "OMP_NUM_THREADS=200000000" "asks for 200000000 threads.*max_steps = 2")

# A run that fails leaves its last good state, once: here a particle gets too far away for the strips in step 5.
add_test(NAME leaves_box_runs COMMAND ${CMAKE_COMMAND}
   "-DCOMMAND=${with_one};--quiet;--set;domain.right=open;--set;domain.upper=399999,1.5;--set;fluid.gravity=0;--set;body(1).lower=399997.7,0;--set;body(1).upper=399997.8,0.1;--set;body(1).velocity=20,0;--set;body(1).pressure=zero;--set;body(2).pressure=zero;--set;fluid.mach=0.1;--set;output.snapshots=3 steps;--set;output.energy=3 steps;--output;leaves_box;${scenes}/still_layers.nml"
   -DWORKING_DIRECTORY=${here} -DEXIT_STATUS=2 "-DEXPECT=4 million strips .* after step 5 at t = 0.075.*: particle 2, before the step at .399998.9.*last snapshot"
   "-DCREATED=leaves_box;leaves_box/snapshot_000002.vtkhdf" "-DNOT_CREATED=leaves_box/snapshot_000003.vtkhdf" -P ${run_and_expect})
set_tests_properties(leaves_box_runs PROPERTIES FIXTURES_SETUP leaves_box_result TIMEOUT 30)
add_test(NAME leaves_box_has_each_state_once COMMAND ${DYNSPH_AWK}
   "/^#/ { next } n++ && $1 <= last + 0 && n > 2 { bad = 1 } { last = $1 } END { exit bad || n < 3 }"
   ${here}/leaves_box/energy.dat)
set_tests_properties(leaves_box_has_each_state_once PROPERTIES FIXTURES_REQUIRED leaves_box_result TIMEOUT 30)
