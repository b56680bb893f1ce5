#include "patient_builder/plausibility/detail/fit.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>

#include "anatomy/known_structures.h"
#include "core/parallel.h"
#include "patient_builder/detail/label_boxes.h"

namespace trocar::patient_builder::detail {
namespace {

// A better place of the labels is one whose borders lie on steps of HU that are larger by this factor, this far away.
// Chosen so that no patient of docs/validation.md (section Findings) is told of, and 15 mm are.
constexpr double kBetter = 1.25, kLeastShift_mm = 5.0;
constexpr double kFarthest_mm = 30.0, kStep_mm = 5.0, kFineStep_mm = 1.5;
constexpr std::size_t kFewestEdges = 300, kFewestStructures = 3;
constexpr double kClearStep_hu = 45.0;  ///< A place with smaller steps fits nothing.

struct BestShift {
  volume::Index3 shift{};
  double step_hu = 0.0;
};

/// The best of the places around `middle`, `most` steps of so many voxels to each side.
template <class StepHu>
BestShift find_best_around(const volume::Index3& middle, const volume::Index3& step, const volume::Index3& most,
                           const StepHu& step_hu) {
  std::vector<BestShift> tried;
  for (std::int64_t k = -most[2]; k <= most[2]; ++k)
    for (std::int64_t j = -most[1]; j <= most[1]; ++j)
      for (std::int64_t i = -most[0]; i <= most[0]; ++i)
        tried.push_back({{middle[0] + i * step[0], middle[1] + j * step[1], middle[2] + k * step[2]}, 0.0});
  parallel_for(tried.size(), 8, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) tried[n].step_hu = step_hu(tried[n].shift);
  });
  return *std::max_element(tried.begin(), tried.end(),
                           [](const BestShift& a, const BestShift& b) { return a.step_hu < b.step_hu; });
}

/// The place with the largest steps within `farthest_mm` along each axis: in coarse steps, then in finer ones around
/// it.
template <class StepHu>
BestShift find_best(const volume::GridGeometry& g, const Vec3& farthest_mm, const StepHu& step_hu,
                    double step_mm = kStep_mm) {
  volume::Index3 coarse{}, most{}, fine{}, around{};
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    const double spacing_mm = g.spacing_mm[axis];
    coarse[a] = std::max<std::int64_t>(1, std::lround(step_mm / spacing_mm));
    most[a] = std::lround(farthest_mm[axis] / (spacing_mm * static_cast<double>(coarse[a])));
    fine[a] = std::max<std::int64_t>(1, std::lround(kFineStep_mm / spacing_mm));
    around[a] = farthest_mm[axis] > 0.0 ? (coarse[a] + fine[a] - 1) / fine[a] : 0;
  }
  const BestShift best = find_best_around({0, 0, 0}, coarse, most, step_hu);
  return find_best_around(best.shift, fine, around, step_hu);
}

