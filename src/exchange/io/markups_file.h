#pragma once

#include <filesystem>
#include <vector>

#include "anatomy/patient.h"
#include "core/result.h"

namespace trocar {

/// 3D Slicer markups (.mrk.json, schema 1.0.x), LPS or RAS inside, LPS mm in memory. Landmarks are the control points
/// of fiducial markups; points that were never placed are left out. Errors: other units or frames, no usable position;
/// with `inside`, a file outside of that folder.
Result<std::vector<Landmark>> read_landmarks(const std::filesystem::path& path,
                                             const std::filesystem::path& inside = {});
Status write_landmarks(const std::vector<Landmark>& landmarks, const std::filesystem::path& path);
/// Paths are line markups: control point 1 the entry, 2 the target.
Result<std::vector<NeedlePath>> read_paths(const std::filesystem::path& path, const std::filesystem::path& inside = {});
Status write_paths(const std::vector<NeedlePath>& paths, const std::filesystem::path& path);

}  // namespace trocar
