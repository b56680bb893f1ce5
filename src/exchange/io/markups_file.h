#pragma once

#include <filesystem>
#include <vector>

#include "anatomy/patient.h"
#include "core/result.h"

namespace trocar::io {

/// 3D Slicer markups (.mrk.json, schema 1.0.x), LPS or RAS in the file, LPS mm in memory. Landmarks are the control
/// points of fiducial markups; points without a position are skipped. Errors: other units or frames, no usable
/// position; with `inside`, a file outside of that folder.
Result<std::vector<anatomy::Landmark>> read_landmarks(const std::filesystem::path& path,
                                                      const std::filesystem::path& inside = {});
Status write_landmarks(const std::vector<anatomy::Landmark>& landmarks, const std::filesystem::path& path);
/// Paths are line markups: control point 1 the entry, 2 the target.
Result<std::vector<anatomy::NeedlePath>> read_paths(const std::filesystem::path& path,
                                                    const std::filesystem::path& inside = {});
Status write_paths(const std::vector<anatomy::NeedlePath>& paths, const std::filesystem::path& path);

}  // namespace trocar::io
