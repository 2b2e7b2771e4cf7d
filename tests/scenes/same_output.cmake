# Checks that what a command prints is, byte by byte, what a file holds.
#
#    cmake "-DCOMMAND=program;argument;..." -DFILE=... -DSCRATCH=... -P same_output.cmake
#
# SCRATCH is where the output is put.
cmake_minimum_required(VERSION 3.18)

execute_process(COMMAND ${COMMAND} OUTPUT_FILE "${SCRATCH}" RESULT_VARIABLE status)
if(NOT status EQUAL 0)
   message(FATAL_ERROR "exit status ${status} instead of 0")
endif()
execute_process(COMMAND ${CMAKE_COMMAND} -E compare_files "${SCRATCH}" "${FILE}" RESULT_VARIABLE status)
if(NOT status EQUAL 0)
   string(REPLACE ";" " " command_line "${COMMAND}")
   message(FATAL_ERROR "${FILE} is out of date; write it anew: ${command_line} > ${FILE}")
endif()
