#include "io/patient/patient_folder.h"

#include <fmt/format.h>

#include "core/files/input_file.h"
#include "core/log.h"
#include "core/parallel.h"
#include "io/image/detail/raw_volume.h"
#include "io/image/detail/volume_file.h"
#include "io/markups_file.h"
#include "io/patient/detail/patient_layout.h"
#include "motion/motion_file.h"

namespace trocar::io {
namespace fs = std::filesystem;
namespace {

template <class T>
Result<volume::Grid<T>> read_volume(const fs::path& folder, const char* name, detail::Check check) {
  const fs::path file = folder / name;
  TROCAR_TRY_STATUS(detail::check_volume_path(file));
  TROCAR_TRY(const detail::RawVolume raw, detail::read_volume_file(file, check, folder));
  return detail::to_grid<T>(raw, file.string(), detail::convert_voxels);
}

Status load_volumes(const fs::path& folder, anatomy::VirtualPatient& patient) {
  Result<volume::CtGrid> ct, distance;
  Result<volume::LabelGrid> labels;
  using detail::Check;  // The content hash later verifies that CT and labels are complete.
  parallel_invoke([&] { ct = read_volume<std::int16_t>(folder, detail::kCtFile, Check::kSize); },
                  [&] { labels = read_volume<std::uint8_t>(folder, detail::kLabelFile, Check::kSize); },
                  [&] {
                    distance = read_volume<std::int16_t>(folder, detail::kDistanceFile, Check::kUnpack);
                    if (distance) patient.skin_distance_mm = detail::from_hundredths(*distance);
                  });
  if (!ct) return tl::unexpected(ct.error());
  if (!labels) return tl::unexpected(labels.error());
  if (!distance) return tl::unexpected(distance.error());
  patient.ct = std::move(*ct);
  patient.labels = std::move(*labels);
  return {};
}

/// nullptr: the folder has no motion model.
Result<std::shared_ptr<const motion::MotionModel>> load_motion(const fs::path& folder) {
  const fs::path file = folder / detail::kMotionFile;
  std::error_code error;
  if (!fs::exists(fs::symlink_status(file, error))) return std::shared_ptr<const motion::MotionModel>();
  TROCAR_TRY(const InputFile input, InputFile::open(file, FileKind::kToml, folder));
  TROCAR_TRY(const std::string text, input.read_all());
  return motion::parse_motion(text, file.string());
}

}  // namespace

void round_as_saved(anatomy::VirtualPatient& patient) {
  for (volume::GridGeometry* geometry :
       {&patient.ct.geometry, &patient.labels.geometry, &patient.skin_distance_mm.geometry})
    detail::round_geometry(*geometry);
  patient.skin_distance_mm = detail::from_hundredths(detail::to_hundredths(patient.skin_distance_mm));
}

Result<PatientTitle> load_patient_title(const fs::path& folder) {
  TROCAR_TRY(const detail::PatientDescription description, detail::load_description(folder));
  return PatientTitle{description.name, description.description};
}

Result<anatomy::VirtualPatient> load_patient(const fs::path& folder) {
  TROCAR_TRY(detail::PatientDescription description, detail::load_description(folder));
  anatomy::VirtualPatient patient;
  patient.name = std::move(description.name);
  patient.description = std::move(description.description);
  patient.provenance = std::move(description.provenance);
  patient.posture = description.posture;
  patient.label_table = std::move(description.label_table);
  patient.repairs = std::move(description.repairs);
  TROCAR_TRY_STATUS(load_volumes(folder, patient));
  TROCAR_TRY_STATUS(detail::check_geometry(patient, folder.string()));
  TROCAR_TRY_STATUS(detail::check_label_ids(patient, folder.string()));
  TROCAR_TRY(patient.landmarks, read_landmarks(folder / detail::kLandmarkFile, folder));
  TROCAR_TRY(patient.paths, read_paths(folder / detail::kPathFile, folder));
  TROCAR_TRY(patient.motion, load_motion(folder));
  patient.content_hash = anatomy::hash_patient(patient);
  log_info("loaded {}: {} labels, {:.1f} Mvoxel", folder.string(), patient.label_table.labels.size(),
           1e-6 * static_cast<double>(patient.labels.voxels.size()));
  if (patient.content_hash == description.content_hash) return patient;
  return fail("the patient's volumes or labels changed after it was built", folder.string(), detail::kBuildAgain);
}

}  // namespace trocar::io
