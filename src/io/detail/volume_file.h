#pragma once

#include <filesystem>

#include "core/result.h"
#include "io/detail/raw_volume.h"

namespace trocar::detail {

/// Reads a NIfTI, NRRD or MetaImage file as it is, place in LPS mm.
Result<RawVolume> read_volume_file(const std::filesystem::path& path);

/// Writes a volume (one number a voxel) by the path's ending, compressed where the format can, and checks that it is
/// all there: the libraries do not report a full disk. Writes straight to `path`; the caller makes it atomic.
Status write_volume_file(const RawVoxels& voxels, const GridGeometry& geometry, const std::filesystem::path& path);

}  // namespace trocar::detail
