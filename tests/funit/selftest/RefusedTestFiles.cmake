# Test files that the translator has to refuse.

# The translator has to refuse the file <name>.pf with this content, and to say `message` of line `line`.
function(translator_refuses name line message content)
   set(directory ${CMAKE_CURRENT_BINARY_DIR}/refused)
   file(WRITE ${directory}/${name}.pf "${content}")
   add_test(NAME funit_refuses_${name} COMMAND ${CMAKE_COMMAND}
      "-DCOMMAND=$<TARGET_FILE:funit_translate>;${directory}/${name}.pf;${name}.F90" -DWORKING_DIRECTORY=${directory}
      -DEXIT_STATUS=1 "-DEXPECT=/${name}.pf:${line}: error: ${message}" -DNOT_CREATED=${name}.F90 -P ${run_and_expect})
endfunction()

# The same for lines inside a module that has a test as well; the first of them is line 3.
function(translator_refuses_lines name line message lines)
   translator_refuses(${name} ${line} "${message}"
      "module ${name}\ncontains\n${lines}\n@test\nsubroutine a_test()\nend subroutine\nend module\n")
endfunction()

translator_refuses(no_test 3 "no @test in this file" "module no_test\n! @test\nend module\n")
translator_refuses(no_module 3 "no module in this file" "@test\nsubroutine a_test()\nend subroutine\n")
translator_refuses(other_name 1 "module another in file other_name.pf" "module another\n@test\nsubroutine a()\nend\nend\n")
translator_refuses(test_at_end 2 "@test without a subroutine" "module test_at_end\n@test\n")

set(refused "@test has to stand on the line above .subroutine name..., without prefixes")
translator_refuses_lines(recursive_test 4 "${refused}" "@test\nrecursive subroutine r()\nend subroutine")
translator_refuses_lines(pure_test 4 "${refused}" "@test\npure subroutine p()\nend subroutine")
translator_refuses_lines(blank_after_test 4 "${refused}" "@test\n\nsubroutine b()\nend subroutine")
translator_refuses_lines(test_of_function 4 "${refused}" "@test\nfunction f()\nend function")
translator_refuses_lines(test_with_argument 4 "@test procedures are declared" "@test\nsubroutine t(this)\nend subroutine")
translator_refuses_lines(test_before_test 4 "@test has to stand" "@test\n@test\nsubroutine t()\nend subroutine")
translator_refuses_lines(test_with_options 3 "nothing may follow @test" "@test(npes=[1])\nsubroutine t()\nend subroutine")
translator_refuses_lines(test_with_comment 3 "nothing may follow @test" "@test ! why\nsubroutine t()\nend subroutine")
translator_refuses_lines(clashing_name 4 "the name run clashes" "@test\nsubroutine Run()\nend subroutine")
translator_refuses_lines(test_named_string 4 "the name string clashes" "@test\nsubroutine string()\nend subroutine")
translator_refuses_lines(clashing_helper 3 "the name finalize clashes" "pure integer function finalize()\nend function")
string(REPEAT "n" 45 long_name)
translator_refuses_lines(long_name 4 "test name of more than 44" "@test\nsubroutine ${long_name}()\nend subroutine")

translator_refuses_lines(second_before 7 "second @before"
   "@before\nsubroutine b()\nend subroutine\n@before\nsubroutine c()\nend subroutine")
translator_refuses_lines(second_after 7 "second @after"
   "@after\nsubroutine b()\nend subroutine\n@after\nsubroutine c()\nend subroutine")
translator_refuses_lines(disable_alone 3 "@disable has to stand between @test" "@disable\nsubroutine d()\nend subroutine")
translator_refuses_lines(unknown_annotation 3 "annotation @mpitest is not among" "@mpiTest\nsubroutine m()\nend subroutine")
translator_refuses_lines(unknown_assert 4 "annotation @assertall is not among" "subroutine h()\n@assertAll(x)\nend subroutine")

set(refused "@assertequal needs its arguments between parentheses, all on its line")
translator_refuses_lines(continued_assert 4 "${refused}" "subroutine h()\n@assertEqual(1, &\n   2)\nend subroutine")
translator_refuses_lines(continued_string 4 "${refused}" "subroutine h()\n@assertEqual(')', 'a)&\n&b')\nend subroutine")
translator_refuses_lines(comment_in_assert 4 "${refused}" "subroutine h()\n@assertEqual(1, ! two\n   2)\nend subroutine")
translator_refuses_lines(assert_without_list 4 "${refused}" "subroutine h()\n@assertEqual\nend subroutine")
translator_refuses_lines(comment_after_assert 4 "nothing may follow the arguments of @asserttrue"
   "subroutine h()\n@assertTrue(.true.) ! why\nend subroutine")
translator_refuses_lines(continued_after_assert 4 "nothing may follow the arguments of @asserttrue"
   "subroutine h()\n@assertTrue(.true.) &\nend subroutine")

string(REPEAT "-" 132 dashes)
translator_refuses_lines(long_line 3 "line of more than 132 columns" "!${dashes}")
# What pFUnit makes of it, "  call assertEqual(..., &", has 133 columns; 132 are accepted in passing.pf.
string(REPEAT "-" 109 dashes)
translator_refuses_lines(long_call 4 "@assertequal makes a line of more than 132 columns in pFUnit"
   "subroutine h()\n@assertEqual('', '${dashes}')\nend subroutine")
translator_refuses_lines(preprocessor_comment 3 "/. begins a comment" "! output/*.h5")
