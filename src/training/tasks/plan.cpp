#include "tasks/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>

#include "core/parallel.h"
#include "core/random.h"
#include "geometry/pose.h"
#include "tasks/detail/block_grid.h"
#include "tasks/detail/path_check.h"
#include "tasks/detail/planning_map.h"
#include "tasks/fit_to_patient.h"

namespace trocar::tasks {
namespace {

using detail::PathCandidate;
using detail::PathFindings;
using detail::PlanningMap;
using detail::PlanTargets;
using Verdict = detail::PathVerdict;

constexpr std::size_t kMinLines = 65536;  ///< Tested lines: at 100 mm depth 1.4 mm apart on the skin.
constexpr std::size_t kLinesPerTarget = 2048;
constexpr std::size_t kLinesPerPath = 32;  ///< About one line in forty is a path in a real abdomen.
constexpr std::size_t kMaxLines = std::size_t{1} << 22;
constexpr std::size_t kBlock = 64;            ///< Paths checked in parallel.
constexpr std::size_t kMaxSpreadCount = 500;  ///< More paths are not spread: they are close together anyway.
constexpr double kFirstSpread_mm = 16.0;
/// Accepted additional length of a path with the full reported margin instead of none [assumed].
constexpr double kMarginWorth_mm = 20.0;

/// Direction n of a low-discrepancy sequence on the sphere (Roberts' R2 sequence, shifted by the seed).
Vec3 direction(std::uint64_t seed, std::size_t n) {
  constexpr double kA = 0.7548776662466927;  // 1/g and 1/g^2 of the plastic number g
  constexpr double kB = 0.5698402909980532;
  double whole = 0.0;
  const double u = std::modf(uniform01(seed, 0) + kA * static_cast<double>(n), &whole);
  const double v = std::modf(uniform01(seed, 1) + kB * static_cast<double>(n), &whole);
  const double z = 1.0 - 2.0 * u;
  const double r = std::sqrt(std::max(0.0, 1.0 - z * z));
  return {r * std::cos(2.0 * std::numbers::pi * v), r * std::sin(2.0 * std::numbers::pi * v), z};
}

/// The same towards the entry zone, in the cone of directions that it covers from the target.
Vec3 direction_to(const EntryZone& zone, const Vec3& target_P, const Vec3& on_sphere) {
  const Vec3 way = zone.centre_P - target_P;
  const double distance = way.norm();
  if (distance <= zone.radius_mm) return on_sphere;
  const double cos_edge = std::sqrt(1.0 - std::pow(zone.radius_mm / distance, 2));
  const double z = 1.0 - 0.5 * (1.0 - on_sphere.z()) * (1.0 - cos_edge);
  const double r = std::sqrt(std::max(0.0, 1.0 - z * z));
  const double around = std::atan2(on_sphere.y(), on_sphere.x());
  const Vec3 local(r * std::cos(around), r * std::sin(around), z);
  return rotation_between(Vec3::UnitZ(), way / distance) * local;
}

std::vector<PathCandidate> trace_lines(const PlanningMap& map, const Needle& needle, const PlanTargets& targets,
                                       const PlanOptions& options) {
  const std::size_t target_count = targets.points_P.size();
  const std::size_t count = std::clamp(kLinesPerPath * static_cast<std::size_t>(options.count),
                                       std::max(kMinLines, kLinesPerTarget * target_count), kMaxLines);
  std::vector<PathCandidate> lines(count);
  parallel_for(count, 512, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) {
      const Vec3& target_P = targets.points_P[n % target_count];
      Vec3 outward = direction(options.seed, n / target_count);
      if (map.task.entry_zone) outward = direction_to(*map.task.entry_zone, target_P, outward);
      lines[n] = trace_path(map, needle, target_P, outward);
    }
  });
  return lines;
}

