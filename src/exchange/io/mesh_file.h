#pragma once

#include <filesystem>

#include "core/result.h"
#include "geometry/triangle_mesh.h"

namespace trocar::io {

/// Surfaces by ending: .vtp, .stl (binary written, text read too). LPS mm; polygons become triangles. Errors: no
/// surface, damaged or cut, no triangle, a vertex that is not a number; with `inside`, a file outside of that folder.
Result<TriangleMesh> read_mesh(const std::filesystem::path& path, const std::filesystem::path& inside = {});
Status write_mesh(const TriangleMesh& mesh_P, const std::filesystem::path& path);

}  // namespace trocar::io
