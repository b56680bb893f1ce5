#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "anatomy/patient.h"
#include "core/progress.h"
#include "core/result.h"

namespace trocar::io {

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
/// programs that only read (others use open_patient.h).
Result<anatomy::VirtualPatient> load_source(const PatientSource& source, const Progress& progress = {});

}  // namespace trocar::io
