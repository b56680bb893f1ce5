#pragma once

#include <filesystem>

#include "core/result.h"
#include "geometry/triangle_mesh.h"

namespace trocar {

/// Surfaces by ending: .vtp, .stl (binary). LPS mm.
Result<TriangleMesh> read_mesh(const std::filesystem::path& path);
Status write_mesh(const TriangleMesh& mesh_P, const std::filesystem::path& path);

}  // namespace trocar
