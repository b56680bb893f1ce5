#pragma once

#include "anatomy/known_structures.h"
#include "anatomy/label_table.h"
#include "core/result.h"
#include "volume/grid.h"

namespace trocar::anatomy::detail {

/// Error: one of the structures that fill_unlabelled assigns is not known.
Status check_fill_names(const KnownStructures& known);

/// Assigns a label to every unlabelled voxel inside the body by its smoothed CT value and its region: "fat", "muscle",
/// "bone_other", "gas", "lung", else "soft_tissue". The used labels are added to the table. Precondition:
/// check_fill_names has passed.
void fill_unlabelled(const volume::CtGrid& ct, const volume::FloatGrid& skin_distance_mm, volume::LabelGrid& labels,
                     LabelTable& table, const KnownStructures& known);

}  // namespace trocar::anatomy::detail
