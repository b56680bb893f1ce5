#include "volume/morphology.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>
#include <span>

#include "core/parallel.h"
#include "volume/detail/run_labels.h"
#include "volume/distance.h"
#include "volume/grid.h"

namespace trocar::volume::detail {

/// 1 where the centre of a voxel of the mask lies within `radius_mm`: exact, as by the distance, and faster for small
/// balls. Nothing for a ball of many rows. Parallel.
std::optional<MaskGrid> find_near(const MaskGrid& mask, double radius_mm);

}  // namespace trocar::volume::detail

namespace trocar::volume {
namespace {

detail::Block block_of(const GridGeometry& g) {
  return {static_cast<std::size_t>(g.size[0]), static_cast<std::size_t>(g.size[1]),
          static_cast<std::size_t>(g.size[2])};
}

std::vector<std::size_t> component_sizes(const detail::RunLabels& labels) {
  std::vector<std::size_t> sizes(labels.component_count, 0);
  for (const detail::Run& run : labels.runs) sizes[run.component] += run.length();
  return sizes;
}

/// Calls write(first voxel, length, component) for every run; rows in parallel.
void for_each_run(const detail::RunLabels& labels, const auto& write) {
  parallel_for(labels.block.rows * labels.block.planes, 1024, [&](std::size_t first, std::size_t last) {
    for (std::size_t r = first; r < last; ++r)
      for (const detail::Run& run : labels.row(r))
        write(r * labels.block.columns + run.first, run.length(), run.component);
  });
}

/// Components with a voxel on the border of the block; its first and last plane count only on request.
std::vector<bool> touches_border(const detail::RunLabels& labels, bool with_planes) {
  const auto& [columns, rows, planes] = labels.block;
  std::vector<bool> result(labels.component_count, false);
  for (std::size_t r = 0; r < rows * planes; ++r) {
    const bool row_on_border =
        r % rows == 0 || r % rows == rows - 1 || (with_planes && (r / rows == 0 || r / rows == planes - 1));
    for (const detail::Run& run : labels.row(r))
      if (row_on_border || run.first == 0 || run.last == columns - 1) result[run.component] = true;
  }
  return result;
}

void fill_block(std::span<std::uint8_t> voxels, const detail::Block& block, bool with_planes) {
  const detail::RunLabels background = detail::label_runs(voxels, block, false);
  const std::vector<bool> is_open = touches_border(background, with_planes);
  for (std::size_t r = 0; r < block.rows * block.planes; ++r)
    for (const detail::Run& run : background.row(r))
      if (!is_open[run.component])
        std::fill_n(voxels.begin() + static_cast<std::ptrdiff_t>(r * block.columns + run.first), run.length(),
                    std::uint8_t{1});
}

/// A box of voxels, both ends inclusive.
struct Box {
  Index3 first;
  Index3 last;
};

/// The smallest box around the mask; nothing for an empty mask.
std::optional<Box> bounding_box(const MaskGrid& mask) {
  const auto& size = mask.geometry.size;
  Box box{size, {-1, -1, -1}};
  for (std::int64_t k = 0; k < size[2]; ++k) {
    for (std::int64_t j = 0; j < size[1]; ++j) {
      const std::uint8_t* row = mask.voxels.data() + mask.geometry.offset({0, j, k});
      const auto is_set = [](std::uint8_t v) { return v != 0; };
      const auto* first = std::find_if(row, row + size[0], is_set);
      if (first == row + size[0]) continue;
      std::int64_t last_i = size[0] - 1;
      while (row[last_i] == 0) --last_i;
      const Index3 low{first - row, j, k};
      const Index3 high{last_i, j, k};
      for (std::size_t a = 0; a < 3; ++a) {
        box.first[a] = std::min(box.first[a], low[a]);
        box.last[a] = std::max(box.last[a], high[a]);
      }
    }
  }
  if (box.last[0] < 0) return std::nullopt;
  return box;
}

Box grown(Box box, const GridGeometry& geometry, double margin_mm) {
  for (std::size_t a = 0; a < 3; ++a) {
    const double voxels = std::ceil(margin_mm / geometry.spacing_mm[static_cast<int>(a)]) + 1.0;
    const auto margin = static_cast<std::int64_t>(std::min(voxels, static_cast<double>(geometry.size[a])));
    box.first[a] = std::max<std::int64_t>(0, box.first[a] - margin);
    box.last[a] = std::min(geometry.size[a] - 1, box.last[a] + margin);
  }
  return box;
}

/// Copies a box out of a mask (1 if a voxel is set, selected by `of_set`).
MaskGrid cut_out(const MaskGrid& mask, const Box& box, bool of_set) {
  GridGeometry geometry = mask.geometry;
  for (std::size_t a = 0; a < 3; ++a) geometry.size[a] = box.last[a] - box.first[a] + 1;
  MaskGrid part(geometry);
  for (std::int64_t k = 0; k < geometry.size[2]; ++k)
    for (std::int64_t j = 0; j < geometry.size[1]; ++j) {
      const auto from = mask.geometry.offset({box.first[0], box.first[1] + j, box.first[2] + k});
      const auto to = geometry.offset({0, j, k});
      for (std::size_t i = 0; i < static_cast<std::size_t>(geometry.size[0]); ++i)
        part.voxels[to + i] = (mask.voxels[from + i] != 0) == of_set ? 1 : 0;
    }
  return part;
}

/// 1 where the distance to the mask is at most `limit_mm`.
MaskGrid nearer_than(const MaskGrid& mask, float limit_mm) {
  const FloatGrid distance = distance_to_mask_mm(mask);
  MaskGrid near(mask.geometry);
  for (std::size_t n = 0; n < near.voxels.size(); ++n) near.voxels[n] = distance.voxels[n] <= limit_mm ? 1 : 0;
  return near;
}

/// Sets the voxels of the box to `value` within the radius of a voxel of `part`, the mask of that box.
void paint_near(const MaskGrid& part, const Box& box, double radius_mm, std::uint8_t value, MaskGrid& result) {
  // A ball of whole voxels must include its outermost ones despite rounding.
  constexpr double kRounding = 1e-6;
  const double limit_mm = radius_mm * (1.0 + kRounding);
  std::optional<MaskGrid> near = detail::find_near(part, limit_mm);
  if (!near) near = nearer_than(part, static_cast<float>(limit_mm));
  for (std::int64_t k = box.first[2]; k <= box.last[2]; ++k)
    for (std::int64_t j = box.first[1]; j <= box.last[1]; ++j) {
      const auto from = near->geometry.offset({0, j - box.first[1], k - box.first[2]});
      const auto to = result.geometry.offset({box.first[0], j, k});
      for (std::size_t i = 0; i < static_cast<std::size_t>(near->geometry.size[0]); ++i)
        if (near->voxels[from + i] != 0) result.voxels[to + i] = value;
    }
}

}  // namespace

Components connected_components(const MaskGrid& mask) {
  const detail::RunLabels labels = detail::label_runs(mask.voxels, block_of(mask.geometry), true);
  const std::vector<std::size_t> sizes = component_sizes(labels);
  std::vector<std::size_t> by_size(sizes.size());
  std::iota(by_size.begin(), by_size.end(), std::size_t{0});
  std::stable_sort(by_size.begin(), by_size.end(), [&](std::size_t a, std::size_t b) { return sizes[a] > sizes[b]; });

  Components result{Grid<std::int32_t>(mask.geometry), {}};
  std::vector<std::int32_t> id_of(sizes.size());
  for (const std::size_t component : by_size) {
    result.voxel_counts.push_back(sizes[component]);
    id_of[component] = static_cast<std::int32_t>(result.voxel_counts.size());
  }
  for_each_run(labels, [&](std::size_t offset, std::size_t length, std::uint32_t component) {
    std::fill_n(result.ids.voxels.begin() + static_cast<std::ptrdiff_t>(offset), length, id_of[component]);
  });
  return result;
}

MaskGrid largest_component(const MaskGrid& mask) {
  const detail::RunLabels labels = detail::label_runs(mask.voxels, block_of(mask.geometry), true);
  const std::vector<std::size_t> sizes = component_sizes(labels);
  MaskGrid result(mask.geometry);
  const auto largest = static_cast<std::uint32_t>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
  for_each_run(labels, [&](std::size_t offset, std::size_t length, std::uint32_t component) {
    if (component == largest)
      std::fill_n(result.voxels.begin() + static_cast<std::ptrdiff_t>(offset), length, std::uint8_t{1});
  });
  return result;
}

MaskGrid fill_holes(const MaskGrid& mask) {
  MaskGrid result = mask;
  fill_block(result.voxels, block_of(mask.geometry), true);
  return result;
}

MaskGrid fill_holes_in_slices(const MaskGrid& mask) {
  MaskGrid result = mask;
  const detail::Block slice{static_cast<std::size_t>(mask.geometry.size[0]),
                            static_cast<std::size_t>(mask.geometry.size[1]), 1};
  const std::size_t voxels = slice.columns * slice.rows;
  parallel_for(static_cast<std::size_t>(mask.geometry.size[2]), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) fill_block({result.voxels.data() + k * voxels, voxels}, slice, false);
  });
  return result;
}

