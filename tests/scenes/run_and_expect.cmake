# Runs a command and checks how it ends: for whole runs, above all those that have to stop with an error.
# (CTest's WILL_FAIL accepts any crash and its PASS_REGULAR_EXPRESSION ignores the exit status.)
#
#    add_test(NAME refuses_unknown_key COMMAND ${CMAKE_COMMAND}
#       "-DCOMMAND=$<TARGET_FILE:dynsph>;${CMAKE_CURRENT_SOURCE_DIR}/unknown_key.nml"
#       -DWORKING_DIRECTORY=${CMAKE_CURRENT_BINARY_DIR}/refuses_unknown_key
#       -DEXIT_STATUS=2 "-DEXPECT=has no key 'alpa';did you mean 'alpha'"
#       -P ${PROJECT_SOURCE_DIR}/tests/scenes/run_and_expect.cmake)
#
# COMMAND            program;argument;...; "${CMAKE_COMMAND};-E;env;OMP_NUM_THREADS=1;program;..." sets the environment
# WORKING_DIRECTORY  made if it does not exist
# EXIT_STATUS        required exactly; a crash has none and fails
# EXPECT             regular expressions, each of which must match somewhere in standard output and error taken together
# REJECT             regular expressions none of which may match
# CREATED            files or directories, relative to WORKING_DIRECTORY, that must exist afterwards
# NOT_CREATED        ... that must not exist afterwards
#
# The first three are required. All others are lists separated by ; so a regular expression may contain neither ; nor [ ]
# (use a dot). What CREATED and NOT_CREATED name is removed before the run, so that an earlier run cannot decide the outcome.
cmake_minimum_required(VERSION 3.18)

foreach(name IN ITEMS COMMAND WORKING_DIRECTORY EXIT_STATUS)
   if("${${name}}" STREQUAL "")
      message(FATAL_ERROR "run_and_expect.cmake needs -D${name}=...")
   endif()
endforeach()
file(MAKE_DIRECTORY "${WORKING_DIRECTORY}")
foreach(path IN LISTS CREATED NOT_CREATED)
   if(path STREQUAL "" OR IS_ABSOLUTE "${path}" OR path MATCHES "^\\.")
      message(FATAL_ERROR "CREATED and NOT_CREATED name paths below WORKING_DIRECTORY, not '${path}'")
   endif()
   file(REMOVE_RECURSE "${WORKING_DIRECTORY}/${path}")
endforeach()

execute_process(COMMAND ${COMMAND} WORKING_DIRECTORY "${WORKING_DIRECTORY}"
   RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
string(REPLACE ";" " " command_line "${COMMAND}")
message("command: ${command_line}\nin: ${WORKING_DIRECTORY}\nexit status: ${status}\noutput:\n${output}")

set(failed "")
if(NOT status STREQUAL EXIT_STATUS)
   string(APPEND failed "\n  exit status ${status} instead of ${EXIT_STATUS}")
endif()
foreach(expression IN LISTS EXPECT)
   if(NOT output MATCHES "${expression}")
      string(APPEND failed "\n  the output does not match: ${expression}")
   endif()
endforeach()
foreach(expression IN LISTS REJECT)
   if(output MATCHES "${expression}")
      string(APPEND failed "\n  the output matches: ${expression}")
   endif()
endforeach()
foreach(path IN LISTS CREATED)
   if(NOT EXISTS "${WORKING_DIRECTORY}/${path}")
      string(APPEND failed "\n  not created: ${path}")
   endif()
endforeach()
foreach(path IN LISTS NOT_CREATED)
   if(EXISTS "${WORKING_DIRECTORY}/${path}")
      string(APPEND failed "\n  created: ${path}")
   endif()
endforeach()
if(failed)
   message("Requirements not met:${failed}")
   message(FATAL_ERROR "The run did not end as required.")
endif()
