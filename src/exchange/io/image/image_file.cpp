#include "io/image/image_file.h"

#include <algorithm>
#include <string>

#include "io/image/detail/image_header.h"
#include "io/image/detail/payload.h"
#include "io/image/detail/read_grid.h"
#include "io/image/detail/volume_file.h"

namespace trocar::io {
namespace fs = std::filesystem;

Result<CtScan> read_ct_scan(const fs::path& path, const std::string& series,
                            const std::vector<std::string>& preferred) {
  std::error_code error;
  CtScan scan;
  if (fs::is_directory(path, error)) {
    TROCAR_TRY(auto volume, detail::read_dicom_folder<std::int16_t>(path, detail::convert_voxels, series, preferred));
    scan.grid = std::move(volume.grid);
    scan.series_uid = std::move(volume.series_uid);
    scan.frame_of_reference = std::move(volume.frame_of_reference);
    scan.patient_id = std::move(volume.patient_id);
    scan.slices_P = std::move(volume.slices_P);
    scan.warnings = std::move(volume.warnings);
    return scan;
  }
  if (!series.empty())
    return fail_usage("a series can only be chosen in a folder of DICOM files", path.string(), "omit --series");
  TROCAR_TRY(scan.grid, detail::read_grid<std::int16_t>(path, detail::convert_voxels, scan.warnings));
  return scan;
}

Result<volume::CtGrid> read_ct(const fs::path& path, const std::string& series) {
  TROCAR_TRY(CtScan scan, read_ct_scan(path, series));
  return std::move(scan.grid);
}

Result<volume::LabelGrid> read_labels(const fs::path& path) {
  std::vector<std::string> unused;
  return detail::read_grid<std::uint8_t>(path, detail::convert_voxels, unused);
}

Result<volume::LabelGrid> read_gray_levels(const fs::path& path, std::vector<std::string>& warnings) {
  std::error_code error;
  if (fs::is_directory(path, error)) return detail::read_grid<std::uint8_t>(path, detail::convert_gray, warnings);
  TROCAR_TRY_STATUS(detail::check_image_path(path));
  TROCAR_TRY(const detail::RawVolume raw, detail::read_volume_file(path));
  warnings.insert(warnings.end(), raw.warnings.begin(), raw.warnings.end());
  TROCAR_TRY(auto grid, detail::to_grid<std::uint8_t>(raw, path.string(), detail::convert_gray));
  if (detail::has_fractions(raw.voxels()))
    warnings.push_back(path.filename().string() + ": the gray levels have fractions and are rounded");
  return grid;
}

std::vector<std::string_view> image_endings() {
  std::vector<std::string_view> endings;
  for (const detail::ImageEnding& ending : detail::kImageEndings) endings.push_back(ending.text);
  return endings;
}

std::string name_without_ending(const fs::path& path) {
  std::string name = path.filename().string();
  std::size_t longest = 0;
  for (const std::string_view ending : image_endings())
    if (name.size() > ending.size() && name.ends_with(ending)) longest = std::max(longest, ending.size());
  name.resize(name.size() - longest);
  return name;
}

Result<volume::FloatGrid> read_float(const fs::path& path) {
  std::vector<std::string> unused;
  return detail::read_grid<float>(path, detail::convert_voxels, unused);
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
    if (!detail::is_library_field(key)) fields.insert_or_assign(key, value);
  return fields;
}

}  // namespace trocar::io
