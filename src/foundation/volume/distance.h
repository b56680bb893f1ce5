#pragma once

#include "volume/grid.h"

namespace trocar::volume {

/// Signed distance (mm, anisotropic spacing) from voxel centres to the surface of a mask: negative inside, positive
/// outside. The surface is the set of points half way between two neighbouring voxel centres, one inside, one outside
/// (the centres of the faces between them); the distance to that set is exact (Euclidean, to a float's rounding). The
/// distance to planes along the grid axes is exact. Against any other surface that the mask was made from (a voxel is
/// inside where its centre is), |distance| is too small by at most half the largest spacing, because the face centres
/// lie within that distance of it; and too large by at most 0.55 of it on planes and on spheres of fifteen voxels'
/// radius or more (tested). The border of the grid is not a surface; a mask without a surface gives +-infinity.
/// Parallel; separable lower envelopes (Felzenszwalb & Huttenlocher 2012, doi 10.4086/toc.2012.v008a019). Uses 8 bytes
/// per voxel, of which 4 are the result.
FloatGrid signed_distance_mm(const MaskGrid& mask);

/// Exact Euclidean distance (mm) from each voxel centre to the nearest voxel centre of the mask (0 on the mask).
FloatGrid distance_to_mask_mm(const MaskGrid& mask);

}  // namespace trocar::volume
