# Draws the pictures of a result and checks that they are there and show something.
#
#    cmake -DDRAW=utils/plots/draw -DBIN=build/bin -DRESULT=DIR "-DPICTURES=energy.png;..." -DBYTES=5000 -P check_pictures.cmake
#
# Prints SKIPPED where gnuplot or bash is missing.
cmake_minimum_required(VERSION 3.18)

find_program(gnuplot gnuplot)
find_program(bash bash)
if(NOT gnuplot OR NOT bash)
   message("SKIPPED: gnuplot or bash is missing")
   return()
endif()
foreach(name IN LISTS PICTURES)
   file(REMOVE "${RESULT}/${name}")
endforeach()
set(ENV{DYNSPH_BIN} "${BIN}")
set(ENV{GNUTERM} "no_such_terminal")   # the user's, for other work
execute_process(COMMAND ${bash} ${DRAW} ${RESULT} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
message("${output}")
if(NOT status EQUAL 0)
   message(FATAL_ERROR "${DRAW}: exit status ${status} instead of 0")
endif()
foreach(name IN LISTS PICTURES)
   if(NOT EXISTS "${RESULT}/${name}")
      message(FATAL_ERROR "${name} was not drawn")
   endif()
   file(SIZE "${RESULT}/${name}" size)
   file(READ "${RESULT}/${name}" signature LIMIT 4 HEX)
   if(size LESS BYTES OR NOT signature STREQUAL "89504e47")
      message(FATAL_ERROR "${name} is no picture of at least ${BYTES} bytes: ${size} bytes, beginning with ${signature}")
   endif()
endforeach()
