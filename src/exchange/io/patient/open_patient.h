#pragma once

#include <optional>
#include <vector>

#include "anatomy/patient.h"
#include "core/progress.h"
#include "core/result.h"
#include "io/patient/patient_source.h"

namespace trocar::io {

/// Loads the patient of a source with the source's cache: an embedded patient is stored in the cache and read from it.
/// The patient is identical with and without the cache. Errors: those of load_source().
Result<anatomy::VirtualPatient> open_patient(const PatientSource& source, const Progress& progress = {});
/// Surfaces of the patient: read from its folder, or extracted from the labels of an embedded patient.
Result<std::vector<anatomy::NamedMesh>> open_meshes(const PatientSource& source, const anatomy::VirtualPatient& patient,
                                                    const Progress& progress = {});

/// Surfaces of an embedded patient in its cache; empty if it has none there.
std::optional<std::vector<anatomy::NamedMesh>> find_kept_meshes(const PatientSource& source);

}  // namespace trocar::io
