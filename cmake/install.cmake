# What `cmake --install` writes: the programs, their data, and every module as a library for other projects, by
#   find_package(trocar REQUIRED)
#   target_link_libraries(program PRIVATE trocar::haptics)
# A module's headers lie in include/trocar/TIER/MODULE, and are included as "MODULE/file.h" as here.
# Each component becomes one Debian package (cmake/package.cmake): trocar, hapticd, trainer, dev.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/trocar)
install(TARGETS trocar RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT trocar)
install(TARGETS trocar-hapticd RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT hapticd)
install(TARGETS trocar-trainer RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT trainer)
install(DIRECTORY data/ DESTINATION ${CMAKE_INSTALL_DATADIR}/trocar COMPONENT trocar PATTERN README.md EXCLUDE)
install(FILES README.md CHANGELOG.md LICENSE NOTICE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT trocar)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT trocar)

get_property(modules GLOBAL PROPERTY trocar_modules)
foreach(name IN LISTS modules)
  get_property(tier GLOBAL PROPERTY trocar_tier_${name})
  get_property(needed GLOBAL PROPERTY trocar_needed_by_${name})
  string(APPEND needed_libraries "set(trocar_needed_by_${name} ${needed})\n")
  list(APPEND all_needed ${needed})
  set_target_properties(trocar_${name} PROPERTIES EXPORT_NAME ${name})
  install(TARGETS trocar_${name} EXPORT trocar ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev
    FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/trocar/${tier} COMPONENT dev)
endforeach()
install(EXPORT trocar NAMESPACE trocar:: FILE trocarTargets.cmake DESTINATION ${package_folder} COMPONENT dev)

configure_package_config_file(cmake/trocarConfig.cmake.in ${CMAKE_BINARY_DIR}/trocarConfig.cmake
  INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/trocarConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/trocarConfig.cmake ${CMAKE_BINARY_DIR}/trocarConfigVersion.cmake
  cmake/libraries.cmake DESTINATION ${package_folder} COMPONENT dev)

include(package)