/// Candidates in the order of their lower cost bound, and the findings of their exact checks.
class Selection {
 public:
  Selection(const PlanningMap& map, const Needle& needle, std::vector<PathCandidate>& lines)
      : map_(map), needle_(needle), lines_(lines) {
    for (std::size_t n = 0; n < lines.size(); ++n)
      if (lines[n].verdict == Verdict::kFree) order_.push_back(n);
    std::sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
      return std::pair(least_cost_mm(lines[a]), a) < std::pair(least_cost_mm(lines[b]), b);
    });
    findings_.resize(order_.size());
    is_checked_.assign(order_.size(), false);
  }

  /// The `count` paths of lowest cost with entries at least `spread_mm` apart. A checked path is selected when its cost
  /// is not above the lower bound of every unchecked path.
  std::vector<PlannedPath> choose(std::size_t count, double spread_mm, const Progress& progress) {
    std::vector<std::size_t> chosen;
    const auto is_apart = [&](std::size_t n) {
      return spread_mm <= 0.0 || std::none_of(chosen.begin(), chosen.end(), [&](std::size_t other) {
               return (line(n).line_P.a - line(other).line_P.a).norm() < spread_mm;
             });
    };
    std::set<std::pair<double, std::size_t>> waiting;  // checked and free, sorted by cost
    for (std::size_t next = 0; chosen.size() < count && (next < order_.size() || !waiting.empty());) {
      std::vector<std::size_t> block;
      for (; next < order_.size() && block.size() < kBlock; ++next)
        if (is_apart(next)) block.push_back(next);
      check(block);
      for (const std::size_t n : block)
        if (findings_[n].verdict == Verdict::kFree) waiting.emplace(cost_mm(n), n);
      const double bound_mm =
          next < order_.size() ? least_cost_mm(line(next)) : std::numeric_limits<double>::infinity();
      while (!waiting.empty() && waiting.begin()->first <= bound_mm && chosen.size() < count) {
        const std::size_t n = waiting.extract(waiting.begin()).value().second;
        if (is_apart(n)) chosen.push_back(n);
      }
      report(progress, "choosing paths", static_cast<double>(chosen.size()) / static_cast<double>(count));
    }
    std::vector<PlannedPath> paths;
    for (const std::size_t n : chosen) paths.push_back(path(n));
    return paths;
  }

  /// Writes the results of the exact checks back to the lines, for the error message.
  void settle() {
    for (std::size_t n = 0; n < order_.size(); ++n) {
      if (!is_checked_[n]) continue;
      lines_[order_[n]].verdict = findings_[n].verdict;
      lines_[order_[n]].where_P = findings_[n].where_P;
    }
  }

 private:
  static double least_cost_mm(const PathCandidate& line) {
    return path_cost_mm(line.length_mm, line.largest_margin_mm);
  }
  const PathCandidate& line(std::size_t n) const { return lines_[order_[n]]; }
  double cost_mm(std::size_t n) const { return path_cost_mm(line(n).length_mm, findings_[n].spare_margin_mm); }

  void check(const std::vector<std::size_t>& block) {
    parallel_for(block.size(), 1, [&](std::size_t first, std::size_t last) {
      for (std::size_t m = first; m < last; ++m)
        if (!is_checked_[block[m]]) findings_[block[m]] = check_path(map_, needle_, line(block[m]));
    });
    for (const std::size_t n : block) is_checked_[n] = true;
  }

  PlannedPath path(std::size_t n) const {
    const PathFindings& found = findings_[n];
    PlannedPath path;
    path.line_P = line(n).line_P;
    path.length_mm = line(n).length_mm;
    path.organ_path_mm = found.organ_path_mm;
    path.spare_margin_mm = found.spare_margin_mm;
    path.cost_mm = cost_mm(n);
    path.posture = map_.posture;
    if (const anatomy::Label* label = map_.patient.label_table.find(found.nearest_risk))
      path.nearest_risk = label->name;
    return path;
  }

  const PlanningMap& map_;
  const Needle& needle_;
  std::vector<PathCandidate>& lines_;
  std::vector<std::size_t> order_;
  std::vector<PathFindings> findings_;
  std::vector<bool> is_checked_;
};

