# Runs that stop and go on; that they end with the same bits is shown by the study `reliability` (studies.cmake).

# A run that is stopped from outside says how it goes on, has an exit code of its own, and goes on.
add_test(NAME stops_for_a_file COMMAND ${CMAKE_COMMAND}
   "-DCOMMAND=${DYNSPH_BASH};${scenes}/stop_for_a_file.bash;with_stop;${with_one};--output;with_stop;--set;time.end_time=1000;--set;output.energy=1 steps;${scenes}/still_layers.nml"
   -DWORKING_DIRECTORY=${here} -DEXIT_STATUS=4
   "-DEXPECT=the run ended at t = .* of end_time = 1000: file STOP. It goes on with: dynsph --resume with_stop" -P ${run_and_expect})
set_tests_properties(stops_for_a_file PROPERTIES FIXTURES_SETUP stopped_result TIMEOUT 60)
add_test(NAME stopped_run_goes_on COMMAND ${CMAKE_COMMAND}
   "-DCOMMAND=${with_one};--resume;with_stop;--set;time.end_time=100;--set;time.max_steps=2000"
   -DWORKING_DIRECTORY=${here} -DEXIT_STATUS=0
   "-DEXPECT=goes on from with_stop/checkpoint_..h5: step;changed: time.end_time = 100.0 .was 1000.0.;the run ended at t = .* max_steps = 2000"
   "-DNOT_CREATED=with_stop/STOP;with_stop/run.lock" -P ${run_and_expect})
set_tests_properties(stopped_run_goes_on PROPERTIES FIXTURES_REQUIRED stopped_result FIXTURES_SETUP resumed_result TIMEOUT 60)

# Coarse runs that find the reference speed are stopped as the run proper is, and leave nothing; their time counts.
set(auto "--set;fluid.reference_speed=auto;--set;scene.resolution=400;${dam_break}")
add_test(NAME auto_stops_for_a_signal COMMAND ${CMAKE_COMMAND}
   "-DCOMMAND=${DYNSPH_BASH};${scenes}/stop_at_once.bash;stopped_auto;$<TARGET_FILE:dynsph>;${auto}" -DWORKING_DIRECTORY=${here} -DEXIT_STATUS=4
   "-DEXPECT=stopped in the preliminary runs for .*, of which nothing is kept: SIGTERM. The same command begins again"
   -DNOT_CREATED=stopped_auto -P ${run_and_expect})
refused(wall_time_over_in_auto 1 1 "" "max_wall_time = 0.2 s was over in the preliminary runs for &fluid reference_speed = 'auto'"
   --quiet --set time.max_wall_time=0.2 --set fluid.reference_speed=auto --set scene.resolution=400 ${dam_break})
set_tests_properties(auto_stops_for_a_signal refuses_wall_time_over_in_auto PROPERTIES TIMEOUT 60)

# What cannot be changed is named. resumed_and_refused(name arguments "message")
function(resume_refused name message)
   add_test(NAME resume_refuses_${name} COMMAND ${CMAKE_COMMAND} "-DCOMMAND=${with_one};--quiet;--resume;with_stop;${ARGN}"
      -DWORKING_DIRECTORY=${here} -DEXIT_STATUS=1 "-DEXPECT=${message}" "-DNOT_CREATED=fork" -P ${run_and_expect})
   set_tests_properties(resume_refuses_${name} PROPERTIES FIXTURES_REQUIRED "stopped_result;resumed_result" TIMEOUT 30)
endfunction()
resume_refused(another_gravity "fluid.gravity = 2.0 .was 1.0.: one result would be of two scenes. with --fork DIR2" --set fluid.gravity=2)
resume_refused(an_earlier_end "the checkpoint is of t = .*and the run shall end at t = 0.01: give a later end" --set time.end_time=0.01)
resume_refused(a_table_that_was_not "output.energy = 'never' .was '1 steps'.: one result" --set output.energy=never)
resume_refused(another_body_in_a_fork "body.1..pressure = 'zero' .was 'hydrostatic'.: the particles of the checkpoint are of the old one"
   --fork fork --set "body(1).pressure=zero")
