#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "anatomy/patient.h"
#include "core/progress.h"
#include "core/result.h"

namespace trocar {

/// How a command names its patient: a patient folder, or else an embedded patient by name.
struct PatientSource {
  std::string folder_or_name;
  std::uint64_t seed = 1;  ///< Of an embedded patient.
};

/// The patient behind a source. A folder wins over an embedded patient of the same name; a name that is neither is an
/// error that lists the embedded patients (exit status 2).
Result<VirtualPatient> open_patient(const PatientSource& source, const Progress& progress = {});
/// Its surfaces: read from the folder, extracted from the labels of an embedded patient.
Result<std::vector<NamedMesh>> open_meshes(const PatientSource& source, const VirtualPatient& patient,
                                           const Progress& progress = {});

}  // namespace trocar