/// Label of the risk voxel with the largest margin violation around a point; nullptr if there is none.
const anatomy::Label* nearest_risk(const PlanningMap& map, const Vec3& p_P) {
  const volume::LabelGrid& labels = map.patient.labels;
  const detail::IndexBox box = detail::clipped(
      detail::box_around(labels.geometry, p_P, map.largest_margin_mm + 2.0 * map.slack_mm), labels.geometry);
  double smallest = std::numeric_limits<double>::infinity();
  const anatomy::Label* nearest = nullptr;
  for (std::int64_t k = box.low[2]; k <= box.high[2]; ++k)
    for (std::int64_t j = box.low[1]; j <= box.high[1]; ++j)
      for (std::int64_t i = box.low[0]; i <= box.high[0]; ++i) {
        const std::uint8_t id = labels[{i, j, k}];
        if (!map.risks[id]) continue;
        const Vec3 centre =
            labels.geometry.to_mm({static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)});
        const double clearance = (centre - p_P).norm() - map.risks[id]->margin_mm;
        if (clearance >= smallest) continue;
        smallest = clearance;
        nearest = map.patient.label_table.find(id);
      }
  return nearest;
}

/// Text of a verdict, without the structure if that is irrelevant.
std::string reason_of(const PlanningMap& map, const Needle& needle, const PathCandidate& line) {
  const Task& task = map.task;
  switch (line.verdict) {
    case Verdict::kTooLong:
      return fmt::format("are longer than {} mm", std::min(task.max_path_mm, needle.length_mm));
    case Verdict::kCutFace:
      return "leave the volume before the skin";
    case Verdict::kOutOfReach:
      return fmt::format("start where the skin faces down, with the patient {}", anatomy::posture_words(map.posture));
    case Verdict::kOutsideZone:
      return "start outside the entry zone";
    case Verdict::kGlancing:
      return fmt::format("meet the skin at more than {} degrees", task.max_entry_angle_deg);
    case Verdict::kNoMuscle:
      return "do not pass through muscle";
    case Verdict::kLeavesOrgan:
      return fmt::format("leave the {} again before the needle's end", task.organ);
    case Verdict::kOrganPath:
      return fmt::format("pass less than {} mm of {} before the target", task.min_organ_path_mm, task.organ);
    case Verdict::kCrosses:
    case Verdict::kMargin: {
      const anatomy::Label* label = anatomy::find_label(map.patient, line.where_P);
      if (line.verdict == Verdict::kMargin && !(label && map.risks[label->id])) label = nearest_risk(map, line.where_P);
      if (!label) return "are too close to a risk structure";
      if (!map.risks[label->id]) return fmt::format("cross {}", label->tissue);
      return fmt::format("are closer than the margin of {} mm to {}", map.risks[label->id]->margin_mm, label->tissue);
    }
    case Verdict::kFree:
      break;
  }
  return "are free";
}

bool is_about_skin(Verdict verdict) {
  return verdict == Verdict::kTooLong || verdict == Verdict::kCutFace || verdict == Verdict::kOutOfReach ||
         verdict == Verdict::kOutsideZone || verdict == Verdict::kGlancing;
}

/// The reason that excluded the most lines; lines without a valid entry on the skin (half of a body is its back) count
/// only if there are no others, or if the patient lies on the only usable one.
std::string obstacle_of(const PlanningMap& map, const Needle& needle, const std::vector<PathCandidate>& lines) {
  constexpr std::size_t kMaxAsked = 4000;
  constexpr double kManyBelow = 0.1;
  std::vector<const PathCandidate*> asked;
  std::size_t below = 0;
  for (const PathCandidate& line : lines) {
    if (!is_about_skin(line.verdict)) asked.push_back(&line);
    if (line.verdict == Verdict::kOutOfReach) ++below;
  }
  const bool has_entries = !asked.empty();
  if (!has_entries)
    for (const PathCandidate& line : lines) asked.push_back(&line);
  std::map<std::string, std::size_t> reasons;
  const std::size_t stride = std::max<std::size_t>(1, asked.size() / kMaxAsked);
  std::size_t total = 0;
  for (std::size_t n = 0; n < asked.size(); n += stride, ++total) ++reasons[reason_of(map, needle, *asked[n])];
  const auto worst = std::max_element(reasons.begin(), reasons.end(),
                                      [](const auto& a, const auto& b) { return a.second < b.second; });
  std::string text =
      fmt::format("of the {} {:.0f} % {}", has_entries ? "lines from a usable entry" : "lines from the target",
                  100.0 * static_cast<double>(worst->second) / static_cast<double>(total), worst->first);
  const double share_below = static_cast<double>(below) / static_cast<double>(lines.size());
  if (has_entries && share_below > kManyBelow)
    text += fmt::format(", and {:.0f} % of all lines start where the skin faces down", 100.0 * share_below);
  return text;
}

