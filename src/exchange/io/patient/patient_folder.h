#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "anatomy/patient.h"
#include "core/progress.h"
#include "core/result.h"
#include "geometry/pose.h"
#include "io/image/image_file.h"

namespace trocar::io {

inline constexpr int kPatientFormatVersion = 2;  ///< 2: derived labels, repairs. A newer one is refused.

/// An additional small file in the patient folder: task.toml, tissues.toml, thumbnail.png.
struct PatientExtra {
  std::string name;  ///< File name without a folder; not the name of a patient file.
  std::string text;  ///< Its bytes.
};

/// A recorded ultrasound to write with a patient.
struct RecordedUltrasound {
  const volume::LabelGrid& gray_U;
  const ImageFields& fields;
  std::optional<Pose> X_PU;                    ///< Empty: not yet registered; no transform is written.
  std::vector<anatomy::Landmark> landmarks_U;  ///< Positions in U.
};

/// Compression of CT and labels in their files.
enum class VolumePacking {
  kSmall,  ///< gzip.
  kFast    ///< None: for files that are read again soon.
};

/// Writes a patient folder completely or not at all: patient.toml, ct.nrrd, labels.nrrd, skin_distance.nrrd,
/// meshes/NAME.vtp, landmarks.mrk.json, paths.mrk.json. An existing folder is never overwritten. The skin distance is
/// stored in hundredths of a mm, up to 327 mm. `ultrasound` may be null.
Status save_patient(const anatomy::VirtualPatient& patient, const std::vector<anatomy::NamedMesh>& meshes,
                    const std::filesystem::path& folder, const Progress& progress = {},
                    const std::vector<PatientExtra>& extras = {}, const RecordedUltrasound* ultrasound = nullptr,
                    VolumePacking packing = VolumePacking::kSmall);
/// Writes surfaces into a patient folder that has none; a folder that has surfaces stays as it is. A reader of the
/// folder finds either no surfaces or all. Errors: disk error, not a patient folder.
Status add_patient_meshes(const std::filesystem::path& folder, const std::vector<anatomy::NamedMesh>& meshes);
/// Reads a patient folder without the meshes; reads the volumes in parallel. Errors: not a patient folder, a newer
/// version, a missing or damaged file, volumes on different grids, a label without a name, a content hash that does not
/// match.
Result<anatomy::VirtualPatient> load_patient(const std::filesystem::path& folder);
/// The same without the motion model, whatever it is.
Result<anatomy::VirtualPatient> load_anatomy(const std::filesystem::path& folder);
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

/// Patient argument of a command: a patient folder, or the name of an embedded patient.
struct PatientSource {
  std::string folder_or_name;
  std::uint64_t seed = 1;  ///< Seed of an embedded patient.
  /// Folder of PatientCache for embedded patients; if empty, they are generated each time.
  std::filesystem::path cache_folder = {};
};

/// Makes the path of a folder absolute, so that it is valid in another working folder; returns a name unchanged.
std::string absolute_source(const std::string& folder_or_name);

/// Finds a recorded patient. Candidates are the recorded folder, the same path relative to `beside` (the folder of the
/// record), and folders in `beside`; the result is the first whose content hash is `hash`. Without such a folder, the
/// result is a recorded folder with another hash. The name of an embedded patient is returned unchanged. Error: none of
/// these exists.
Result<std::string> find_recorded_patient(const std::string& recorded, const std::string& hash,
                                          const std::filesystem::path& beside);

/// True if a source names a folder; else it is the name of an embedded patient.
bool is_path(const std::string& folder_or_name);

/// Loads the patient of a source: reads its folder or generates it. A folder has precedence over an embedded patient of
/// the same name. For any other name, the error lists the embedded patients (exit status 2). Ignores the cache: for
/// programs that only read (others use open_patient).
Result<anatomy::VirtualPatient> load_source(const PatientSource& source, const Progress& progress = {});

}  // namespace trocar::io
