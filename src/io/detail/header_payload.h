#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/result.h"

namespace trocar::detail {

inline constexpr const char* kExportAgain = "copy or export the file again";
inline constexpr std::size_t kChunkBytes = std::size_t{1} << 18;

/// What a header promises about its voxels.
struct Payload {
  std::filesystem::path file;  ///< The file that has the voxels.
  std::uint64_t offset = 0;    ///< Where the voxels, or their compressed stream, start.
  std::uint64_t bytes = 0;     ///< Bytes after unpacking.
  std::uint64_t packed = 0;    ///< Length of the compressed stream, 0 where the header does not say.
  bool is_compressed = false;  ///< gzip or zlib.
  bool is_text = false;        ///< Numbers written as text; their count is left to the reader.
};

/// Bytes of one volume with these sides; extra axes must be one long. Errors: fewer axes, empty, 4D, impossible, a
/// single slice.
Result<std::uint64_t> volume_bytes(const std::vector<std::int64_t>& sizes, std::uint64_t bytes_per_voxel,
                                   const std::string& where);

/// Looks at a NIfTI-1 or -2 header in either byte order. Errors: none, header and voxels in two files, a place in doubt
/// (no qform and no sform, sheared, not in mm), NaN or infinite voxels.
Result<Payload> nifti_payload(const std::filesystem::path& path);

}  // namespace trocar::detail
