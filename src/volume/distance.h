#pragma once

#include "volume/grid.h"

namespace trocar {

/// Exact Euclidean signed distance (mm, anisotropic spacing) from voxel centres to the surface of a mask: negative
/// inside, positive outside, the surface half way between an inside and an outside voxel centre. A mask without surface
/// gives +-infinity. Parallel; separable lower envelopes (Felzenszwalb & Huttenlocher 2012,
/// doi 10.4086/toc.2012.v008a019).
FloatGrid signed_distance_mm(const MaskGrid& mask);

/// Exact Euclidean distance (mm) from each voxel centre to the nearest voxel centre of the mask (0 on the mask).
FloatGrid distance_to_mask_mm(const MaskGrid& mask);

}  // namespace trocar
