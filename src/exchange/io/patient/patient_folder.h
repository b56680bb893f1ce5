#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "anatomy/patient.h"
#include "core/progress.h"
#include "core/result.h"

namespace trocar::io {

inline constexpr int kPatientFormatVersion = 1;  ///< A folder of a newer version is refused.

/// A small file that lies beside the patient's own: task.toml.
struct PatientExtra {
  std::string name;  ///< Without a folder; none of the patient's own files.
  std::string text;
};

/// Writes a patient folder, whole or not at all: patient.toml, ct.nrrd, labels.nrrd, skin_distance.nrrd,
/// meshes/NAME.vtp, landmarks.mrk.json, paths.mrk.json. An existing folder is never overwritten. The skin distance is
/// kept in hundredths of a mm, up to 327 mm.
Status save_patient(const anatomy::VirtualPatient& patient, const std::vector<anatomy::NamedMesh>& meshes,
                    const std::filesystem::path& folder, const Progress& progress = {},
                    const std::vector<PatientExtra>& extras = {});
/// Reads it back without the meshes; volumes side by side. Errors: no patient folder, a newer version, a missing or
/// damaged file, volumes on different grids, a label without a name, a content hash that does not fit.
Result<anatomy::VirtualPatient> load_patient(const std::filesystem::path& folder);
/// What a list of patients shows; without the volumes. Errors: no patient folder, a newer version, a damaged file.
struct PatientTitle {
  std::string name, description;
};
Result<PatientTitle> load_patient_title(const std::filesystem::path& folder);
/// Rounds skin distance and geometry as a patient folder keeps them: a patient and its saved copy give the same bits.
void round_as_saved(anatomy::VirtualPatient& patient);
Result<std::vector<anatomy::NamedMesh>> load_patient_meshes(const std::filesystem::path& folder);

}  // namespace trocar::io
