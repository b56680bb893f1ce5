#pragma once

#include <string>
#include <vector>

#include "anatomy/derive/derive_choice.h"
#include "anatomy/known_structures.h"
#include "anatomy/patient.h"
#include "core/progress.h"

namespace trocar::anatomy {

/// Error: one of the structures that derive_structures adds is not known.
Status check_derived_names(const KnownStructures& known);

/// Adds the chosen thin structures that segmentation programs do not give to a patient whose body is completely
/// labelled (detail/fill_unlabelled): each where its neighbours are labelled, and none that the segmentation has. The
/// volumes have their axes in the order of P. Returns the names of the structures that were added.
std::vector<std::string> derive_structures(VirtualPatient& patient, const KnownStructures& known,
                                           const DeriveChoice& choice, const Progress& progress = {});

}  // namespace trocar::anatomy
