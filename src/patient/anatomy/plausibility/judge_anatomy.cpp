#include "anatomy/plausibility/judge_anatomy.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "anatomy/plausibility/detail/directions.h"
#include "anatomy/plausibility/detail/edge_match.h"
#include "anatomy/plausibility/detail/fit.h"
#include "anatomy/plausibility/detail/sizes.h"
#include "anatomy/tissue/plausible_hu.h"

namespace trocar::anatomy {
namespace {

using detail::AxisVotes;
using detail::EdgeMatch;

/// Single structures on a side where nearly nobody has them. Two of them are no variant, but exchanged names.
void judge_places(const std::array<AxisVotes, 3>& votes, std::vector<AnatomyFinding>& findings) {
  std::vector<std::string> wrong;
  for (const AxisVotes& axis : votes) wrong.insert(wrong.end(), axis.misplaced.begin(), axis.misplaced.end());
  if (wrong.empty()) return;
  findings.push_back({kPlaces, fmt::format("structures lie where they do not belong: {}", fmt::join(wrong, ", ")),
                      fmt::format("check whether names are exchanged; --confirm {} if it is right", kPlaces),
                      wrong.size() > 1});
}

std::vector<std::string> texts_of(const std::vector<Finding>& findings, std::size_t most) {
  std::vector<std::string> texts;
  for (const Finding& finding : findings)
    if (texts.size() < most) texts.push_back(finding.text);
  return texts;
}

/// A segmentation of another CT has many structures where this one has other things; a single one may be wrong.
void judge_hu(const VirtualPatient& patient, std::vector<AnatomyFinding>& findings) {
  constexpr std::size_t kMostNamed = 4;
  // The bones of old people, and thin ones in thick slices, come near soft tissue.
  constexpr HuMargin kClear{60.0, 0.2};
  const std::vector<LabelStatistics> statistics = label_statistics(patient);
  std::size_t judged = 0;
  const std::vector<Finding> wrong = find_implausible_hu(patient, statistics, &judged, kClear);
  const std::size_t many = judged <= 3 ? 1 : judged <= 8 ? 2 : 4;
  if (wrong.size() >= many && wrong.size() * 4 >= judged) {
    findings.push_back(
        {kOtherCt,
         fmt::format("{} of {} structures have HU that they cannot have ({}): the segmentation seems to belong to "
                     "another CT",
                     wrong.size(), judged, fmt::join(texts_of(wrong, 2), "; ")),
         fmt::format("give the segmentation of this CT; --confirm {} if it is right", kOtherCt)});
    return;
  }
  const std::vector<Finding> findings = find_implausible_hu(patient, statistics);
  std::vector<std::string> texts = texts_of(findings, kMostNamed);
  if (findings.size() > kMostNamed) texts.push_back(fmt::format("and {} more", findings.size() - kMostNamed));
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
  detail::judge_directions(votes, edges, g, mirroring, findings);
  if (findings.empty()) detail::judge_place(edges, g, mirroring, findings);
  if (findings.empty()) detail::judge_single_places(patient, edges, findings);
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
