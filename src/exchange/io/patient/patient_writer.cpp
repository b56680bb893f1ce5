#include <fmt/format.h>

#include <set>

#include "core/files/output_file.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "core/result.h"
#include "core/text.h"
#include "io/image/detail/volume_file.h"
#include "io/image/image_file.h"
#include "io/markups_file.h"
#include "io/mesh_file.h"
#include "io/patient/detail/patient_toml.h"
#include "io/patient/motion_files.h"
#include "io/patient/patient_extras.h"
#include "io/patient/patient_folder.h"
#include "io/sequence/transform_file.h"
#include "motion/motion_file.h"

namespace trocar::io {
namespace fs = std::filesystem;
namespace {

/// A unique file name for a structure.
std::string mesh_file_name(const std::string& name, std::set<std::string>& taken) {
  std::string stem;
  for (const char c : name) {
    const bool is_plain = ascii::is_letter_or_digit(c) || c == '_' || c == '-';
    stem += is_plain ? c : '_';
  }
  if (stem.empty()) stem = "surface";
  std::string file = stem;
  for (int n = 2; !taken.insert(file).second; ++n) file = fmt::format("{}_{}", stem, n);
  return fmt::format("meshes/{}.vtp", file);
}

/// Distances compress badly and unpack slowly: not compressed.
Status write_distance(const volume::FloatGrid& distance_mm, const fs::path& path) {
  const volume::CtGrid hundredths = detail::to_hundredths(distance_mm);
  return detail::write_volume_file({detail::VoxelType::kInt16, std::as_bytes(std::span(hundredths.voxels))},
                                   hundredths.geometry, path, detail::Packing::kPlain);
}

/// CT or labels.
template <class T>
Status write_voxels(const volume::Grid<T>& grid, detail::VoxelType type, const fs::path& path, VolumePacking packing) {
  if (packing == VolumePacking::kSmall) return write_image(grid, path);
  return detail::write_volume_file({type, std::as_bytes(std::span(grid.voxels))}, grid.geometry, path,
                                   detail::Packing::kPlain);
}

Status write_volumes(const anatomy::VirtualPatient& patient, const fs::path& folder, VolumePacking packing) {
  using detail::VoxelType;
  Status ct, labels, distance;
  parallel_invoke(
      [&] { ct = write_voxels(patient.ct, VoxelType::kInt16, folder / detail::kCtFile, packing); },
      [&] { labels = write_voxels(patient.labels, VoxelType::kUInt8, folder / detail::kLabelFile, packing); },
      [&] { distance = write_distance(patient.skin_distance_mm, folder / detail::kDistanceFile); });
  TROCAR_TRY_STATUS(ct);
  TROCAR_TRY_STATUS(labels);
  return distance;
}

Result<std::vector<detail::PatientMeshEntry>> write_meshes(const std::vector<anatomy::NamedMesh>& meshes,
                                                           const fs::path& folder, const Progress& progress) {
  std::vector<detail::PatientMeshEntry> entries;
  std::set<std::string> taken;
  for (const anatomy::NamedMesh& mesh : meshes) {
    report(progress, "surfaces", static_cast<double>(taken.size()) / static_cast<double>(meshes.size()));
    entries.push_back({mesh.name, mesh_file_name(mesh.name, taken)});
    TROCAR_TRY_STATUS(write_mesh(mesh.mesh_P, folder / entries.back().file));
  }
  return entries;
}

Status write_contents(const anatomy::VirtualPatient& patient, const std::vector<anatomy::NamedMesh>& meshes,
                      const fs::path& folder, const Progress& progress, VolumePacking packing) {
  report(progress, "volumes", 0.0);
  TROCAR_TRY_STATUS(write_volumes(patient, folder, packing));
  detail::PatientDescription description{patient.name,
                                         patient.description,
                                         patient.provenance,
                                         patient.posture,
                                         anatomy::hash_patient(patient),
                                         patient.label_table,
                                         {},
                                         patient.repairs};
  TROCAR_TRY(description.meshes, write_meshes(meshes, folder, part_of(progress, 0.8, 1.0)));
  TROCAR_TRY_STATUS(write_landmarks(patient.landmarks, folder / detail::kLandmarkFile));
  TROCAR_TRY_STATUS(write_paths(patient.paths, folder / detail::kPathFile));
  if (patient.motion != nullptr) TROCAR_TRY_STATUS(save_motion_model(*patient.motion, folder));
  TROCAR_TRY_STATUS(write_file_atomically(folder / detail::kDescriptionFile, detail::to_toml(description)));
  report(progress, "saved", 1.0);
  return {};
}

Status write_ultrasound(const RecordedUltrasound& ultrasound, const fs::path& folder) {
  std::error_code error;
  fs::create_directories((folder / kPanoramaFile).parent_path(), error);  // an error is reported when writing
  TROCAR_TRY_STATUS(write_image(ultrasound.gray_U, folder / kPanoramaFile, ultrasound.fields));
  if (!ultrasound.landmarks_U.empty())
    TROCAR_TRY_STATUS(write_landmarks(ultrasound.landmarks_U, folder / kPanoramaLandmarkFile));
  if (!ultrasound.X_PU) return {};
  return write_transform(*ultrasound.X_PU, folder / kPanoramaTransformFile);
}

}  // namespace

Status save_patient(const anatomy::VirtualPatient& patient, const std::vector<anatomy::NamedMesh>& meshes,
                    const fs::path& folder, const Progress& progress, const std::vector<PatientExtra>& extras,
                    const RecordedUltrasound* ultrasound, VolumePacking packing) {
  TROCAR_TRY_STATUS(detail::check_geometry(patient, folder.string()));
  TROCAR_TRY_STATUS(detail::check_label_ids(patient, folder.string()));
  return write_folder_atomically(folder, [&](const fs::path& temporary) -> Status {
    TROCAR_TRY_STATUS(write_contents(patient, meshes, temporary, progress, packing));
    for (const PatientExtra& extra : extras) {
      TROCAR_CHECK(!fs::exists(temporary / extra.name));
      TROCAR_TRY_STATUS(write_file_atomically(temporary / extra.name, extra.text));
    }
    if (ultrasound != nullptr) TROCAR_TRY_STATUS(write_ultrasound(*ultrasound, temporary));
    return {};
  });
}

/// Here and not beside its reader: haptic servers contain no writers.
Status save_motion_model(const motion::MotionModel& model, const fs::path& folder) {
  std::error_code ignored;
  fs::remove(folder / detail::kMotionFile, ignored);
  const motion::MotionParts& parts = model.parts();
  Status border;
  Status modes;
  parallel_invoke([&] { modes = write_image(motion::stack_modes(parts), folder / detail::kMotionModesFile); },
                  [&] {
                    if (!parts.border_mm.empty())
                      border = write_image(parts.border_mm, folder / detail::kMotionBorderFile);
                  });
  TROCAR_TRY_STATUS(modes);
  TROCAR_TRY_STATUS(border);
  return write_file_atomically(folder / detail::kMotionFile, motion::to_toml(model));
}

Status add_patient_meshes(const fs::path& folder, const std::vector<anatomy::NamedMesh>& meshes) {
  TROCAR_TRY(detail::PatientDescription description, detail::load_description(folder));
  if (!description.meshes.empty()) return {};
  TROCAR_TRY(description.meshes, write_meshes(meshes, folder, {}));
  return write_file_atomically(folder / detail::kDescriptionFile, detail::to_toml(description));
}

namespace fs = std::filesystem;

Result<std::vector<anatomy::NamedMesh>> load_patient_meshes(const fs::path& folder) {
  TROCAR_TRY(const detail::PatientDescription description, detail::load_description(folder));
  std::vector<anatomy::NamedMesh> meshes;
  for (const detail::PatientMeshEntry& entry : description.meshes) {
    TROCAR_TRY(TriangleMesh mesh_P, read_mesh(folder / entry.file, folder));
    meshes.push_back({entry.name, std::move(mesh_P)});
  }
  return meshes;
}

}  // namespace trocar::io
