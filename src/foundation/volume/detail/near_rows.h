#pragma once

#include <optional>

#include "volume/grid.h"

namespace trocar::volume::detail {

/// 1 where the centre of a voxel of the mask lies within `radius_mm`: exact, as by the distance, and faster for small
/// balls. Nothing for a ball of many rows. Parallel.
std::optional<MaskGrid> find_near(const MaskGrid& mask, double radius_mm);

}  // namespace trocar::volume::detail
