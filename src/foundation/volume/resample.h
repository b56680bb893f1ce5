#pragma once

#include "volume/grid.h"

namespace trocar::volume {

/// Resamples the volume on another grid, trilinear and rounded; `outside` beyond the box of the source, whose edge
/// values continue for the outer half voxel (as in sample_slice). No averaging: smooth the source first if the target
/// is much coarser. Parallel.
CtGrid resample_linear(const CtGrid& source, const GridGeometry& target, std::int16_t outside);
/// Resamples labels by nearest neighbour; of two that are equally near (to 1e-4 voxels), the one with the higher index.
LabelGrid resample_nearest(const LabelGrid& source, const GridGeometry& target, std::uint8_t outside);

/// The grid that covers the same box with about isotropic spacing: as near to spacing_mm (> 0) as whole voxels allow.
GridGeometry isotropic_geometry(const GridGeometry& source, double spacing_mm);

/// Fraction 0..1 of the target's voxel centres that lie inside the source's box.
double overlap_fraction(const GridGeometry& source, const GridGeometry& target);

}  // namespace trocar::volume
