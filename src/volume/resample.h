#pragma once

#include "volume/grid.h"

namespace trocar {

/// The volume on another grid, trilinear; `outside` beyond its own. Parallel.
CtGrid resample_linear(const CtGrid& source, const GridGeometry& target, std::int16_t outside);
/// The same for labels, by nearest neighbour.
LabelGrid resample_nearest(const LabelGrid& source, const GridGeometry& target, std::uint8_t outside);

/// The grid that covers the same box with (about) isotropic spacing.
GridGeometry isotropic_geometry(const GridGeometry& source, double spacing_mm);

/// Fraction 0..1 of the target's voxel centres that lie inside the source's box.
double overlap_fraction(const GridGeometry& source, const GridGeometry& target);

}  // namespace trocar
