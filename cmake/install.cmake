# cmake --install: the program, the libraries, their headers, and a package for find_package(Clerestory).
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

add_library(clerestory_clerestory INTERFACE)
add_library(clerestory::clerestory ALIAS clerestory_clerestory)
target_link_libraries(clerestory_clerestory INTERFACE
  clerestory::model clerestory::solver clerestory::meshing clerestory::io clerestory::pipeline)

set(libraries clerestory_clerestory clerestory_model clerestory_solver clerestory_meshing clerestory_io
  clerestory_pipeline)
foreach(library ${libraries})
  string(REPLACE "clerestory_" "" name ${library})
  set_target_properties(${library} PROPERTIES EXPORT_NAME ${name})
endforeach()
# The warnings go along because static libraries name all they were linked with; they bind nobody else.
install(TARGETS ${libraries} clerestory_warnings EXPORT ClerestoryTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS clerestory_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(TARGETS clerestory_images clerestory_hdf5 LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/clerestory)
# What reads IFC, with the licence of web-ifc; nothing when it was not there to build with.
install(DIRECTORY ${PROJECT_BINARY_DIR}/${CMAKE_INSTALL_DATADIR}/clerestory/ifc
  DESTINATION ${CMAKE_INSTALL_DATADIR}/clerestory OPTIONAL)
# What pages are made with, with the licence of three.js.
install(DIRECTORY ${PROJECT_BINARY_DIR}/${CMAKE_INSTALL_DATADIR}/clerestory/page
  DESTINATION ${CMAKE_INSTALL_DATADIR}/clerestory)

install(FILES data/paraview/clerestory_view.py DESTINATION ${CMAKE_INSTALL_DATADIR}/clerestory/paraview)

# The doors, not what is behind them: these headers need the standard library only.
set(include_dir ${CMAKE_INSTALL_INCLUDEDIR}/clerestory)
install(DIRECTORY solver DESTINATION ${include_dir} FILES_MATCHING PATTERN "*.h")
install(FILES ${PROJECT_BINARY_DIR}/generated/solver/model/version.h DESTINATION ${include_dir}/solver/model)
install(FILES pipeline/at_time.h pipeline/collect_around.h pipeline/observer.h pipeline/settings.h pipeline/solved.h pipeline/solve_scene.h
  DESTINATION ${include_dir}/pipeline)
install(FILES meshing/build_patches.h meshing/make_lightmap.h DESTINATION ${include_dir}/meshing)
install(FILES io/atomic_file.h io/moment.h io/read_scene.h io/read_sensors.h io/write_result.h io/write_sensors.h io/run_report.h
  DESTINATION ${include_dir}/io)
install(FILES io/formats/epw.h io/formats/weather_year.h DESTINATION ${include_dir}/io/formats)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/Clerestory)
install(EXPORT ClerestoryTargets NAMESPACE clerestory:: DESTINATION ${package_dir})
configure_package_config_file(cmake/ClerestoryConfig.cmake.in ${PROJECT_BINARY_DIR}/ClerestoryConfig.cmake
  INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/ClerestoryConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/ClerestoryConfig.cmake ${PROJECT_BINARY_DIR}/ClerestoryConfigVersion.cmake
  DESTINATION ${package_dir})
