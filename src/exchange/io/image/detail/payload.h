#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/files/input_file.h"

namespace trocar::io::detail {

/// The image formats, selected by the file's ending.
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

/// Extent of the check of compressed voxels before they are read.
enum class Check {
  kUnpack,  ///< The voxels are unpacked once, and their check sums are tested.
  kSize     ///< Only a size check: for files whose content hash is compared afterwards.
};

struct ImageHeader;

/// An image file whose header was compared with its size.
struct CheckedImage {
  InputFile file;  ///< Header and, unless the header names another file, voxels.
  /// Path for a library that opens files by name: InputFile::pinned_path() if the voxels are in the same file; else the
  /// path itself, whose file could be replaced between the check and the library's opening.
  std::filesystem::path library_path;
};

/// Compares a header with its file before anything is allocated: as many bytes as it declares. The libraries behind ITK
/// do not all do this. With `inside` (a patient's folder), header and voxels must be one file. Errors name the defect
/// and the file.
Result<CheckedImage> check_image_file(InputFile file, const ImageHeader& header, Check check,
                                      const std::filesystem::path& inside = {});

/// The same for a path: opens the file and reads its header first (see read_image_header).
Result<CheckedImage> open_image_file(const std::filesystem::path& path, ImageFormat format,
                                     Check check = Check::kUnpack);

/// Type of the numbers that a file stores.
enum class VoxelType { kUInt8, kInt8, kUInt16, kInt16, kUInt32, kInt32, kUInt64, kInt64, kFloat, kDouble };

std::size_t bytes_per_voxel(VoxelType type) noexcept;

}  // namespace trocar::io::detail
