# Third-party libraries, all Debian packages (scripts/packages.txt). The names on the left are those of src/modules.txt.
find_package(Eigen3 REQUIRED)
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
find_package(tl-expected REQUIRED)
find_package(TBB REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(hwy REQUIRED)
find_package(CLI11 REQUIRED)
find_package(PNG REQUIRED)
find_package(GTest REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(xxhash REQUIRED IMPORTED_TARGET libxxhash)
find_library(SOCI_CORE soci_core REQUIRED)
find_library(SOCI_SQLITE3 soci_sqlite3 REQUIRED)
find_path(SOCI_INCLUDE soci/soci.h REQUIRED)
find_package(VTK REQUIRED COMPONENTS CommonCore CommonDataModel FiltersCore FiltersGeneral IOXML IOGeometry
  ImagingCore RenderingCore RenderingOpenGL2 RenderingVolumeOpenGL2 InteractionStyle IOImage)
find_package(ITK REQUIRED COMPONENTS ITKIOImageBase ITKIONIFTI ITKIONRRD ITKIOMeta ITKIOGDCM ITKIOTransformBase
  ITKIOTransformInsightLegacy ITKTransform ITKCommon)

add_library(trocar_soci INTERFACE)
target_include_directories(trocar_soci SYSTEM INTERFACE ${SOCI_INCLUDE})
target_link_libraries(trocar_soci INTERFACE ${SOCI_CORE} ${SOCI_SQLITE3})

# ITK's own use file adds a non-system include path to all later targets.
add_library(trocar_itk INTERFACE)
target_include_directories(trocar_itk SYSTEM INTERFACE ${ITK_INCLUDE_DIRS})
target_link_libraries(trocar_itk INTERFACE ${ITK_LIBRARIES})

set(trocar_library_expected tl::expected)
set(trocar_library_spdlog spdlog::spdlog)
set(trocar_library_xxhash PkgConfig::xxhash)
set(trocar_library_tbb TBB::tbb)
set(trocar_library_toml++ "")
set(trocar_library_json nlohmann_json::nlohmann_json)
set(trocar_library_highway hwy::hwy)
set(trocar_library_vtk-filters VTK::CommonCore VTK::CommonDataModel VTK::FiltersCore VTK::FiltersGeneral)
set(trocar_library_vtk-io VTK::CommonCore VTK::CommonDataModel VTK::IOXML VTK::IOGeometry)
set(trocar_library_vtk-rendering VTK::CommonCore VTK::CommonDataModel VTK::RenderingCore VTK::RenderingOpenGL2
    VTK::FiltersCore VTK::FiltersGeneral)
set(trocar_library_itk trocar_itk)
set(trocar_library_png PNG::PNG)
set(trocar_library_soci trocar_soci)