MaskGrid dilate(const MaskGrid& mask, double radius_mm) {
  if (radius_mm < 0.0) return erode(mask, -radius_mm);
  MaskGrid result = mask;
  const std::optional<Box> box = bounding_box(mask);
  if (!box || radius_mm == 0.0) return result;
  const Box reach = grown(*box, mask.geometry, radius_mm);
  paint_near(cut_out(mask, reach, true), reach, radius_mm, 1, result);
  return result;
}

MaskGrid erode(const MaskGrid& mask, double radius_mm) {
  if (radius_mm < 0.0) return dilate(mask, -radius_mm);
  MaskGrid result = mask;
  const std::optional<Box> box = bounding_box(mask);
  if (!box || radius_mm == 0.0) return result;
  // The nearest outside voxel of any inside one is at most one voxel beyond the bounding box.
  const Box reach = grown(*box, mask.geometry, 0.0);
  paint_near(cut_out(mask, reach, false), reach, radius_mm, 0, result);
  return result;
}

}  // namespace trocar::volume

namespace trocar::volume::detail {
namespace {

constexpr std::size_t kMostRows = 150;    ///< Beyond it the distance transform is about as fast.
constexpr std::uint8_t kMostReach = 255;  ///< Voxels along a row.

/// A row of the ball: the voxels -reach..reach, j and k rows away.
struct BallRow {
  std::int64_t j = 0, k = 0;
  std::uint8_t reach = 0;
};

std::optional<std::vector<BallRow>> rows_of_ball(const Vec3& spacing_mm, double radius_mm) {
  const Vec3 reach = radius_mm * spacing_mm.cwiseInverse();
  if (reach.x() >= kMostReach || reach.y() * reach.z() > static_cast<double>(kMostRows)) return std::nullopt;
  std::vector<BallRow> rows;
  const auto last_j = static_cast<std::int64_t>(reach.y()), last_k = static_cast<std::int64_t>(reach.z());
  for (std::int64_t k = -last_k; k <= last_k; ++k)
    for (std::int64_t j = -last_j; j <= last_j; ++j) {
      const double across_mm =
          std::hypot(static_cast<double>(j) * spacing_mm.y(), static_cast<double>(k) * spacing_mm.z());
      if (across_mm > radius_mm) continue;
      const double along_mm = std::sqrt(radius_mm * radius_mm - across_mm * across_mm);
      rows.push_back({j, k, static_cast<std::uint8_t>(along_mm / spacing_mm.x())});
    }
  if (rows.size() > kMostRows) return std::nullopt;
  return rows;
}

/// Replaces a row of a mask by the distances to its nearest set voxel, at most kMostReach. False if none is set.
bool to_distances(std::span<std::uint8_t> row) {
  std::uint8_t last = kMostReach;
  for (std::uint8_t& voxel : row) {
    last = voxel != 0 ? 0 : static_cast<std::uint8_t>(std::min<int>(last + 1, kMostReach));
    voxel = last;
  }
  last = kMostReach;
  bool has_set = false;
  for (auto voxel = row.rbegin(); voxel != row.rend(); ++voxel) {
    last = static_cast<std::uint8_t>(std::min<int>(last + 1, *voxel));
    *voxel = last;
    has_set = has_set || last == 0;
  }
  return has_set;
}

}  // namespace

std::optional<MaskGrid> find_near(const MaskGrid& mask, double radius_mm) {
  const std::optional<std::vector<BallRow>> ball = rows_of_ball(mask.geometry.spacing_mm, radius_mm);
  if (!ball) return std::nullopt;
  const auto& size = mask.geometry.size;
  const auto length = static_cast<std::size_t>(size[0]);
  const auto rows = static_cast<std::size_t>(size[1] * size[2]);
  MaskGrid distances = mask;
  std::vector<std::uint8_t> has_set(rows);
  parallel_for(rows, 64, [&](std::size_t first, std::size_t last) {
    for (std::size_t r = first; r < last; ++r)
      has_set[r] = to_distances(std::span(distances.voxels).subspan(r * length, length)) ? 1 : 0;
  });
  MaskGrid near(mask.geometry);
  parallel_for(rows, 64, [&](std::size_t first, std::size_t last) {
    for (std::size_t r = first; r < last; ++r) {
      const Index3 at = mask.geometry.index_of(r * length);
      for (const BallRow& row : *ball) {
        const std::int64_t j = at[1] + row.j, k = at[2] + row.k;
        if (j < 0 || j >= size[1] || k < 0 || k >= size[2]) continue;
        const auto other = static_cast<std::size_t>(k * size[1] + j);
        if (has_set[other] == 0) continue;
        const std::uint8_t* from = distances.voxels.data() + other * length;
        std::uint8_t* to = near.voxels.data() + r * length;
        for (std::size_t i = 0; i < length; ++i) to[i] |= from[i] <= row.reach ? std::uint8_t{1} : std::uint8_t{0};
      }
    }
  });
  return near;
}

}  // namespace trocar::volume::detail
