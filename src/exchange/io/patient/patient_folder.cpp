#include "io/patient/patient_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "core/files/folders.h"
#include "core/log.h"
#include "core/parallel.h"
#include "io/image/detail/raw_volume.h"
#include "io/image/detail/volume_file.h"
#include "io/markups_file.h"
#include "io/patient/detail/patient_toml.h"
#include "io/patient/motion_files.h"
#include "motion_builder/breathing_model.h"
#include "phantom/phantom.h"

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
  TROCAR_TRY(anatomy::VirtualPatient patient, load_anatomy(folder));
  TROCAR_TRY(patient.motion, load_motion_model(folder));
  return patient;
}

Result<anatomy::VirtualPatient> load_anatomy(const fs::path& folder) {
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
  patient.content_hash = anatomy::hash_patient(patient);
  log_info("loaded {}: {} labels, {:.1f} Mvoxel", folder.string(), patient.label_table.labels.size(),
           1e-6 * static_cast<double>(patient.labels.voxels.size()));
  if (patient.content_hash == description.content_hash) return patient;
  return fail("the patient's volumes or labels changed after it was built", folder.string(), detail::kBuildAgain);
}

namespace {
namespace fs = std::filesystem;

constexpr std::size_t kMostFolders = 256;  // number of folders searched next to a session

bool has_hash(const fs::path& folder, const std::string& hash) {
  std::error_code ignored;
  if (!fs::is_regular_file(folder / "patient.toml", ignored)) return false;
  const auto description = detail::load_patient_toml(folder / "patient.toml", folder);
  return description && description->content_hash == hash;
}

/// The recorded path and its possible new locations, best first.
std::vector<fs::path> candidates(const fs::path& recorded, const fs::path& beside) {
  std::vector<fs::path> folders{recorded};
  if (recorded.is_relative()) folders.push_back(beside / recorded);
  const fs::path name = recorded.has_filename() ? recorded.filename() : recorded.parent_path().filename();
  folders.push_back(beside / name);
  std::vector<fs::path> neighbours = list_folder(beside).value_or(std::vector<fs::path>());
  std::erase_if(neighbours, [](const fs::path& entry) {
    std::error_code gone;
    return !fs::is_directory(entry, gone);
  });
  if (neighbours.size() > kMostFolders) neighbours.resize(kMostFolders);
  folders.insert(folders.end(), neighbours.begin(), neighbours.end());
  return folders;
}

}  // namespace

bool is_path(const std::string& folder_or_name) {
  std::error_code ignored;
  return folder_or_name.find('/') != std::string::npos || fs::exists(folder_or_name, ignored);
}

std::string absolute_source(const std::string& folder_or_name) {
  std::error_code ignored;
  if (!fs::is_directory(folder_or_name, ignored)) return folder_or_name;
  return fs::absolute(folder_or_name, ignored).lexically_normal().string();
}

Result<std::string> find_recorded_patient(const std::string& recorded, const std::string& hash,
                                          const fs::path& beside) {
  if (recorded.empty()) return fail("the record does not name its patient", beside.string(), "name it with --patient");
  const fs::path folder = beside.empty() ? fs::path(".") : beside;
  for (const fs::path& candidate : candidates(recorded, folder))
    if (has_hash(candidate, hash)) return absolute_source(candidate.string());
  std::error_code ignored;
  if (recorded.find('/') == std::string::npos || fs::is_directory(recorded, ignored)) return recorded;
  return fail("patient folder not found, and no folder with the same content near the session", recorded,
              "name it with --patient");
}

Result<anatomy::VirtualPatient> load_source(const PatientSource& source, const Progress& progress) {
  if (is_path(source.folder_or_name)) return load_patient(source.folder_or_name);
  TROCAR_TRY(anatomy::VirtualPatient patient,
             phantom::generate_phantom(source.folder_or_name, source.seed, {}, part_of(progress, 0.0, 0.8)));
  round_as_saved(patient);
  motion_builder::add_breathing_model(patient, part_of(progress, 0.8, 1.0));
  return patient;
}

}  // namespace trocar::io
