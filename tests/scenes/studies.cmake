# Studies have a quick form, that they do not rot: it must end well and write its results.
# quick_study(test study timeout EXPECT REJECT), the last two as for run_and_expect.
function(quick_study test study timeout expect reject)
   add_test(NAME ${test} COMMAND ${CMAKE_COMMAND}
      "-DCOMMAND=${CMAKE_COMMAND};-E;env;DYNSPH_BUILD=${PROJECT_BINARY_DIR};DYNSPH_RESULTS=${here}/studies;JOBS=1;GOMP_SPINCOUNT=1000;${DYNSPH_BASH};${PROJECT_SOURCE_DIR}/utils/studies/${study};quick"
      -DWORKING_DIRECTORY=${here} -DEXIT_STATUS=0 "-DEXPECT=${expect}" "-DREJECT=${reject}" "-DCREATED=studies/${study}_quick"
      -P ${run_and_expect})
   set_tests_properties(${test} PROPERTIES TIMEOUT ${timeout})
endfunction()

# With the margins in use flows stay calm, with those of a lattice they do not.
quick_study(flows_bear_the_margins margins 120 "in use: 0.84 . 1 of 1;in use: 0.9 . 1 of 1;in use: 0.5365 . 1 of 1; 0 of 1" "")

# Each run with extreme input finishes, or ends with a message that has the facts and a last state that is whole; lattices have the
# edges of linear theory.
quick_study(extreme_input_ends_well stability 600 " 0 BAD" "")
# Coarse runs of all methods give numbers, a table for each of seven scenes and two more; so do all scenes with either model.
quick_study(error_vs_time_runs error_vs_time 300 "" "failed;not the same")
set_tests_properties(error_vs_time_runs PROPERTIES FIXTURES_SETUP error_vs_time_result)
add_test(NAME error_vs_time_has_numbers COMMAND ${DYNSPH_AWK} -v tables=9 -f ${scenes}/check_tables.awk
   ${here}/studies/error_vs_time_quick/table.md)
add_test(NAME both_models_have_numbers COMMAND ${DYNSPH_AWK} -v tables=2 -f ${scenes}/check_tables.awk
   ${here}/studies/error_vs_time_quick/coefficients_table.md)
set_tests_properties(error_vs_time_has_numbers both_models_have_numbers PROPERTIES FIXTURES_REQUIRED error_vs_time_result TIMEOUT 30)
# Every scene says what it leaves out, and a scene with everything takes the bytes of the smallest one and of all parts. Times are
# printed, not judged.
quick_study(leaving_out_is_told leaving_out 120
   ". oscillating_drop . 7854 . ... .  .  . x .  .  .  .  .  . x .  . x .  .  . x . x .  .\n;. minimal . 216 .;. dynamic . 272 .*. minimal . 56 .;. all_dynamic . 320 . 320 ."
   "nan;leaving_out:")

# Runs that are cut, stopped and killed go on with the same bits.
quick_study(runs_go_on reliability 400 "23 of 23 cases end with the same bits" "not the same;exit code")
set_tests_properties(runs_go_on PROPERTIES PROCESSORS 2)

# The paper's campaign: every claim gets a number, and what was stopped goes on where it was.
set(paper "${CMAKE_COMMAND};-E;env;DYNSPH_BUILD=${PROJECT_BINARY_DIR};DYNSPH_RESULTS=${here}/studies;JOBS=1;GOMP_SPINCOUNT=1000;${DYNSPH_BASH};${PROJECT_SOURCE_DIR}/utils/paper/reproduce;smoke")
add_test(NAME paper_campaign_is_stopped COMMAND ${CMAKE_COMMAND}
   "-DCOMMAND=${DYNSPH_BASH};${scenes}/stop_for_a_file.bash;${here}/studies/paper_smoke/dam_dynamic_ma_0.05_24;${paper};dam_dynamic_ma_0.05_24"
   -DWORKING_DIRECTORY=${here} -DEXIT_STATUS=4 "-DEXPECT=1 runs have not ended: call it again" -DCREATED=studies/paper_smoke -P ${run_and_expect})
set_tests_properties(paper_campaign_is_stopped PROPERTIES FIXTURES_SETUP stopped_campaign TIMEOUT 120)
add_test(NAME paper_campaign_goes_on COMMAND ${CMAKE_COMMAND} "-DCOMMAND=${paper}" -DWORKING_DIRECTORY=${here} -DEXIT_STATUS=0
   "-DEXPECT=dam_dynamic_ma_0.05_24  .* t=.*;paper_smoke/figures/dynamic_model.png" "-DREJECT=see ;warning;not ended" -P ${run_and_expect})
set_tests_properties(paper_campaign_goes_on PROPERTIES FIXTURES_REQUIRED stopped_campaign FIXTURES_SETUP campaign TIMEOUT 300)
add_test(NAME paper_claims_have_numbers COMMAND ${CMAKE_COMMAND}
   "-DCOMMAND=grep;-cE;^. [WDLA]. .*. (holds|roughly|does not hold) .;studies/paper_smoke/paper.md" -DWORKING_DIRECTORY=${here} -DEXIT_STATUS=0
   "-DEXPECT=^38" "-DREJECT=nan" -P ${run_and_expect})
set_tests_properties(paper_claims_have_numbers PROPERTIES FIXTURES_REQUIRED campaign TIMEOUT 30)

# What docs/results/paper.md says is what the published facts of runs say.
add_test(NAME paper_page_is_of_its_facts COMMAND ${CMAKE_COMMAND}
   "-DCOMMAND=${CMAKE_COMMAND};-E;env;DYNSPH_BUILD=${PROJECT_BINARY_DIR};${DYNSPH_BASH};${scenes}/published.bash;${PROJECT_SOURCE_DIR};${here}/published"
   -DWORKING_DIRECTORY=${here} -DEXIT_STATUS=0 -P ${run_and_expect})
set_tests_properties(paper_page_is_of_its_facts PROPERTIES TIMEOUT 60)

# All studies at once, in their quick forms: those above are not repeated, and each leaves its tables under its head.
add_test(NAME all_studies_leave_tables COMMAND ${CMAKE_COMMAND}
   "-DCOMMAND=${CMAKE_COMMAND};-E;env;DYNSPH_BUILD=${PROJECT_BINARY_DIR};DYNSPH_RESULTS=${here}/studies;JOBS=1;OMP_NUM_THREADS=1;GOMP_SPINCOUNT=1000;${DYNSPH_BASH};${PROJECT_SOURCE_DIR}/utils/studies/all;quick"
   -DWORKING_DIRECTORY=${here} -DEXIT_STATUS=0 "-DEXPECT=tables and pictures: ${here}/studies/tables_quick" "-DREJECT=failed;nan"
   "-DCREATED=studies/tables_quick" -P ${run_and_expect})
set_tests_properties(all_studies_leave_tables PROPERTIES TIMEOUT 900
   DEPENDS "flows_bear_the_margins;extreme_input_ends_well;error_vs_time_runs;leaving_out_is_told;runs_go_on;paper_campaign_goes_on")
