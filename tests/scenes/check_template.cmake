# Fills in a printed template and has the program check it: every key of the template must be one that is read.
#
#    cmake -DPROGRAM=dynsph -DSCRATCH=template.nml "-DVALUES=group.key=value|..." -P check_template.cmake
#
# VALUES   for each key without a default, and for those that a scene needs besides
# SCRATCH  where the filled-in template is put
cmake_minimum_required(VERSION 3.18)

execute_process(COMMAND ${PROGRAM} --template OUTPUT_VARIABLE text RESULT_VARIABLE status)
if(NOT status EQUAL 0)
   message(FATAL_ERROR "--template: exit status ${status} instead of 0")
endif()
string(REPLACE "|" ";" values "${VALUES}")
foreach(entry IN LISTS values)
   string(REGEX MATCH "^([a-z]+)\\.([a-z_]+)=(.*)$" matched "${entry}")
   set(group "${CMAKE_MATCH_1}")
   set(key "${CMAKE_MATCH_2}")
   set(value "${CMAKE_MATCH_3}")
   # The group's text from its name to the lone slash at its end.
   string(FIND "${text}" "&${group}\n" from)
   if(from LESS 0)
      message(FATAL_ERROR "the template has no group &${group}")
   endif()
   string(SUBSTRING "${text}" 0 ${from} head)
   string(SUBSTRING "${text}" ${from} -1 tail)
   string(FIND "${tail}" "\n   ${key} =" at)
   string(FIND "${tail}" "\n/" end)
   if(at LESS 0 OR at GREATER end)
      message(FATAL_ERROR "the template's group &${group} has no key ${key}")
   endif()
   math(EXPR at "${at} + 1")
   string(SUBSTRING "${tail}" 0 ${at} before)
   string(SUBSTRING "${tail}" ${at} -1 after)
   string(FIND "${after}" "\n" line_end)
   string(SUBSTRING "${after}" ${line_end} -1 after)
   set(text "${head}${before}   ${key} = ${value}${after}")
endforeach()
file(WRITE "${SCRATCH}" "${text}")
execute_process(COMMAND ${PROGRAM} --check "${SCRATCH}" OUTPUT_VARIABLE output ERROR_VARIABLE output RESULT_VARIABLE status)
message("${output}")
if(NOT status EQUAL 0)
   message(FATAL_ERROR "--check of the filled-in template: exit status ${status} instead of 0")
endif()
