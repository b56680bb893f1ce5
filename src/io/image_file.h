#pragma once

#include <filesystem>

#include "core/result.h"
#include "volume/grid.h"

namespace trocar {

/// Reads a 3D CT: NIfTI, NRRD, MHA/MHD, one DICOM series (a folder, JPEG 2000 included; slice step from positions).
/// Result in LPS mm, HU rounded to int16; RAS files are turned, mirrored grids re-ordered. Refused with a clear
/// message: no image, truncated, 4D, empty, NaN or infinite voxels, values outside int16, uneven slice steps, gantry
/// tilt, more than one series in a folder.
Result<CtGrid> read_ct(const std::filesystem::path& path);

/// Reads a label volume or a mask: the same formats, .seg.nrrd and DICOM mask series included. Values 0..255.
Result<LabelGrid> read_labels(const std::filesystem::path& path);

/// A float volume (distance fields, float NIfTI).
Result<FloatGrid> read_float(const std::filesystem::path& path);

/// Writes by ending: .nrrd .nii .nii.gz .mha; compressed where the format can; whole or not at all.
Status write_image(const CtGrid& grid, const std::filesystem::path& path);
Status write_image(const LabelGrid& grid, const std::filesystem::path& path);
Status write_image(const FloatGrid& grid, const std::filesystem::path& path);

}  // namespace trocar
