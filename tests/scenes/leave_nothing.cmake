# A run that has to write no file, above all one that is refused: exact exit status, the expected message and nothing
# but that, nothing left behind.
#
#    cmake "-DCOMMAND=program;argument;..." -DWORKING_DIRECTORY=... -DEXIT_STATUS=1 "-DEXPECT=..." -DLINES=1
#       ["-DFILES=old/run.log;..."] -P leave_nothing.cmake
#
# COMMAND, WORKING_DIRECTORY, EXIT_STATUS, EXPECT as in run_and_expect.cmake; the directory is emptied first.
# LINES   lines of output, standard output and error together; 'any' number
# FILES   files that are there before, relative to WORKING_DIRECTORY; they must stay as they are
cmake_minimum_required(VERSION 3.18)

if("${WORKING_DIRECTORY}" STREQUAL "" OR "${LINES}" STREQUAL "")
   message(FATAL_ERROR "leave_nothing.cmake needs -DWORKING_DIRECTORY=... and -DLINES=...")
endif()
file(REMOVE_RECURSE "${WORKING_DIRECTORY}")
foreach(name IN LISTS FILES)
   file(WRITE "${WORKING_DIRECTORY}/${name}" "was here before\n")
endforeach()
file(MAKE_DIRECTORY "${WORKING_DIRECTORY}")
file(GLOB_RECURSE before LIST_DIRECTORIES true "${WORKING_DIRECTORY}/*")

include(${CMAKE_CURRENT_LIST_DIR}/run_and_expect.cmake)

file(GLOB_RECURSE after LIST_DIRECTORIES true "${WORKING_DIRECTORY}/*")
if(NOT "${before}" STREQUAL "${after}")
   message(FATAL_ERROR "The run left something behind or took something away:\nbefore: ${before}\nafter: ${after}")
endif()
foreach(name IN LISTS FILES)
   file(READ "${WORKING_DIRECTORY}/${name}" content)
   if(NOT content STREQUAL "was here before\n")
      message(FATAL_ERROR "The run changed ${name}")
   endif()
endforeach()
string(REGEX MATCHALL "\n" line_ends "${output}")
list(LENGTH line_ends number)
if(NOT LINES STREQUAL "any" AND NOT number EQUAL LINES)
   message(FATAL_ERROR "${number} lines of output instead of ${LINES}")
endif()
