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

constexpr double kEnoughCore = 0.5;         // share of the maximum that counts as having reached the target
constexpr double kLesionReach = 2.0;        // a core with lesion counts up to this multiple of the target tolerance
constexpr double kPainTolerance = 1.0;      // pain events that halve the points of the comfort
constexpr double kOrganTolerance_mm = 5.0;  // missing organ on the way that halves the points of the access
constexpr double kPassTolerance = 1.0;      // needless punctures of the organ that halve the points of the passes
constexpr double kAwayTolerance_mm = 10.0;  // missing distance from a landmark that halves the points of the access
constexpr double kSlowReturn = 0.7;         // share of the points for single drops: the bevel is only partly in it

constexpr const char* kBleedingNames[] = {"usual", "raised", "high"};

constexpr std::pair<std::string_view, std::string_view> kTitles[] = {
    {"target", "Distance to the target"},
    {"confirmation", "Proof of the place"},
    {"core", "Target tissue in the cores"},
    {"passes", "Punctures of the organ beyond those needed"},
    {"risk", "Structures at risk touched"},
    {"access", "Missing margin to structures at risk"},
    {"entry", "Insertion point"},
    {"angle", "Needle direction"},
    {"visibility", "Advance with the tip in the image"},
    {"comfort", "Painful moments"},
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

/// A part before its weight is known. Empty share: it cannot be judged.
struct PartShare {
  const char* name;
  double value;
  const char* unit;
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

/// Punctures of the organ that another way would have saved: a coaxial needle passes its surface once for all cores.
double needless_passes(const Judgement& judged) noexcept {
  const std::size_t needed = judged.attempt.needle.is_coaxial ? 1 : judged.attempt.task.cores;
  const std::size_t passes = judged.bleeding->passes;
  return passes > needed ? static_cast<double>(passes - needed) : 0.0;
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

/// All parts that the program knows, in the order of display.
std::vector<PartShare> all_parts(const Judgement& judged, double risk_weight) {
  const tasks::Task& task = judged.attempt.task;
  const metrics::AttemptMetrics& measured = judged.measured;
  const bool is_biopsy = judged.attempt.needle.is_biopsy;
  const bool is_finished = !judged.cores.empty() || !is_biopsy;
  const double length_mm = judged.expert.line_P.length_mm();
  const auto risks = static_cast<double>(measured.risks.size() + judged.stylet_risks.size());
  const double dose_gycm2 = judged.attempt.xray.dose_area_gycm2;
  std::optional<double> core;
  if (is_biopsy) core = cores_share(judged);
  const double safe = risk_weight > 0.0 ? std::max(0.0, 1.0 - judged.risk_penalty / risk_weight) : 1.0;
  const double time = is_finished ? share_below(measured.time_s, task.time_limit_s) : 0.0;
  std::optional<double> dose;  // without X-ray there is nothing to judge
  if (judged.attempt.xray.beam_s > 0.0) dose = is_finished ? share_below(dose_gycm2, task.dose_limit_gycm2) : 0.0;
  std::optional<double> bevel;
  if (judged.bevel && task.bevel) bevel = share_at(judged.bevel->to_fibres_deg, task.bevel->tolerance_deg);
  const auto pain = static_cast<double>(judged.pain.size());
  std::optional<double> passes;
  if (judged.bleeding) passes = needless_passes(judged);
  return {
      {"target", judged.target_mm, "mm", share_at(judged.target_mm, task.target_tolerance_mm)},
      {"confirmation", judged.confirmed_s ? 1.0 : 0.0, "", confirmation_share(judged)},
      {"core", target_in_cores_mm(judged), "mm", core},
      {"risk", risks, "", safe},
      {"access", judged.access.missing_margin_mm, "mm", access_share(judged)},
      {"entry", judged.entry_mm, "mm", share_at(judged.entry_mm, task.entry_tolerance_mm)},
      {"angle", measured.angle_deg, "°", share_at(measured.angle_deg, task.angle_tolerance_deg)},
      {"visibility", 100.0 * judged.attempt.tip_visible_share.value_or(0.0), "%", judged.attempt.tip_visible_share},
      {"comfort", pain, "", share_at(pain, kPainTolerance)},
      {"length", measured.travel_mm, "mm", share_below(std::max(0.0, measured.travel_mm - length_mm), length_mm)},
      {"time", measured.time_s, "s", time},
      {"dose", dose_gycm2, "Gy cm²", dose},
      {"passes", passes.value_or(0.0), "", passes ? std::optional(share_at(*passes, kPassTolerance)) : std::nullopt},
      {"bevel", judged.bevel ? judged.bevel->to_fibres_deg : 0.0, "°", bevel},
  };
}

double weight_of(const tasks::Task& task, const char* part) {
  const auto found = task.weights.find(part);
  return found != task.weights.end() ? found->second : 0.0;
}

std::vector<ScorePart> parts_of(const Judgement& judged) {
  const tasks::Task& task = judged.attempt.task;
  std::vector<PartShare> shares = all_parts(judged, weight_of(task, "risk"));
  std::erase_if(shares, [&](const PartShare& part) { return !part.share || weight_of(task, part.name) <= 0.0; });
  double sum = 0.0;
  for (const PartShare& part : shares) sum += weight_of(task, part.name);
  std::vector<ScorePart> parts;
  for (const PartShare& part : shares) {
    const double most = 100.0 * weight_of(task, part.name) / sum;
    const double share = judged.measured.has_entered ? *part.share : 0.0;
    parts.push_back({part.name, std::string(part_title(part.name)), part.value, part.unit, share * most, most});
  }
  return parts;
}

/// A biopsy reaches its target with a core taken near the planned point, or with a core that contains lesion from
/// slightly further away, since a lesion has a size. Healthy organ is everywhere: a core of it does not prove the
/// position.
bool has_reached_target(const Judgement& judged) noexcept {
  const tasks::Task& task = judged.attempt.task;
  if (!judged.measured.has_entered || (judged.attempt.needle.is_biopsy && judged.cores.empty())) return false;
  if (task.confirmed_by != tasks::Substance::kNothing && !judged.confirmed_s) return false;
  if (judged.target_mm <= task.target_tolerance_mm) return true;
  const bool has_lesion = std::any_of(judged.cores.begin(), judged.cores.end(),
                                      [&](const BiopsyCore& core) { return core_share(judged, core) >= kEnoughCore; });
  return has_lesion && !judged.is_parenchymal && judged.target_mm <= kLesionReach * task.target_tolerance_mm;
}

/// Empty: it can be scored.
std::string why_not_scored(const Judgement& judged) {
  if (!judged.measured.has_touched_skin) return "the needle never touched the skin";
  if (!judged.measured.has_entered) return "the needle did not pierce the skin";
  if (judged.attempt.needle.is_biopsy && judged.attempt.shots.empty()) return "the gun was not fired";
  return {};
}

std::vector<std::string> find_fails(const Judgement& judged, const Outcome& outcome) {
  std::vector<std::string> fails;
  const tasks::Substance wanted = judged.attempt.task.confirmed_by;
  if (wanted != tasks::Substance::kNothing && judged.measured.has_entered && !judged.confirmed_s)
    fails.push_back(fmt::format("the place is not proven: no {} came back", tasks::substance_words(wanted)));
  else if (!outcome.target_reached)
    fails.emplace_back("the target was not reached");
  if (judged.too_high_s) fails.push_back(judged.attempt.task.highest_entry->reason);
  for (const std::string& name : outcome.risks_touched) {
    const anatomy::Label* const label = judged.attempt.patient.label_table.find(name);
    const tasks::RiskStructure* const risk = label != nullptr ? tasks::find_risk(judged.attempt.task, *label) : nullptr;
    if (risk != nullptr && risk->is_critical)
      fails.push_back(fmt::format("the {} was touched", anatomy::structure_words(name)));
  }
  if (outcome.score < judged.attempt.task.pass_mark)
    fails.push_back(fmt::format("the score is below {:.0f}", judged.attempt.task.pass_mark));
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

std::string_view part_title(std::string_view part) noexcept {
  for (const auto& [name, title] : kTitles)
    if (name == part) return title;
  return {};
}

std::string part_value_text(const ScorePart& part) {
  if (part.name == "confirmation") return part.value > 0.0 ? "yes" : "no";
  if (part.unit.empty()) return fmt::format("{:.0f}", part.value);
  return fmt::format("{:.{}f} {}", part.value, part.value < 100.0 ? 1 : 0, part.unit);
}

Outcome score_attempt(const AttemptData& given) {
  AttemptData attempt = given;
  while (!attempt.shots.empty() && attempt.shots.back() >= attempt.samples.size())
    attempt.shots = attempt.shots.first(attempt.shots.size() - 1);
  Outcome outcome;
  const Judgement judged = judge(attempt, outcome.expert);
  outcome.not_scored = why_not_scored(judged);
  outcome.cores = judged.cores;
  outcome.bleeding = judged.bleeding;
  outcome.pain_events = judged.pain.size();
  for (const auto* touches : {&judged.measured.risks, &judged.stylet_risks})
    for (const metrics::RiskTouch& touch : *touches) outcome.risks_touched.push_back(touch.label);
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

}  // namespace trocar::scoring
