#include "io/patient_source.h"

#include <filesystem>

#include "anatomy/phantom/phantom.h"
#include "io/patient_folder.h"
#include "surface/extract_surface.h"

namespace trocar {
namespace {
namespace fs = std::filesystem;

bool is_path(const std::string& folder_or_name) {
  std::error_code ignored;
  return folder_or_name.find('/') != std::string::npos || fs::exists(folder_or_name, ignored);
}

}  // namespace

Result<VirtualPatient> open_patient(const PatientSource& source, const Progress& progress) {
  if (is_path(source.folder_or_name)) return load_patient(source.folder_or_name);
  return generate_phantom(source.folder_or_name, source.seed, {}, progress);
}

Result<std::vector<NamedMesh>> open_meshes(const PatientSource& source, const VirtualPatient& patient,
                                           const Progress& progress) {
  if (is_path(source.folder_or_name)) return load_patient_meshes(source.folder_or_name);
  return extract_surfaces(patient, {}, progress);
}

}  // namespace trocar
