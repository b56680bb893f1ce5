#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "anatomy/known_structures.h"
#include "anatomy/patient.h"
#include "core/progress.h"
#include "core/result.h"
#include "patient_builder/derive/derive_structures.h"

namespace trocar::patient_builder {

/// Error: a structure that complete_labels adds is not known.
Status check_completed_names(const anatomy::KnownStructures& known);

/// The last steps of build_patient: labels every unlabelled voxel of the body from HU and position, then adds the thin
/// structures of `derive` where their neighbours are labelled. Uses CT, labels and skin distance; what it adds is
/// marked as derived. Returns the names of the thin structures. Precondition: check_completed_names has passed, and
/// the label table leaves six free ids above its last.
std::vector<std::string> complete_labels(anatomy::VirtualPatient& patient, const anatomy::KnownStructures& known,
                                         const DeriveChoice& derive, const Progress& progress = {});

/// The patient that build_patient makes of the same CT and skin if the segmentation has only structures of these
/// tissues: all others and the derived ones are removed, the rest is numbered from 1, and complete_labels adds what it
/// finds without them, thin structures only of the kinds that `full` has. Landmarks and paths stay. Errors: no
/// structure data.
Result<anatomy::VirtualPatient> with_segmented_only(const anatomy::VirtualPatient& full,
                                                    std::span<const std::string_view> tissues,
                                                    const Progress& progress = {});

/// Removes the labels that complete_labels found from HU and position (fat, muscle, gas ...); the thin structures stay.
void remove_found_labels(anatomy::VirtualPatient& patient);

}  // namespace trocar::patient_builder
