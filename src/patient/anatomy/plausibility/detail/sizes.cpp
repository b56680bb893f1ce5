#include "anatomy/plausibility/detail/sizes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "anatomy/derive/detail/spine_labels.h"
#include "anatomy/detail/label_boxes.h"
#include "anatomy/structure_pattern.h"

namespace trocar::anatomy::detail {
namespace {

/// Adults and children from hypoplasia to the largest that are published. [assumed, wide on purpose]
struct SizeRange {
  std::string_view name;
  double low_ml, high_ml;
  double longest_mm = 0.0;       ///< Longest axis of the ellipsoid with the same moments; 0: not judged.
  double least_fullness = 0.0;   ///< See LabelShape: below it, voxels are scattered or form a shell.
  double longest_to_next = 0.0;  ///< At least so many times as long as wide.
};
constexpr std::array kKnownSizes{SizeRange{"liver", 150, 6000, 400, 0.3},
                                 SizeRange{"spleen", 5, 5000, 350, 0.25},
                                 SizeRange{"kidney", 10, 1500, 250, 0.3},
                                 SizeRange{"gallbladder", 1, 500, 250, 0.25},
                                 SizeRange{"stomach", 10, 4000},
                                 SizeRange{"pancreas", 5, 300, 300},
                                 SizeRange{"aorta", 5, 700, 0, 0, 1.3},
                                 SizeRange{"inferiorvenacava", 2, 400, 0, 0, 1.3},
                                 SizeRange{"urinarybladder", 3, 3000, 300, 0.3}};
constexpr double kSmallestTube_ml = 30.0;
constexpr SizeRange kVertebra{"vertebra", 1, 200, 200, 0.15};

const SizeRange* find_range(const Label& label) {
  if (const int place = vertebra_place(label.name); place > 0 && place < kSacrum) return &kVertebra;
  const std::string plain = without_side(plain_name(label.name));
  const auto found = std::ranges::find(kKnownSizes, plain, &SizeRange::name);
  return found == kKnownSizes.end() ? nullptr : found;
}

constexpr std::size_t kWholeSegmentation = 12;  ///< Structures from which on a missing organ means something.
constexpr std::array<std::string_view, 4> kExpected{"spleen", "kidney_left", "kidney_right", "liver"};

bool is_whole(const IndexBox& box, const volume::GridGeometry& g) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (box.low[axis] == 0 || box.high[axis] == g.size[axis] - 1) return false;
  return true;
}

/// What is wrong with the size or shape of a structure; empty if nothing is.
std::string size_text(const Label& label, const SizeRange& range, const LabelShape& shape, double ml, bool is_whole) {
  if (ml > range.high_ml || (is_whole && ml < range.low_ml))
    return fmt::format("{} has {:.3g} ml (expected {:g} to {:g})", label.name, ml, range.low_ml, range.high_ml);
  if (range.longest_mm > 0.0 && shape.axes_mm[2] > range.longest_mm)
    return fmt::format("{} is {:.0f} mm long (expected at most {:g})", label.name, shape.axes_mm[2], range.longest_mm);
  if (is_whole && shape.fullness < range.least_fullness)
    return fmt::format("{} is scattered or hollow: it fills {:.0f} % of its outline", label.name,
                       100.0 * shape.fullness);
  if (is_whole && ml > kSmallestTube_ml && shape.axes_mm[2] < range.longest_to_next * shape.axes_mm[1])
    return fmt::format("{} is no tube: {:.0f} mm long and {:.0f} mm wide", label.name, shape.axes_mm[2],
                       shape.axes_mm[1]);
  return {};
}

void judge_each(const volume::GridGeometry& g, const LabelTable& table, const LabelBoxes& boxes,
                const LabelShapes& shapes, std::vector<AnatomyFinding>& findings) {
  std::vector<std::string> texts;
  for (const Label& label : table.labels) {
    const SizeRange* range = find_range(label);
    if (range == nullptr || label.is_derived || boxes.voxels[label.id] == 0) continue;
    const double ml = static_cast<double>(boxes.voxels[label.id]) * g.voxel_volume_mm3() / 1000.0;
    const std::string text = size_text(label, *range, shapes[label.id], ml, is_whole(boxes.box[label.id], g));
    if (!text.empty()) texts.push_back(text);
  }
  // A voxel size that is wrong changes all of them.
  constexpr std::size_t kMany = 3;
  const bool is_grave = texts.size() >= kMany;
  if (!texts.empty())
    findings.push_back(
        {kSizes, fmt::format("{}", fmt::join(texts, ", ")),
         fmt::format("check the size of the voxels and the segmentation; --confirm {} if it is right", kSizes),
         is_grave});
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

void judge_sizes(const volume::LabelGrid& labels, const LabelTable& table, const LabelShapes& shapes,
                 std::vector<AnatomyFinding>& findings) {
  const LabelBoxes boxes = find_label_boxes(labels);
  judge_each(labels.geometry, table, boxes, shapes, findings);
  judge_missing(labels, table, boxes, findings);
}

}  // namespace trocar::anatomy::detail
