# Installs, moves what was installed to another place, and works from there: a run, its table and its pictures.
#
#    cmake -DBUILD=build -DSOURCE=. -DDIRECTORY=... -P check_install.cmake
#
# DIRECTORY  where all this is done; emptied first
cmake_minimum_required(VERSION 3.18)

file(REMOVE_RECURSE "${DIRECTORY}")
file(MAKE_DIRECTORY "${DIRECTORY}/work")
set(moved "${DIRECTORY}/moved here")

# must_do(command...): runs in work/, where nothing but the system's programs can be found; `output` is what was printed.
function(must_do)
   execute_process(COMMAND ${CMAKE_COMMAND} -E env --unset=DYNSPH_BIN PATH=/usr/local/bin:/usr/bin:/bin OMP_NUM_THREADS=1 ${ARGV}
      WORKING_DIRECTORY "${DIRECTORY}/work" RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
   if(NOT status EQUAL 0)
      message(FATAL_ERROR "${ARGV}: exit status ${status} instead of 0\n${output}")
   endif()
   set(output "${output}" PARENT_SCOPE)
endfunction()

# must_be_there(file...)
function(must_be_there)
   foreach(name IN LISTS ARGV)
      if(NOT EXISTS "${name}" OR IS_DIRECTORY "${name}")
         message(FATAL_ERROR "there is no file ${name}")
      endif()
   endforeach()
endfunction()

must_do(${CMAKE_COMMAND} --install ${BUILD} --prefix ${DIRECTORY}/prefix)
file(RENAME "${DIRECTORY}/prefix" "${moved}")
file(GLOB_RECURSE sources RELATIVE "${SOURCE}" "${SOURCE}/input/*" "${SOURCE}/docs/*")
foreach(name IN LISTS sources)
   if(name MATCHES "^input/")
      must_be_there("${moved}/share/dynsph/${name}")
   else()
      must_be_there("${moved}/share/doc/dynsph/${name}")
   endif()
endforeach()
must_be_there("${moved}/share/doc/dynsph/LICENSE" "${moved}/share/doc/dynsph/README.md" "${moved}/share/dynsph/check_paraview.py")

# Nothing looks for anything in the build directory, and the programs that are not under the GPL do without FFTW.
find_program(objdump objdump)
file(GLOB programs "${moved}/bin/*")
foreach(program IN LISTS programs)
   if(objdump AND NOT IS_SYMLINK "${program}")
      must_do(${objdump} -p "${program}")
      string(REGEX MATCH "R[UN]*PATH[^\n]*" path "${output}")
      string(FIND "${path}" "${BUILD}" at)
      if(at GREATER -1)
         message(FATAL_ERROR "${program} looks for libraries in the build directory: ${path}")
      endif()
      if(output MATCHES "NEEDED +libfftw" AND NOT program MATCHES "/dynsph-spectra$")
         message(FATAL_ERROR "${program} is linked with FFTW")
      endif()
   endif()
endforeach()

must_do("${moved}/bin/dynsph" --quiet --set scene.resolution=10 --set time.max_steps=20 --set "output.energy=1 steps"
   --output result "${moved}/share/dynsph/input/dam_break.nml")
must_do("${moved}/bin/dynsph-snapshot-to-text" result/snapshot_000000.vtkhdf)
string(REGEX MATCHALL "\n +[-.0-9]" rows "${output}")
list(LENGTH rows number)
if(NOT output MATCHES "# title: " OR NOT number EQUAL 200)
   message(FATAL_ERROR "dynsph-snapshot-to-text gives ${number} rows, not one for each of 200 particles:\n${output}")
endif()
foreach(program IN ITEMS dynsph-spectra dynsph-stability)
   must_do("${moved}/bin/${program}" --help)
endforeach()

find_program(gnuplot gnuplot)
find_program(bash bash)
if(NOT gnuplot OR NOT bash)
   return()   # the rest is drawn
endif()
must_do("${moved}/bin/dynsph-draw" result)
must_do("${moved}/bin/dynsph-animate" result)
must_do(${gnuplot} -e "dir='result'" "${moved}/share/dynsph/plots/field.gp")
must_be_there("${DIRECTORY}/work/result/energy.png" "${DIRECTORY}/work/result/field_first.png" "${DIRECTORY}/work/result/field.png"
   "${DIRECTORY}/work/result/animation.gif")
