#pragma once

#include <array>
#include <vector>

#include "anatomy/label_table.h"
#include "volume/grid.h"

namespace trocar::anatomy::detail {

using Reversal = std::array<bool, 3>;  ///< Of i, j, k.

/// How well the borders of structures lie on steps of HU: the mean step (HU) across them, over some thousand places.
/// Structures of gas and food, and those found from HU, are not counted.
class EdgeMatch {
 public:
  /// Axes of both along P, one geometry.
  EdgeMatch(const volume::CtGrid& ct, const volume::LabelGrid& labels, const LabelTable& table);

  std::size_t count() const noexcept { return edges_.size(); }
  /// Structures that are judged and occur.
  std::size_t structures() const noexcept { return structures_; }
  /// With the labels reversed along some axes, about the middle of the grid, and then moved by so many voxels.
  double step_hu(const volume::Index3& shift, const Reversal& reversed = {}) const noexcept;

 private:
  struct Edge {
    volume::Index3 low;  ///< The voxel before the border; the next one along the axis is behind it.
    int axis;
  };
  double step_at(volume::Index3 low, int axis, const volume::Index3& shift) const noexcept;

  const volume::CtGrid& ct_;
  std::array<std::int64_t, 3> reach_{};  ///< Voxels on each side of a border, about 3 mm.
  std::vector<Edge> edges_;
  std::size_t structures_ = 0;
};

}  // namespace trocar::anatomy::detail
