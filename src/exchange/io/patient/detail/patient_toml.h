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

// Files of a patient folder.
inline constexpr const char* kDescriptionFile = "patient.toml";
inline constexpr const char* kCtFile = "ct.nrrd";
inline constexpr const char* kLabelFile = "labels.nrrd";
inline constexpr const char* kDistanceFile = "skin_distance.nrrd";
inline constexpr const char* kLandmarkFile = "landmarks.mrk.json";
inline constexpr const char* kPathFile = "paths.mrk.json";
// Of a motion model, all or none.
inline constexpr const char* kMotionFile = "motion.toml";
inline constexpr const char* kMotionModesFile = "motion_modes.nrrd";
inline constexpr const char* kMotionBorderFile = "motion_border.nrrd";

inline constexpr const char* kBuildAgain = "build the patient again";

/// Reads patient.toml. Errors: not a patient folder, a newer version, a damaged file.
Result<PatientDescription> load_description(const std::filesystem::path& folder);

/// The distance to the skin in hundredths of a mm, clamped at 327 mm, as stored in skin_distance.nrrd.
volume::CtGrid to_hundredths(const volume::FloatGrid& distance_mm);
volume::FloatGrid from_hundredths(const volume::CtGrid& hundredths);

/// Error: the label table lacks a label of the volume.
Status check_label_ids(const anatomy::VirtualPatient& patient, const std::string& where);
/// Error: CT, labels and skin distance are on different grids.
Status check_geometry(const anatomy::VirtualPatient& patient, const std::string& where);

}  // namespace trocar::io::detail
