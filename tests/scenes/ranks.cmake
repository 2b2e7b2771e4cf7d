# One run by several ranks, bit by bit that of one process; and how it ends. Only in a build with MPI.
if(NOT DYNSPH_MPI)
   return()
endif()

set(DYNSPH_MPI_FLAGS --oversubscribe --bind-to none --mca mpi_yield_when_idle 1 CACHE STRING
   "what mpiexec is told in tests: more ranks than cores, and those that wait give way")
set(launcher ${MPIEXEC_EXECUTABLE} ${DYNSPH_MPI_FLAGS} ${MPIEXEC_NUMPROC_FLAG})
function(add_ranks_test case)
   add_test(NAME ranks_${case} COMMAND ${DYNSPH_BASH} ${scenes}/ranks.bash ${case} $<TARGET_FILE:dynsph> ${PROJECT_SOURCE_DIR}/input ${launcher})
   file(MAKE_DIRECTORY ${here}/ranks)
   set_tests_properties(ranks_${case} PROPERTIES WORKING_DIRECTORY ${here}/ranks PROCESSORS 2 TIMEOUT 300)
endfunction()

file(GLOB inputs CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}/input ${PROJECT_SOURCE_DIR}/input/*.nml)
foreach(input IN LISTS inputs)
   get_filename_component(name ${input} NAME_WE)
   add_ranks_test(same_bits_${name})
endforeach()
foreach(case IN ITEMS past_the_impact every_stage auto goes_on_with_others signal kill stop too_far out_of_balance no_table refusal)
   add_ranks_test(${case})
endforeach()

# Suites of what ranks do together, which are among the fast tests with one process. Others know nothing of ranks, or look at slots.
foreach(suite IN ITEMS communication diffusion dissipation dynamic_steps energy features forces no_slip order periodic probes
        search_margins solid_forces time_step vortex_start wall_forces)
   foreach(n IN ITEMS 2 3)
      add_test(NAME ranks_${n}_test_${suite} COMMAND ${launcher} ${n} $<TARGET_FILE:test_${suite}>)
      set_tests_properties(ranks_${n}_test_${suite} PROPERTIES PROCESSORS 2 TIMEOUT 120
         ENVIRONMENT "OMPI_ALLOW_RUN_AS_ROOT=1;OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1;GOMP_SPINCOUNT=1000;OMP_NUM_THREADS=1")
   endforeach()
endforeach()
