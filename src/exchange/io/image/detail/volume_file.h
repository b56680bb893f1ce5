#pragma once

#include <filesystem>

#include "core/result.h"
#include "io/image/detail/itk_image.h"
#include "io/image/detail/raw_volume.h"

namespace trocar::io::detail {

/// A path that must name a file with something in it. Errors: no such file, not a regular file, empty.
Status check_volume_path(const std::filesystem::path& path);

/// Reads a NIfTI, NRRD or MetaImage file as it is, place in LPS mm. Errors of open_image_file().
Result<RawVolume> read_volume_file(const std::filesystem::path& path, Check check = Check::kUnpack,
                                   const std::filesystem::path& inside = {});

/// Writes a volume (one number a voxel) by the path's ending, compressed where asked and the format can, and checks
/// that it is all there: the libraries do not report a full disk. Writes straight to `path`; the caller makes it
/// atomic. Fields only where the format has them (NRRD).
Status write_volume_file(const RawVoxels& voxels, const volume::GridGeometry& geometry,
                         const std::filesystem::path& path, Packing packing = Packing::kCompressed,
                         TextFields fields = {});

}  // namespace trocar::io::detail
