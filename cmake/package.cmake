# Debian packages from the install rules, one a component, by `cpack -G DEB`: scripts/package builds what they hold first.
include(package_dependencies)

set(packaging ${PROJECT_SOURCE_DIR}/packaging)
set(made ${CMAKE_BINARY_DIR}/package)

# Man pages and completion: what the programs say of themselves, so the target is not part of a plain build.
set(page_trocar trocar)
set(page_hapticd trocar-hapticd)
set(page_trainer trocar-trainer)
foreach(component IN ITEMS trocar hapticd trainer)
  set(page ${made}/${page_${component}}.1.gz)
  add_custom_command(OUTPUT ${page} DEPENDS ${page_${component}} ${PROJECT_SOURCE_DIR}/scripts/man_pages VERBATIM
    COMMAND ${PROJECT_SOURCE_DIR}/scripts/man_pages --version ${PROJECT_VERSION} $<TARGET_FILE:${page_${component}}> ${page})
  list(APPEND made_files ${page})
  install(FILES ${page} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT ${component} OPTIONAL)
endforeach()
set(completion ${made}/completion/trocar)
add_custom_command(OUTPUT ${completion} DEPENDS trocar VERBATIM
  COMMAND ${CMAKE_COMMAND} -E make_directory ${made}/completion
  COMMAND ${CMAKE_COMMAND} -E env TROCAR_DATA_DIR=${PROJECT_SOURCE_DIR}/data $<TARGET_FILE:trocar> completion bash > ${completion})
set(changelog ${made}/changelog.gz)
add_custom_command(OUTPUT ${changelog} DEPENDS ${PROJECT_SOURCE_DIR}/CHANGELOG.md VERBATIM
  COMMAND gzip -9nc ${PROJECT_SOURCE_DIR}/CHANGELOG.md > ${changelog})
add_custom_target(package_files DEPENDS ${made_files} ${completion} ${changelog} trocar trocar-hapticd trocar-trainer)
install(FILES ${completion} DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT trocar OPTIONAL)

install(FILES ${packaging}/postgresql_roles.sql DESTINATION ${CMAKE_INSTALL_DOCDIR}/packaging COMPONENT trocar)
install(FILES ${packaging}/trocar-trainer.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications COMPONENT trainer)
install(FILES ${packaging}/trocar-trainer.svg DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps COMPONENT trainer)
install(FILES ${packaging}/70-trocar.rules DESTINATION lib/udev/rules.d COMPONENT hapticd)
# /etc belongs to the prefix /usr only; elsewhere the limits lie where an administrator finds them.
install(CODE "
  set(etc \"\${CMAKE_INSTALL_PREFIX}/etc\")
  if(CMAKE_INSTALL_PREFIX STREQUAL \"/usr\")
    set(etc /etc)
  endif()
  file(INSTALL \"${packaging}/trocar.conf\" DESTINATION \"\${etc}/security/limits.d\")" COMPONENT hapticd)

set(CPACK_PACKAGE_NAME trocar)
set(CPACK_PACKAGE_VENDOR "Trocar maintainers")
set(CPACK_PACKAGE_CONTACT "Trocar maintainers <maintainers@trocar.invalid>")
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_GENERATOR DEB)
set(CPACK_COMPONENTS_ALL trocar hapticd trainer dev)
set(CPACK_STRIP_FILES ON)
set(CPACK_SET_DESTDIR ON)
set(CPACK_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_THREADS 0)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(same_version "(= ${PROJECT_VERSION})")

set(CPACK_DEBIAN_TROCAR_PACKAGE_NAME trocar)
set(CPACK_DEBIAN_TROCAR_PACKAGE_SECTION science)
set(CPACK_DEBIAN_TROCAR_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_TROCAR_PACKAGE_SUGGESTS "trocar-trainer, xvfb, xauth")
set(CPACK_DEBIAN_TROCAR_DESCRIPTION "simulator for needle punctures: command line and data
Trocar turns a CT and its segmentation into a virtual patient, computes
the forces, ultrasound and X-ray images of a needle puncture, and records
and scores every attempt. It is for training and research, and not a
medical device.

This package holds the command line and the tables of all programs.")

set(CPACK_DEBIAN_HAPTICD_PACKAGE_NAME trocar-hapticd)
set(CPACK_DEBIAN_HAPTICD_PACKAGE_SECTION science)
set(CPACK_DEBIAN_HAPTICD_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_HAPTICD_PACKAGE_DEPENDS "trocar ${same_version}, adduser")
set(CPACK_DEBIAN_HAPTICD_PACKAGE_SUGGESTS spacenavd)
set(CPACK_DEBIAN_HAPTICD_PACKAGE_CONTROL_EXTRA
  "${packaging}/debian/postinst;${packaging}/debian/postrm;${packaging}/debian/conffiles")
set(CPACK_DEBIAN_HAPTICD_DESCRIPTION "simulator for needle punctures: haptic server
The server computes the forces of a needle puncture at 1 to 4 kHz for
one haptic device, real or simulated. The package also holds access
rules for devices, and real-time limits for the members of the group
trocar.")

set(CPACK_DEBIAN_TRAINER_PACKAGE_NAME trocar-trainer)
set(CPACK_DEBIAN_TRAINER_PACKAGE_SECTION science)
set(CPACK_DEBIAN_TRAINER_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_TRAINER_PACKAGE_DEPENDS "trocar ${same_version}, trocar-hapticd ${same_version}")
set(CPACK_DEBIAN_TRAINER_PACKAGE_RECOMMENDS "qttranslations5-l10n")
set(CPACK_DEBIAN_TRAINER_DESCRIPTION "simulator for needle punctures: trainer's window
The window in which a trainee performs a puncture on a virtual patient by
mouse, keyboard or haptic device, with ultrasound, X-ray, slices, a 3D
view, forces, feedback and replay.")

list(JOIN trocar_dev_packages ", " dev_packages)
set(CPACK_DEBIAN_DEV_PACKAGE_NAME libtrocar-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "${dev_packages}")
set(CPACK_DEBIAN_DEV_PACKAGE_RECOMMENDS "trocar ${same_version}")
set(CPACK_DEBIAN_DEV_DESCRIPTION "simulator for needle punctures: libraries and headers
Every module of Trocar as a static library, with its headers and the
files of find_package(trocar) of CMake.")

foreach(component IN LISTS CPACK_COMPONENTS_ALL)
  string(TOUPPER ${component} upper)
  set(folder ${CMAKE_INSTALL_DATADIR}/doc/${CPACK_DEBIAN_${upper}_PACKAGE_NAME})
  install(FILES ${packaging}/copyright DESTINATION ${folder} COMPONENT ${component})
  install(FILES ${changelog} DESTINATION ${folder} COMPONENT ${component} OPTIONAL)
endforeach()
include(CPack)
