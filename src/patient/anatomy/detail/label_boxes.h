#pragma once

#include <array>
#include <cstdint>

#include "volume/grid.h"

namespace trocar::anatomy::detail {

/// A box of voxels, both ends included; empty if low > high.
struct IndexBox {
  volume::Index3 low{0, 0, 0};
  volume::Index3 high{-1, -1, -1};

  bool is_empty() const noexcept { return low[0] > high[0] || low[1] > high[1] || low[2] > high[2]; }
  void include(const volume::Index3& ijk) noexcept;
  void include(const IndexBox& other) noexcept;
  bool operator==(const IndexBox&) const = default;
};

/// The box around the voxels of each label, and their number. Parallel.
struct LabelBoxes {
  std::array<IndexBox, 256> box{};
  std::array<std::size_t, 256> voxels{};
};
LabelBoxes find_label_boxes(const volume::LabelGrid& labels);

/// The box, larger by a margin (mm) on all sides, inside the grid.
IndexBox grown(const IndexBox& box, double margin_mm, const volume::GridGeometry& geometry) noexcept;
/// The geometry of a box of a grid: its voxel centres.
volume::GridGeometry cut_geometry(const volume::GridGeometry& geometry, const IndexBox& box) noexcept;

/// Calls visit(offset in the whole grid, offset in the box, ijk) for every voxel of a box, i fastest.
template <class Visit>
void for_each_in(const volume::GridGeometry& geometry, const IndexBox& box, Visit&& visit) {
  std::size_t in_box = 0;
  for (std::int64_t k = box.low[2]; k <= box.high[2]; ++k)
    for (std::int64_t j = box.low[1]; j <= box.high[1]; ++j) {
      std::size_t n = geometry.offset({box.low[0], j, k});
      for (std::int64_t i = box.low[0]; i <= box.high[0]; ++i, ++n, ++in_box) visit(n, in_box, volume::Index3{i, j, k});
    }
}

/// The voxels of a box for whose label `is_wanted` is true.
template <class IsWanted>
volume::MaskGrid cut_mask(const volume::LabelGrid& labels, const IndexBox& box, IsWanted&& is_wanted) {
  volume::MaskGrid mask(cut_geometry(labels.geometry, box));
  for_each_in(labels.geometry, box, [&](std::size_t n, std::size_t in_box, const volume::Index3&) {
    mask.voxels[in_box] = is_wanted(labels.voxels[n]) ? 1 : 0;
  });
  return mask;
}

}  // namespace trocar::anatomy::detail
