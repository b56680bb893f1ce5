#include "io/image/detail/nifti_voxels.h"

#include <fmt/format.h>
#include <itk_zlib.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "core/available_memory.h"
#include "io/image/detail/image_header.h"
#include "io/image/detail/inflate_input.h"
#include "io/image/detail/raw_volume.h"

namespace trocar::io::detail {
namespace {

template <std::size_t Size>
void swap_numbers(std::span<std::byte> bytes) {
  for (std::size_t at = 0; at + Size <= bytes.size(); at += Size) std::reverse(&bytes[at], &bytes[at] + Size);
}

void swap_bytes(std::span<std::byte> bytes, std::size_t number_bytes) {
  if (number_bytes == 2) swap_numbers<2>(bytes);
  if (number_bytes == 4) swap_numbers<4>(bytes);
  if (number_bytes == 8) swap_numbers<8>(bytes);
}

/// False: the stream ends before, or is damaged.
bool read_bytes(gzFile file, std::span<std::byte> bytes) {
  while (!bytes.empty()) {
    const std::size_t most = std::min<std::size_t>(bytes.size(), std::size_t{1} << 30);
    const int got = gzread(file, bytes.data(), static_cast<unsigned>(most));
    if (got <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(got));
  }
  return true;
}

/// The bytes behind the voxels, up to as many as the voxels have; none: the stream is damaged. zlib compares the check
/// sum when it reaches the end of the stream; a stream without an end is no error of gzread().
std::optional<std::uint64_t> bytes_behind(gzFile file, std::uint64_t voxel_bytes) {
  std::vector<std::byte> more(kChunkBytes);
  std::uint64_t behind = 0;
  while (behind <= voxel_bytes) {
    int status = Z_OK;
    const int got = gzread(file, more.data(), static_cast<unsigned>(more.size()));
    gzerror(file, &status);
    if (got < 0 || (status != Z_OK && status != Z_STREAM_END)) return std::nullopt;
    if (got == 0) break;
    behind += static_cast<std::uint64_t>(got);
  }
  return behind;
}

}  // namespace

Result<std::unique_ptr<std::byte[]>> read_nifti_voxels(const InputFile& input, const ImageHeader& header) {
  const std::string where = input.path().string();
  const Payload& payload = header.payload;
  const std::size_t number_bytes = bytes_per_voxel(header.type);
  const std::size_t count = header.geometry.voxel_count() * number_bytes;
  const std::uint64_t first = payload.is_compressed ? payload.bytes - count : payload.offset;
  const std::uint64_t available = input.size() > first ? input.size() - first : 0;
  if (!payload.is_compressed && available < count)
    return fail(fmt::format("the image ends before its last voxel ({} of {} bytes)", available, count), where,
                kExportAgain);
  const auto damaged = fail("the compressed voxels are damaged or end too early", where, kExportAgain);
  if (payload.is_compressed && !could_unpack_to(payload.bytes, input.size())) return damaged;
  TROCAR_TRY_STATUS(check_memory_for_image(count, available_memory_bytes(), where));
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(input.pinned_path().c_str(), "rb"), gzclose);
  if (!file) return fail("cannot be opened", where, kExportAgain);
  gzbuffer(file.get(), kChunkBytes);
  auto bytes = std::make_unique_for_overwrite<std::byte[]>(count);
  const std::span all(bytes.get(), count);
  if (gzseek(file.get(), static_cast<z_off_t>(first), SEEK_SET) < 0 || !read_bytes(file.get(), all)) return damaged;
  const auto behind = bytes_behind(file.get(), count);
  if (!behind) return damaged;
  if (is_far_more(count + *behind, count))
    return fail(fmt::format(kHoldsMore, count, count + *behind), where, kExportAgain);
  if (header.is_swapped) swap_bytes(all, number_bytes);
  return bytes;
}

}  // namespace trocar::io::detail
