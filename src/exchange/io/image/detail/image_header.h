#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/files/input_file.h"
#include "io/image/detail/payload.h"
#include "volume/grid.h"

namespace trocar::io::detail {

inline constexpr const char* kExportAgain = "copy or export the file again";
inline constexpr const char* kSaveIn3dSlicer = "open it in 3D Slicer, check its place, and save it as .nrrd";
inline constexpr std::size_t kChunkBytes = std::size_t{1} << 18;

/// Declaration of the voxels in a header.
struct Payload {
  std::uint64_t offset = 0;           ///< Start of the voxels or of their compressed stream.
  std::uint64_t bytes = 0;            ///< Bytes after unpacking.
  std::uint64_t packed = 0;           ///< Length of the compressed stream, 0 if the header does not declare it.
  bool is_compressed = false;         ///< gzip or zlib.
  bool is_text = false;               ///< Numbers written as text.
  bool is_hex = false;                ///< Text of two digits a byte, without spaces.
  std::uint64_t least_bytes = 0;      ///< Lower limit of the file size: no encoding is shorter. Text only.
  std::filesystem::path data_file{};  ///< The file with the voxels, relative to the header; empty: the header file.
};

/// True if a file holds so much more than its header states that the header cannot be right: half as much again, as
/// where each number has more bytes than stated. A little more behind the voxels is harmless.
constexpr bool is_far_more(std::uint64_t bytes, std::uint64_t stated) noexcept {
  constexpr std::uint64_t kHarmless = 4096;
  return bytes > stated + kHarmless && bytes - stated >= stated / 2;
}
inline constexpr const char* kHoldsMore = "holds far more data than its header states ({} of {} bytes are its voxels)";

/// What the header of an image file states, read by this program: the place of the voxels is taken from here, not from
/// a library. docs/import.md lists what happens where a header contradicts itself.
struct ImageHeader {
  Payload payload;
  /// Index -> P (LPS, mm). R_PV may be mirrored or slightly sheared, see tidy_geometry().
  volume::GridGeometry geometry;
  double slope = 1.0;  ///< Value = stored number * slope + intercept.
  double intercept = 0.0;
  std::vector<std::string> warnings;  ///< Without the name of the file.
  /// False where ITK is known to read another place from a valid header: the two are not compared.
  bool is_place_compared = true;
  VoxelType type = VoxelType::kUInt8;  ///< NIfTI only, as the next ones.
  bool is_swapped = false;             ///< The file's byte order is not this machine's.
  std::string label_table;             ///< XML of an extension that names label numbers (Caret), unread.
};

/// Sets the place of a grid from the affine map index -> P: columns of `axes_P` are steps of one voxel along i, j, k.
/// Errors, at `where`: `name` (of the field) contains NaN or infinity, or has a step of length zero.
Status set_place(const Mat3& axes_P, const Vec3& origin_P, const std::string& name, const std::string& where,
                 volume::GridGeometry& geometry);

/// Largest distance of the same voxel in two grids of one size (mm).
double largest_distance_mm(const volume::GridGeometry& a, const volume::GridGeometry& b);

/// Opens the file that a header names for its voxels. Errors: an absolute path, a path that leaves the header's folder
/// (".." or a symbolic link), and those of InputFile.
Result<InputFile> open_data_file(const std::filesystem::path& header, const std::filesystem::path& data_file,
                                 FileKind kind);

/// Bytes of one volume with these sides; extra axes must have length 1. Errors: fewer axes, empty, 4D, impossible, a
/// single slice.
Result<std::uint64_t> volume_bytes(const std::vector<std::int64_t>& sizes, std::uint64_t bytes_per_voxel,
                                   const std::string& where);
/// The first three of the sizes that volume_bytes() has accepted.
volume::Index3 sides(const std::vector<std::int64_t>& sizes);

/// Readers of the headers, NIfTI-1 and -2 in either byte order, NRRD and MetaImage. Errors: not a file of the format,
/// an impossible size, more than one number a voxel (NRRD: apart from the layers of a .seg.nrrd), a place that is
/// unknown or contradicts itself.
Result<ImageHeader> read_nifti_header(const InputFile& file);
Result<ImageHeader> read_nrrd_header(const InputFile& file);
Result<ImageHeader> read_meta_header(const InputFile& file);
Result<ImageHeader> read_image_header(const InputFile& file, ImageFormat format);

/// True if ITK itself adds an entry of this key to the fields of an image.
inline bool is_library_field(std::string_view key) noexcept {
  return key.starts_with("NRRD_") || key.starts_with("ITK_");
}

}  // namespace trocar::io::detail
