#pragma once

#include <filesystem>

#include "core/result.h"
#include "geometry/shapes.h"

namespace trocar::io {

/// Reads and writes surfaces by ending: .vtp, .stl (written as binary; text is also read). LPS mm; polygons become
/// triangles. Errors: no surface, damaged or truncated, no triangle, a vertex that is not a number; with `inside`, a
/// file outside of that folder.
Result<TriangleMesh> read_mesh(const std::filesystem::path& path, const std::filesystem::path& inside = {});
Status write_mesh(const TriangleMesh& mesh_P, const std::filesystem::path& path);

}  // namespace trocar::io
