#pragma once

#include <filesystem>

#include "core/result.h"
#include "geometry/pose.h"

namespace trocar {

/// A rigid ITK transform (.tfm, LPS mm): points of the frame named first to the frame named second. A file that is no
/// transform, or not rigid within 1e-4, is an error.
Result<Pose> read_transform(const std::filesystem::path& path);
Status write_transform(const Pose& X_AB, const std::filesystem::path& path);

}  // namespace trocar
