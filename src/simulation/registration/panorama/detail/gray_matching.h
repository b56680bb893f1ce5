#pragma once

#include <array>
#include <vector>

#include "registration/panorama/blend.h"

namespace trocar::registration::detail {

/// For each volume, the gray level of the first one (0..255) that corresponds to each of its own: equal ranks among the
/// usable voxels that a volume has in common with those before it. Volumes with little in common keep their levels.
std::vector<std::array<float, 256>> match_gray_levels(const std::vector<PlacedVolume>& volumes);

}  // namespace trocar::registration::detail
