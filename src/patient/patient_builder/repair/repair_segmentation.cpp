#include "patient_builder/repair/repair_segmentation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "patient_builder/detail/label_boxes.h"
#include "patient_builder/repair/detail/repairs.h"

namespace trocar::patient_builder {

std::vector<anatomy::Finding> repair_segmentation(const volume::CtGrid& ct, volume::LabelGrid& labels,
                                                  anatomy::LabelTable& table) {
  std::vector<anatomy::Finding> repairs;
  detail::correct_sides(labels, table, repairs);
  detail::remove_islands(labels, table, repairs);
  detail::join_ribs(ct, labels, table, repairs);
  detail::fill_label_holes(labels, table, repairs);
  return repairs;
}

namespace detail {
namespace {

// Assumed limits. Neighbouring vertebrae differ by less than a fifth; mixed labels are known of 1 to 2 % of
// segmentations (TotalSegmentator, issue 291).
constexpr double kLargestRatio = 1.6;
constexpr double kSmallestRatio = 0.55;
constexpr double kLeastStepMm = 8.0;  // between the middles of neighbouring vertebrae
constexpr double kLargestStepMm = 60.0;
constexpr double kSecondPartShare = 0.05;
constexpr double kSecondPartMl = 1.0;

bool touches_border(const IndexBox& box, const volume::GridGeometry& g) {
  for (std::size_t a = 0; a < 3; ++a)
    if (box.low[a] == 0 || box.high[a] == g.size[a] - 1) return true;
  return false;
}

class FindingCollector {
 public:
  explicit FindingCollector(const anatomy::VirtualPatient& patient)
      : patient_(patient), table_(patient.label_table), boxes_(find_label_boxes(patient.labels)) {}

  std::vector<anatomy::Finding> find() {
    check_sides();
    check_vertebrae();
    check_parts();
    check_ribs();
    return std::move(findings_);
  }

 private:
  Vec3 middle_P(std::uint8_t id) const {
    const LabelParts parts = find_parts(patient_.labels, id, boxes_.box[id]);
    return patient_.labels.geometry.centre_mm(parts.middle.front());
  }

  void check_sides() {
    const SideCount sides = count_sides(patient_.labels, table_);
    if (sides.is_mirrored())
      findings_.push_back({fmt::format("left and right are exchanged in {} of {} pairs: the image may be mirrored",
                                       sides.wrong, sides.wrong + sides.right),
                           {},
                           {}});
  }

  void check_vertebrae() {
    const SpineLabels spine = find_spine_labels(table_, boxes_);
    std::vector<std::uint8_t> order;  // from head to feet, without the sacrum
    for (std::uint8_t place = 1; place < kSacrum; ++place)
      if (spine.id_of[place] != 0) order.push_back(spine.id_of[place]);
    std::vector<Vec3> middles;
    for (const std::uint8_t id : order) middles.push_back(middle_P(id));
    for (std::size_t n = 0; n < order.size(); ++n) check_volume(order, n, middles[n]);
    for (std::size_t n = 1; n < order.size(); ++n) {
      const int places = spine.place[order[n]] - spine.place[order[n - 1]];
      const double down_mm = middles[n - 1].z() - middles[n].z();
      const std::string &upper = table_.find(order[n - 1])->name, &lower = table_.find(order[n])->name;
      if (down_mm <= 0.0)
        findings_.push_back({fmt::format("{} lies above {}", lower, upper), lower, middles[n]});
      else if (places == 1 && spine.place[order[n]] < kS1 && (down_mm < kLeastStepMm || down_mm > kLargestStepMm))
        findings_.push_back({fmt::format("{} is {:.0f} mm below {}", lower, down_mm, upper), lower, middles[n]});
    }
  }

