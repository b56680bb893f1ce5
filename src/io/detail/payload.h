#pragma once

#include <cstdint>
#include <filesystem>

#include "core/result.h"

namespace trocar::detail {

/// The image formats, told by the file's ending.
enum class ImageFormat { kNifti, kNrrd, kMeta };

/// Format of a path by its ending (.nii .nii.gz .nrrd .nhdr .mha .mhd, any case). Errors: another ending.
Result<ImageFormat> find_image_format(const std::filesystem::path& path);

/// How closely compressed voxels are looked at before they are read.
enum class Check {
  kUnpack,  ///< Unpacked once, check sums included.
  kSize     ///< Only whether they could be enough: for files whose content hash is compared afterwards.
};

/// Holds a header against its file before anything is allocated: a header of the format, one 3D volume of possible
/// size, and as many bytes as it promises. The libraries behind ITK do not all do this. Errors name what is wrong and
/// the file.
Status check_image_file(const std::filesystem::path& path, ImageFormat format, Check check = Check::kUnpack);

}  // namespace trocar::detail
