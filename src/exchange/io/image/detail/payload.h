#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/files/input_file.h"

namespace trocar::io::detail {

/// The image formats, told by the file's ending.
enum class ImageFormat { kNifti, kNrrd, kMeta };

struct ImageEnding {
  std::string_view text;
  ImageFormat format;
};

/// All endings of image files, in lower case.
inline constexpr std::array kImageEndings{
    ImageEnding{".nii", ImageFormat::kNifti}, ImageEnding{".nii.gz", ImageFormat::kNifti},
    ImageEnding{".nrrd", ImageFormat::kNrrd}, ImageEnding{".nhdr", ImageFormat::kNrrd},
    ImageEnding{".mha", ImageFormat::kMeta},  ImageEnding{".mhd", ImageFormat::kMeta}};

/// Format of a path by its ending, in any case. Errors: another ending.
Result<ImageFormat> find_image_format(const std::filesystem::path& path);

/// File name without the ending of an image file and ".seg": "liver.nii.gz" -> "liver", "liver.seg.nrrd" -> "liver".
std::string image_stem(const std::filesystem::path& path);

/// How closely compressed voxels are looked at before they are read.
enum class Check {
  kUnpack,  ///< Unpacked once, check sums included.
  kSize     ///< Only whether they could be enough: for files whose content hash is compared afterwards.
};

/// An image file whose header was compared with its size.
struct CheckedImage {
  InputFile file;  ///< Header and, unless the header names another file, voxels.
  /// Where a library that opens by name may read it. InputFile::pinned_path() where the library does not look at the
  /// ending and the voxels are in the same file; else the path itself, which could be replaced between the check and
  /// the library's opening.
  std::filesystem::path library_path;
};

/// Compares a header with its file before anything is allocated: a header of the format, one 3D volume of possible
/// size, and as many bytes as it declares. The libraries behind ITK do not all do this. With `inside`
/// (a patient's folder), header and voxels must be one file in that folder. Errors name what is wrong and the file.
Result<CheckedImage> open_image_file(const std::filesystem::path& path, ImageFormat format,
                                     Check check = Check::kUnpack, const std::filesystem::path& inside = {});

}  // namespace trocar::io::detail
