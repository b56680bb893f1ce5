#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "core/result.h"
#include "geometry/pose.h"

namespace trocar::io {

/// A rigid ITK transform (.tfm, LPS mm): points of the frame named first to the frame named second, so that X_PT as a
/// file maps points of the tool T to P. Any linear ITK type is read, its centre of rotation worked in; written as an
/// affine one. A file that is no transform, several, not finite, or not rigid within 1e-4 is an error.
Result<Pose> read_transform(const std::filesystem::path& path);
/// What a transform file says beside its pose, by name; readers of ITK skip these comment lines.
using TransformNotes = std::map<std::string, std::string>;
Status write_transform(const Pose& X_AB, const std::filesystem::path& path, const TransformNotes& notes = {});
/// The notes of a file that write_transform wrote ("# trocar depth_mm = 150"); none in files of others.
Result<TransformNotes> read_transform_notes(const std::filesystem::path& path);

}  // namespace trocar::io
