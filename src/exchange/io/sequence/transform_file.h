#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "core/result.h"
#include "geometry/pose.h"
#include "volume/spline_field.h"

namespace trocar::io {

/// Reads a rigid ITK transform (.tfm, LPS mm). A file of X_AB maps points of B to A; for example, X_PT maps points of
/// the tool T to P. Any linear ITK type is read, including its centre of rotation; the writer writes an affine
/// transform. Errors: no transform, several transforms, not finite, not rigid within 1e-4.
Result<Pose> read_transform(const std::filesystem::path& path);
/// Named notes of a transform file in addition to its pose; readers of ITK skip these comment lines.
using TransformNotes = std::map<std::string, std::string>;
Status write_transform(const Pose& X_AB, const std::filesystem::path& path, const TransformNotes& notes = {});
/// The notes of a file that write_transform wrote ("# trocar depth_mm = 150"); empty for files of other programs.
Result<TransformNotes> read_transform_notes(const std::filesystem::path& path);

/// Writes an ITK composite transform (.tfm, LPS mm) that maps p of B to X_AB * (p + u(p)): a B-spline, then an affine
/// transform. Other programs read it; read_transform reads single linear transforms only.
Status write_deformation(const Pose& X_AB, const volume::SplineField& field_B, const std::filesystem::path& path);

}  // namespace trocar::io
