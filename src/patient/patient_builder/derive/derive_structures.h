#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "anatomy/known_structures.h"
#include "anatomy/patient.h"
#include "core/progress.h"
#include "core/result.h"

namespace trocar::patient_builder {

/// Structures that a build can add, in the order in which they are made. A name without its side is one entry.
inline constexpr std::string_view kDerivable[] = {"dural_sac",
                                                  "ligamentum_flavum",
                                                  "epidural_fat",
                                                  "epidural_veins",
                                                  "interspinous_ligament",
                                                  "supraspinous_ligament",
                                                  "bile_ducts",
                                                  "pleural_recess",
                                                  "inferior_epigastric_zone",
                                                  "neurovascular_bundle",
                                                  "peritoneum"};

/// Start of the name of a structure in an exported segmentation that was derived, and not seen: a build keeps it so.
inline constexpr std::string_view kDerivedMark = "derived_";
/// True for one of kDerivable, with or without a side.
bool is_derivable(std::string_view name);
/// True for kDerivedMark and the name of one.
bool is_marked_derived(std::string_view name);

/// Which of them a build adds. The default is all.
struct DeriveChoice {
  bool is_all = true;
  std::vector<std::string> names;  ///< Without `is_all`: these.

  bool has(std::string_view name) const noexcept;
};

/// Those of kDerivable that a label table has, derived or segmented.
DeriveChoice derivable_in(const anatomy::LabelTable& table);

/// "all", "none", or names separated by commas. Error (exit status 2): an unknown name.
Result<DeriveChoice> parse_derive_choice(std::string_view text);

/// Error: one of the structures that derive_structures adds is not known.
Status check_derived_names(const anatomy::KnownStructures& known);

/// Adds the chosen thin structures that segmentation programs do not give to a patient whose body is completely
/// labelled (complete_labels.h): each where its neighbours are labelled, and none that the segmentation has. The
/// volumes have their axes in the order of P. Returns the names of the structures that were added.
std::vector<std::string> derive_structures(anatomy::VirtualPatient& patient, const anatomy::KnownStructures& known,
                                           const DeriveChoice& choice, const Progress& progress = {});

}  // namespace trocar::patient_builder
