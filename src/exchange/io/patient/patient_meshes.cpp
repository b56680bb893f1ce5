#include "io/mesh_file.h"
#include "io/patient/detail/patient_layout.h"
#include "io/patient/patient_folder.h"

namespace trocar::io {
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
