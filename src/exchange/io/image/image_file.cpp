#include "io/image/image_file.h"

#include <algorithm>
#include <cctype>
#include <string>

#include "core/files/atomic_file.h"
#include "io/image/detail/read_grid.h"
#include "io/image/detail/volume_file.h"

namespace trocar::io {
namespace fs = std::filesystem;
namespace {

constexpr const char* kOwnPrefixes[] = {"NRRD_", "ITK_"};  ///< Entries that ITK adds to the fields.

bool is_own_note(const std::string& key) {
  return std::any_of(std::begin(kOwnPrefixes), std::end(kOwnPrefixes),
                     [&](const char* prefix) { return key.starts_with(prefix); });
}

Status check_fields(const ImageFields& fields, const fs::path& path) {
  const auto is_key = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.'; };
  const auto is_text = [](unsigned char c) { return c >= 0x20 && c != 0x7F && c != '\\'; };
  if (!fields.empty() && path.extension() != ".nrrd")
    return fail_usage("only .nrrd files carry fields", path.string(), "let the name end in .nrrd");
  for (const auto& [key, value] : fields) {
    const bool is_good_key = !key.empty() && !is_own_note(key) && std::all_of(key.begin(), key.end(), is_key);
    if (!is_good_key || !std::all_of(value.begin(), value.end(), is_text))
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

Result<volume::CtGrid> read_ct(const fs::path& path, const std::string& series) {
  if (!series.empty()) {
    std::error_code error;
    if (!fs::is_directory(path, error))
      return fail_usage("a series can only be chosen in a folder of DICOM files", path.string(), "omit --series");
    return detail::read_dicom_folder<std::int16_t>(path, detail::convert_voxels, series);
  }
  return detail::read_grid<std::int16_t>(path, detail::convert_voxels);
}

Result<volume::LabelGrid> read_labels(const fs::path& path) {
  return detail::read_grid<std::uint8_t>(path, detail::convert_voxels);
}

Result<volume::FloatGrid> read_float(const fs::path& path) {
  return detail::read_grid<float>(path, detail::convert_voxels);
}

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

Result<ImageFields> read_image_fields(const fs::path& path) {
  TROCAR_TRY_STATUS(detail::check_image_path(path));
  std::error_code error;
  if (fs::is_directory(path, error)) return ImageFields{};
  TROCAR_TRY(const auto format, detail::find_image_format(path));
  if (format != detail::ImageFormat::kNrrd) return ImageFields{};
  TROCAR_TRY(const auto checked, detail::open_image_file(path, format, detail::Check::kSize));
  TROCAR_TRY(const auto all, detail::read_fields_with_itk(checked, format));
  ImageFields fields;
  for (const auto& [key, value] : all)
    if (!is_own_note(key)) fields.insert_or_assign(key, value);
  return fields;
}

}  // namespace trocar::io
