#pragma once

#include <vector>

#include "anatomy/patient.h"
#include "core/progress.h"
#include "core/result.h"
#include "io/patient/patient_source.h"

namespace trocar::io {

/// The patient behind a source, with the source's cache: an embedded patient is kept there, and read from there. It is
/// the same whether it comes from the cache or not. Errors of load_source().
Result<anatomy::VirtualPatient> open_patient(const PatientSource& source, const Progress& progress = {});
/// Its surfaces: read from the folder, extracted from the labels of an embedded patient.
Result<std::vector<anatomy::NamedMesh>> open_meshes(const PatientSource& source, const anatomy::VirtualPatient& patient,
                                                    const Progress& progress = {});

}  // namespace trocar::io
