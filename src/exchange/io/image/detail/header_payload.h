#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/files/input_file.h"

namespace trocar::io::detail {

inline constexpr const char* kExportAgain = "copy or export the file again";
inline constexpr std::size_t kChunkBytes = std::size_t{1} << 18;

/// Declaration of the voxels in a header.
struct Payload {
  std::uint64_t offset = 0;           ///< Start of the voxels or of their compressed stream.
  std::uint64_t bytes = 0;            ///< Bytes after unpacking.
  std::uint64_t packed = 0;           ///< Length of the compressed stream, 0 if the header does not declare it.
  bool is_compressed = false;         ///< gzip or zlib.
  bool is_text = false;               ///< Numbers written as text.
  std::uint64_t least_bytes = 0;      ///< Lower limit of the file size: no encoding is shorter. Text only.
  std::filesystem::path data_file{};  ///< The file with the voxels, relative to the header; empty: the header file.
};

/// Opens the file that a header names for its voxels. Errors: an absolute path, a path that leaves the header's folder
/// (".." or a symbolic link), and those of InputFile.
Result<InputFile> open_data_file(const std::filesystem::path& header, const std::filesystem::path& data_file,
                                 FileKind kind);

/// Bytes of one volume with these sides; extra axes must have length 1. Errors: fewer axes, empty, 4D, impossible, a
/// single slice.
Result<std::uint64_t> volume_bytes(const std::vector<std::int64_t>& sizes, std::uint64_t bytes_per_voxel,
                                   const std::string& where);

/// Checks a NIfTI-1 or -2 header in either byte order. Errors: no NIfTI header, header and voxels in two files, an
/// uncertain position (no qform and no sform, sheared, not in mm), NaN or infinite voxels.
Result<Payload> nifti_payload(const InputFile& file);

}  // namespace trocar::io::detail
