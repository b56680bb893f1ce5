#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "ultrasound/sweep/freehand.h"
#include "volume/grid.h"

namespace trocar::ultrasound::detail {

/// Fills voxels that are not `known` (1: a known voxel) from known ones, by the first of `ways` that is applicable;
/// returns the number of filled voxels. A filled voxel is not a source for other voxels.
std::size_t fill_holes(volume::LabelGrid& gray, const std::vector<std::uint8_t>& known,
                       const std::vector<HoleFilling>& ways);

}  // namespace trocar::ultrasound::detail
