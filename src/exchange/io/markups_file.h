#pragma once

#include <filesystem>
#include <string>
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
/// A curve or list of points, as drawn.
struct MarkupPoints {
  std::string name;      ///< The markup's.
  bool is_list = false;  ///< Fiducials: each point stands for itself.
  std::vector<Vec3> points_P;
};
/// Open curves, lines and fiducials with their control points, in the file's order. Errors: those of the file; a curve
/// or line with fewer than two placed points; nothing of the three kinds.
Result<std::vector<MarkupPoints>> read_markup_points(const std::filesystem::path& path);
Status write_paths(const std::vector<anatomy::NeedlePath>& paths, const std::filesystem::path& path);

}  // namespace trocar::io
