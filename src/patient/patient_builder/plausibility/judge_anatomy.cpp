#include "patient_builder/plausibility/judge_anatomy.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "anatomy/tissue/hounsfield.h"
#include "patient_builder/plausibility/detail/directions.h"
#include "patient_builder/plausibility/detail/edge_match.h"
#include "patient_builder/plausibility/detail/fit.h"

namespace trocar::patient_builder {
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

std::vector<std::string> texts_of(const std::vector<anatomy::Finding>& findings, std::size_t most) {
  std::vector<std::string> texts;
  for (const anatomy::Finding& finding : findings)
    if (texts.size() < most) texts.push_back(finding.text);
  return texts;
}

/// A segmentation of another CT has many structures where this one has other things; a single one may be wrong.
void judge_hu(const anatomy::VirtualPatient& patient, std::vector<AnatomyFinding>& findings) {
  constexpr std::size_t kMostNamed = 4;
  // The bones of old people, and thin ones in thick slices, come near soft tissue.
  constexpr anatomy::HuMargin kClear{60.0, 0.2};
  const std::vector<anatomy::LabelStatistics> statistics = anatomy::label_statistics(patient);
  std::size_t judged = 0;
  const std::vector<anatomy::Finding> wrong = anatomy::find_implausible_hu(patient, statistics, &judged, kClear);
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
  const std::vector<anatomy::Finding> implausible = anatomy::find_implausible_hu(patient, statistics);
  std::vector<std::string> texts = texts_of(implausible, kMostNamed);
  if (implausible.size() > kMostNamed) texts.push_back(fmt::format("and {} more", implausible.size() - kMostNamed));
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

std::vector<AnatomyFinding> judge_anatomy(const anatomy::VirtualPatient& patient, Mirroring mirroring) {
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

}  // namespace trocar::patient_builder

// The CT table against the posture.

namespace trocar::patient_builder {
namespace {

// Assumed: a table's shell is denser than foam and clothes, runs through most slices, and is as wide as the body.
constexpr int kTableAbove_hu = -700;
constexpr double kBlock_mm = 5.0;
constexpr double kShareOfSlices = 0.7;
constexpr double kLeastCover = 0.35;  ///< Of the body's width that the table covers on its side.
constexpr double kLeastBeside = 0.6;  ///< The same on the left and right, where an arm covers some of it.
constexpr double kClearCover = 2.0;   ///< Times that on every other side: arms and the table's rims cover less.
constexpr std::int64_t kFewestSlices = 5;

/// Seen along the body, in blocks of voxels: which ones hold body, and which ones the table.
struct TableView {
  std::int64_t nx = 0, ny = 0;
  std::vector<std::uint8_t> body, table;
  bool is_body(std::int64_t x, std::int64_t y) const { return body[static_cast<std::size_t>(y * nx + x)] != 0; }
  bool is_table(std::int64_t x, std::int64_t y) const { return table[static_cast<std::size_t>(y * nx + x)] != 0; }
};

/// Body or something dense outside it, in the blocks of one slice.
struct SliceBlocks {
  std::vector<std::uint8_t> body, dense;
};

void fill_blocks(const volume::CtGrid& ct, const volume::MaskGrid& body, std::int64_t k,
                 const std::array<std::int64_t, 2>& step, const TableView& view, SliceBlocks& blocks) {
  std::ranges::fill(blocks.body, std::uint8_t{0});
  std::ranges::fill(blocks.dense, std::uint8_t{0});
  const volume::GridGeometry& g = ct.geometry;
  std::size_t n = g.offset({0, 0, k});
  for (std::int64_t j = 0; j < g.size[1]; ++j)
    for (std::int64_t i = 0; i < g.size[0]; ++i, ++n) {
      const auto block = static_cast<std::size_t>(j / step[1] * view.nx + i / step[0]);
      if (body.voxels[n] != 0) {
        blocks.body[block] = 1;
      } else if (ct.voxels[n] > kTableAbove_hu) {
        blocks.dense[block] = 1;
      }
    }
}

bool is_near_body(const SliceBlocks& blocks, const TableView& view, std::int64_t x, std::int64_t y) {
  for (std::int64_t v = std::max<std::int64_t>(y - 1, 0); v <= std::min(y + 1, view.ny - 1); ++v)
    for (std::int64_t u = std::max<std::int64_t>(x - 1, 0); u <= std::min(x + 1, view.nx - 1); ++u)
      if (blocks.body[static_cast<std::size_t>(v * view.nx + u)] != 0) return true;
  return false;
}

TableView view_along_body(const volume::CtGrid& ct, const volume::MaskGrid& body) {
  const volume::GridGeometry& g = ct.geometry;
  const std::array<std::int64_t, 2> step{std::max<std::int64_t>(1, std::lround(kBlock_mm / g.spacing_mm.x())),
                                         std::max<std::int64_t>(1, std::lround(kBlock_mm / g.spacing_mm.y()))};
  TableView view{(g.size[0] + step[0] - 1) / step[0], (g.size[1] + step[1] - 1) / step[1], {}, {}};
  const auto count = static_cast<std::size_t>(view.nx * view.ny);
  std::vector<std::int64_t> body_slices(count), dense_slices(count);
  SliceBlocks blocks{std::vector<std::uint8_t>(count), std::vector<std::uint8_t>(count)};
  for (std::int64_t k = 0; k < g.size[2]; ++k) {
    fill_blocks(ct, body, k, step, view, blocks);
    for (std::int64_t y = 0; y < view.ny; ++y)
      for (std::int64_t x = 0; x < view.nx; ++x) {
        const auto block = static_cast<std::size_t>(y * view.nx + x);
        body_slices[block] += blocks.body[block];
        dense_slices[block] += blocks.dense[block] != 0 && !is_near_body(blocks, view, x, y) ? 1 : 0;
      }
  }
  for (std::size_t block = 0; block < count; ++block) {
    view.body.push_back(2 * body_slices[block] > g.size[2] ? 1 : 0);
    const double share = static_cast<double>(dense_slices[block]) / static_cast<double>(g.size[2]);
    view.table.push_back(share >= kShareOfSlices ? 1 : 0);
  }
  return view;
}

/// Share of the body's lines along an axis (x: 0, y: 1) with a piece of the table beyond the body at the low and at
/// the high end.
std::array<double, 2> cover_along(const TableView& view, bool is_y) {
  const std::int64_t lines = is_y ? view.nx : view.ny, length = is_y ? view.ny : view.nx;
  double of_body = 0.0;
  std::array<double, 2> covered{};
  for (std::int64_t line = 0; line < lines; ++line) {
    std::int64_t first = length, last = -1;
    const auto is_body = [&](std::int64_t n) { return is_y ? view.is_body(line, n) : view.is_body(n, line); };
    const auto is_table = [&](std::int64_t n) { return is_y ? view.is_table(line, n) : view.is_table(n, line); };
    for (std::int64_t n = 0; n < length; ++n)
      if (is_body(n)) first = std::min(first, n), last = n;
    if (last < 0) continue;
    of_body += 1.0;
    bool is_low = false, is_high = false;
    for (std::int64_t n = 0; n < first; ++n) is_low |= is_table(n);
    for (std::int64_t n = last + 1; n < length; ++n) is_high |= is_table(n);
    covered[0] += is_low ? 1.0 : 0.0;
    covered[1] += is_high ? 1.0 : 0.0;
  }
  for (double& share : covered) share /= std::max(of_body, 1.0);
  return covered;
}

const char* side_words(anatomy::Posture posture) {
  switch (posture) {
    case anatomy::Posture::kProne:
      return "in front of the body";
    case anatomy::Posture::kLeftLateral:
      return "left of the body";
    case anatomy::Posture::kRightLateral:
      return "right of the body";
    case anatomy::Posture::kSupine:
    case anatomy::Posture::kSitting:
      break;
  }
  return "behind the body";
}

}  // namespace

std::optional<anatomy::Posture> find_scanned_posture(const volume::CtGrid& ct, const volume::MaskGrid& body) {
  if (ct.geometry.size[2] < kFewestSlices) return std::nullopt;
  const TableView view = view_along_body(ct, body);
  const auto x = cover_along(view, false), y = cover_along(view, true);
  std::array<std::pair<double, anatomy::Posture>, 4> sides{{{y[1], anatomy::Posture::kSupine},
                                                            {y[0], anatomy::Posture::kProne},
                                                            {x[1], anatomy::Posture::kLeftLateral},
                                                            {x[0], anatomy::Posture::kRightLateral}}};
  std::ranges::sort(sides, [](const auto& a, const auto& b) { return a.first > b.first; });
  const auto& [cover, posture] = sides[0];
  const bool is_beside = posture == anatomy::Posture::kLeftLateral || posture == anatomy::Posture::kRightLateral;
  if (cover < (is_beside ? kLeastBeside : kLeastCover) || cover < kClearCover * sides[1].first) return std::nullopt;
  return posture;
}

std::vector<AnatomyFinding> judge_posture(const volume::CtGrid& ct, const volume::MaskGrid& body,
                                          anatomy::Posture posture) {
  const std::optional<anatomy::Posture> scanned = find_scanned_posture(ct, body);
  if (!scanned || *scanned == posture) return {};
  return {{kPosture,
           fmt::format("the table lies {}: the CT was taken {} ({}), and organs, gas and fluid lie as they did then, "
                       "while the patient is {} ({})",
                       side_words(*scanned), anatomy::posture_words(*scanned), anatomy::posture_name(*scanned),
                       anatomy::posture_words(posture), anatomy::posture_name(posture)),
           fmt::format("build with {}{}", kUsePosture, anatomy::posture_name(*scanned)), false,
           fmt::format("{}{}", kUsePosture, anatomy::posture_name(*scanned))}};
}

}  // namespace trocar::patient_builder

// A CT that is cropped inside the body has no skin, to which depths are measured.

namespace trocar::patient_builder {
namespace {

constexpr double kMostlyInside = 0.5;  ///< Share of every side from which on no task has a skin to enter.
constexpr double kTold = 0.1;          ///< Of all sides: arms and hips are often beyond the edge of a CT.

/// Calls visit(offset) for the outermost voxels of one side: the lowest or highest i or j.
template <class Visit>
void for_each_at_side(const volume::GridGeometry& g, std::size_t axis, bool is_high, const Visit& visit) {
  const std::size_t other = 1 - axis;
  for (std::int64_t k = 0; k < g.size[2]; ++k)
    for (std::int64_t n = 0; n < g.size[other]; ++n) {
      volume::Index3 ijk{0, 0, k};
      ijk[axis] = is_high ? g.size[axis] - 1 : 0;
      ijk[other] = n;
      visit(g.offset(ijk));
    }
}

}  // namespace

std::vector<AnatomyFinding> judge_sides(const volume::MaskGrid& body) {
  double all = 0.0, inside = 0.0, least_share = 1.0;
  for (const std::size_t axis : {0U, 1U})
    for (const bool is_high : {false, true}) {
      double of_side = 0.0, inside_of_side = 0.0;
      for_each_at_side(body.geometry, axis, is_high, [&](std::size_t n) {
        of_side += 1.0;
        inside_of_side += body.voxels[n];
      });
      all += of_side;
      inside += inside_of_side;
      least_share = std::min(least_share, inside_of_side / std::max(of_side, 1.0));
    }
  const double share = inside / std::max(all, 1.0);
  if (share < kTold) return {};
  const std::string text =
      fmt::format("{:.0f} % of the sides of the CT lie inside the body: there it shows no skin", 100.0 * share);
  return {{kCropped, text,
           fmt::format("give a CT that shows the skin; --confirm {} takes the sides of the CT as the skin", kCropped),
           least_share >= kMostlyInside}};
}

void take_sides_as_skin(volume::MaskGrid& body) {
  for (const std::size_t axis : {0U, 1U})
    for (const bool is_high : {false, true})
      for_each_at_side(body.geometry, axis, is_high, [&](std::size_t n) { body.voxels[n] = 0; });
}

anatomy::AirIn air_of(const std::vector<std::string>& confirmed) {
  return std::ranges::find(confirmed, kCropped) != confirmed.end() ? anatomy::AirIn::kNowhere
                                                                   : anatomy::AirIn::kAroundTheBody;
}

}  // namespace trocar::patient_builder
