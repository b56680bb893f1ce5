#include <fmt/format.h>

#include "anatomy/repair/detail/label_parts.h"
#include "anatomy/repair/detail/repairs.h"

namespace trocar::anatomy::detail {
namespace {

// Assumed: gaps of a segmentation program are smaller; a larger closed cavity was left open on purpose (a cyst, a
// necrosis), and is only told.
constexpr double kLargestHoleMl = 2.0;
constexpr double kSmallestMl = 0.001;

bool is_solid(const Label& label) {
  for (const char* tissue : {"lung", "bowel", "gas", "fluid", "adipose", "soft_tissue"})
    if (label.tissue == tissue) return false;
  return !label.is_derived;
}

void fill_holes_of(const Label& label, const IndexBox& box, volume::LabelGrid& labels, std::vector<Finding>& repairs) {
  const volume::MaskGrid mask = cut_mask(labels, box, [&](std::uint8_t id) { return id == label.id; });
  volume::MaskGrid holes = volume::fill_holes(mask);
  bool has_holes = false;
  for_each_in(labels.geometry, box, [&](std::size_t n, std::size_t in_box, const volume::Index3&) {
    holes.voxels[in_box] = holes.voxels[in_box] && labels.voxels[n] == 0 ? 1 : 0;
    has_holes = has_holes || holes.voxels[in_box];
  });
  if (!has_holes) return;
  const volume::Components parts = volume::connected_components(holes);
  const double voxel_ml = labels.geometry.voxel_volume_mm3() / 1000.0;
  const auto is_filled = [&](std::size_t part) {
    return static_cast<double>(parts.voxel_counts[part]) * voxel_ml <= kLargestHoleMl;
  };
  std::size_t count = 0, kept = 0;
  double volume_ml = 0.0, kept_ml = 0.0;
  for (std::size_t part = 0; part < parts.voxel_counts.size(); ++part) {
    ++(is_filled(part) ? count : kept);
    (is_filled(part) ? volume_ml : kept_ml) += static_cast<double>(parts.voxel_counts[part]) * voxel_ml;
  }
  std::optional<Vec3> place_P;  // in the largest hole
  std::size_t place_part = parts.voxel_counts.size();
  for_each_in(labels.geometry, box, [&](std::size_t n, std::size_t in_box, const volume::Index3& ijk) {
    if (parts.ids.voxels[in_box] == 0) return;
    const auto part = static_cast<std::size_t>(parts.ids.voxels[in_box] - 1);
    if (!is_filled(part)) return;
    labels.voxels[n] = label.id;
    if (part >= place_part) return;
    place_part = part;
    place_P = labels.geometry.centre_mm(ijk);
  });
  if (kept > 0)
    repairs.push_back(
        {fmt::format("left {} in {} open", amount_text(kept, "hole", "holes", kept_ml), label.name), label.name, {}});
  if (volume_ml >= kSmallestMl)
    repairs.push_back({fmt::format("filled {} in {}", amount_text(count, "hole", "holes", volume_ml), label.name),
                       label.name, place_P});
}

}  // namespace

void fill_label_holes(volume::LabelGrid& labels, const LabelTable& table, std::vector<Finding>& repairs) {
  const LabelBoxes boxes = find_label_boxes(labels);
  for (const Label& label : table.labels)
    if (is_solid(label) && boxes.voxels[label.id] > 0) fill_holes_of(label, boxes.box[label.id], labels, repairs);
}

}  // namespace trocar::anatomy::detail
