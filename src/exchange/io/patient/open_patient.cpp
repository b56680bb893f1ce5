#include "io/patient/open_patient.h"

#include "core/log.h"
#include "io/patient/patient_cache.h"
#include "io/patient/patient_folder.h"
#include "surface/extract_surface.h"

namespace trocar::io {
namespace {

/// If the cache cannot be written, the command continues more slowly.
template <class Kept>
void log_if_failed(const Kept& kept) {
  if (!kept) log_info("the patient is not cached: {}", kept.error().text());
}

}  // namespace

Result<anatomy::VirtualPatient> open_patient(const PatientSource& source, const Progress& progress) {
  if (source.cache_folder.empty() || is_path(source.folder_or_name)) return load_source(source, progress);
  const PatientCache cache(source.cache_folder);
  if (const auto kept = cache.find(source)) {
    if (auto patient = load_patient(*kept)) return patient;
    cache.forget(source);
  }
  TROCAR_TRY(anatomy::VirtualPatient patient, load_source(source, progress));
  log_if_failed(cache.keep(source, patient));
  return patient;
}

Result<std::vector<anatomy::NamedMesh>> open_meshes(const PatientSource& source, const anatomy::VirtualPatient& patient,
                                                    const Progress& progress) {
  if (is_path(source.folder_or_name)) return load_patient_meshes(source.folder_or_name);
  const PatientCache cache(source.cache_folder);
  if (auto kept = find_kept_meshes(source)) return *std::move(kept);
  auto meshes = surface::extract_surfaces(patient, {}, progress);
  log_if_failed(cache.keep_surfaces(source, meshes));
  return meshes;
}

std::optional<std::vector<anatomy::NamedMesh>> find_kept_meshes(const PatientSource& source) {
  const auto kept = PatientCache(source.cache_folder).find(source);
  if (!kept) return std::nullopt;
  auto meshes = load_patient_meshes(*kept);
  if (!meshes || meshes->empty()) return std::nullopt;
  return *std::move(meshes);
}

}  // namespace trocar::io
