# What prints and runs nothing, and the programs that go on with results: readers, spectra, pictures, stability, margins.

# What prints and runs nothing. prints(name lines "message" arguments...)
function(prints name lines message)
   add_test(NAME ${name} COMMAND ${CMAKE_COMMAND} "-DCOMMAND=$<TARGET_FILE:dynsph>;${ARGN}" -DWORKING_DIRECTORY=${here}/${name}
      -DEXIT_STATUS=0 -DLINES=${lines} "-DEXPECT=${message}" -P ${leave_nothing})
   set_tests_properties(${name} PROPERTIES TIMEOUT 30)
endfunction()

prints(check_runs_nothing any "particles +28800;nothing was run" --check ${dam_break})
prints(check_of_still_tank any "particles +800;nothing was run" --check --output result ${scenes}/still_tank.nml)
prints(check_of_auto any "particles +800;preliminary runs at d/dx = 5 find it;nothing was run" --check --set fluid.reference_speed=auto ${scenes}/still_tank.nml)
# The viscous limit is told, not refused; all warnings about the input are shown.
prints(check_of_stiff_viscosity any "viscous limit dt <= 0.0625 h..2/nu.*times as many steps;both act;c_s has no effect;above 0.1;nothing was run"
   --check --set fluid.viscosity=1 --set fluid.mach=0.2 --set model.c_s=0.1 ${scenes}/still_tank.nml)
