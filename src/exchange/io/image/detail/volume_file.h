#pragma once

#include <filesystem>

#include "core/result.h"
#include "io/image/detail/itk_image.h"
#include "io/image/detail/raw_volume.h"

namespace trocar::io::detail {

/// Checks that a path names a file that is not empty. Errors: no such file, not a regular file, empty.
Status check_volume_path(const std::filesystem::path& path);

/// Reads a NIfTI, NRRD or MetaImage file without conversion, geometry in LPS mm. Errors: those of open_image_file().
Result<RawVolume> read_volume_file(const std::filesystem::path& path, Check check = Check::kUnpack,
                                   const std::filesystem::path& inside = {});

/// Writes a volume (one number per voxel) in the format of the path's ending, compressed if requested and supported.
/// Checks that the file is complete: the libraries do not report a full disk. Writes directly to `path`; the caller
/// makes it atomic. Fields are written only in formats that have them (NRRD).
Status write_volume_file(const RawVoxels& voxels, const volume::GridGeometry& geometry,
                         const std::filesystem::path& path, Packing packing = Packing::kCompressed,
                         TextFields fields = {});

}  // namespace trocar::io::detail
