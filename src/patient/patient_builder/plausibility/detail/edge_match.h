#pragma once

#include <array>
#include <vector>

#include "anatomy/patient.h"
#include "volume/grid.h"

namespace trocar::patient_builder::detail {

using Reversal = std::array<bool, 3>;  ///< Of i, j, k.

/// How well the borders of structures lie on steps of HU: the mean step (HU) across them, over some thousand places.
/// Structures of gas and food, and those found from HU, are not counted.
class EdgeMatch {
 public:
  /// Axes of both along P, one geometry.
  EdgeMatch(const volume::CtGrid& ct, const volume::LabelGrid& labels, const anatomy::LabelTable& table);

  std::size_t count() const noexcept { return edges_.size(); }
  /// Structures that are judged and occur.
  std::size_t structures() const noexcept { return structures_; }
  /// Of one structure; 0 if it is not judged.
  std::size_t count_of(std::uint8_t id) const noexcept { return edges_of_[id].size(); }
  double step_hu_of(std::uint8_t id, const volume::Index3& shift) const noexcept {
    return mean_step(edges_of_[id], shift, {});
  }
  /// With the labels reversed along some axes, about the middle of the grid, and then moved by so many voxels.
  double step_hu(const volume::Index3& shift, const Reversal& reversed = {}) const noexcept {
    return mean_step(edges_, shift, reversed);
  }

 private:
  struct Edge {
    volume::Index3 low;  ///< The voxel before the border; the next one along the axis is behind it.
    int axis;
  };
  double mean_step(const std::vector<Edge>& edges, const volume::Index3& shift,
                   const Reversal& reversed) const noexcept;
  double step_at(volume::Index3 low, int axis, const volume::Index3& shift) const noexcept;

  const volume::CtGrid& ct_;
  std::array<std::int64_t, 3> reach_{};  ///< Voxels on each side of a border, about 3 mm.
  std::vector<Edge> edges_;
  std::array<std::vector<Edge>, 256> edges_of_;
  std::size_t structures_ = 0;
};

}  // namespace trocar::patient_builder::detail
