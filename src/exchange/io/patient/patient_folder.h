#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "anatomy/patient.h"
#include "core/progress.h"
#include "core/result.h"

namespace trocar::io {

inline constexpr int kPatientFormatVersion = 1;  ///< A folder of a newer version is refused.

/// An additional small file in the patient folder: task.toml.
struct PatientExtra {
  std::string name;  ///< File name without a folder; not the name of a patient file.
  std::string text;
};

/// Writes a patient folder completely or not at all: patient.toml, ct.nrrd, labels.nrrd, skin_distance.nrrd,
/// meshes/NAME.vtp, landmarks.mrk.json, paths.mrk.json. An existing folder is never overwritten. The skin distance is
/// stored in hundredths of a mm, up to 327 mm. The files of a panorama (patient_panorama.h) in `panorama_from`, the
/// folder from which the patient was read, are copied if they exist.
Status save_patient(const anatomy::VirtualPatient& patient, const std::vector<anatomy::NamedMesh>& meshes,
                    const std::filesystem::path& folder, const Progress& progress = {},
                    const std::vector<PatientExtra>& extras = {}, const std::filesystem::path& panorama_from = {});
/// Reads a patient folder without the meshes; reads the volumes in parallel. Errors: not a patient folder, a newer
/// version, a missing or damaged file, volumes on different grids, a label without a name, a content hash that does not
/// match.
Result<anatomy::VirtualPatient> load_patient(const std::filesystem::path& folder);
/// Data for a list of patients; read without the volumes. Errors: not a patient folder, a newer version, a damaged
/// file.
struct PatientTitle {
  std::string name, description;
};
Result<PatientTitle> load_patient_title(const std::filesystem::path& folder);
/// Rounds skin distance and geometry to the precision of a patient folder: a patient and its saved copy are then
/// bit-identical.
void round_as_saved(anatomy::VirtualPatient& patient);
Result<std::vector<anatomy::NamedMesh>> load_patient_meshes(const std::filesystem::path& folder);

}  // namespace trocar::io
