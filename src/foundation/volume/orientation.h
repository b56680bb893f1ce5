#pragma once

#include "volume/grid.h"

namespace trocar::volume {

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

}  // namespace trocar::volume
