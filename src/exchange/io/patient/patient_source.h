#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "anatomy/patient.h"
#include "core/progress.h"
#include "core/result.h"

namespace trocar::io {

/// How a command names its patient: a patient folder, or else an embedded patient by name.
struct PatientSource {
  std::string folder_or_name;
  std::uint64_t seed = 1;  ///< Of an embedded patient.
  /// Embedded patients are kept there (PatientCache); empty: they are generated each time.
  std::filesystem::path cache_folder = {};
};

/// A folder by its absolute path, so that it is found from another working folder, too; a name as it is.
std::string absolute_source(const std::string& folder_or_name);

/// Where a recorded patient lies now: the folder that was recorded, the same path from `beside` (the folder of the
/// record), or a folder in `beside`; the first whose content hash is `hash`. A recorded folder with another hash is
/// given where there is no better one; an embedded patient's name is given as it is. Error: nothing of these is there.
Result<std::string> find_recorded_patient(const std::string& recorded, const std::string& hash,
                                          const std::filesystem::path& beside);

/// Whether a source names a folder; else it is an embedded patient's name.
bool is_path(const std::string& folder_or_name);

/// The patient behind a source: read from its folder, or generated. A folder wins over an embedded patient of the same
/// name; a name that is neither is an error that lists the embedded patients (exit status 2). Ignores the cache: for
/// programs that only read (open_patient.h for the others).
Result<anatomy::VirtualPatient> load_source(const PatientSource& source, const Progress& progress = {});

}  // namespace trocar::io
