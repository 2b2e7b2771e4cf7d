# Checks that a scene's shortest form has few lines and is the same scene: both give the same complete input.
#
#    cmake -DPROGRAM=dynsph -DSCENE=input/scene.nml -DLINES=14 -DDIRECTORY=... -P short_form.cmake
#
# LINES      that it may have, without rows of tables
# DIRECTORY  where the form and the results of both are put; emptied first
cmake_minimum_required(VERSION 3.18)

file(REMOVE_RECURSE "${DIRECTORY}")
file(MAKE_DIRECTORY "${DIRECTORY}")
set(short "${DIRECTORY}/short.nml")
execute_process(COMMAND ${PROGRAM} --shortest ${SCENE} OUTPUT_FILE "${short}" RESULT_VARIABLE status)
if(NOT status EQUAL 0)
   message(FATAL_ERROR "--shortest ${SCENE}: exit status ${status} instead of 0")
endif()
file(READ "${short}" text)
# Further rows of a table are as many as the file that it was read from has.
string(REGEX REPLACE "\n      [-0-9][^\n]*" "" counted "${text}")
string(REGEX MATCHALL "\n" line_ends "${counted}")
list(LENGTH line_ends number)
message("${text}")
if(number GREATER LINES OR number EQUAL 0)
   message(FATAL_ERROR "${number} lines, at most ${LINES} are allowed")
endif()
foreach(form IN ITEMS ${SCENE} ${short})
   get_filename_component(name ${form} NAME_WE)
   execute_process(COMMAND ${PROGRAM} --quiet --set time.max_steps=1 --output "${DIRECTORY}/${name}" ${form}
      OUTPUT_VARIABLE output ERROR_VARIABLE output RESULT_VARIABLE status)
   if(NOT status EQUAL 0)
      message(FATAL_ERROR "${form}: exit status ${status} instead of 0\n${output}")
   endif()
endforeach()
get_filename_component(name ${SCENE} NAME_WE)
execute_process(COMMAND ${CMAKE_COMMAND} -E compare_files "${DIRECTORY}/${name}/input_used.nml" "${DIRECTORY}/short/input_used.nml"
   RESULT_VARIABLE status)
if(NOT status EQUAL 0)
   message(FATAL_ERROR "the complete inputs in ${DIRECTORY}/${name} and ${DIRECTORY}/short differ")
endif()
