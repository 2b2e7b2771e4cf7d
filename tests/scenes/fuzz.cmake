# Short form of the fuzz (tests/fuzz/fuzz): input, command lines and files that nobody meant to give.
set(fuzz ${PROJECT_SOURCE_DIR}/tests/fuzz/fuzz)

foreach(part IN ITEMS "scenes;350" "arguments;100" "files;50")
   list(GET part 0 name)
   add_test(NAME fuzz_${name} COMMAND ${DYNSPH_BASH} ${fuzz} $<TARGET_FILE_DIR:dynsph> ${here}/fuzz_${name} ${part})
   set_tests_properties(fuzz_${name} PROPERTIES TIMEOUT 300)
endforeach()

# It sees what it is there for: sees_fault(name mutants "line of a script in the place of dynsph" "message").
function(sees_fault name mutants line message)
   set(bin ${here}/fuzz_bin_${name})
   file(WRITE ${bin}/dynsph "#!/bin/sh\ncase $1 in --keys) cat '${PROJECT_SOURCE_DIR}/docs/input.md'; exit 0 ;; --version) exit 0 ;; esac\n${line}\n")
   file(COPY ${bin}/dynsph DESTINATION ${bin}/bin
      FILE_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
   add_test(NAME fuzz_sees_${name} COMMAND ${CMAKE_COMMAND}
      "-DCOMMAND=${DYNSPH_BASH};${fuzz};${bin}/bin;fuzz_sees_${name};scenes;${mutants}" -DWORKING_DIRECTORY=${here} -DEXIT_STATUS=1
      "-DEXPECT=FAILED scenes .*${message};repeats it" "-DCREATED=fuzz_sees_${name}/failures" -P ${run_and_expect})
   set_tests_properties(fuzz_sees_${name} PROPERTIES TIMEOUT 120)
endfunction()

sees_fault(crash 10 "kill -SEGV $$" "exit code 139")
sees_fault(silence 10 "exit 1" "exit code 1 without a message")
sees_fault(strange_end 10 "echo no >&2; exit 5" "exit code 5")
sees_fault(trace 10 "echo Backtrace >&2; exit 1" "an error of the run-time library")
sees_fault(unknown_key 10 "cat \"$2\"" "exit code 0")
sees_fault(hang 1 "while :; do :; done" "exit code 137")
