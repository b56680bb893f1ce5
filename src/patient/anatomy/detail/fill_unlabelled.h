#pragma once

#include "anatomy/label_table.h"
#include "volume/grid.h"

namespace trocar::detail {

/// Gives every voxel inside the body that has no label one by its smoothed CT value and its region: "fat", "muscle",
/// "bone_other", "gas", "lung", else "soft_tissue". The labels that were used are added to the table.
void fill_unlabelled(const CtGrid& ct, const FloatGrid& skin_distance_mm, LabelGrid& labels, LabelTable& table);

}  // namespace trocar::detail
