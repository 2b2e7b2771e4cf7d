# Compares files of the same names in two directories byte by byte.
#
#    cmake -DFIRST=DIR -DSECOND=DIR "-DFILES=energy.dat;..." -P same_files.cmake
cmake_minimum_required(VERSION 3.18)

if("${FIRST}" STREQUAL "" OR "${SECOND}" STREQUAL "" OR "${FILES}" STREQUAL "")
   message(FATAL_ERROR "same_files.cmake needs -DFIRST=..., -DSECOND=... and -DFILES=...")
endif()
set(failed "")
foreach(name IN LISTS FILES)
   execute_process(COMMAND ${CMAKE_COMMAND} -E compare_files "${FIRST}/${name}" "${SECOND}/${name}" RESULT_VARIABLE status)
   if(NOT status EQUAL 0)
      string(APPEND failed "\n  ${name}")
   endif()
endforeach()
if(failed)
   message(FATAL_ERROR "Missing or different in ${FIRST} and ${SECOND}:${failed}")
endif()
