# Headers that most files read, compiled once for all of them. Two thirds of the build's time was the reading of headers.
# A file still names every header it uses: the preset `check` builds without this, each header alone.
trocar_find_library(expected)
set(trocar_common_headers <core/result.h> <geometry/pose.h> <Eigen/Core> <Eigen/Geometry> <fmt/format.h> <tl/expected.hpp>
  <algorithm> <array> <atomic> <chrono> <cmath> <cstdint> <filesystem> <functional> <map> <memory> <optional> <set>
  <span> <sstream> <string> <string_view> <tuple> <utility> <variant> <vector>)

# A target whose precompiled header holds the common headers and `ARGN`; targets with the same compile options share it
# by trocar_use_precompiled().
function(trocar_precompile name)
  set(source ${CMAKE_BINARY_DIR}/generated/${name}.cpp)
  file(GENERATE OUTPUT ${source} CONTENT "// Carries the precompiled header.\n")
  add_library(${name} OBJECT ${source})
  target_link_libraries(${name} PRIVATE Eigen3::Eigen fmt::fmt tl::expected trocar_warnings)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/src/foundation)
  target_precompile_headers(${name} PRIVATE ${trocar_common_headers} ${ARGN})
endfunction()

function(trocar_use_precompiled target name)
  target_precompile_headers(${target} REUSE_FROM ${name})
endfunction()
