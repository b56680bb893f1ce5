#include "patient_builder/detail/label_boxes.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <string>

#include "anatomy/known_structures.h"
#include "core/parallel.h"

namespace trocar::patient_builder::detail {

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

std::uint8_t vertebra_place(std::string_view name) {
  const std::string plain = anatomy::plain_name(name);
  if (plain == "sacrum") return kSacrum;
  std::string_view rest = plain;
  for (const std::string_view stem : {"vertebrae", "vertebra"}) {
    if (!rest.starts_with(stem)) continue;
    rest.remove_prefix(stem.size());
    break;
  }
  if (rest.size() == plain.size() || rest.size() < 2 || rest.size() > 3) return 0;
  int number = 0;
  for (const char c : rest.substr(1)) {
    if (c < '0' || c > '9') return 0;
    number = 10 * number + (c - '0');
  }
  const auto place = [&](int most, int first) {
    return number >= 1 && number <= most ? static_cast<std::uint8_t>(first + number - 1) : std::uint8_t{0};
  };
  switch (rest.front()) {
    case 'c':
      return place(7, 1);
    case 't':
      return place(12, kT1);
    case 'l':
      return place(6, kL1);
    case 's':
      return place(1, kS1);
    default:
      return 0;
  }
}

bool are_neighbours(std::uint8_t above, std::uint8_t below) noexcept {
  if (above == 0 || below <= above || above >= kS1) return false;
  if (above >= kL5 && below >= kS1) return true;  // L5 or L6 on S1 or on a sacrum that includes S1
  return below == above + 1;
}

SpineLabels find_spine_labels(const anatomy::LabelTable& table, const LabelBoxes& boxes) {
  SpineLabels spine;
  for (const anatomy::Label& label : table.labels) {
    const std::uint8_t place = vertebra_place(label.name);
    if (place == 0 || boxes.voxels[label.id] == 0 || label.tissue != "bone") continue;
    spine.place[label.id] = place;
    spine.id_of[place] = label.id;
    spine.box.include(boxes.box[label.id]);
    ++spine.count;
  }
  return spine;
}

}  // namespace trocar::patient_builder::detail
