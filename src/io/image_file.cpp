#include "io/image_file.h"

#include <string>

#include "core/atomic_file.h"
#include "io/detail/read_grid.h"
#include "io/detail/volume_file.h"

namespace trocar {
namespace fs = std::filesystem;
namespace {

template <class T>
Status write_grid(const Grid<T>& grid, detail::VoxelType type, const fs::path& path) {
  if (grid.empty()) return fail("there is no image to write", path.string());
  return write_atomically(path, [&](const fs::path& temporary) -> Status {
    auto status = detail::write_volume_file({type, std::as_bytes(std::span(grid.voxels))}, grid.geometry, temporary);
    if (!status) return fail(status.error().what, path.string(), status.error().advice);
    return {};
  });
}

}  // namespace

Result<CtGrid> read_ct(const fs::path& path) {
  return detail::read_grid<std::int16_t>(path, detail::convert_voxels);
}

Result<LabelGrid> read_labels(const fs::path& path) {
  return detail::read_grid<std::uint8_t>(path, detail::convert_voxels);
}

Result<FloatGrid> read_float(const fs::path& path) {
  return detail::read_grid<float>(path, detail::convert_voxels);
}

Status write_image(const CtGrid& grid, const fs::path& path) {
  return write_grid(grid, detail::VoxelType::kInt16, path);
}

Status write_image(const LabelGrid& grid, const fs::path& path) {
  return write_grid(grid, detail::VoxelType::kUInt8, path);
}

Status write_image(const FloatGrid& grid, const fs::path& path) {
  return write_grid(grid, detail::VoxelType::kFloat, path);
}

}  // namespace trocar
