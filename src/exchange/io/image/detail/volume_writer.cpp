#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "io/image/detail/payload.h"
#include "io/image/detail/volume_file.h"

namespace trocar::io::detail {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t kHeaderBytes = 1 << 16;  ///< Upper limit of the overhead of header and compression.

/// Reserves the maximum size of the image. The libraries report a full disk on the terminal only.
Status reserve_space(const fs::path& path, std::uint64_t bytes) {
  const int file = ::open(path.c_str(), O_CREAT | O_WRONLY | O_TRUNC | O_CLOEXEC, 0666);
  const bool is_open = file >= 0;
  const bool is_reserved = is_open && ::posix_fallocate(file, 0, static_cast<off_t>(bytes)) == 0;
  const bool is_released = is_open && ::ftruncate(file, 0) == 0;
  if (is_open) ::close(file);
  if (is_reserved && is_released) return {};
  if (!is_open) return fail("the image cannot be written", path.string(), "choose another place");
  return fail(fmt::format("no space for an image of {} MB", 1 + bytes / 1'000'000), path.string(),
              "free some disk space");
}

}  // namespace

Status write_volume_file(const RawVoxels& voxels, const volume::GridGeometry& geometry, const fs::path& path,
                         Packing packing, TextFields fields) {
  TROCAR_TRY(const ImageFormat format, find_image_format(path));
  TROCAR_TRY_STATUS(reserve_space(path, voxels.bytes.size() + voxels.bytes.size() / 256 + kHeaderBytes));
  ItkImage image;
  image.size = geometry.size;
  for (int axis = 0; axis < 3; ++axis) {
    const auto n = static_cast<std::size_t>(axis);
    image.spacing_mm[n] = geometry.spacing_mm[axis];
    image.origin_P[n] = geometry.origin_P[axis];
    for (int row = 0; row < 3; ++row) image.axes_P[n][static_cast<std::size_t>(row)] = geometry.R_PV(row, axis);
  }
  image.type = voxels.type;
  image.fields = std::move(fields);
  TROCAR_TRY_STATUS(write_with_itk(image, voxels.bytes, path, format, packing));
  if (open_image_file(path, format)) return {};
  return fail("the image was not written whole", path.string(), "check the disk space");
}

}  // namespace trocar::io::detail
