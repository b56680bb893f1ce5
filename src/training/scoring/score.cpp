#include "scoring/score.h"

#include <algorithm>
#include <cmath>

#include "metrics/attempt_metrics.h"
#include "scoring/detail/hints.h"
#include "tasks/task_labels.h"

namespace trocar::scoring {
namespace {

// Weights of the parts; their sum is 100.
struct Weights {
  double target, core, risk, entry, angle, length, time, dose;
};
constexpr Weights kBiopsy{25, 25, 20, 10, 10, 5, 5, 0};
constexpr Weights kPuncture{50, 0, 20, 10, 10, 5, 5, 0};
constexpr Weights kPunctureByXray{40, 0, 20, 10, 10, 5, 5, 10};

constexpr double kEnoughCore = 0.5;  // share of the maximum that counts as having reached the target

constexpr double kLesionReach = 2.0;  // a core with lesion counts up to this multiple of the target tolerance

/// Share of a part's points at a deviation: 1 at 0, 1/2 at the tolerance, decreasing without end (docs/physics.md, S1).
double share_at(double deviation, double tolerance) noexcept {
  const double ratio = tolerance > 0.0 ? deviation / tolerance : HUGE_VAL;
  return deviation > 0.0 ? 1.0 / (1.0 + ratio * ratio) : 1.0;
}

/// Share of a part's points for an expense: 1 at 0, 0 from the limit on.
double share_below(double expense, double limit) noexcept {
  const double ratio = limit > 0.0 ? expense / limit : 1.0;
  return std::max(0.0, 1.0 - ratio * ratio);
}

double core_share(const BiopsyCore& core, double possible_mm) noexcept {
  return possible_mm > 0.0 ? std::min(1.0, core.target_mm / possible_mm) : 0.0;
}

/// Structures touched by the stylet but not by the needle.
std::vector<metrics::RiskTouch> find_stylet_risks(const tasks::TaskLabels& labels,
                                                  const anatomy::VirtualPatient& patient,
                                                  const metrics::AttemptMetrics& metrics,
                                                  const std::optional<BiopsyCore>& core) {
  std::vector<metrics::RiskTouch> touches;
  if (!core) return touches;
  for (const std::string& name : core->risks_in_throw) {
    const bool is_known = std::any_of(metrics.risks.begin(), metrics.risks.end(),
                                      [&](const metrics::RiskTouch& touch) { return touch.label == name; });
    if (!is_known) touches.push_back({name, 0.0, labels.risk(patient.label_table.find(name)->id)->penalty});
  }
  return touches;
}

/// Distance of the entry from its target: from the zone's edge, or without a zone from the expert's entry.
double entry_miss_mm(const tasks::Task& task, const tasks::PlannedPath& plan,
                     const metrics::AttemptMetrics& metrics) noexcept {
  if (task.entry_zone) return task.entry_zone->distance_outside_mm(plan.line_P.a + metrics.entry_offset_P);
  return metrics.entry_offset_P.norm();
}

const Weights& weights_of(const tasks::Task& task, const tasks::Needle& needle) noexcept {
  if (needle.is_biopsy) return kBiopsy;
  return task.dose_limit_gycm2 > 0.0 ? kPunctureByXray : kPuncture;
}

struct Worth {
  double target = 0.0, core = 0.0, entry = 0.0, angle = 0.0, length = 0.0, time = 0.0, dose = 0.0;  // shares 0..1
  double risk_penalty = 0.0;
};

Worth worth_of(const tasks::Task& task, const tasks::Needle& needle, const tasks::PlannedPath& plan,
               const metrics::AttemptMetrics& metrics, const std::optional<BiopsyCore>& core, double possible_mm,
               const tasks::XrayUse& xray) noexcept {
  const double length_mm = plan.line_P.length_mm();
  const bool is_finished = core || !needle.is_biopsy;
  Worth worth;
  worth.target = share_at(metrics.target_offset_P.norm(), task.target_tolerance_mm);
  worth.core = core ? core_share(*core, possible_mm) : 0.0;
  worth.entry = share_at(entry_miss_mm(task, plan, metrics), task.entry_tolerance_mm);
  worth.angle = share_at(metrics.angle_deg, task.angle_tolerance_deg);
  worth.length = share_below(std::max(0.0, metrics.travel_mm - length_mm), length_mm);
  worth.time = is_finished ? share_below(metrics.time_s, task.time_limit_s) : 0.0;
  worth.dose = is_finished ? share_below(xray.dose_area_gycm2, task.dose_limit_gycm2) : 0.0;
  return worth;
}

struct PartFigures {
  double entry_mm = 0.0, dose_gycm2 = 0.0;
  std::size_t risks = 0;
};

std::vector<ScorePart> parts_of(const Worth& worth, const Weights& weights, const metrics::AttemptMetrics& metrics,
                                const PartFigures& figures, const std::optional<BiopsyCore>& core) {
  const double safe = metrics.has_entered ? std::max(0.0, weights.risk - worth.risk_penalty) : 0.0;
  const double scale = metrics.has_entered ? 1.0 : 0.0;
  const auto part = [&](const char* name, const char* title, double value, const char* unit, double share, double max) {
    return ScorePart{name, title, value, unit, scale * share * max, max};
  };
  std::vector<ScorePart> parts{
      part("target", "Distance to the target", metrics.target_offset_P.norm(), "mm", worth.target, weights.target),
      part("entry", "Insertion point", figures.entry_mm, "mm", worth.entry, weights.entry),
      part("angle", "Needle direction", metrics.angle_deg, "°", worth.angle, weights.angle),
      ScorePart{"risk", "Structures at risk touched", static_cast<double>(figures.risks), "", safe, weights.risk},
      part("length", "Needle travel inside the body", metrics.travel_mm, "mm", worth.length, weights.length),
      part("time", "Time from the skin to the target", metrics.time_s, "s", worth.time, weights.time)};
  if (weights.dose > 0.0)
    parts.push_back(
        part("dose", "Radiation dose (dose-area product)", figures.dose_gycm2, "Gy cm²", worth.dose, weights.dose));
  if (weights.core > 0.0)
    parts.push_back(
        part("core", "Target tissue in the core", core ? core->target_mm : 0.0, "mm", worth.core, weights.core));
  if (const double beyond = worth.risk_penalty - weights.risk; metrics.has_entered && beyond > 0.0)
    parts.push_back({"deduction", "Deduction for structures at risk", worth.risk_penalty, "points", -beyond, 0.0});
  return parts;
}

/// A biopsy reaches its target with a core taken near the planned point, or with a core that contains lesion from
/// slightly further away, since a lesion has a size. Healthy organ is everywhere: a core of it does not prove the
/// position.
bool has_reached_target(const tasks::Task& task, const tasks::Needle& needle, const metrics::AttemptMetrics& metrics,
                        const std::optional<BiopsyCore>& core, double core_share, bool is_parenchymal) noexcept {
  if (!metrics.has_entered || (needle.is_biopsy && !core)) return false;
  const double off_mm = metrics.target_offset_P.norm();
  if (off_mm <= task.target_tolerance_mm) return true;
  return core && !is_parenchymal && core_share >= kEnoughCore && off_mm <= kLesionReach * task.target_tolerance_mm;
}

/// Empty: it can be scored.
std::string why_not_scored(const tasks::Needle& needle, const metrics::AttemptMetrics& metrics, bool has_fired) {
  if (!metrics.has_touched_skin) return "the needle never touched the skin";
  if (!metrics.has_entered) return "the needle did not pierce the skin";
  if (needle.is_biopsy && !has_fired) return "the gun was not fired";
  return {};
}

}  // namespace

Outcome score_attempt(const tasks::Task& task, const anatomy::VirtualPatient& patient,
                      const anatomy::TissueTable& tissues, const tasks::Needle& needle, const tasks::PlannedPath& plan,
                      std::span<const telemetry::TickSample> samples, std::optional<std::size_t> fired,
                      std::span<const tasks::Interruption> interruptions, const tasks::XrayUse& xray) {
  if (fired && *fired >= samples.size()) fired.reset();
  const metrics::AttemptMetrics metrics =
      metrics::measure_attempt(task, patient, tissues, plan, samples, fired, interruptions);

  Outcome outcome;
  outcome.not_scored = why_not_scored(needle, metrics, fired.has_value());
  double possible_mm = 0.0;
  if (needle.is_biopsy) {
    possible_mm = take_core(task, patient, needle, plan.line_P.b, plan.line_P.direction()).target_mm;
    if (possible_mm <= 0.0) possible_mm = needle.notch_mm;  // a plan without a core is no reference
    if (fired && metrics.has_entered) outcome.core = take_core(task, patient, needle, metrics.tip_P, metrics.axis_P);
  }

  Worth worth = worth_of(task, needle, plan, metrics, outcome.core, possible_mm, xray);
  const tasks::TaskLabels labels(task, patient);
  const std::vector<metrics::RiskTouch> stylet_risks = find_stylet_risks(labels, patient, metrics, outcome.core);
  for (const auto* touches : {&metrics.risks, &stylet_risks})
    for (const metrics::RiskTouch& touch : *touches) {
      outcome.risks_touched.push_back(touch.label);
      worth.risk_penalty += touch.penalty;
    }
  const PartFigures figures{metrics.has_entered ? entry_miss_mm(task, plan, metrics) : 0.0, xray.dose_area_gycm2,
                            outcome.risks_touched.size()};
  outcome.parts = parts_of(worth, weights_of(task, needle), metrics, figures, outcome.core);
  if (outcome.is_scored())
    for (const ScorePart& part : outcome.parts) outcome.score += part.points;
  outcome.score = std::clamp(outcome.score, 0.0, 100.0);

  outcome.target_reached = has_reached_target(task, needle, metrics, outcome.core, worth.core, labels.is_parenchymal());
  outcome.hints = make_hints(
      {task, needle, plan, metrics, outcome.core, stylet_risks, possible_mm, labels.is_parenchymal(), outcome.parts});
  if (!outcome.is_scored()) outcome.parts.clear();  // hints may still mention them
  return outcome;
}

}  // namespace trocar::scoring
