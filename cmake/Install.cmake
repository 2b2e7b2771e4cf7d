# cmake --install: programs, what they are run with, and what there is to read. Everything finds its like from where it stands,
# so that the whole may be moved.
#
#    bin/                  programs, dynsph-draw for pictures, dynsph-animate
#    share/dynsph/input/   scenes, and in reference/ what was measured
#    share/dynsph/plots/   the scripts behind these two
#    share/dynsph/         check_paraview.py
#    share/doc/dynsph/     README.md, LICENSE, docs/
include(GNUInstallDirs)

set(programs dynsph dynsph-snapshot-to-text dynsph-spectra dynsph-stability dynsph-bench)
# HDF5 and FFTW may be where the system does not look, as behind `module load`.
set_target_properties(${programs} PROPERTIES INSTALL_RPATH_USE_LINK_PATH ON)
install(TARGETS ${programs} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})

set(data ${CMAKE_INSTALL_DATADIR}/dynsph)
install(DIRECTORY input DESTINATION ${data} FILES_MATCHING PATTERN *.nml PATTERN *.csv PATTERN *.txt)
install(DIRECTORY utils/plots DESTINATION ${data} FILES_MATCHING PATTERN *.gp PATTERN *.bash PATTERN *.awk)
install(PROGRAMS utils/plots/draw utils/plots/animate DESTINATION ${data}/plots)
install(PROGRAMS utils/check_paraview.py DESTINATION ${data})
foreach(script draw animate)
   file(RELATIVE_PATH path ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_DATADIR}/dynsph/plots/${script})
   file(CREATE_LINK ${path} ${PROJECT_BINARY_DIR}/generated/dynsph-${script} SYMBOLIC)
   install(FILES ${PROJECT_BINARY_DIR}/generated/dynsph-${script} DESTINATION ${CMAKE_INSTALL_BINDIR})
endforeach()

install(FILES README.md CHANGELOG.md CITATION.cff LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR})