  /// Compares the vertebra with its neighbours in the list.
  void check_volume(const std::vector<std::uint8_t>& order, std::size_t n, const Vec3& middle_P) {
    const volume::GridGeometry& g = patient_.labels.geometry;
    double sum = 0.0, count = 0.0;
    for (const std::size_t other : {n - 1, n + 1}) {
      if (other >= order.size() || touches_border(boxes_.box[order[other]], g)) continue;
      sum += static_cast<double>(boxes_.voxels[order[other]]);
      count += 1.0;
    }
    const anatomy::Label& label = *table_.find(order[n]);
    // S1 is often a part of the sacrum.
    if (count == 0.0 || touches_border(boxes_.box[order[n]], g) || vertebra_place(label.name) >= kS1) return;
    const double ratio = static_cast<double>(boxes_.voxels[order[n]]) * count / sum;
    if (ratio <= kLargestRatio && ratio >= kSmallestRatio) return;
    findings_.push_back(
        {fmt::format("{} has {:.0f} % of the volume of its neighbours: labels of vertebrae may be mixed", label.name,
                     100.0 * ratio),
         label.name, middle_P});
  }

  void check_parts() {
    for (const anatomy::Label& label : table_.labels) {
      if (!is_one_part(label) || rib_number(label) != 0 || boxes_.voxels[label.id] == 0) continue;
      const LabelParts parts = find_parts(patient_.labels, label.id, boxes_.box[label.id]);
      if (parts.count() < 2) continue;
      const double least_ml = std::min(kSecondPartMl, kSecondPartShare * parts.volume_ml(0));
      if (parts.volume_ml(1) < least_ml) continue;
      findings_.push_back(
          {fmt::format("{} has {} parts, the second of {:.1f} ml", label.name, parts.count(), parts.volume_ml(1)),
           label.name, patient_.labels.geometry.centre_mm(parts.middle[1])});
    }
  }

  void check_ribs() {
    const volume::GridGeometry& g = patient_.labels.geometry;
    for (const RibGap& gap : find_rib_gaps(patient_.labels, table_, boxes_)) {
      if (touches_border(boxes_.box[gap.rib], g) || touches_border(boxes_.box[gap.vertebra], g)) continue;
      findings_.push_back({fmt::format("{} ends {:.0f} mm from {}", table_.find(gap.rib)->name, gap.length_mm,
                                       table_.find(gap.vertebra)->name),
                           table_.find(gap.rib)->name, g.centre_mm(gap.from)});
    }
  }

  const anatomy::VirtualPatient& patient_;
  const anatomy::LabelTable& table_;
  LabelBoxes boxes_;
  std::vector<anatomy::Finding> findings_;
};

}  // namespace
}  // namespace detail

std::vector<anatomy::Finding> segmentation_findings(const anatomy::VirtualPatient& patient) {
  return detail::FindingCollector(patient).find();
}

}  // namespace trocar::patient_builder

namespace trocar::patient_builder::detail {
namespace {

// Assumed: gaps of a segmentation program are smaller; a larger closed cavity was left open on purpose (a cyst, a
// necrosis), and is only told.
constexpr double kLargestHoleMl = 2.0;
constexpr double kSmallestMl = 0.001;

bool is_solid(const anatomy::Label& label) {
  for (const char* tissue : {"lung", "bowel", "gas", "fluid", "adipose", "soft_tissue"})
    if (label.tissue == tissue) return false;
  return !label.is_derived;
}

void fill_holes_of(const anatomy::Label& label, const IndexBox& box, volume::LabelGrid& labels,
                   std::vector<anatomy::Finding>& repairs) {
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

void fill_label_holes(volume::LabelGrid& labels, const anatomy::LabelTable& table,
                      std::vector<anatomy::Finding>& repairs) {
  const LabelBoxes boxes = find_label_boxes(labels);
  for (const anatomy::Label& label : table.labels)
    if (is_solid(label) && boxes.voxels[label.id] > 0) fill_holes_of(label, boxes.box[label.id], labels, repairs);
}

}  // namespace trocar::patient_builder::detail
