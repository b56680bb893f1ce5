#pragma once

#include <cstdint>

#include "volume/grid.h"

namespace trocar::anatomy::phantom {

/// Adds the quantum noise of a scanner: Gaussian, sigma 9 HU at the skin to 13 HU in the middle of the body, correlated
/// over about 1.3 voxels [assumed: an abdominal CT of standard dose with a soft kernel]. HU stay within -1024..3071.
/// Parallel; a pure function of seed and voxel index.
void add_scanner_noise(volume::CtGrid& ct, const volume::FloatGrid& skin_distance_mm, std::uint64_t seed);

}  // namespace trocar::anatomy::phantom
