# The version of what generates patients: a hash of the sources of these modules, of the compiler and of its options. Its
# entries in the cache of patients carry it, so that all programs of a build share them. Run as a script, this file writes
# the source that returns it.
if(CMAKE_SCRIPT_MODE_FILE)
  file(STRINGS ${LIST} files)
  set(all "${MADE_BY}")
  foreach(file IN LISTS files)
    file(SHA256 ${file} hash)
    string(APPEND all ${hash})
  endforeach()
  string(SHA256 version "${all}")
  file(WRITE ${OUT} "#include \"io/patient/detail/maker_version.h\"\n
namespace trocar::io::detail {
std::string_view maker_version() noexcept { return \"${version}\"; }
}  // namespace trocar::io::detail\n")
  return()
endif()

function(trocar_add_maker_version)
  set(files)
  foreach(folder foundation/core foundation/config foundation/geometry foundation/volume patient exchange/io)
    file(GLOB_RECURSE found CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/${folder}/*.h ${PROJECT_SOURCE_DIR}/src/${folder}/*.cpp)
    list(APPEND files ${found})
  endforeach()
  trocar_filter(files EXCLUDE "/(test|testing|fuzz)/")
  if(NOT files)
    message(FATAL_ERROR "no source of the patients' generator was found below ${PROJECT_SOURCE_DIR}/src")
  endif()
  set(list ${CMAKE_BINARY_DIR}/generated/patient_maker_files.txt)
  set(out ${CMAKE_BINARY_DIR}/generated/maker_version.cpp)
  list(JOIN files "\n" lines)
  file(CONFIGURE OUTPUT ${list} CONTENT "${lines}\n")
  string(TOUPPER "${CMAKE_BUILD_TYPE}" type)
  set(made_by "${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION} ${CMAKE_BUILD_TYPE} ${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${type}}")
  add_custom_command(OUTPUT ${out} DEPENDS ${files} ${list} ${CMAKE_CURRENT_FUNCTION_LIST_FILE} VERBATIM
    COMMAND ${CMAKE_COMMAND} -DLIST=${list} -DOUT=${out} "-DMADE_BY=${made_by}" -P ${CMAKE_CURRENT_FUNCTION_LIST_FILE})
  target_sources(trocar_io PRIVATE ${out})
endfunction()
