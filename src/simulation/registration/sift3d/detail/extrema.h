#pragma once

#include <vector>

#include "registration/sift3d/scale_space.h"

namespace trocar::registration::detail {

/// Voxel whose difference of Gaussians exceeds, or falls below, that of its 26 neighbours and of 27 each at the scales
/// above and below.
struct Extremum {
  volume::Index3 ijk{0, 0, 0};
  int level = 0;  ///< Of the difference: level + 1 less level. 1..scales.
};

/// Extrema of an octave of absolute value `least` or more, in the order of voxels in memory, levels within. Voxels with
/// a neighbour that is not usable are no extrema. Parallel.
/// `scale_exponent`: differences are multiplied by 2^(scale_exponent * level / scales) before they are compared.
std::vector<Extremum> find_extrema(const Octave& octave, int scales, double scale_exponent, float least);

}  // namespace trocar::registration::detail