struct Obstacle {
  anatomy::Posture posture;
  std::string text;
};

/// The obstacles of the postures; equal ones of several postures once.
tl::unexpected<Error> no_path(const Task& task, const anatomy::VirtualPatient& patient,
                              const std::vector<Obstacle>& obstacles) {
  std::vector<std::pair<std::string, std::string>> texts;  // obstacle, postures
  for (const auto& [posture, text] : obstacles) {
    const auto same = std::ranges::find(texts, text, &std::pair<std::string, std::string>::first);
    const std::string words(anatomy::posture_words(posture));
    if (same == texts.end())
      texts.emplace_back(text, words);
    else
      same->second += ", " + words;
  }
  std::string what = "no safe path";
  for (const auto& [text, postures] : texts)
    what += fmt::format("{} with the patient {}: {}", &text == &texts.front().first ? "" : ";", postures, text);
  return fail(std::move(what), patient.name,
              fmt::format("relax this limit of the task {}, choose a posture with --posture, or select another patient",
                          task.name));
}

/// The paths in the posture of the map; empty: none, and `lines` are settled.
std::vector<PlannedPath> find_paths(const PlanningMap& map, const Needle& needle, const PlanOptions& options,
                                    std::vector<PathCandidate>& lines, const Progress& progress) {
  Selection selection(map, needle, lines);
  const auto count = static_cast<std::size_t>(options.count);
  const bool is_spread = count > 1 && count <= kMaxSpreadCount;
  std::vector<PlannedPath> paths;
  for (double spread = is_spread ? kFirstSpread_mm : 0.0; paths.size() < count;
       spread = spread > 1.0 ? spread / 2 : 0.0) {
    paths = selection.choose(count, spread, progress);
    if (spread == 0.0 || paths.empty()) break;
  }
  if (paths.empty()) selection.settle();
  return paths;
}

}  // namespace

double path_cost_mm(double length_mm, double spare_margin_mm) noexcept {
  const double missing = 1.0 - std::clamp(spare_margin_mm / detail::kReportedMargin_mm, 0.0, 1.0);
  return length_mm + kMarginWorth_mm * missing * missing;
}

Result<std::vector<PlannedPath>> plan_paths(const Task& task, const anatomy::VirtualPatient& patient,
                                            const Needle& needle, const PlanOptions& options,
                                            const Progress& progress) {
  if (options.count < 1 || options.count > 100000)
    return fail_usage("the number of paths must be from 1 to 100000", fmt::format("{}", options.count),
                      "choose a number in this range");
  if (patient.labels.empty() || patient.skin_distance_mm.empty())
    return fail("has no labels or no skin", patient.name, "build the patient again");
  report(progress, "finding targets", 0.0);
  PlanningMap map = detail::make_planning_map(task, patient);
  TROCAR_TRY(const PlanTargets targets, detail::find_targets(map));
  report(progress, "measuring distances", 0.1);
  detail::measure_clearance(map, targets, std::min(task.max_path_mm, needle.length_mm) + needle.throw_mm);
  std::vector<Obstacle> obstacles;
  for (const anatomy::Posture posture : postures_to_try(task, patient)) {
    report(progress, "trying lines", 0.4);
    map.posture = posture;
    std::vector<PathCandidate> lines = trace_lines(map, needle, targets, options);
    std::vector<PlannedPath> paths = find_paths(map, needle, options, lines, progress);
    if (!paths.empty()) return paths;
    obstacles.push_back({posture, obstacle_of(map, needle, lines)});
  }
  return no_path(task, patient, obstacles);
}

}  // namespace trocar::tasks