add_test(NAME a_fork_may_change_more COMMAND ${CMAKE_COMMAND}
   "-DCOMMAND=${with_one};--resume;with_stop;--fork;forked;--overwrite;--set;fluid.gravity=2;--set;time.max_steps=2100;--set;output.energy=1 steps"
   -DWORKING_DIRECTORY=${here} -DEXIT_STATUS=0 "-DEXPECT=changed: fluid.gravity = 2.0 .was 1.0." "-DCREATED=forked/summary.txt" -P ${run_and_expect})
set_tests_properties(a_fork_may_change_more PROPERTIES FIXTURES_REQUIRED "stopped_result;resumed_result" FIXTURES_SETUP forked_result TIMEOUT 60)
add_test(NAME a_fork_says_where_it_is_from COMMAND ${CMAKE_COMMAND} "-DCOMMAND=grep;orked.from.* with_stop at step;forked/input_used.nml;forked/summary.txt"
   -DWORKING_DIRECTORY=${here} -DEXIT_STATUS=0 "-DEXPECT=input_used.nml:! Forked;summary.txt:forked_from = with_stop at step" -P ${run_and_expect})
set_tests_properties(a_fork_says_where_it_is_from PROPERTIES FIXTURES_REQUIRED forked_result TIMEOUT 30)

# A checkpoint of another run is no checkpoint of this one.
add_test(NAME exchange_of_checkpoints COMMAND ${DYNSPH_BASH} -c
   "rm -rf exchanged && cp -r with_stop exchanged && cp forked/checkpoint_?.h5 exchanged")
set_tests_properties(exchange_of_checkpoints PROPERTIES WORKING_DIRECTORY ${here} FIXTURES_REQUIRED "resumed_result;forked_result"
   FIXTURES_SETUP exchanged_result TIMEOUT 30)
add_test(NAME refuses_checkpoints_of_another_run COMMAND ${CMAKE_COMMAND} "-DCOMMAND=${with_one};--quiet;--resume;exchanged"
   -DWORKING_DIRECTORY=${here} -DEXIT_STATUS=3
   "-DEXPECT=cannot go on from 'exchanged/checkpoint_.*': it is of another input than 'exchanged/input_used.nml'" -P ${run_and_expect})
set_tests_properties(refuses_checkpoints_of_another_run PROPERTIES FIXTURES_REQUIRED exchanged_result TIMEOUT 30)

# Of a checkpoint whose first byte is another the other one is taken.
add_test(NAME damage_of_a_checkpoint COMMAND ${DYNSPH_BASH} -c
   "rm -rf damaged && cp -r with_stop damaged && printf x | dd of=damaged/checkpoint_a.h5 conv=notrunc")
set_tests_properties(damage_of_a_checkpoint PROPERTIES WORKING_DIRECTORY ${here} FIXTURES_REQUIRED "stopped_result;resumed_result"
   FIXTURES_SETUP damaged_result TIMEOUT 30)
add_test(NAME a_damaged_checkpoint_is_not_used COMMAND ${CMAKE_COMMAND} "-DCOMMAND=${with_one};--quiet;--resume;damaged"
   -DWORKING_DIRECTORY=${here} -DEXIT_STATUS=0
   "-DEXPECT='damaged/checkpoint_a.h5' cannot be used: it is not one of dynsph;the run ended at" -P ${run_and_expect})
set_tests_properties(a_damaged_checkpoint_is_not_used PROPERTIES FIXTURES_REQUIRED damaged_result TIMEOUT 60)

refused(resume_of_nothing 3 1 "" "cannot go on with 'nowhere': it is not a directory" --resume nowhere)
refused(resume_without_a_checkpoint 3 1 "old/run.log" "there is no checkpoint in 'old' to go on from" --resume old)
refused(files_of_others 1 1 "mine/probes.dat" "'mine/probes.dat' was not written by a run of dynsph" --overwrite --output mine ${dam_break})

# A flow whose energy does not balance has failed.
add_test(NAME balance_is_watched COMMAND ${CMAKE_COMMAND}
   "-DCOMMAND=${with_one};--quiet;--output;out_of_balance;--set;scene.resolution=16;--set;time.balance_limit=5e-4;--set;output.snapshots=never;${dam_break}"
   -DWORKING_DIRECTORY=${here} -DEXIT_STATUS=2
   "-DEXPECT=the energy balance misses 0.00.* after step .*0 at t = 2.*fastest: particle .* with speed/c0 .*The state is in the last snapshot"
   "-DCREATED=out_of_balance" -P ${run_and_expect})
set_tests_properties(balance_is_watched PROPERTIES TIMEOUT 60)
