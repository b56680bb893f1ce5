#pragma once

#include <cstddef>
#include <memory>

#include "io/image/detail/image_header.h"

namespace trocar::io::detail {

/// Reads the voxels of a NIfTI file in this machine's byte order, unscaled. Read here and not by ITK, which follows the
/// qform, refuses a shear of 0.02 degrees and NIfTI-2, and turns NaN into 0 (ADR 26). Errors: truncated, damaged (a
/// wrong check sum included), no memory.
Result<std::unique_ptr<std::byte[]>> read_nifti_voxels(const InputFile& file, const ImageHeader& header);

}  // namespace trocar::io::detail
