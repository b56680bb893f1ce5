#include "io/patient/patient_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <set>

#include "core/check.h"
#include "core/files/atomic_file.h"
#include "core/log.h"
#include "core/parallel.h"
#include "io/image/detail/raw_volume.h"
#include "io/image/detail/read_grid.h"
#include "io/image/detail/volume_file.h"
#include "io/image/image_file.h"
#include "io/markups_file.h"
#include "io/mesh_file.h"
#include "io/patient/detail/patient_toml.h"

namespace trocar::io {
namespace fs = std::filesystem;
namespace {

constexpr const char* kDescriptionFile = "patient.toml";
constexpr const char* kCtFile = "ct.nrrd";
constexpr const char* kLabelFile = "labels.nrrd";
constexpr const char* kDistanceFile = "skin_distance.nrrd";
constexpr const char* kLandmarkFile = "landmarks.mrk.json";
constexpr const char* kPathFile = "paths.mrk.json";
constexpr const char* kBuildAgain = "build the patient again";
constexpr float kDistanceUnit_mm = 0.01F;  ///< Of skin_distance.nrrd; beyond 327 mm it is clamped.
constexpr std::size_t kGrain = std::size_t{1} << 18;

volume::CtGrid to_hundredths(const volume::FloatGrid& distance_mm) {
  volume::CtGrid hundredths;
  hundredths.geometry = distance_mm.geometry;
  hundredths.voxels.resize(distance_mm.voxels.size());
  parallel_for(distance_mm.voxels.size(), kGrain, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n)
      hundredths.voxels[n] = static_cast<std::int16_t>(
          std::lround(std::clamp(distance_mm.voxels[n] / kDistanceUnit_mm, -32767.0F, 32767.0F)));
  });
  return hundredths;
}

volume::FloatGrid from_hundredths(const volume::CtGrid& hundredths) {
  volume::FloatGrid distance_mm;
  distance_mm.geometry = hundredths.geometry;
  distance_mm.voxels.resize(hundredths.voxels.size());
  parallel_for(hundredths.voxels.size(), kGrain, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n)
      distance_mm.voxels[n] = kDistanceUnit_mm * static_cast<float>(hundredths.voxels[n]);
  });
  return distance_mm;
}

/// Checks that the table contains every label of the volume.
Status check_label_ids(const anatomy::VirtualPatient& patient, const std::string& where) {
  std::array<bool, 256> occurs{};
  for (const std::uint8_t id : patient.labels.voxels) occurs[id] = true;
  for (std::size_t id = 1; id < occurs.size(); ++id)
    if (occurs[id] && patient.label_table.find(static_cast<std::uint8_t>(id)) == nullptr)
      return fail(fmt::format("the label volume has the value {}, which is not in the label table", id), where,
                  kBuildAgain);
  return {};
}

Status check_geometry(const anatomy::VirtualPatient& patient, const std::string& where) {
  const volume::GridGeometry& g = patient.ct.geometry;
  if (g.matches(patient.labels.geometry) && g.matches(patient.skin_distance_mm.geometry)) return {};
  return fail("CT, labels and skin distance are not on the same grid", where, kBuildAgain);
}

/// A unique file name for a structure.
std::string mesh_file_name(const std::string& name, std::set<std::string>& taken) {
  std::string stem;
  for (const char c : name) {
    const bool is_plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-';
    stem += is_plain ? c : '_';
  }
  if (stem.empty()) stem = "surface";
  std::string file = stem;
  for (int n = 2; !taken.insert(file).second; ++n) file = fmt::format("{}_{}", stem, n);
  return fmt::format("meshes/{}.vtp", file);
}

/// Distances compress badly and unpack slowly: not compressed.
Status write_distance(const volume::FloatGrid& distance_mm, const fs::path& path) {
  const volume::CtGrid hundredths = to_hundredths(distance_mm);
  return detail::write_volume_file({detail::VoxelType::kInt16, std::as_bytes(std::span(hundredths.voxels))},
                                   hundredths.geometry, path, detail::Packing::kPlain);
}

Status write_volumes(const anatomy::VirtualPatient& patient, const fs::path& folder) {
  Status ct, labels, distance;
  parallel_invoke([&] { ct = write_image(patient.ct, folder / kCtFile); },
                  [&] { labels = write_image(patient.labels, folder / kLabelFile); },
                  [&] { distance = write_distance(patient.skin_distance_mm, folder / kDistanceFile); });
  TROCAR_TRY_STATUS(ct);
  TROCAR_TRY_STATUS(labels);
  return distance;
}

