# Writes the module `build_info`: what --version prints.
execute_process(COMMAND git -C ${PROJECT_SOURCE_DIR} describe --always --dirty
   OUTPUT_VARIABLE DYNSPH_GIT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT DYNSPH_GIT)
   set(DYNSPH_GIT "unknown")
endif()
configure_file(${PROJECT_SOURCE_DIR}/cmake/build_info.f90.in ${PROJECT_BINARY_DIR}/generated/build_info.f90 @ONLY)
list(APPEND generated_sources ${PROJECT_BINARY_DIR}/generated/build_info.f90)
