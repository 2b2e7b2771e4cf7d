# Animates a result and checks that there is a GIF with a picture for each snapshot.
#
#    cmake -DANIMATE=utils/plots/animate -DBIN=build/bin -DRESULT=DIR "-DFIELDS=velocity;..." -P check_animation.cmake
#
# Prints SKIPPED where gnuplot or bash is missing.
cmake_minimum_required(VERSION 3.18)

find_program(gnuplot gnuplot)
find_program(bash bash)
if(NOT gnuplot OR NOT bash)
   message("SKIPPED: gnuplot or bash is missing")
   return()
endif()
file(REMOVE "${RESULT}/animation.gif")
set(ENV{DYNSPH_BIN} "${BIN}")
set(ENV{GNUTERM} "no_such_terminal")   # the user's, for other work
execute_process(COMMAND ${bash} ${ANIMATE} ${RESULT} ${FIELDS} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE errors)
if(NOT status EQUAL 0 OR NOT output STREQUAL "${RESULT}/animation.gif\n" OR NOT errors STREQUAL "")
   message(FATAL_ERROR "${ANIMATE}: exit status ${status}\n${output}${errors}")
endif()
file(GLOB left "${RESULT}/animation.gif.partial")
file(GLOB snapshots "${RESULT}/snapshot_*.vtkhdf")
list(LENGTH snapshots expected)
file(READ "${RESULT}/animation.gif" bytes HEX)
string(REGEX MATCHALL "21f904........002c00000000" pictures "${bytes}")   # how long it is shown, and where it is
list(LENGTH pictures number)
if(left OR NOT bytes MATCHES "^474946383961.*003b$" OR NOT number EQUAL expected)
   message(FATAL_ERROR "animation.gif has ${number} pictures, not one for each of ${expected} snapshots, or is no whole GIF")
endif()
