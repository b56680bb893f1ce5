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

/// Order of the axes of a grid that runs along P: `axis[n]` is the axis of the source that becomes axis n, and
/// `is_turned[n]` is true if it is traversed from its far end.
struct AxisOrder {
  std::array<std::size_t, 3> axis{0, 1, 2};
  std::array<bool, 3> is_turned{false, false, false};

  bool is_identity() const noexcept {
    return axis == std::array<std::size_t, 3>{0, 1, 2} && !is_turned[0] && !is_turned[1] && !is_turned[2];
  }
};

/// The order in which i, j and k lie nearest to +x, +y and +z of P (left, back, head). If several orders are equally
/// near, the first one.
AxisOrder order_along_P(const GridGeometry& geometry) noexcept;

/// The geometry with its axes in this order: the same voxel centres in P.
GridGeometry reordered(const GridGeometry& geometry, const AxisOrder& order) noexcept;

/// The same voxels at the same places in P with i, j and k nearest to +x, +y and +z: k runs from feet to head for any
/// stored order of the volume. Copies values without interpolation. The result is a right-handed grid.
CtGrid along_P(CtGrid grid);
LabelGrid along_P(LabelGrid grid);

/// Convolves a volume with a Gaussian of `sigma_voxels` (each >= 0, checked; 0 leaves an axis as it is), sampled and
/// cut at 4 sigma, of sum 1. Beyond the grid the volume is 0. Parallel, SIMD selected at run time; the result does not
/// depend on the number of threads.
void gaussian_blur(FloatGrid& grid, const Vec3& sigma_voxels);

}  // namespace trocar::volume
