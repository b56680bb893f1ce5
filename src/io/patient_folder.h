#pragma once

#include <filesystem>
#include <vector>

#include "anatomy/patient.h"
#include "core/progress.h"
#include "core/result.h"

namespace trocar {

inline constexpr int kPatientFormatVersion = 1;  ///< A folder of a newer version is refused.

/// Writes a patient folder, whole or not at all: patient.toml, ct.nrrd, labels.nrrd, skin_distance.nrrd,
/// meshes/NAME.vtp, landmarks.mrk.json, paths.mrk.json. An existing folder is never overwritten.
Status save_patient(const VirtualPatient& patient, const std::vector<NamedMesh>& meshes,
                    const std::filesystem::path& folder, const Progress& progress = {});
/// Reads it back without the meshes; volumes side by side. Checks geometry, label table and hash.
Result<VirtualPatient> load_patient(const std::filesystem::path& folder);
Result<std::vector<NamedMesh>> load_patient_meshes(const std::filesystem::path& folder);

}  // namespace trocar
