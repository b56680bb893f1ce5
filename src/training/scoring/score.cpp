#include "scoring/score.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "anatomy/structure_words.h"
#include "scoring/detail/hints.h"
#include "scoring/detail/judgement.h"

namespace trocar::scoring {
namespace {

constexpr double kEnoughCore = 0.5;         // of what one core could hold: the target was reached
constexpr double kMinorHarm = 0.4;          // share of the points for structures at risk that a minor harm costs
constexpr double kPainTolerance = 1.0;      // pain events that halve the points of the comfort
constexpr double kOrganTolerance_mm = 5.0;  // missing organ on the way that halves the points of the access
constexpr double kPassTolerance = 1.0;      // needless punctures of the organ that halve the points of the passes
constexpr double kAwayTolerance_mm = 10.0;  // missing distance from a landmark that halves the points of the access
constexpr double kSlowReturn = 0.7;         // share of the points for single drops: the bevel is only partly in it

constexpr double kJustBefore_mm = 1.0;  // a needle that stops so near, on the target's wall, did not miss it

constexpr const char* kBleedingNames[] = {"usual", "raised", "high"};

constexpr std::pair<std::string_view, std::string_view> kTitles[] = {
    {"target", "Distance to the target"},
    {"confirmation", "Confirmation of position"},
    {"core", "Target tissue in the cores"},
    {"passes", "Extra organ punctures and shots"},
    {"risk", "Structures harmed"},
    {"access", "Missing safety margin to structures at risk"},
    {"entry", "Insertion point"},
    {"angle", "Needle direction"},
    {"visibility", "Tip visible while advancing"},
    {"comfort", "Pain events"},
    {"length", "Needle travel inside the body"},
    {"time", "Time from the skin to the target"},
    {"dose", "Radiation dose (dose-area product)"},
    {"bevel", "Bevel against the fibres"},
};

/// Share of a part's points at a deviation: 1 at 0, 1/2 at the tolerance, decreasing without end (docs/physics.md, E1).
double share_at(double deviation, double tolerance) noexcept {
  const double ratio = tolerance > 0.0 ? deviation / tolerance : HUGE_VAL;
  return deviation > 0.0 ? 1.0 / (1.0 + ratio * ratio) : 1.0;
}

/// Share of a part's points for an expense: 1 at 0, 0 from the limit on.
double share_below(double expense, double limit) noexcept {
  const double ratio = limit > 0.0 ? expense / limit : 1.0;
  return std::max(0.0, 1.0 - ratio * ratio);
}

/// A part with its value. Empty share: the attempt did not come so far.
struct PartShare {
  double value = 0.0;
  const char* unit = "";
  std::optional<double> share;
};

/// Share of a core's target tissue in what was possible, 0..1.
double core_share(const Judgement& judged, const BiopsyCore& core) noexcept {
  return judged.possible_core_mm > 0.0 ? std::min(1.0, core.target_mm / judged.possible_core_mm) : 0.0;
}

/// Of the task's number of cores, the best ones.
double cores_share(const Judgement& judged) {
  std::vector<double> shares;
  for (const BiopsyCore& core : judged.cores) shares.push_back(core_share(judged, core));
  std::sort(shares.begin(), shares.end(), std::greater<>());
  shares.resize(judged.attempt.task.cores);
  return std::accumulate(shares.begin(), shares.end(), 0.0) / static_cast<double>(shares.size());
}

double target_in_cores_mm(const Judgement& judged) noexcept {
  double sum_mm = 0.0;
  for (const BiopsyCore& core : judged.cores) sum_mm += core.target_mm;
  return sum_mm;
}

/// Punctures of the organ and shots that another way would have saved: a coaxial needle passes its surface once for all
/// cores, and a shot that takes no core of the task is one too many.
double needless_passes(const Judgement& judged) noexcept {
  const std::size_t cores = judged.attempt.needle.is_biopsy ? judged.attempt.task.cores : 1;
  const std::size_t needed = judged.attempt.needle.is_coaxial ? 1 : cores;
  const std::size_t passes = judged.bleeding ? judged.bleeding->passes : 0, shots = judged.attempt.shots.size();
  const std::size_t surplus = (passes > needed ? passes - needed : 0) + (shots > cores ? shots - cores : 0);
  return static_cast<double>(surplus);
}

/// Points for structures at risk: none with a critical or major harm.
double unharmed_share(const Judgement& judged) noexcept {
  double share = 1.0;
  for (const metrics::HarmEvent& event : judged.harms) share -= event.grade >= tasks::Harm::kMajor ? 1.0 : kMinorHarm;
  return std::max(0.0, share);
}

double access_share(const Judgement& judged) noexcept {
  const tasks::Task& task = judged.attempt.task;
  const AccessJudgement& access = judged.access;
  return share_at(access.missing_margin_mm, task.margin_tolerance_mm) *
         share_at(access.excess_angle_deg, task.angle_tolerance_deg) *
         share_at(access.outside_zone_mm, task.entry_tolerance_mm) *
         share_at(access.missing_organ_mm, kOrganTolerance_mm) * share_at(access.missing_away_mm, kAwayTolerance_mm);
}

double confirmation_share(const Judgement& judged) noexcept {
  if (!judged.confirmed_s) return 0.0;
  for (const tasks::Action& action : judged.attempt.actions)
    if (action.result.substance == judged.attempt.task.confirmed_by && !action.result.is_slow()) return 1.0;
  return kSlowReturn;
}

/// Healthy organ is everywhere: a core of it does not prove the place.
bool has_reached_target(const Judgement& judged) noexcept {
  const tasks::Task& task = judged.attempt.task;
  if (!judged.measured.has_entered) return false;
  if (task.confirmed_by != tasks::Substance::kNothing) return judged.confirmed_s.has_value();
  const bool is_near = judged.target_mm <= task.target_tolerance_mm;
  if (!judged.attempt.needle.is_biopsy) return judged.is_planned_place ? is_near : judged.target_mm <= 0.0;
  const bool is_enough = !judged.cores.empty() && target_in_cores_mm(judged) >= kEnoughCore * judged.possible_core_mm;
  return is_enough && (!judged.is_planned_place || is_near);
}

PartShare share_of(const Judgement& judged, std::string_view part) {
  const tasks::Task& task = judged.attempt.task;
  const metrics::AttemptMetrics& measured = judged.measured;
  if (part == "target") return {judged.target_mm, "mm", share_at(judged.target_mm, task.target_tolerance_mm)};
  if (part == "confirmation") return {judged.confirmed_s ? 1.0 : 0.0, "", confirmation_share(judged)};
  if (part == "core") return {target_in_cores_mm(judged), "mm", cores_share(judged)};
  if (part == "risk") return {static_cast<double>(judged.harms.size()), "", unharmed_share(judged)};
  if (part == "access") return {judged.access.missing_margin_mm, "mm", access_share(judged)};
  if (part == "entry") return {judged.entry_mm, "mm", share_at(judged.entry_mm, task.entry_tolerance_mm)};
  if (part == "angle") return {measured.angle_deg, "°", share_at(measured.angle_deg, task.angle_tolerance_deg)};
  if (part == "visibility") {
    const std::optional<double>& seen = judged.attempt.tip_visible_share;
    return {100.0 * seen.value_or(0.0), "%", seen};
  }
  if (part == "comfort") {
    const auto pain = static_cast<double>(judged.pain.size());
    return {pain, "", share_at(pain, kPainTolerance)};
  }
  if (part == "length") {
    const double length_mm = judged.expert.line_P.length_mm();
    return {measured.travel_mm, "mm", share_below(std::max(0.0, measured.travel_mm - length_mm), length_mm)};
  }
  if (part == "time" && is_finished(judged))
    return {measured.time_s, "s", share_below(measured.time_s, task.time_limit_s)};
  if (part == "dose" && is_finished(judged)) {
    const double dose_gycm2 = judged.attempt.xray.dose_area_gycm2;
    return {dose_gycm2, "Gy cm²", share_below(dose_gycm2, task.dose_limit_gycm2)};
  }
  if (part == "passes") {
    const double passes = needless_passes(judged);
    return {passes, "", share_at(passes, kPassTolerance)};
  }
  if (part == "bevel" && judged.bevel && task.bevel)
    return {judged.bevel->to_fibres_deg, "°", share_at(judged.bevel->to_fibres_deg, task.bevel->tolerance_deg)};
  return {};
}

double weight_of(const tasks::Task& task, std::string_view part) {
  const auto found = task.weights.find(part);
  return found != task.weights.end() ? found->second : 0.0;
}

std::vector<ScorePart> parts_of(const Judgement& judged) {
  const AttemptData& attempt = judged.attempt;
  std::vector<ScorePart> parts;
  for (const auto& [name, most] : judged_parts(attempt.task, attempt.needle, attempt.has_transducer)) {
    const PartShare found = share_of(judged, name);
    const double share = judged.measured.has_entered ? found.share.value_or(0.0) : 0.0;
    const bool is_place = name == "target" && judged.is_planned_place;
    parts.push_back({name, is_place ? "Distance to the planned place" : std::string(part_title(name)), found.value,
                     found.unit, share * most, most, found.share.has_value()});
  }
  return parts;
}

/// Empty: it can be scored.
std::string why_not_scored(const Judgement& judged) {
  if (!judged.measured.has_touched_skin) return "the needle never touched the skin";
  if (!judged.measured.has_entered) return "the needle did not pierce the skin";
  if (!judged.attempt.needle.is_biopsy || !judged.cores.empty()) return {};
  return judged.attempt.shots.empty() ? "the gun was not fired" : "the gun was fired only outside the body";
}

std::string why_not_reached(const Judgement& judged) {
  if (judged.cores.empty() || judged.is_planned_place) return "the target was not reached";
  return fmt::format("the target was not reached: the cores hold {:.0f} mm of it, one can hold {:.0f} mm",
                     target_in_cores_mm(judged), judged.possible_core_mm);
}

/// Harm that decides before any sum.
void add_harms(const Judgement& judged, std::vector<std::string>& fails) {
  for (const metrics::HarmEvent& event : judged.harms)
    if (event.grade >= tasks::Harm::kMajor) fails.push_back(metrics::harm_words(event));
}

std::vector<std::string> find_fails(const Judgement& judged, const Outcome& outcome) {
  std::vector<std::string> fails;
  add_harms(judged, fails);
  if (judged.too_high_s) fails.push_back(judged.attempt.task.highest_entry->reason);
  const tasks::Substance wanted = judged.attempt.task.confirmed_by;
  if (wanted != tasks::Substance::kNothing && judged.measured.has_entered && !judged.confirmed_s)
    fails.push_back(fmt::format("position not confirmed: no {} came back", tasks::substance_words(wanted)));
  else if (!outcome.target_reached)
    fails.push_back(why_not_reached(judged));
  if (outcome.is_scored() && outcome.score < judged.attempt.task.pass_mark)
    fails.push_back(fmt::format("the score is below the pass mark of {:.0f}", judged.attempt.task.pass_mark));
  return fails;
}

}  // namespace

const char* to_string(BleedingRisk risk) noexcept {
  return kBleedingNames[static_cast<std::size_t>(risk)];
}

std::optional<BleedingRisk> find_bleeding_risk(std::string_view name) noexcept {
  const auto found = std::find(std::begin(kBleedingNames), std::end(kBleedingNames), name);
  if (found == std::end(kBleedingNames)) return std::nullopt;
  return static_cast<BleedingRisk>(found - std::begin(kBleedingNames));
}

const BiopsyCore* Outcome::best_core() const noexcept {
  const auto best = std::max_element(
      cores.begin(), cores.end(), [](const BiopsyCore& a, const BiopsyCore& b) { return a.target_mm < b.target_mm; });
  return best != cores.end() ? &*best : nullptr;
}

const char* target_words(const Outcome& outcome) noexcept {
  if (outcome.target_reached) return "reached";
  const auto value_of = [&](std::string_view name) {
    const auto part = std::ranges::find(outcome.parts, name, &ScorePart::name);
    return part != outcome.parts.end() && part->is_judged ? std::optional(part->value) : std::nullopt;
  };
  const double apart_mm = value_of("target").value_or(HUGE_VAL);
  if (value_of("confirmation").value_or(1.0) <= 0.0 && apart_mm <= 0.0) return "not confirmed";
  return apart_mm < kJustBefore_mm ? "not reached" : "missed";
}

std::string_view part_title(std::string_view part) noexcept {
  for (const auto& [name, title] : kTitles)
    if (name == part) return title;
  return {};
}

std::vector<std::pair<std::string, double>> judged_parts(const tasks::Task& task, const tasks::Needle& needle,
                                                         bool has_transducer) {
  std::vector<std::pair<std::string, double>> parts;
  double sum = 0.0;
  for (const auto& [name, title] : kTitles) {
    const double weight = weight_of(task, name);
    const bool is_left_out = (name == "core" && !needle.is_biopsy) || (name == "visibility" && !has_transducer);
    if (weight <= 0.0 || is_left_out) continue;
    parts.emplace_back(name, weight);
    sum += weight;
  }
  for (auto& part : parts) part.second *= 100.0 / sum;
  return parts;
}

std::string part_value_text(const ScorePart& part) {
  if (!part.is_judged) return "not judged";
  if (part.name == "confirmation") return part.value > 0.0 ? "yes" : "no";
  if (part.unit.empty()) return fmt::format("{:.0f}", part.value);
  return fmt::format("{:.{}f} {}", part.value, part.value < 100.0 ? 1 : 0, part.unit);
}

bool is_finished(const Judgement& judged) noexcept {
  return judged.attempt.needle.is_biopsy ? !judged.cores.empty() : has_reached_target(judged);
}

Outcome conclude(const Judgement& judged) {
  Outcome outcome;
  outcome.not_scored = why_not_scored(judged);
  outcome.cores = judged.cores;
  outcome.bleeding = judged.bleeding;
  outcome.pain_events = judged.pain.size();
  outcome.harms = judged.harms;
  for (const metrics::HarmEvent& event : judged.harms) outcome.risks_touched.push_back(event.label);
  outcome.parts = parts_of(judged);
  if (outcome.is_scored())
    for (const ScorePart& part : outcome.parts) outcome.score += part.points;
  outcome.score = std::clamp(outcome.score, 0.0, 100.0);
  outcome.target_reached = has_reached_target(judged);
  outcome.fails = find_fails(judged, outcome);
  outcome.is_passed = outcome.is_scored() && outcome.fails.empty();
  outcome.hints = make_hints(judged, outcome.parts);
  if (!outcome.is_scored()) outcome.parts.clear();  // hints may still mention them
  return outcome;
}

Outcome score_attempt(const AttemptData& given) {
  AttemptData attempt = given;
  while (!attempt.shots.empty() && attempt.shots.back() >= attempt.samples.size())
    attempt.shots = attempt.shots.first(attempt.shots.size() - 1);
  std::size_t expert = 0;
  const Judgement judged = judge(attempt, expert);
  Outcome outcome = conclude(judged);
  outcome.expert = expert;
  return outcome;
}

}  // namespace trocar::scoring
