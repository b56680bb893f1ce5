#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "anatomy/patient.h"
#include "core/result.h"

namespace trocar::io::detail {

struct PatientMeshEntry {
  std::string name;  ///< The label's name, or "skin".
  std::string file;  ///< Below the patient folder: "meshes/liver.vtp".
};

/// Content of patient.toml.
struct PatientDescription {
  std::string name;
  std::string description;
  std::vector<std::string> provenance;
  anatomy::Posture posture = anatomy::Posture::kSupine;
  std::string content_hash;
  anatomy::LabelTable label_table;
  std::vector<PatientMeshEntry> meshes;
  std::vector<anatomy::Finding> repairs;
};

/// The file's text, format version kPatientFormatVersion.
std::string to_toml(const PatientDescription& patient);

/// Reads patient.toml. Errors: missing, of a newer version, an unknown key, label ids or names that are not unique, a
/// mesh file outside of meshes/, a link that leads out of the folder.
Result<PatientDescription> load_patient_toml(const std::filesystem::path& path, const std::filesystem::path& folder);

}  // namespace trocar::io::detail
