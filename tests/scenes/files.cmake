# Where something cannot be written: exit code 3, which file, and the reason in the system's own words.

# told(case status EXPECT): a case of files.bash; EXPECT as for run_and_expect.
function(told case status expect)
   add_test(NAME tells_${case} COMMAND ${CMAKE_COMMAND}
      "-DCOMMAND=${CMAKE_COMMAND};-E;env;OMP_NUM_THREADS=1;GOMP_SPINCOUNT=1000;${DYNSPH_BASH};${scenes}/files.bash;${case};$<TARGET_FILE:dynsph>;${scenes}/still_tank.nml"
      -DWORKING_DIRECTORY=${here}/files -DEXIT_STATUS=${status} "-DEXPECT=${expect}" "-DREJECT=Backtrace;At line;dumped;cut"
      -P ${run_and_expect})
   set_tests_properties(tells_${case} PROPERTIES TIMEOUT 60 SKIP_REGULAR_EXPRESSION "SKIPPED:")
endfunction()

# Standard output that is full or closed: what was asked for was not said. A run goes on, and has its results.
set(screen "cannot write to standard output")
foreach(option IN ITEMS keys help template version shortest check)
   told(full_screen_${option} 3 "^${screen}: No space left on device\n$")
   told(closed_screen_${option} 3 "^${screen}: Bad file descriptor\n$")
endforeach()
told(quiet_check 0 "^$")
told(spectra_help 3 "^${screen}: No space left on device\n$")
told(run_full_screen 0 "^warning: ${screen}: No space left on device. the run goes on, and 'run_full_screen/run.log' has what it says\n$")
told(run_closed_screen 0 "^warning: ${screen}: Bad file descriptor. the run goes on, and 'run_closed_screen/run.log' has what it says\n$")
told(run_broken_pipe 0 "^warning: ${screen}: Broken pipe. the run goes on, and 'run_broken_pipe/run.log' has what it says\n$")

# The limit of a file's size.
told(limit_table 3 "^cannot write 'limit_table/energy.dat': File too large\n$")
told(limit_snapshot 3 "^cannot write 'limit_snapshot/snapshot_000000.vtkhdf' .at .*.: File too large\n$")
told(limit_log 3 "cannot write the log 'limit_log/run.log': File too large\n$")
told(limit_text 3 "^cannot write 'limit_text/table.txt': File too large\n$")
told(limit_picture 3 "^draw: cannot write '.*/energy.png': File too large\n$")
told(limit_animation 3 "^animate: cannot write '.*/animation.gif': File too large\n$")

# What has no animation.
told(no_animation 3 "^animate: fewer than two snapshots in 'no_animation': nothing to animate\n$")
told(no_such_field 1 "^animate: not all snapshots of 'no_such_field' have 'x'. nothing'. the last has x y ")

# Few open files, links, a directory that goes away.
told(few_open_files 3 "^cannot write .*'few_open_files/.*: Too many open files\n$")
told(link 0 "the run ended at")
told(link_to_nowhere 3 "^cannot make the directory 'link_to_nowhere': it is a symbolic link that leads nowhere. choose another")
told(link_to_file 3 "^cannot write results to 'link_to_file': it is not a directory")
foreach(way IN ITEMS removed renamed)
   told(${way} 3 "^cannot write '${way}/energy.dat': it was removed or renamed meanwhile\ncannot write '${way}/summary.txt': .*No such file or directory\n$")
endforeach()

# Runs without space say so, leave whole files, and end with the same bits when there is more.
quick_study(full_disks_are_told reliability_disks 120 ", 0 BAD" "BAD:")