/// "15 mm to the left, 5 mm to the head"
std::string way_text(const Vec3& way_mm) {
  constexpr std::array<std::array<const char*, 2>, 3> kWords{{{"right", "left"}, {"front", "back"}, {"feet", "head"}}};
  std::vector<std::string> parts;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double mm = way_mm[static_cast<Eigen::Index>(axis)];
    if (std::abs(mm) >= 1.0)
      parts.push_back(fmt::format("{:.0f} mm to the {}", std::abs(mm), kWords[axis][mm > 0.0 ? 1 : 0]));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string found_text(const std::array<AxisVotes, 3>& votes) {
  std::vector<std::string> texts;
  for (const AxisVotes& axis : votes)
    if (axis.is_reversed())
      for (const std::string& wrong : axis.wrong_ones)
        if (texts.size() < 5 && std::ranges::find(texts, wrong) == texts.end()) texts.push_back(wrong);
  return fmt::format("{}", fmt::join(texts, ", "));
}

/// The largest steps of HU with the labels reversed along some axes, and moved along these.
double best_reversed_hu(const EdgeMatch& edges, const volume::GridGeometry& g, const Reversal& reversed) {
  constexpr double kFarthestReversed_mm = 60.0;  // twice as far as the body's middle lies from the grid's
  Vec3 farthest_mm = Vec3::Zero();
  for (std::size_t a = 0; a < 3; ++a)
    if (reversed[a]) farthest_mm[static_cast<Eigen::Index>(a)] = kFarthestReversed_mm;
  return find_best(g, farthest_mm, [&](const volume::Index3& shift) { return edges.step_hu(shift, reversed); }).step_hu;
}

/// "left and right, front and back"
std::string axes_text(const Reversal& reversed) {
  constexpr std::array kAxes{"left and right", "front and back", "head and feet"};
  std::vector<std::string> names;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (reversed[axis]) names.emplace_back(kAxes[axis]);
  return fmt::format("{}", fmt::join(names, ", "));
}

constexpr Reversal kLeftRight{true, false, false};

AnatomyFinding reversed_labels(const Reversal& reversed, const std::string& found, Mirroring mirroring) {
  if (reversed != kLeftRight)
    return {kTurned,
            fmt::format("the labels are turned against the CT: {} are exchanged ({})", axes_text(reversed), found),
            fmt::format("export the labels again with their orientation; --confirm {} if they are right", kTurned)};
  const bool was_asked = mirroring == Mirroring::kLabels;
  return {kMirrored, fmt::format("the labels are mirrored ({}), and fit the CT when they are mirrored back", found),
          fmt::format("build {}", was_asked ? "without --mirror" : std::string("with ") + kMirrorLabels), true,
          was_asked ? "" : kMirrorLabels};
}

AnatomyFinding reversed_image(const Reversal& reversed, const std::string& found, Mirroring mirroring) {
  if (reversed != kLeftRight)
    return {kTurned, fmt::format("{} are exchanged ({}): the image is turned", axes_text(reversed), found),
            fmt::format("export CT and labels again with their orientation; --confirm {} if it is right", kTurned)};
  const bool was_asked = mirroring == Mirroring::kBoth;
  return {kMirrored, fmt::format("left and right are exchanged ({}): a mirrored image, or situs inversus", found),
          fmt::format("build {} if the image is mirrored, --confirm {} if the patient is like that",
                      was_asked ? "without --mirror" : std::string("with ") + kMirrorBoth, kMirrored),
          true, was_asked ? "" : kMirrorBoth};
}

}  // namespace

void judge_directions(const std::array<AxisVotes, 3>& votes, const EdgeMatch& edges, const volume::GridGeometry& g,
                      Mirroring mirroring, std::vector<AnatomyFinding>& findings) {
  const Reversal reversed{votes[0].is_reversed(), votes[1].is_reversed(), votes[2].is_reversed()};
  if (reversed == Reversal{}) return;
  const bool is_alone =
      edges.count() >= kFewestEdges && best_reversed_hu(edges, g, reversed) > kBetter * edges.step_hu({0, 0, 0});
  findings.push_back(is_alone ? reversed_labels(reversed, found_text(votes), mirroring)
                              : reversed_image(reversed, found_text(votes), mirroring));
}

void judge_place(const EdgeMatch& edges, const volume::GridGeometry& g, Mirroring mirroring,
                 std::vector<AnatomyFinding>& findings) {
  if (edges.count() < kFewestEdges || edges.structures() < kFewestStructures) return;
  const double here_hu = edges.step_hu({0, 0, 0});
  const BestShift best =
      find_best(g, Vec3::Constant(kFarthest_mm), [&](const volume::Index3& shift) { return edges.step_hu(shift); });
  constexpr std::array<Reversal, 4> kLikely{
      {kLeftRight, {false, true, false}, {false, false, true}, {true, true, false}}};
  for (const Reversal& reversed : kLikely) {
    const double reversed_hu = best_reversed_hu(edges, g, reversed);
    if (reversed_hu < kClearStep_hu || reversed_hu <= kBetter * std::max(here_hu, best.step_hu)) continue;
    findings.push_back(reversed_labels(
        reversed, fmt::format("steps of {:.0f} HU at their borders, {:.0f} when reversed", here_hu, reversed_hu),
        mirroring));
    return;
  }
  const Vec3 way_mm = volume::to_vec3(best.shift).cwiseProduct(g.spacing_mm);
  if (best.step_hu < kClearStep_hu || best.step_hu <= kBetter * here_hu || way_mm.norm() < kLeastShift_mm) return;
  findings.push_back({kShifted,
                      fmt::format("the labels lie beside the structures in the CT: they would fit {} "
                                  "(steps of {:.0f} instead of {:.0f} HU at their borders)",
                                  way_text(way_mm), best.step_hu, here_hu),
                      fmt::format("give the labels of this CT, with its place in their header; --confirm {} if they "
                                  "are right",
                                  kShifted)});
}

