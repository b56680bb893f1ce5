#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <string>

#include "core/files/output_file.h"
#include "core/text.h"
#include "io/image/detail/image_header.h"
#include "io/image/detail/payload.h"
#include "io/image/detail/volume_file.h"
#include "io/image/image_file.h"

namespace trocar::io {
namespace fs = std::filesystem;
namespace {

Status check_fields(const ImageFields& fields, const fs::path& path) {
  const auto is_key = [](char c) { return ascii::is_letter_or_digit(c) || c == '_' || c == '-' || c == '.'; };
  const auto is_text = [](unsigned char c) { return c >= 0x20 && c != 0x7F && c != '\\'; };
  if (!fields.empty() && path.extension() != ".nrrd")
    return fail_usage("only .nrrd files carry fields", path.string(), "let the name end in .nrrd");
  for (const auto& [key, value] : fields) {
    const bool is_valid_key =
        !key.empty() && !detail::is_library_field(key) && std::all_of(key.begin(), key.end(), is_key);
    if (!is_valid_key || !std::all_of(value.begin(), value.end(), is_text))
      return fail_usage("not a field for an image's header: " + key, path.string(),
                        "use letters, digits, _, - and . in keys and one line of printable text as value");
  }
  return {};
}

template <class T>
Status write_grid(const volume::Grid<T>& grid, detail::VoxelType type, const fs::path& path,
                  const ImageFields& fields = {}) {
  if (grid.empty()) return fail("there is no image to write", path.string(), "make an image first");
  TROCAR_TRY_STATUS(check_fields(fields, path));
  return write_atomically(path, [&](const fs::path& temporary) -> Status {
    auto status = detail::write_volume_file({type, std::as_bytes(std::span(grid.voxels))}, grid.geometry, temporary,
                                            detail::Packing::kCompressed, {fields.begin(), fields.end()});
    if (!status) return fail(status.error().what, path.string(), status.error().advice);
    return {};
  });
}

}  // namespace

Status write_image(const volume::CtGrid& grid, const fs::path& path) {
  return write_grid(grid, detail::VoxelType::kInt16, path);
}

Status write_image(const volume::LabelGrid& grid, const fs::path& path) {
  return write_grid(grid, detail::VoxelType::kUInt8, path);
}

Status write_image(const volume::FloatGrid& grid, const fs::path& path) {
  return write_grid(grid, detail::VoxelType::kFloat, path);
}

Status write_image(const volume::CtGrid& grid, const fs::path& path, const ImageFields& fields) {
  return write_grid(grid, detail::VoxelType::kInt16, path, fields);
}

Status write_image(const volume::LabelGrid& grid, const fs::path& path, const ImageFields& fields) {
  return write_grid(grid, detail::VoxelType::kUInt8, path, fields);
}

Status write_image(const volume::FloatGrid& grid, const fs::path& path, const ImageFields& fields) {
  return write_grid(grid, detail::VoxelType::kFloat, path, fields);
}

}  // namespace trocar::io

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
