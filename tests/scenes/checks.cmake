# The checks that other tests are made of fail when they should.
set(samples ${here}/samples)
file(WRITE ${samples}/summary.txt "steps = 10\nerror = 1.5E-003\nmaximum = NaN\npeak = none\n")
file(WRITE ${samples}/table.dat "# head\n time a b\n 0 1 0\n 1 2 -3\n 2 1.5 NaN\n")
file(WRITE ${samples}/empty.dat "# head\n time a\n")
file(WRITE ${samples}/other/table.dat "# head\n time a b\n 0 1 0\n 1 2 -3\n 2 1.5 nan\n")
file(WRITE ${samples}/tables.md "| run | error |\n| --- | --- |\n| a | 0.1 |\n\n| run | error |\n| --- | --- |\n| b | failed |\n")

# a_check(name STATUS MESSAGE command...): how it ends, and what it says.
function(a_check name status message)
   add_test(NAME check_of_${name} COMMAND ${CMAKE_COMMAND} "-DCOMMAND=${ARGN}" -DWORKING_DIRECTORY=${samples} -DEXIT_STATUS=${status}
      "-DEXPECT=${message}" -P ${run_and_expect})
   set_tests_properties(check_of_${name} PROPERTIES TIMEOUT 30)
endfunction()
function(a_summary_check name status rule message)
   a_check(${name} ${status} "${message}" ${CMAKE_COMMAND} -DFILE=summary.txt "-DRULES=${rule}" -P ${scenes}/check_summary.cmake)
endfunction()
function(a_column_check name status rule message table)
   a_check(${name} ${status} "${message}" ${DYNSPH_AWK} -v ${rule} -f ${scenes}/check_columns.awk ${table})
endfunction()

a_summary_check(number_in_its_range 0 "error|1.4e-3|1.6e-3" "")
a_summary_check(number_below 1 "error|1.6e-3|" "error = 1.5E-003 is less than 1.6e-3")
a_summary_check(number_above 1 "error||1.4e-3" "error = 1.5E-003 is more than 1.4e-3")
a_summary_check(key_that_is_missing 1 "rror||" "rror is no number")
a_summary_check(nan_in_summary 1 "maximum||" "maximum is no number")
a_summary_check(word_in_summary 1 "peak||" "peak is no number")
a_check(missing_summary 1 "" ${CMAKE_COMMAND} -DFILE=nowhere.txt "-DRULES=steps|1|" -P ${scenes}/check_summary.cmake)

a_column_check(column_at_most 0 "at_most=a 0 2" "is at most 2 in 3 rows" table.dat)
a_column_check(column_mean 0 "means=a 1 1.7 1.8" "mean a is 1.75" table.dat)
a_column_check(column_mean_too_large 1 "means=a 0 1 1.4" "mean a is 1.5, wanted: 1 to 1.4" table.dat)
a_column_check(column_mean_too_small 1 "means=a 0 1.6 2" "mean a is 1.5, wanted: 1.6 to 2" table.dat)
a_column_check(column_mean_of_nothing 1 "means=a 3 1 2" "no row from time 3 on" table.dat)
a_column_check(column_too_large 1 "at_most=a 0 1.9" "is more than 1.9 at time 1" table.dat)
a_column_check(nan_in_column 1 "at_most=b 0 5" "b = NaN is no number" table.dat)
a_column_check(column_that_is_missing 1 "at_most=c 0 5" "there is no column c" table.dat)
a_column_check(column_without_late_rows 1 "at_most=a 3 5" "no row from time 3 on" table.dat)
a_column_check(column_that_falls 1 "never_falls_by=a 0.4" "a falls by 0.5" table.dat)
a_column_check(column_that_crosses 0 "crosses=a 1.5 0.4 0.6" "passes 1.5 at 0.5" table.dat)
a_column_check(column_that_crosses_late 1 "crosses=a 1.5 0.6 0.7" "passes 1.5 at 0.5" table.dat)
a_column_check(column_that_never_crosses 1 "crosses=a 3 0 2" "passes 3 never" table.dat)
a_column_check(table_without_rows 1 "at_most=a 0 5" "only 0 rows" empty.dat)
a_column_check(missing_table 2 "at_most=a 0 5" "" nowhere.dat)

a_check(failed_cell 1 "no number: . b . failed" ${DYNSPH_AWK} -v tables=2 -f ${scenes}/check_tables.awk tables.md)
a_check(number_of_tables 1 "instead of 3" sh -c "sed s/failed/0.2/ tables.md | '${DYNSPH_AWK}' -v tables=3 -f '${scenes}/check_tables.awk'")
a_check(files_that_differ 1 "Missing or different" ${CMAKE_COMMAND} -DFIRST=. -DSECOND=other -DFILES=table.dat -P ${scenes}/same_files.cmake)
a_check(files_that_are_missing 1 "Missing or different" ${CMAKE_COMMAND} -DFIRST=. -DSECOND=other -DFILES=nowhere.dat
   -P ${scenes}/same_files.cmake)
a_check(file_left_behind 1 "left something behind" ${CMAKE_COMMAND} -E env TMPDIR=. ${CMAKE_COMMAND} -DCOMMAND=mktemp
   -DWORKING_DIRECTORY=left_1 -DEXIT_STATUS=0 -DLINES=1 -P ${leave_nothing})
a_check(number_of_lines 1 "1 lines of output instead of 2" ${CMAKE_COMMAND} "-DCOMMAND=pwd" -DWORKING_DIRECTORY=left_2
   -DEXIT_STATUS=0 -DLINES=2 -P ${leave_nothing})
