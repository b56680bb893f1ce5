#include <algorithm>
#include <string>

#include "core/ascii.h"
#include "core/files/atomic_file.h"
#include "io/image/detail/image_fields.h"
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
