# Asserts that must not compile, as in pFUnit, and some of their kind that must.

# compilation_of(name message assert): the compiler has to refuse a test of this assert, and to say `message` of its line;
# `message` "" is for one that has to compile.
function(compilation_of name message assert)
   set(directory ${CMAKE_CURRENT_BINARY_DIR}/compiled)
   file(WRITE ${directory}/${name}.pf
      "module ${name}\nuse funit\nimplicit none\ncontains\n@test\nsubroutine a_test()\n${assert}\nend subroutine\nend module\n")
   set(status 1)
   set(expected "${name}.pf:7:.*${message}")
   if(message STREQUAL "")
      set(status 0)
      set(expected "")
   endif()
   add_test(NAME funit_compilation_of_${name} COMMAND ${CMAKE_COMMAND}
      "-DCOMMAND=sh;-c;'$<TARGET_FILE:funit_translate>' ${name}.pf ${name}.F90 && LC_ALL=C '${CMAKE_Fortran_COMPILER}' -c '-I$<TARGET_PROPERTY:funit,Fortran_MODULE_DIRECTORY>' ${name}.F90 -o ${name}.o"
      -DWORKING_DIRECTORY=${directory} -DEXIT_STATUS=${status} "-DEXPECT=${expected}" -P ${run_and_expect})
endfunction()

compilation_of(same_ranks "" "@assertEqual([1, 2], [1, 2], message='(,)')")
compilation_of(scalar_against_table "" "@assertEqual('a,(', reshape(['b'], [1, 1]))")
compilation_of(array_against_scalar "no specific subroutine for the generic .funit_check_ranks" "@assertEqual([1, 2], 1)")
compilation_of(array_against_table "no specific subroutine for the generic .funit_check_ranks"
   "@assertEqual([1.0d0], reshape([1.0d0], [1, 1]))")
compilation_of(true_of_rank_two "no specific subroutine for the generic .asserttrue" "@assertTrue(reshape([.true.], [1, 1]))")
compilation_of(false_of_rank_two "no specific subroutine for the generic .assertfalse" "@assertFalse(reshape([.true.], [1, 1]))")
compilation_of(wider_expected "no specific subroutine for the generic .assertequal" "@assertEqual(1_8, 1_4)")
compilation_of(unnamed_tolerance "no specific subroutine for the generic .assertequal" "@assertEqual(1.0d0, 1.0d0, 1.0d0)")