file(GLOB scene_files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/input/*.nml)
foreach(scene_file IN LISTS scene_files)
   get_filename_component(scene_name ${scene_file} NAME_WE)
   prints(${scene_name}_is_valid any "is valid. nothing was run" --check ${scene_file})
   add_test(NAME ${scene_name}_has_a_short_form COMMAND ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:dynsph> -DSCENE=${scene_file} -DLINES=14
      -DDIRECTORY=${here}/short_form/${scene_name} -P ${scenes}/short_form.cmake)
   set_tests_properties(${scene_name}_has_a_short_form PROPERTIES TIMEOUT 60)
endforeach()
prints(version_is_said any "dynsph ${PROJECT_VERSION} .*GCC" --version)
prints(help_is_said any "Usage: dynsph;--overwrite;Exit codes" --help)

add_test(NAME template_is_valid COMMAND ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:dynsph> -DSCRATCH=${here}/template.nml
   "-DVALUES=scene.resolution=10|domain.upper=2.0, 1.5|fluid.sound_speed=10.0|body.lower=0.0, 0.0|body.upper=1.0, 1.0|time.end_time=1.0|solid.name='lid'|solid.vertices=1.2, 0.9, 3.0, 0.9, 3.0, 2.0, 1.2, 2.0|sponge.lower=0.5, 0.0|sponge.upper=1.0, 1.0|sponge.rate=1.0|probe.name='P1'|probe.position=2.0, 0.1|gauge.name='H1'|gauge.at=1.0"
   -P ${scenes}/check_template.cmake)
add_test(NAME input_page_is_up_to_date COMMAND ${CMAKE_COMMAND} "-DCOMMAND=$<TARGET_FILE:dynsph>;--keys"
   -DFILE=${PROJECT_SOURCE_DIR}/docs/input.md -DSCRATCH=${here}/input.md -P ${scenes}/same_output.cmake)
set_tests_properties(template_is_valid input_page_is_up_to_date PROPERTIES TIMEOUT 30)

# A scene from a pipe.
add_test(NAME scene_from_a_pipe COMMAND ${CMAKE_COMMAND}
   "-DCOMMAND=sh;-c;cat ${scenes}/still_layers.nml | $<TARGET_FILE:dynsph> --check /dev/stdin"
   -DWORKING_DIRECTORY=${here} -DEXIT_STATUS=0 "-DEXPECT=is valid. nothing was run" -P ${run_and_expect})
set_tests_properties(scene_from_a_pipe PROPERTIES TIMEOUT 30)

# ParaView's own reader and h5py see in the snapshots what docs/files.md says. Python of the system: its vtk and h5py.
add_test(NAME paraview_reads_snapshots COMMAND sh -c
   "/usr/bin/python3 -c 'import vtkmodules.vtkIOHDF, h5py' 2>/dev/null || { echo 'no python3 with vtk and h5py'; exit 77; }; exec /usr/bin/python3 '${PROJECT_SOURCE_DIR}/utils/check_paraview.py' --particles 20000 '${here}/dam_break'/snapshot_*.vtkhdf")
set_tests_properties(paraview_reads_snapshots PROPERTIES SKIP_RETURN_CODE 77 FIXTURES_REQUIRED dam_break_result TIMEOUT 60)

# Spectra of its probes, after the impact; a second time they would be replaced.
add_test(NAME probe_spectrum_is_made COMMAND ${CMAKE_COMMAND}
   "-DCOMMAND=$<TARGET_FILE:dynsph-spectra>;probe;dam_break/probes.dat;--from;7;--above=50;--segment;1;--sound-speed;10;--length;5.366;--height;1"
   -DWORKING_DIRECTORY=${here} -DEXIT_STATUS=0 "-DEXPECT=segments of .* degrees of freedom;above 50;P1 .* %;c0/.2H. = 5\n"
   "-DREJECT=NaN;warning" "-DCREATED=dam_break/probe_spectrum.dat" "-DNOT_CREATED=dam_break/probe_spectrum.dat.partial"
   -P ${run_and_expect})
set_tests_properties(probe_spectrum_is_made PROPERTIES FIXTURES_REQUIRED dam_break_result FIXTURES_SETUP probe_spectrum TIMEOUT 30)
# The acoustic modes of the box are those of the table's head: 10/(2*5.3667) and 10/2.
add_test(NAME probe_spectrum_knows_the_box COMMAND ${CMAKE_COMMAND}
   "-DCOMMAND=$<TARGET_FILE:dynsph-spectra>;probe;one_thread/probes.dat" -DWORKING_DIRECTORY=${here} -DEXIT_STATUS=0
   "-DEXPECT=c0/.2L. = 0.9317\n;c0/.2H. = 5\n" "-DCREATED=one_thread/probe_spectrum.dat" -P ${run_and_expect})
set_tests_properties(probe_spectrum_knows_the_box PROPERTIES FIXTURES_REQUIRED thread_results TIMEOUT 30)
add_test(NAME vorticity_spectrum_is_made COMMAND ${CMAKE_COMMAND}
   "-DCOMMAND=$<TARGET_FILE:dynsph-spectra>;vorticity;--field;dam_break/snapshot_000003.vtkhdf;dam_break/snapshot_000009.vtkhdf"
   -DWORKING_DIRECTORY=${here} -DEXIT_STATUS=0 "-DEXPECT= 9.00.*dam_break/snapshot_000009.vtkhdf" "-DREJECT=NaN;warning"
   "-DCREATED=dam_break/vorticity_spectrum_000003.dat;dam_break/vorticity_spectrum_000009.dat;dam_break/vorticity_field_000009.dat"
   -P ${run_and_expect})
set_tests_properties(vorticity_spectrum_is_made PROPERTIES FIXTURES_REQUIRED dam_break_result TIMEOUT 60)
add_test(NAME probe_spectrum_is_not_replaced COMMAND ${CMAKE_COMMAND}
   "-DCOMMAND=$<TARGET_FILE:dynsph-spectra>;probe;dam_break/probes.dat" -DWORKING_DIRECTORY=${here} -DEXIT_STATUS=1
   "-DEXPECT=dam_break/probe_spectrum.dat' is there already. --overwrite" "-DREJECT=Backtrace" -P ${run_and_expect})
set_tests_properties(probe_spectrum_is_not_replaced PROPERTIES FIXTURES_REQUIRED "dam_break_result;probe_spectrum" TIMEOUT 30)
add_test(NAME probe_spectrum_helps COMMAND ${CMAKE_COMMAND}
   "-DCOMMAND=$<TARGET_FILE:dynsph-spectra>;probe;--help" -DWORKING_DIRECTORY=${here} -DEXIT_STATUS=0
   "-DEXPECT=usage: dynsph-spectra probe;--overlap X;--help  *this text;example:" -P ${run_and_expect})

# The pictures get drawn.
add_test(NAME pictures_are_drawn COMMAND ${CMAKE_COMMAND} -DDRAW=${PROJECT_SOURCE_DIR}/utils/plots/draw
   -DBIN=$<TARGET_FILE_DIR:dynsph> -DRESULT=${here}/dam_break -DBYTES=10000
   "-DPICTURES=energy.png;dissipation.png;energy_balance.png;probes.png;probe_spectrum.png;field_first.png;field_middle.png;field_last.png"
   -P ${scenes}/check_pictures.cmake)
set_tests_properties(pictures_are_drawn PROPERTIES SKIP_REGULAR_EXPRESSION "SKIPPED:"
   FIXTURES_REQUIRED "dam_break_result;probe_spectrum" TIMEOUT 60)
add_test(NAME pictures_are_drawn_whatever_the_name COMMAND ${CMAKE_COMMAND} -DDRAW=${PROJECT_SOURCE_DIR}/utils/plots/draw
   -DBIN=${PROJECT_BINARY_DIR}/bin "-DRESULT=${here}/ it's blank" -DBYTES=5000 "-DPICTURES=energy.png;dissipation.png"
   -P ${scenes}/check_pictures.cmake)
set_tests_properties(pictures_are_drawn_whatever_the_name PROPERTIES SKIP_REGULAR_EXPRESSION "SKIPPED:" FIXTURES_REQUIRED early_result
   TIMEOUT 60)
add_test(NAME other_fields_are_drawn COMMAND ${CMAKE_COMMAND} -DDRAW=${PROJECT_SOURCE_DIR}/utils/plots/draw
   -DBIN=$<TARGET_FILE_DIR:dynsph> -DRESULT=${here}/one_thread_dynamic -DBYTES=10000
   "-DPICTURES=energy.png;field_last.png;more_first.png;more_middle.png;more_last.png" -P ${scenes}/check_pictures.cmake)
set_tests_properties(other_fields_are_drawn PROPERTIES SKIP_REGULAR_EXPRESSION "SKIPPED:"
   FIXTURES_REQUIRED dynamic_thread_results TIMEOUT 60)

# All snapshots as an animation.
function(animates test fixture result)
   add_test(NAME ${test} COMMAND ${CMAKE_COMMAND} -DANIMATE=${PROJECT_SOURCE_DIR}/utils/plots/animate -DBIN=${PROJECT_BINARY_DIR}/bin
      "-DRESULT=${here}/${result}" "-DFIELDS=${ARGN}" -P ${scenes}/check_animation.cmake)
   set_tests_properties(${test} PROPERTIES SKIP_REGULAR_EXPRESSION "SKIPPED:" FIXTURES_REQUIRED ${fixture} TIMEOUT 60)
endfunction()
animates(animation_is_made dynamic_thread_results one_thread_dynamic)
animates(animation_is_made_whatever_the_name early_result " it's blank" pressure velocity_x)

add_test(NAME snapshot_has_its_title COMMAND ${CMAKE_COMMAND}
   "-DCOMMAND=$<TARGET_FILE:dynsph-snapshot-to-text>;taylor_green/snapshot_000000.vtkhdf"
   -DWORKING_DIRECTORY=${here} -DEXIT_STATUS=0 "-DEXPECT=# title: Taylor-Green vortices\n" -P ${run_and_expect})
set_tests_properties(snapshot_has_its_title PROPERTIES FIXTURES_REQUIRED taylor_green_result TIMEOUT 30)

# What cmake --install makes works, wherever it is moved to.
add_test(NAME installed_programs_work COMMAND ${CMAKE_COMMAND} -DBUILD=${PROJECT_BINARY_DIR} -DSOURCE=${PROJECT_SOURCE_DIR}
   -DDIRECTORY=${here}/installed -P ${scenes}/check_install.cmake)
set_tests_properties(installed_programs_work PROPERTIES TIMEOUT 60)

# dynsph-stability: what its columns do not hold, arguments longer than a number is as a rule, an edge that was not found.
function(stability_says test status lines message reject)
   add_test(NAME ${test} COMMAND ${CMAKE_COMMAND}
      "-DCOMMAND=${CMAKE_COMMAND};-E;env;OMP_NUM_THREADS=1;$<TARGET_FILE:dynsph-stability>;${ARGN}"
      -DWORKING_DIRECTORY=${here}/${test} -DEXIT_STATUS=${status} -DLINES=${lines} "-DEXPECT=${message}" "-DREJECT=${reject}"
      -P ${leave_nothing})
   set_tests_properties(${test} PROPERTIES TIMEOUT 60)
endfunction()
stability_says(stability_refuses_a_huge_delta 1 1 "--delta and --alpha must be from 0 to 100" "Infinity" --delta 1e300 --cfl 1)
stability_says(stability_reads_long_numbers 0 2 "   0.0000   0.0000   1.0000" "0.1000 "
   --delta 0.100000000000000000000000000000e-5 --cfl 1)
stability_says(stability_prints_no_edge_it_missed 2 any "the edge is not within 25 %" "0.0625" --integrator rk2)

# dynsph-margins: without margins it is dynsph; with half the one of density diffusion, where that rules the step, it takes twice the
# steps (dt is 0.264 h/c0 at most); what cannot be a margin is refused.
set(margins "${CMAKE_COMMAND};-E;env;OMP_NUM_THREADS=1;$<TARGET_FILE:dynsph-margins>;--quiet;--overwrite")
add_test(NAME margins_in_use_run COMMAND ${CMAKE_COMMAND}
   "-DCOMMAND=${margins};--set;scene.resolution=20;--set;time.max_steps=300;--set;output.energy=1 steps;--set;output.snapshots=100 steps;--set;output.precision=double;--output;margins_in_use;${dam_break}"
   -DWORKING_DIRECTORY=${here} -DEXIT_STATUS=0 "-DCREATED=margins_in_use" -P ${run_and_expect})
set_tests_properties(margins_in_use_run PROPERTIES FIXTURES_SETUP thread_results TIMEOUT 60)
add_test(NAME margins_in_use_are_those_of_dynsph COMMAND ${CMAKE_COMMAND} -DFIRST=${here}/one_thread -DSECOND=${here}/margins_in_use
   "-DFILES=energy.dat;probes.dat;input_used.nml;snapshot_000003.vtkhdf" -P ${scenes}/same_files.cmake)
set_tests_properties(margins_in_use_are_those_of_dynsph PROPERTIES FIXTURES_REQUIRED thread_results TIMEOUT 30)
add_test(NAME half_a_margin_runs COMMAND ${CMAKE_COMMAND}
   "-DCOMMAND=${margins};--diffusion=0.45;--set;scene.resolution=10;--set;model.delta=1;--set;time.end_time=0.2;--output;half_a_margin;${dam_break}"
   -DWORKING_DIRECTORY=${here} -DEXIT_STATUS=0 "-DCREATED=half_a_margin" -P ${run_and_expect})
set_tests_properties(half_a_margin_runs PROPERTIES FIXTURES_SETUP half_a_margin_result TIMEOUT 30)
add_test(NAME half_a_margin_takes_twice_the_steps COMMAND ${CMAKE_COMMAND} -DFILE=${here}/half_a_margin/summary.txt
   "-DRULES=steps|76|78" -P ${scenes}/check_summary.cmake)
set_tests_properties(half_a_margin_takes_twice_the_steps PROPERTIES FIXTURES_REQUIRED half_a_margin_result TIMEOUT 30)
add_test(NAME margins_refuses_no_margin COMMAND ${CMAKE_COMMAND}
   "-DCOMMAND=${margins};--sound;1e-300;--output;no_margin;${dam_break}" -DWORKING_DIRECTORY=${here} -DEXIT_STATUS=1
   "-DEXPECT=dynsph-margins: --sound must be from 0.01 to 1.2; 1 is the limit of a lattice" "-DNOT_CREATED=no_margin"
   -P ${run_and_expect})

# The pair loops are vectorised: a harmless `merge` in one made it three times slower once, and nothing said so.
find_program(DYNSPH_OBJDUMP objdump)
if(DYNSPH_OBJDUMP AND CMAKE_BUILD_TYPE STREQUAL "Release" AND CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
   file(WRITE ${here}/check_vectors "\"$1\" -d --no-show-raw-insn \"$2\" | \"$3\" -v lanes=$4 -f \"$5\"\n")
   add_test(NAME pair_loops_are_vectorised COMMAND sh ${here}/check_vectors ${DYNSPH_OBJDUMP} $<TARGET_FILE:dynsph> ${DYNSPH_AWK}
      ${DYNSPH_LANES_TAKEN} ${scenes}/check_vectors.awk)
endif()
