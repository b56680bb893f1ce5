#include "anatomy/plausibility/judge_anatomy.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "anatomy/plausibility/detail/directions.h"
#include "anatomy/plausibility/detail/edge_match.h"
#include "anatomy/plausibility/detail/sizes.h"
#include "anatomy/tissue/plausible_hu.h"
#include "core/parallel.h"

namespace trocar::anatomy {
namespace {

using detail::AxisVotes;
using detail::EdgeMatch;
using detail::Reversal;

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

void judge_directions(const std::array<AxisVotes, 3>& votes, const EdgeMatch& edges, const volume::GridGeometry& g,
                      Mirroring mirroring, std::vector<AnatomyFinding>& findings) {
  const Reversal reversed{votes[0].is_reversed(), votes[1].is_reversed(), votes[2].is_reversed()};
  if (reversed == Reversal{}) return;
  const bool is_alone =
      edges.count() >= kFewestEdges && best_reversed_hu(edges, g, reversed) > kBetter * edges.step_hu({0, 0, 0});
  findings.push_back(is_alone ? reversed_labels(reversed, found_text(votes), mirroring)
                              : reversed_image(reversed, found_text(votes), mirroring));
}

/// Labels that fit the CT better elsewhere, or reversed although no organ tells.
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

/// Structures whose borders show in every CT: by tissue, a step of HU above which they lie where they belong, and
/// whether another place is sure enough to refuse. Chosen on the patients of docs/validation.md (section Findings).
struct SharpTissue {
  std::string_view name;
  double sure_hu;
  bool is_grave;
};
constexpr std::array kSharp{SharpTissue{"bone", 90, true}, SharpTissue{"liver", 45, true},
                            SharpTissue{"spleen", 45, true}, SharpTissue{"kidney", 45, true},
                            SharpTissue{"gallbladder", 30}};
constexpr double kTold = 1.6, kSure = 1.8;  ///< Times as large steps elsewhere.

/// Single structures that were drawn elsewhere, in a segmentation that fits otherwise.
void judge_single_places(const VirtualPatient& patient, const EdgeMatch& edges, std::vector<AnatomyFinding>& findings) {
  constexpr std::size_t kFewest = 200;
  constexpr double kCloseStep_mm = 4.0;  // a small structure fits in a small place
  const volume::GridGeometry& g = patient.labels.geometry;
  std::vector<std::string> texts;
  bool is_grave = false;
  for (const Label& label : patient.label_table.labels) {
    const auto tissue = std::ranges::find(kSharp, label.tissue, &SharpTissue::name);
    if (label.is_derived || tissue == kSharp.end() || edges.count_of(label.id) < kFewest) continue;
    const double here_hu = edges.step_hu_of(label.id, {0, 0, 0});
    if (here_hu > tissue->sure_hu) continue;
    const auto step_hu = [&](const volume::Index3& shift) { return edges.step_hu_of(label.id, shift); };
    const BestShift best = find_best(g, Vec3::Constant(kFarthest_mm), step_hu, kCloseStep_mm);
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

/// Single structures on a side where nearly nobody has them. Two of them are no variant, but exchanged names.
void judge_places(const std::array<AxisVotes, 3>& votes, std::vector<AnatomyFinding>& findings) {
  std::vector<std::string> wrong;
  for (const AxisVotes& axis : votes) wrong.insert(wrong.end(), axis.misplaced.begin(), axis.misplaced.end());
  if (wrong.empty()) return;
  findings.push_back({kPlaces, fmt::format("structures lie where they do not belong: {}", fmt::join(wrong, ", ")),
                      fmt::format("check whether names are exchanged; --confirm {} if it is right", kPlaces),
                      wrong.size() > 1});
}

/// A segmentation of another CT has many structures where this one has other things; a single one may be wrong.
void judge_hu(const VirtualPatient& patient, std::vector<AnatomyFinding>& findings) {
  constexpr std::size_t kMany = 4, kMostNamed = 4;
  // The bones of old people, and thin ones in thick slices, come near soft tissue.
  constexpr HuMargin kClear{60.0, 0.2};
  const std::vector<LabelStatistics> statistics = label_statistics(patient);
  std::size_t judged = 0;
  const std::vector<Finding> wrong = find_implausible_hu(patient, statistics, &judged, kClear);
  if (wrong.size() >= kMany && wrong.size() * 4 >= judged) {
    findings.push_back(
        {kOtherCt,
         fmt::format("{} of {} structures have HU that they cannot have ({}; {}): the segmentation seems to "
                     "belong to another CT",
                     wrong.size(), judged, wrong[0].text, wrong[1].text),
         fmt::format("give the segmentation of this CT; --confirm {} if it is right", kOtherCt)});
    return;
  }
  std::vector<std::string> texts;
  const std::vector<Finding> doubts = find_implausible_hu(patient, statistics);
  for (const Finding& doubt : doubts)
    if (texts.size() < kMostNamed) texts.push_back(doubt.text);
  if (doubts.size() > kMostNamed) texts.push_back(fmt::format("and {} more", doubts.size() - kMostNamed));
  if (!texts.empty())
    findings.push_back({kHu, fmt::format("{}", fmt::join(texts, "; ")), "check the segmentation", false});
}

/// Along x: the middle of what is no air.
double middle_of_body(const volume::CtGrid& ct) {
  constexpr std::size_t kMostVisited = 500'000;
  constexpr int kAirBelow_hu = -300;
  const std::size_t stride = std::max<std::size_t>(1, ct.voxels.size() / kMostVisited) | 1;
  double sum = 0.0, count = 0.0;
  for (std::size_t n = 0; n < ct.voxels.size(); n += stride) {
    if (ct.voxels[n] < kAirBelow_hu) continue;
    sum += static_cast<double>(static_cast<std::int64_t>(n) % ct.geometry.size[0]);
    count += 1.0;
  }
  return ct.geometry.to_mm({sum / std::max(count, 1.0), 0.0, 0.0}).x();
}

}  // namespace

std::vector<AnatomyFinding> judge_anatomy(const VirtualPatient& patient, Mirroring mirroring) {
  std::vector<AnatomyFinding> findings;
  const EdgeMatch edges(patient.ct, patient.labels, patient.label_table);
  const volume::GridGeometry& g = patient.labels.geometry;
  const detail::LabelShapes shapes = detail::find_label_shapes(patient.labels);
  const auto votes =
      detail::vote_directions(shapes, g.voxel_volume_mm3() / 1000.0, patient.label_table, middle_of_body(patient.ct));
  judge_directions(votes, edges, g, mirroring, findings);
  if (findings.empty()) judge_place(edges, g, mirroring, findings);
  if (findings.empty()) judge_single_places(patient, edges, findings);
  if (findings.empty() || !findings.back().is_grave) judge_places(votes, findings);
  if (findings.empty() || !findings.back().is_grave) judge_hu(patient, findings);
  detail::judge_sizes(patient.labels, patient.label_table, shapes, findings);
  return findings;
}

bool is_confirmed(const std::vector<std::string>& provenance, const std::string& name) {
  const std::string start = confirmation({name, {}, {}});
  return std::ranges::any_of(provenance, [&](const std::string& line) { return line.starts_with(start); });
}

std::string confirmation(const AnatomyFinding& finding) {
  return fmt::format("confirmed: {}: {}", finding.name, finding.text);
}

Status settle_findings(const std::vector<AnatomyFinding>& findings, const std::vector<std::string>& confirmed,
                       std::vector<std::string>& provenance, std::vector<std::string>& warnings) {
  for (const std::string& name : confirmed)
    if (std::ranges::none_of(findings, [&](const AnatomyFinding& finding) { return finding.name == name; }))
      warnings.push_back(fmt::format("nothing to confirm: there is no finding \"{}\"", name));
  const AnatomyFinding* gravest = nullptr;
  for (const AnatomyFinding& finding : findings) {
    if (std::ranges::find(confirmed, finding.name) != confirmed.end()) {
      provenance.push_back(confirmation(finding));
    } else if (finding.is_grave) {
      if (gravest == nullptr) gravest = &finding;
    } else {
      const std::string repair = finding.repair.empty() ? "" : fmt::format("{}, or ", finding.repair);
      warnings.push_back(fmt::format("{} ({}--confirm {} if it is right)", finding.text, repair, finding.name));
    }
  }
  if (gravest == nullptr) return {};
  return fail(gravest->text, {}, gravest->advice);
}

Status check_confirmable(const std::vector<std::string>& names) {
  constexpr std::array kAll{kMirrored, kTurned, kShifted, kNumbers, kOtherCt, kCropped,
                            kMissing,  kSizes,  kPlaces,  kHu,      kPosture};
  for (const std::string& name : names)
    if (std::ranges::find(kAll, name) == kAll.end())
      return fail_usage(fmt::format("there is no finding \"{}\"", name), "--confirm",
                        fmt::format("give one of {}", fmt::join(kAll, ", ")));
  return {};
}

}  // namespace trocar::anatomy
