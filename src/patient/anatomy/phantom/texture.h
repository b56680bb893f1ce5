#pragma once

#include <cstdint>

#include "volume/grid.h"

namespace trocar::anatomy::phantom {

/// Adds the quantum noise of a scanner: Gaussian with sigma_hu half way to the middle of the body, a fifth less at the
/// skin and a fifth more in the middle, two thirds of its power correlated over about 1.3 voxels,
/// the rest white. HU stay within
/// -1024..3071. Parallel; a pure function of seed and voxel index.
void add_scanner_noise(volume::CtGrid& ct, const volume::FloatGrid& skin_distance_mm, std::uint64_t seed,
                       double sigma_hu);

}  // namespace trocar::anatomy::phantom