Status write_contents(const anatomy::VirtualPatient& patient, const std::vector<anatomy::NamedMesh>& meshes,
                      const fs::path& folder, const Progress& progress) {
  report(progress, "volumes", 0.0);
  TROCAR_TRY_STATUS(write_volumes(patient, folder));
  detail::PatientDescription description{
      patient.name, patient.description, patient.provenance, anatomy::hash_patient(patient), patient.label_table, {}};
  std::set<std::string> taken;
  for (const anatomy::NamedMesh& mesh : meshes) {
    report(progress, "surfaces", 0.8 + 0.2 * static_cast<double>(taken.size()) / static_cast<double>(meshes.size()));
    description.meshes.push_back({mesh.name, mesh_file_name(mesh.name, taken)});
    TROCAR_TRY_STATUS(write_mesh(mesh.mesh_P, folder / description.meshes.back().file));
  }
  TROCAR_TRY_STATUS(write_landmarks(patient.landmarks, folder / kLandmarkFile));
  TROCAR_TRY_STATUS(write_paths(patient.paths, folder / kPathFile));
  TROCAR_TRY_STATUS(write_file_atomically(folder / kDescriptionFile, detail::to_toml(description)));
  report(progress, "saved", 1.0);
  return {};
}

Result<detail::PatientDescription> load_description(const fs::path& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error))
    return fail("no such patient folder", folder.string(), "build one with trocar patient build");
  if (!fs::exists(folder / kDescriptionFile, error))
    return fail("not a patient folder: it has no patient.toml", folder.string(), "build one with trocar patient build");
  return detail::load_patient_toml(folder / kDescriptionFile, folder);
}

template <class T>
Result<volume::Grid<T>> read_volume(const fs::path& folder, const char* name, detail::Check check) {
  return detail::read_grid<T>(folder / name, detail::convert_voxels, check, folder);
}

Status load_volumes(const fs::path& folder, anatomy::VirtualPatient& patient) {
  Result<volume::CtGrid> ct, distance;
  Result<volume::LabelGrid> labels;
  using detail::Check;  // The content hash later verifies that CT and labels are complete.
  parallel_invoke([&] { ct = read_volume<std::int16_t>(folder, kCtFile, Check::kSize); },
                  [&] { labels = read_volume<std::uint8_t>(folder, kLabelFile, Check::kSize); },
                  [&] {
                    distance = read_volume<std::int16_t>(folder, kDistanceFile, Check::kUnpack);
                    if (distance) patient.skin_distance_mm = from_hundredths(*distance);
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
  patient.skin_distance_mm = from_hundredths(to_hundredths(patient.skin_distance_mm));
}

Status save_patient(const anatomy::VirtualPatient& patient, const std::vector<anatomy::NamedMesh>& meshes,
                    const fs::path& folder, const Progress& progress, const std::vector<PatientExtra>& extras) {
  TROCAR_TRY_STATUS(check_geometry(patient, folder.string()));
  TROCAR_TRY_STATUS(check_label_ids(patient, folder.string()));
  return write_folder_atomically(folder, [&](const fs::path& temporary) -> Status {
    TROCAR_TRY_STATUS(write_contents(patient, meshes, temporary, progress));
    for (const PatientExtra& extra : extras) {
      TROCAR_CHECK(!fs::exists(temporary / extra.name));
      TROCAR_TRY_STATUS(write_file_atomically(temporary / extra.name, extra.text));
    }
    return {};
  });
}

Result<PatientTitle> load_patient_title(const fs::path& folder) {
  TROCAR_TRY(const detail::PatientDescription description, load_description(folder));
  return PatientTitle{description.name, description.description};
}

Result<anatomy::VirtualPatient> load_patient(const fs::path& folder) {
  TROCAR_TRY(detail::PatientDescription description, load_description(folder));
  anatomy::VirtualPatient patient;
  patient.name = std::move(description.name);
  patient.description = std::move(description.description);
  patient.provenance = std::move(description.provenance);
  patient.label_table = std::move(description.label_table);
  TROCAR_TRY_STATUS(load_volumes(folder, patient));
  TROCAR_TRY_STATUS(check_geometry(patient, folder.string()));
  TROCAR_TRY_STATUS(check_label_ids(patient, folder.string()));
  TROCAR_TRY(patient.landmarks, read_landmarks(folder / kLandmarkFile, folder));
  TROCAR_TRY(patient.paths, read_paths(folder / kPathFile, folder));
  patient.content_hash = anatomy::hash_patient(patient);
  log_info("loaded {}: {} labels, {:.1f} Mvoxel", folder.string(), patient.label_table.labels.size(),
           1e-6 * static_cast<double>(patient.labels.voxels.size()));
  if (patient.content_hash == description.content_hash) return patient;
  return fail("the patient's volumes or labels changed after it was built", folder.string(), kBuildAgain);
}

Result<std::vector<anatomy::NamedMesh>> load_patient_meshes(const fs::path& folder) {
  TROCAR_TRY(const detail::PatientDescription description, load_description(folder));
  std::vector<anatomy::NamedMesh> meshes;
  for (const detail::PatientMeshEntry& entry : description.meshes) {
    TROCAR_TRY(TriangleMesh mesh_P, read_mesh(folder / entry.file, folder));
    meshes.push_back({entry.name, std::move(mesh_P)});
  }
  return meshes;
}

}  // namespace trocar::io
