#include "io/patient/open_patient.h"

#include "core/log.h"
#include "io/patient/patient_cache.h"
#include "io/patient/patient_folder.h"
#include "surface/extract_surface.h"

namespace trocar::io {
namespace fs = std::filesystem;
namespace {

/// If the cache cannot be written, the command continues more slowly.
void log_if_failed(const Result<fs::path>& kept) {
  if (!kept) log_info("the patient is not cached: {}", kept.error().text());
}

}  // namespace

Result<anatomy::VirtualPatient> open_patient(const PatientSource& source, const Progress& progress) {
  if (source.cache_folder.empty() || is_path(source.folder_or_name)) return load_source(source, progress);
  const PatientCache cache(source.cache_folder);
  if (const auto kept = cache.find_volumes(source)) {
    if (auto patient = load_patient(*kept)) return patient;
    cache.forget(source);
  }
  TROCAR_TRY(anatomy::VirtualPatient patient, load_source(source, progress));
  log_if_failed(cache.keep(source, patient, {}));
  return patient;
}

Result<std::vector<anatomy::NamedMesh>> open_meshes(const PatientSource& source, const anatomy::VirtualPatient& patient,
                                                    const Progress& progress) {
  if (is_path(source.folder_or_name)) return load_patient_meshes(source.folder_or_name);
  const PatientCache cache(source.cache_folder);
  if (const auto kept = cache.find(source))
    if (auto meshes = load_patient_meshes(*kept)) return meshes;
  auto meshes = surface::extract_surfaces(patient, {}, progress);
  if (!source.cache_folder.empty()) log_if_failed(cache.keep(source, patient, meshes));
  return meshes;
}

}  // namespace trocar::io
