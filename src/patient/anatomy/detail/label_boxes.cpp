#include "anatomy/detail/label_boxes.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "core/parallel.h"

namespace trocar::anatomy::detail {

void IndexBox::include(const volume::Index3& ijk) noexcept {
  const bool was_empty = is_empty();
  for (std::size_t a = 0; a < 3; ++a) {
    low[a] = was_empty ? ijk[a] : std::min(low[a], ijk[a]);
    high[a] = was_empty ? ijk[a] : std::max(high[a], ijk[a]);
  }
}

void IndexBox::include(const IndexBox& other) noexcept {
  if (other.is_empty()) return;
  include(other.low);
  include(other.high);
}

LabelBoxes find_label_boxes(const volume::LabelGrid& labels) {
  const volume::GridGeometry& g = labels.geometry;
  LabelBoxes boxes;
  std::mutex mutex;
  const auto rows = static_cast<std::size_t>(g.size[1] * g.size[2]);
  parallel_for(rows, 1 << 10, [&](std::size_t first, std::size_t last) {
    LabelBoxes part;
    for (std::size_t row = first; row < last; ++row) {
      const auto j = static_cast<std::int64_t>(row) % g.size[1], k = static_cast<std::int64_t>(row) / g.size[1];
      const std::uint8_t* voxel = labels.voxels.data() + row * static_cast<std::size_t>(g.size[0]);
      for (std::int64_t i = 0; i < g.size[0];) {  // run by run
        const std::uint8_t id = voxel[i];
        const std::int64_t begin = i;
        while (i < g.size[0] && voxel[i] == id) ++i;
        part.voxels[id] += static_cast<std::size_t>(i - begin);
        if (id == 0) continue;
        part.box[id].include(volume::Index3{begin, j, k});
        part.box[id].include(volume::Index3{i - 1, j, k});
      }
    }
    const std::lock_guard lock(mutex);
    for (std::size_t id = 0; id < 256; ++id) {
      boxes.voxels[id] += part.voxels[id];
      boxes.box[id].include(part.box[id]);
    }
  });
  return boxes;
}

IndexBox grown(const IndexBox& box, double margin_mm, const volume::GridGeometry& geometry) noexcept {
  IndexBox larger = box;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto steps =
        static_cast<std::int64_t>(std::ceil(margin_mm / geometry.spacing_mm[static_cast<Eigen::Index>(a)]));
    larger.low[a] = std::max<std::int64_t>(0, box.low[a] - steps);
    larger.high[a] = std::min(geometry.size[a] - 1, box.high[a] + steps);
  }
  return larger;
}

volume::GridGeometry cut_geometry(const volume::GridGeometry& geometry, const IndexBox& box) noexcept {
  volume::GridGeometry cut = geometry;
  cut.origin_P = geometry.centre_mm(box.low);
  for (std::size_t a = 0; a < 3; ++a) cut.size[a] = std::max<std::int64_t>(0, box.high[a] - box.low[a] + 1);
  return cut;
}

}  // namespace trocar::anatomy::detail
