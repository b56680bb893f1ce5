#pragma once

#include <string>
#include <vector>

#include "anatomy/build_patient.h"
#include "anatomy/known_structures.h"
#include "anatomy/tissue/hounsfield.h"

namespace trocar::anatomy {

// Judges a segmentation as a whole: what no single structure shows, and what makes another patient of it. Each finding
// has a name by which a person can confirm that the patient is really like that.

/// Names of the findings.
inline constexpr const char* kMirrored = "mirrored";  ///< Left and right are exchanged.
inline constexpr const char* kTurned = "turned";      ///< Two or three directions are exchanged.
inline constexpr const char* kShifted = "shifted";    ///< The labels lie beside what the CT shows.
inline constexpr const char* kNumbers = "numbers";    ///< The label numbers have another meaning.
inline constexpr const char* kOtherCt = "other-ct";   ///< Many structures have HU that they cannot have.
inline constexpr const char* kCropped = "cropped";    ///< The sides of the CT lie inside the body.
inline constexpr const char* kMissing = "missing";    ///< A large organ has no label in a whole segmentation.
inline constexpr const char* kSizes = "sizes";        ///< An organ has a volume that no person's has.

struct AnatomyFinding {
  std::string name;      ///< One of the above.
  std::string text;      ///< What was found, with numbers: one line.
  std::string advice;    ///< The likely cause and the option that repairs it.
  bool is_grave = true;  ///< No patient is built unless it is confirmed; else it is told.
};

/// Finds a source whose values mean structures of plausible HU and order by another label map, and not by the given
/// one.
std::vector<AnatomyFinding> judge_numbers(const volume::CtGrid& ct, const std::vector<LabelSource>& sources,
                                          const KnownStructures& known);

/// The structures of a segmentation in a patient that has a CT, labels and their table, but no repairs and nothing
/// found from HU yet: directions, place, HU, volumes. The axes of the volumes run along P.
std::vector<AnatomyFinding> judge_anatomy(const VirtualPatient& patient);

/// How much of the sides of a CT (left, right, front, back) lies inside the body: where it does, there is no skin.
/// Grave from half on.
std::vector<AnatomyFinding> judge_sides(const volume::MaskGrid& body);
/// Makes the sides of the CT the skin where they lie inside the body.
void take_sides_as_skin(volume::MaskGrid& body);
/// A CT that a person has confirmed to be cropped needs no air.
AirIn air_of(const std::vector<std::string>& confirmed);

/// Sorts findings into what was confirmed (provenance), what is only told (warnings), and the first grave one, which is
/// the error.
Status settle_findings(const std::vector<AnatomyFinding>& findings, const std::vector<std::string>& confirmed,
                       std::vector<std::string>& provenance, std::vector<std::string>& warnings);

/// Errors (exit status 2): a name that no finding has.
Status check_confirmable(const std::vector<std::string>& names);

}  // namespace trocar::anatomy
