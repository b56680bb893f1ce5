#pragma once

#include "anatomy/label_table.h"
#include "volume/grid.h"

namespace trocar::anatomy::detail {

/// Gives every voxel inside the body that has no label one by its smoothed CT value and its region: "fat", "muscle",
/// "bone_other", "gas", "lung", else "soft_tissue". The labels that were used are added to the table.
void fill_unlabelled(const volume::CtGrid& ct, const volume::FloatGrid& skin_distance_mm, volume::LabelGrid& labels,
                     LabelTable& table);

}  // namespace trocar::anatomy::detail