namespace {

/// Structures whose borders show in every CT: by tissue, a step of HU above which they lie where they belong, and
/// whether another place is sure enough to refuse. Chosen on the patients of docs/validation.md (section Findings).
struct SharpTissue {
  std::string_view name;
  double sure_hu;
  bool is_grave;
};
constexpr std::array kSharp{SharpTissue{"bone", 90, true}, SharpTissue{"liver", 45, true},
                            SharpTissue{"spleen", 45, true}, SharpTissue{"kidney", 45, true},
                            SharpTissue{"gallbladder", 30, false}};
constexpr double kTold = 1.6, kSure = 1.8;  ///< Times as large steps elsewhere.

}  // namespace

void judge_single_places(const anatomy::VirtualPatient& patient, const EdgeMatch& edges,
                         std::vector<AnatomyFinding>& findings) {
  constexpr std::size_t kFewest = 200;
  constexpr double kFarthestOfOne_mm = 45.0;
  constexpr double kCloseStep_mm = 4.0;  // a small structure fits in a small place
  const volume::GridGeometry& g = patient.labels.geometry;
  std::vector<std::string> texts;
  bool is_grave = false;
  for (const anatomy::Label& label : patient.label_table.labels) {
    const auto tissue = std::ranges::find(kSharp, label.tissue, &SharpTissue::name);
    if (label.is_derived || tissue == kSharp.end() || edges.count_of(label.id) < kFewest) continue;
    const double here_hu = edges.step_hu_of(label.id, {0, 0, 0});
    if (here_hu > tissue->sure_hu) continue;
    const auto step_hu = [&](const volume::Index3& shift) { return edges.step_hu_of(label.id, shift); };
    const BestShift best = find_best(g, Vec3::Constant(kFarthestOfOne_mm), step_hu, kCloseStep_mm);
    const Vec3 way_mm = volume::to_vec3(best.shift).cwiseProduct(g.spacing_mm);
    if (best.step_hu < kClearStep_hu || best.step_hu < kTold * here_hu || way_mm.norm() < kLeastShift_mm) continue;
    is_grave |= tissue->is_grave && best.step_hu >= kSure * here_hu;
    texts.push_back(fmt::format("{} would fit {} (steps of {:.0f} instead of {:.0f} HU at its border)", label.name,
                                way_text(way_mm), best.step_hu, here_hu));
  }
  if (texts.empty()) return;
  constexpr std::size_t kMany = 4, kMostNamed = 3;
  const std::size_t count = texts.size();
  texts.resize(std::min(count, kMostNamed));
  const std::string named = fmt::format("{}", fmt::join(texts, ", "));
  if (count >= kMany) {
    findings.push_back({kOtherCt,
                        fmt::format("{} structures lie beside what the CT shows, each elsewhere ({}): the segmentation "
                                    "seems to belong to another CT",
                                    count, named),
                        fmt::format("give the segmentation of this CT; --confirm {} if it is right", kOtherCt)});
    return;
  }
  findings.push_back({kShifted, fmt::format("single structures lie beside what the CT shows: {}", named),
                      fmt::format("segment them again; --confirm {} if they are right", kShifted), is_grave});
}

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

const SizeRange* find_range(const anatomy::Label& label) {
  if (const int place = vertebra_place(label.name); place > 0 && place < kSacrum) return &kVertebra;
  const std::string plain = anatomy::without_side(anatomy::plain_name(label.name));
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
std::string size_text(const anatomy::Label& label, const SizeRange& range, const LabelShape& shape, double ml,
                      bool is_whole) {
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

void judge_each(const volume::GridGeometry& g, const anatomy::LabelTable& table, const LabelBoxes& boxes,
                const LabelShapes& shapes, std::vector<AnatomyFinding>& findings) {
  std::vector<std::string> texts;
  for (const anatomy::Label& label : table.labels) {
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
void judge_missing(const volume::LabelGrid& labels, const anatomy::LabelTable& table, const LabelBoxes& boxes,
                   std::vector<AnatomyFinding>& findings) {
  std::size_t present = 0, whole = 0;
  std::vector<std::string> missing;
  for (const anatomy::Label& label : table.labels) present += !label.is_derived && boxes.voxels[label.id] > 0 ? 1 : 0;
  for (const std::string_view name : kExpected) {
    bool is_there = false;
    for (const anatomy::Label& label : table.labels) {
      if (anatomy::plain_name(label.name) != anatomy::plain_name(name) || boxes.voxels[label.id] == 0) continue;
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

void judge_sizes(const volume::LabelGrid& labels, const anatomy::LabelTable& table, const LabelShapes& shapes,
                 std::vector<AnatomyFinding>& findings) {
  const LabelBoxes boxes = find_label_boxes(labels);
  judge_each(labels.geometry, table, boxes, shapes, findings);
  judge_missing(labels, table, boxes, findings);
}

}  // namespace trocar::patient_builder::detail
