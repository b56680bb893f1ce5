#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>

#include "anatomy/patient.h"
#include "core/parallel.h"
#include "tasks/task.h"
#include "volume/grid.h"

namespace trocar::tasks::detail {

/// A box of voxel indices, both ends included; empty when low > high. May reach beyond the grid.
struct IndexBox {
  volume::Index3 low{1, 1, 1};
  volume::Index3 high{0, 0, 0};
  bool is_empty() const noexcept { return low[0] > high[0] || low[1] > high[1] || low[2] > high[2]; }
};
IndexBox united(const IndexBox& a, const IndexBox& b) noexcept;
IndexBox grown(const IndexBox& box, std::int64_t voxels) noexcept;
IndexBox grown(const IndexBox& box, const volume::Index3& voxels) noexcept;
IndexBox clipped(const IndexBox& box, const volume::GridGeometry& geometry) noexcept;
/// The voxels within `radius_mm` of a point along each axis.
IndexBox box_around(const volume::GridGeometry& geometry, const Vec3& p_P, double radius_mm) noexcept;

/// Bounding box and number of voxels of each label.
struct LabelBoxes {
  std::array<IndexBox, 256> boxes{};
  std::array<std::size_t, 256> voxels{};
};
LabelBoxes find_label_boxes(const volume::LabelGrid& labels);

/// A coarse grid whose cells are whole blocks of voxels of a finer one.
struct BlockGrid {
  volume::GridGeometry geometry;  ///< Geometry of the cells.
  volume::Index3 first{};         ///< Voxel at the corner of cell (0,0,0).
  volume::Index3 factor{};        ///< Voxels per cell along each axis.
  double half_diagonal_mm = 0.0;

  Vec3 centre(std::size_t cell) const noexcept {
    const volume::Index3 ijk = geometry.index_of(cell);
    return geometry.centre_mm(ijk);
  }
};
volume::Index3 blocks_factor(const volume::GridGeometry& geometry, double cell_mm) noexcept;
BlockGrid make_blocks(const volume::GridGeometry& geometry, const IndexBox& box, double cell_mm);

/// 1 where any voxel of the cell has a label that `is_in`; voxels beyond the grid count as `beyond`.
template <class IsIn>
volume::MaskGrid block_mask(const volume::LabelGrid& labels, const BlockGrid& blocks, const IsIn& is_in, bool beyond) {
  std::array<std::uint8_t, 256> is_member{};
  for (std::size_t id = 0; id < is_member.size(); ++id) is_member[id] = is_in(static_cast<std::uint8_t>(id)) ? 1 : 0;
  volume::MaskGrid mask(blocks.geometry);
  const volume::Index3 cells = blocks.geometry.size;
  const volume::Index3 size = labels.geometry.size;
  parallel_for(static_cast<std::size_t>(cells[2]), 1, [&](std::size_t begin, std::size_t end) {
    for (auto ck = static_cast<std::int64_t>(begin); ck < static_cast<std::int64_t>(end); ++ck)
      for (std::int64_t k = 0; k < blocks.factor[2]; ++k)
        for (std::int64_t j = 0; j < cells[1] * blocks.factor[1]; ++j) {
          const volume::Index3 voxel{blocks.first[0], blocks.first[1] + j, blocks.first[2] + ck * blocks.factor[2] + k};
          std::uint8_t* row = &mask[{0, j / blocks.factor[1], ck}];
          const bool is_row_in = voxel[1] >= 0 && voxel[1] < size[1] && voxel[2] >= 0 && voxel[2] < size[2];
          const std::int64_t row_offset = (voxel[2] * size[1] + voxel[1]) * size[0];
          for (std::int64_t ci = 0; ci < cells[0]; ++ci)
            for (std::int64_t i = 0; i < blocks.factor[0]; ++i) {
              const std::int64_t x = voxel[0] + ci * blocks.factor[0] + i;
              const bool is_inside = is_row_in && x >= 0 && x < size[0];
              row[ci] |= is_inside ? is_member[labels.voxels[static_cast<std::size_t>(row_offset + x)]]
                                   : static_cast<std::uint8_t>(beyond ? 1 : 0);
            }
        }
  });
  return mask;
}

/// The mask of some labels in a box (cut to the grid), as a grid of its own.
template <class IsIn>
volume::MaskGrid cut_mask(const volume::LabelGrid& labels, const IndexBox& box, const IsIn& is_in) {
  const IndexBox in = clipped(box, labels.geometry);
  volume::GridGeometry geometry = labels.geometry;
  for (std::size_t a = 0; a < 3; ++a) geometry.size[a] = in.high[a] - in.low[a] + 1;
  geometry.origin_P = labels.geometry.centre_mm(in.low);
  volume::MaskGrid mask(geometry);
  for (std::size_t n = 0; n < mask.voxels.size(); ++n) {
    const volume::Index3 ijk = geometry.index_of(n);
    mask.voxels[n] = is_in(labels[{ijk[0] + in.low[0], ijk[1] + in.low[1], ijk[2] + in.low[2]}]) ? 1 : 0;
  }
  return mask;
}

/// What the patient's target lacks for a task with least_target_ml, in one line; empty: nothing, or the task has none.
std::string target_shortage(const Task& task, const anatomy::VirtualPatient& patient);

}  // namespace trocar::tasks::detail
