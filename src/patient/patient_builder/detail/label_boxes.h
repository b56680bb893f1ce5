#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "anatomy/patient.h"
#include "volume/grid.h"

namespace trocar::patient_builder::detail {

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

// Vertebrae by their place in the spine: C1 is 1, T1 8, L1 20, S1 26, the sacrum 27; 0 is none.
inline constexpr std::uint8_t kT1 = 8, kL1 = 20, kL5 = 24, kS1 = 26, kSacrum = 27;

/// Place of a vertebra in the spine by its name ("vertebrae_L3", "vertebra_L3", "sacrum"); 0: no vertebra.
std::uint8_t vertebra_place(std::string_view name);
/// True if `below` is the next vertebra below `above` and they have a joint: not S1 and the sacrum.
bool are_neighbours(std::uint8_t above, std::uint8_t below) noexcept;

/// The labelled vertebrae of a patient.
struct SpineLabels {
  std::array<std::uint8_t, 256> place{};  ///< By label id.
  std::array<std::uint8_t, 28> id_of{};   ///< By place; 0: not labelled.
  IndexBox box;                           ///< Around all of them.
  int count = 0;
};
SpineLabels find_spine_labels(const anatomy::LabelTable& table, const LabelBoxes& boxes);

}  // namespace trocar::patient_builder::detail
