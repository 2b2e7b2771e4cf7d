# DYNSPH_LANES: how many doubles the processor's vector registers hold; the
# pair kernels work on clusters of that many particles. Writes the module `lanes`.
set(native_flag "")
if(DYNSPH_NATIVE)
   set(native_flag -march=native)
endif()
execute_process(
   COMMAND ${CMAKE_Fortran_COMPILER} ${native_flag} -Q --help=target
   OUTPUT_VARIABLE target ERROR_QUIET)
if(target MATCHES "-mavx512f[ \t]+\\[enabled")
   set(detected 8)
   add_compile_options(-mprefer-vector-width=512)
elseif(target MATCHES "-mavx[ \t]+\\[enabled")
   set(detected 4)
else()
   set(detected 2)
endif()
set(DYNSPH_LANES ${detected} CACHE STRING "doubles in a vector register: 8, 4 or 2")
configure_file(${PROJECT_SOURCE_DIR}/cmake/lanes.f90.in ${PROJECT_BINARY_DIR}/generated/lanes.f90 @ONLY)
list(APPEND generated_sources ${PROJECT_BINARY_DIR}/generated/lanes.f90)
