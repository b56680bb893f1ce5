#include "tasks/detail/block_grid.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <mutex>

#include "volume/morphology.h"

namespace trocar::tasks::detail {

IndexBox united(const IndexBox& a, const IndexBox& b) noexcept {
  if (a.is_empty()) return b;
  if (b.is_empty()) return a;
  IndexBox box = a;
  for (std::size_t n = 0; n < 3; ++n) {
    box.low[n] = std::min(a.low[n], b.low[n]);
    box.high[n] = std::max(a.high[n], b.high[n]);
  }
  return box;
}

IndexBox grown(const IndexBox& box, const volume::Index3& voxels) noexcept {
  IndexBox result = box;
  for (std::size_t n = 0; n < 3; ++n) {
    result.low[n] -= voxels[n];
    result.high[n] += voxels[n];
  }
  return result;
}

IndexBox grown(const IndexBox& box, std::int64_t voxels) noexcept {
  return grown(box, {voxels, voxels, voxels});
}

IndexBox clipped(const IndexBox& box, const volume::GridGeometry& geometry) noexcept {
  IndexBox result = box;
  for (std::size_t n = 0; n < 3; ++n) {
    result.low[n] = std::max<std::int64_t>(box.low[n], 0);
    result.high[n] = std::min(box.high[n], geometry.size[n] - 1);
  }
  return result;
}

IndexBox box_around(const volume::GridGeometry& geometry, const Vec3& p_P, double radius_mm) noexcept {
  const Vec3 index = geometry.to_index(p_P);
  IndexBox box;
  for (int a = 0; a < 3; ++a) {
    const double reach = radius_mm / geometry.spacing_mm[a];
    box.low[static_cast<std::size_t>(a)] = static_cast<std::int64_t>(std::floor(index[a] - reach));
    box.high[static_cast<std::size_t>(a)] = static_cast<std::int64_t>(std::ceil(index[a] + reach));
  }
  return box;
}

LabelBoxes find_label_boxes(const volume::LabelGrid& labels) {
  LabelBoxes all;
  std::mutex mutex;
  const volume::Index3 size = labels.geometry.size;
  parallel_for(static_cast<std::size_t>(size[2]), 8, [&](std::size_t begin, std::size_t end) {
    LabelBoxes part;
    const auto add = [&](std::uint8_t id, const IndexBox& run, std::int64_t length) {
      part.boxes[id] = united(part.boxes[id], run);
      part.voxels[id] += static_cast<std::size_t>(length);
    };
    for (auto k = static_cast<std::int64_t>(begin); k < static_cast<std::int64_t>(end); ++k)
      for (std::int64_t j = 0; j < size[1]; ++j) {
        const std::uint8_t* row = &labels.voxels[static_cast<std::size_t>((k * size[1] + j) * size[0])];
        for (std::int64_t i = 0; i < size[0];) {
          const std::int64_t start = i;
          while (i < size[0] && row[i] == row[start]) ++i;
          if (row[start] != 0) add(row[start], {{start, j, k}, {i - 1, j, k}}, i - start);
        }
      }
    const std::scoped_lock lock(mutex);  // unions and sums do not depend on their order
    for (std::size_t id = 0; id < all.boxes.size(); ++id) {
      all.boxes[id] = united(all.boxes[id], part.boxes[id]);
      all.voxels[id] += part.voxels[id];
    }
  });
  return all;
}

volume::Index3 blocks_factor(const volume::GridGeometry& geometry, double cell_mm) noexcept {
  volume::Index3 factor{};
  for (int a = 0; a < 3; ++a)
    factor[static_cast<std::size_t>(a)] = std::max<std::int64_t>(1, std::llround(cell_mm / geometry.spacing_mm[a]));
  return factor;
}

BlockGrid make_blocks(const volume::GridGeometry& geometry, const IndexBox& box, double cell_mm) {
  BlockGrid blocks;
  blocks.first = box.low;
  blocks.factor = blocks_factor(geometry, cell_mm);
  blocks.geometry = geometry;
  Vec3 first_centre;
  for (int a = 0; a < 3; ++a) {
    const auto n = static_cast<std::size_t>(a);
    const std::int64_t voxels = box.high[n] - box.low[n] + 1;
    blocks.geometry.size[n] = (voxels + blocks.factor[n] - 1) / blocks.factor[n];
    blocks.geometry.spacing_mm[a] = geometry.spacing_mm[a] * static_cast<double>(blocks.factor[n]);
    first_centre[a] = static_cast<double>(box.low[n]) + 0.5 * static_cast<double>(blocks.factor[n] - 1);
  }
  blocks.geometry.origin_P = geometry.to_mm(first_centre);
  blocks.half_diagonal_mm = 0.5 * blocks.geometry.spacing_mm.norm();
  return blocks;
}

namespace {

constexpr double kMm3PerMl = 1000.0;

/// Volume (ml) of the largest connected piece of some labels.
double largest_piece_ml(const volume::LabelGrid& labels, const std::array<bool, 256>& is_target) {
  const LabelBoxes boxes = find_label_boxes(labels);
  IndexBox box;
  for (std::size_t id = 0; id < is_target.size(); ++id)
    if (is_target[id] && boxes.voxels[id] > 0) box = united(box, boxes.boxes[id]);
  if (box.is_empty()) return 0.0;
  const volume::Components pieces =
      volume::connected_components(cut_mask(labels, box, [&](std::uint8_t id) { return is_target[id]; }));
  return static_cast<double>(pieces.voxel_counts.front()) * labels.geometry.spacing_mm.prod() / kMm3PerMl;
}

}  // namespace

std::string target_shortage(const Task& task, const anatomy::VirtualPatient& patient) {
  if (task.least_target_ml <= 0.0) return {};
  std::array<bool, 256> is_wanted{};
  bool is_derived = false;
  for (const anatomy::Label& label : patient.label_table.labels) {
    is_wanted[label.id] = is_target(task, label);
    is_derived |= is_wanted[label.id] && label.is_derived;
  }
  const double ml = largest_piece_ml(patient.labels, is_wanted);
  if (ml >= task.least_target_ml) return {};
  const std::string target =
      task.target_label.empty() ? fmt::format("{}", fmt::join(task.target_tissues, ", ")) : task.target_label;
  if (ml == 0.0) return fmt::format("no {} is labelled: the target of this task is no healthy tissue", target);
  return fmt::format("the {} has at most {:.2g} ml in one piece{}: the task needs {:g} ml", target, ml,
                     is_derived ? " (derived, not seen in the scan)" : "", task.least_target_ml);
}

}  // namespace trocar::tasks::detail
