#include "anatomy/plausibility/detail/sizes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <string>
#include <string_view>

#include "anatomy/detail/label_boxes.h"
#include "anatomy/detail/structure_pattern.h"

namespace trocar::anatomy::detail {
namespace {

/// Volumes of adults and children from hypoplasia to the largest that are published (ml). [assumed, wide on purpose]
struct VolumeRange {
  std::string_view name;
  double low_ml, high_ml;
};
constexpr std::array kVolumes{VolumeRange{"liver", 150, 6000},       VolumeRange{"spleen", 5, 5000},
                              VolumeRange{"kidney", 10, 1500},       VolumeRange{"gallbladder", 1, 500},
                              VolumeRange{"stomach", 10, 4000},      VolumeRange{"pancreas", 5, 300},
                              VolumeRange{"aorta", 5, 700},          VolumeRange{"inferiorvenacava", 2, 400},
                              VolumeRange{"urinarybladder", 3, 3000}};

constexpr std::size_t kWholeSegmentation = 12;  ///< Structures from which on a missing organ means something.
constexpr std::array<std::string_view, 4> kExpected{"spleen", "kidney_left", "kidney_right", "liver"};

bool is_whole(const IndexBox& box, const volume::GridGeometry& g) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (box.low[axis] == 0 || box.high[axis] == g.size[axis] - 1) return false;
  return true;
}

void judge_volumes(const volume::LabelGrid& labels, const LabelTable& table, const LabelBoxes& boxes,
                   std::vector<AnatomyFinding>& findings) {
  std::vector<std::string> texts;
  for (const Label& label : table.labels) {
    const std::string plain = without_side(plain_name(label.name));
    for (const VolumeRange& range : kVolumes) {
      if (plain != range.name || label.is_derived || boxes.voxels[label.id] == 0) continue;
      const double ml = static_cast<double>(boxes.voxels[label.id]) * labels.geometry.voxel_volume_mm3() / 1000.0;
      const bool is_too_small = ml < range.low_ml && is_whole(boxes.box[label.id], labels.geometry);
      if (is_too_small || ml > range.high_ml)
        texts.push_back(
            fmt::format("{} has {:.3g} ml (expected {:g} to {:g})", label.name, ml, range.low_ml, range.high_ml));
    }
  }
  if (!texts.empty())
    findings.push_back({kSizes, fmt::format("{}", fmt::join(texts, ", ")), "check the segmentation", false});
}

/// An organ is expected if the scan reaches from above the kidneys or liver to below them: both of two others are
/// whole.
void judge_missing(const volume::LabelGrid& labels, const LabelTable& table, const LabelBoxes& boxes,
                   std::vector<AnatomyFinding>& findings) {
  std::size_t present = 0, whole = 0;
  std::vector<std::string> missing;
  for (const Label& label : table.labels) present += !label.is_derived && boxes.voxels[label.id] > 0 ? 1 : 0;
  for (const std::string_view name : kExpected) {
    bool is_there = false;
    for (const Label& label : table.labels) {
      if (plain_name(label.name) != plain_name(name) || boxes.voxels[label.id] == 0) continue;
      is_there = true;
      whole += is_whole(boxes.box[label.id], labels.geometry) ? 1 : 0;
    }
    if (!is_there) missing.emplace_back(name);
  }
  if (present < kWholeSegmentation || whole < 2 || missing.empty()) return;
  findings.push_back({kMissing, fmt::format("no label for: {}", fmt::join(missing, ", ")),
                      "removed from the patient, or not found by the segmentation", false});
}

}  // namespace

void judge_sizes(const volume::LabelGrid& labels, const LabelTable& table, std::vector<AnatomyFinding>& findings) {
  const LabelBoxes boxes = find_label_boxes(labels);
  judge_volumes(labels, table, boxes, findings);
  judge_missing(labels, table, boxes, findings);
}

}  // namespace trocar::anatomy::detail
