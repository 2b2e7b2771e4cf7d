# Stands in for pFUnit's CMake package where pFUnit is not installed: add_pfunit_ctest with the arguments that are used here.

add_library(funit STATIC ${CMAKE_CURRENT_LIST_DIR}/funit_values.f90 ${CMAKE_CURRENT_LIST_DIR}/funit.f90)
add_executable(funit_translate ${CMAKE_CURRENT_LIST_DIR}/translate.f90)
# A directory of its own, as in pFUnit: who uses modules of somebody else has to say so.
set_target_properties(funit PROPERTIES Fortran_MODULE_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/funit_modules)
target_include_directories(funit PUBLIC ${CMAKE_CURRENT_BINARY_DIR}/funit_modules)
foreach(target IN ITEMS funit funit_translate)
   target_compile_options(${target} PRIVATE -std=f2018 -Wall -Wextra -Wimplicit-interface)
endforeach()
target_compile_options(funit PRIVATE -Wno-unused-dummy-argument)   # of funit_check_ranks, which is for the compiler alone

# add_pfunit_ctest(name TEST_SOURCES a.pf ... [OTHER_SOURCES x.f90 ...] [LINK_LIBRARIES library ...]
#                  [EXTRA_USE module EXTRA_INITIALIZE procedure EXTRA_FINALIZE procedure])
#
# One executable and one ctest of this name for the suites in all TEST_SOURCES; the module's procedures are called before the first
# test and after the last.
function(add_pfunit_ctest name)
   funit_add_executable(${name} ${ARGN})
   add_test(NAME ${name} COMMAND ${name})
endfunction()

# The executable alone; same arguments.
function(funit_add_executable name)
   cmake_parse_arguments(PARSE_ARGV 1 arg "" "EXTRA_USE;EXTRA_INITIALIZE;EXTRA_FINALIZE" "TEST_SOURCES;OTHER_SOURCES;LINK_LIBRARIES")
   if(arg_UNPARSED_ARGUMENTS OR NOT arg_TEST_SOURCES)
      message(FATAL_ERROR "add_pfunit_ctest(${name}): no TEST_SOURCES, or arguments the stand-in for pFUnit does not know: "
         "${arg_UNPARSED_ARGUMENTS}")
   endif()

   set(directory ${CMAKE_CURRENT_BINARY_DIR}/generated/${name})
   file(MAKE_DIRECTORY ${directory})
   set(generated ${directory}/main.f90)
   set(declarations "")
   set(calls "")
   foreach(source IN LISTS arg_TEST_SOURCES)
      get_filename_component(path ${source} ABSOLUTE)
      get_filename_component(suite ${source} NAME_WE)
      add_custom_command(OUTPUT ${directory}/${suite}.F90
         COMMAND funit_translate ${path} ${directory}/${suite}.F90
         DEPENDS ${path} funit_translate VERBATIM)
      list(APPEND generated ${directory}/${suite}.F90)
      string(APPEND declarations "   external :: ${suite}_suite\n")
      string(APPEND calls "   call ${suite}_suite()\n")
   endforeach()
   set(uses "   use funit, only: funit_finish\n")
   if(arg_EXTRA_USE)
      string(APPEND uses "   use ${arg_EXTRA_USE}\n")
   endif()
   if(arg_EXTRA_INITIALIZE)
      string(PREPEND calls "   call ${arg_EXTRA_INITIALIZE}()\n")
   endif()
   if(arg_EXTRA_FINALIZE)
      string(APPEND calls "   call ${arg_EXTRA_FINALIZE}()\n")
   endif()
   file(GENERATE OUTPUT ${directory}/main.f90 CONTENT
      "program funit_main\n${uses}   implicit none\n${declarations}${calls}   call funit_finish()\nend program\n")

   add_executable(${name} ${generated} ${arg_OTHER_SOURCES})
   set_target_properties(${name} PROPERTIES Fortran_MODULE_DIRECTORY ${directory})   # its own, as in pFUnit
   target_link_libraries(${name} PRIVATE ${arg_LINK_LIBRARIES} funit)
   # Generated code may warn: -Werror among the flags of the whole build is not meant for it.
   target_compile_options(${name} PRIVATE -Wno-error)
endfunction()
