#pragma once

#include <optional>
#include <string>
#include <vector>

#include "anatomy/known_structures.h"
#include "anatomy/tissue/hounsfield.h"
#include "patient_builder/build_patient.h"
#include "patient_builder/plausibility/anatomy_finding.h"

namespace trocar::patient_builder {

// Judges a segmentation as a whole, see AnatomyFinding.

/// Finds a source whose values mean structures of plausible HU and order by another label map, and not by the given
/// one.
std::vector<AnatomyFinding> judge_numbers(const volume::CtGrid& ct, const std::vector<LabelSource>& sources,
                                          const anatomy::KnownStructures& known);

/// The structures of a segmentation in a patient that has a CT, labels and their table, but no repairs and nothing
/// found from HU yet: directions, place, HU, volumes. The axes of the volumes run along P.
std::vector<AnatomyFinding> judge_anatomy(const anatomy::VirtualPatient& patient,
                                          Mirroring mirroring = Mirroring::kNone);

/// How much of the sides of a CT (left, right, front, back) lies inside the body: where it does, there is no skin.
/// Grave from half on.
std::vector<AnatomyFinding> judge_sides(const volume::MaskGrid& body);
/// Makes the sides of the CT the skin where they lie inside the body.
void take_sides_as_skin(volume::MaskGrid& body);
/// A CT that a person has confirmed to be cropped needs no air.
anatomy::AirIn air_of(const std::vector<std::string>& confirmed);

/// The posture in which a CT was taken, from the side of the body on which its table lies: what is outside the body and
/// the same in most slices. None if there is no table, or no clear side. Axes along P.
std::optional<anatomy::Posture> find_scanned_posture(const volume::CtGrid& ct, const volume::MaskGrid& body);
/// Told if the patient was scanned otherwise than `posture`: organs, gas and fluid lie as they were scanned.
std::vector<AnatomyFinding> judge_posture(const volume::CtGrid& ct, const volume::MaskGrid& body,
                                          anatomy::Posture posture);

/// The line of the provenance that keeps a confirmed finding, and whether one of that name is among its lines.
std::string confirmation(const AnatomyFinding& finding);
bool is_confirmed(const std::vector<std::string>& provenance, const std::string& name);

/// Sorts findings into what was confirmed (provenance), what is only told (warnings), and the first grave one, which is
/// the error.
Status settle_findings(const std::vector<AnatomyFinding>& findings, const std::vector<std::string>& confirmed,
                       std::vector<std::string>& provenance, std::vector<std::string>& warnings);

/// Errors (exit status 2): a name that no finding has.
Status check_confirmable(const std::vector<std::string>& names);

}  // namespace trocar::patient_builder
