#include "io/patient/patient_extras.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <vector>

#include "core/files/folders.h"
#include "core/text.h"
#include "io/image/image_file.h"
#include "io/patient/patient_folder.h"
#include "io/sequence/transform_file.h"

namespace trocar::io {
namespace fs = std::filesystem;
namespace {

constexpr const char* kDynamicRange = "trocar_dynamic_range_db";
constexpr const char* kMakeIt = "make them with trocar ultrasound stitch and trocar register";

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

Status check_files(const PatientSource& source) {
  if (!is_path(source.folder_or_name))
    return fail("an embedded patient has no panorama", source.folder_or_name,
                fmt::format("use a patient folder with {} and {}: {}", kPanoramaFile, kPanoramaTransformFile, kMakeIt));
  std::vector<std::string> missing;
  for (const char* file : {kPanoramaFile, kPanoramaTransformFile})
    if (!is_file(fs::path(source.folder_or_name) / file)) missing.emplace_back(file);
  if (missing.empty()) return {};
  return fail(fmt::format("the patient has no panorama: {} missing", fmt::join(missing, " and ")),
              source.folder_or_name, kMakeIt);
}

}  // namespace

bool has_panorama(const PatientSource& source) {
  if (!is_path(source.folder_or_name)) return false;
  const fs::path folder = source.folder_or_name;
  return is_file(folder / kPanoramaFile) && is_file(folder / kPanoramaTransformFile);
}

Result<std::shared_ptr<const ultrasound::Panorama>> load_panorama(const PatientSource& source) {
  TROCAR_TRY_STATUS(check_files(source));
  const fs::path volume = fs::path(source.folder_or_name) / kPanoramaFile;
  TROCAR_TRY(const Pose X_PU, read_transform(fs::path(source.folder_or_name) / kPanoramaTransformFile));
  TROCAR_TRY(const ImageFields fields, read_image_fields(volume));
  ultrasound::PanoramaOptions options;
  if (const auto field = fields.find(kDynamicRange); field != fields.end()) {
    const auto number = parse_number<double>(field->second);
    if (!number)
      return fail(fmt::format("{} is not a number: \"{}\"", kDynamicRange, field->second), volume.string(),
                  "correct the header, or stitch the panorama again");
    options.dynamic_range_db = *number;
  }
  std::vector<std::string> unused;  // the volume was written by this program
  TROCAR_TRY(const volume::LabelGrid gray_U, read_gray_levels(volume, unused));
  auto panorama = ultrasound::make_panorama(gray_U, X_PU, options);
  if (!panorama) return fail(panorama.error().what, volume.string(), panorama.error().advice);
  return panorama;
}

namespace fs = std::filesystem;

std::optional<fs::path> find_thumbnail(const std::string& folder_or_name) {
  const fs::path file = is_path(folder_or_name) ? fs::path(folder_or_name) / kThumbnailFile
                                                : data_dir() / "phantoms" / "thumbnails" / (folder_or_name + ".png");
  std::error_code ignored;
  if (folder_or_name.empty() || !fs::is_regular_file(file, ignored)) return std::nullopt;
  return file;
}

}  // namespace trocar::io
