#include "scoring/detail/judgement.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "scoring/attempt_end.h"
#include "scoring/core_sample.h"
#include "tasks/assess_path.h"
#include "tasks/fit_to_patient.h"
#include "telemetry/tick_sample.h"
#include "volume/sampling.h"

namespace trocar::scoring {
namespace {

constexpr double kShortestPath_mm = 3.0;   // that has a direction and margins
constexpr double kTargetSearch_mm = 40.0;  // farther away the plan's end is what counts

/// Place that has to be at the target: the middle of the notch after the shot, or the tip.
Vec3 reach_P(const tasks::Needle& needle, const Vec3& tip_P, const Vec3& axis_P) {
  return tip_P + needle.notch_middle_mm() * axis_P;
}

/// The expert path whose entry and end are nearest to those of the attempt.
std::size_t nearest_expert(const AttemptData& attempt, const metrics::AttemptMetrics& first) {
  const Vec3 entry_P = attempt.experts.front().line_P.a + first.entry_offset_P;
  const auto distance_mm = [&](const tasks::PlannedPath& path) {
    return (path.line_P.a - entry_P).norm() + (path.line_P.b - first.tip_P).norm();
  };
  const auto nearest = std::min_element(attempt.experts.begin(), attempt.experts.end(),
                                        [&](const auto& a, const auto& b) { return distance_mm(a) < distance_mm(b); });
  return static_cast<std::size_t>(nearest - attempt.experts.begin());
}

/// From a point to the nearest voxel of the target, 0 in it; empty: there is none within kTargetSearch_mm.
std::optional<Vec3> way_to_target(const AttemptData& attempt, const tasks::TaskLabels& labels, const Vec3& p_P) {
  const volume::LabelGrid& grid = attempt.patient.labels;
  const auto is_target = [&](std::uint8_t id) { return labels.part(id) == tasks::TaskLabels::Part::kTarget; };
  if (is_target(volume::sample_nearest<std::uint8_t>(grid, p_P, 0))) return Vec3(Vec3::Zero());
  const Vec3 index = grid.geometry.to_index(p_P);
  volume::Index3 low{}, high{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const double reach = kTargetSearch_mm / grid.geometry.spacing_mm[axis];
    const auto last = static_cast<double>(grid.geometry.size[a] - 1);
    low[a] = static_cast<std::int64_t>(std::clamp(std::ceil(index[axis] - reach), 0.0, last));
    high[a] = static_cast<std::int64_t>(std::clamp(std::floor(index[axis] + reach), 0.0, last));
  }
  Vec3 nearest_V = Vec3::Constant(kTargetSearch_mm);
  for (std::int64_t k = low[2]; k <= high[2]; ++k)
    for (std::int64_t j = low[1]; j <= high[1]; ++j)
      for (std::int64_t i = low[0]; i <= high[0]; ++i) {
        if (!is_target(grid[{i, j, k}])) continue;
        const Vec3 apart = Vec3(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)) - index;
        // To the voxel's box.
        const Vec3 way_V = (apart - apart.cwiseMax(-0.5).cwiseMin(0.5)).cwiseProduct(grid.geometry.spacing_mm);
        if (way_V.squaredNorm() < nearest_V.squaredNorm()) nearest_V = way_V;
      }
  if (nearest_V.norm() > kTargetSearch_mm) return std::nullopt;
  return Vec3(grid.geometry.R_PV * nearest_V);
}

/// Of the place that has to be there, from that of the nearest expert path.
double from_plan_mm(const AttemptData& attempt, const Vec3& tip_P, const Vec3& axis_P) {
  double nearest_mm = HUGE_VAL;
  for (const tasks::PlannedPath& path : attempt.experts)
    nearest_mm = std::min(nearest_mm, (reach_P(attempt.needle, tip_P, axis_P) -
                                       reach_P(attempt.needle, path.line_P.b, path.line_P.direction()))
                                          .norm());
  return nearest_mm;
}

/// Nerve roots float in the fluid of the sac.
bool floats_in_target(const AttemptData& attempt, const Vec3& p_P) {
  const anatomy::Label* const label = anatomy::find_label(attempt.patient, p_P);
  return label != nullptr && label->tissue == "nerve" &&
         tasks::find_harm(attempt.task, *label).grade == tasks::Harm::kNone;
}

double find_target_mm(Judgement& judged, const tasks::TaskLabels& labels) {
  const AttemptData& attempt = judged.attempt;
  const metrics::AttemptMetrics& metrics = judged.measured;
  if (!attempt.needle.is_biopsy && judged.confirmed_s && floats_in_target(attempt, metrics.pierced_tip_P)) return 0.0;
  double nearest_mm = HUGE_VAL;
  const auto reach = [&](const Vec3& tip_P, const Vec3& axis_P) {
    double found_mm = from_plan_mm(attempt, tip_P, axis_P);
    if (!judged.is_planned_place) {
      judged.to_target_P = way_to_target(attempt, labels, reach_P(attempt.needle, tip_P, axis_P));
      found_mm = judged.to_target_P ? judged.to_target_P->norm() : std::max(kTargetSearch_mm, found_mm);
    }
    nearest_mm = std::min(nearest_mm, found_mm);
  };
  for (const BiopsyCore& core : judged.cores) reach(core.tip_P, core.axis_P);
  if (judged.cores.empty()) reach(metrics.pierced_tip_P, metrics.axis_P);
  return nearest_mm;
}

double find_entry_mm(const AttemptData& attempt, const tasks::PlannedPath& expert,
                     const metrics::AttemptMetrics& metrics) {
  const Vec3 entry_P = expert.line_P.a + metrics.entry_offset_P;
  return attempt.task.entry_zone ? attempt.task.entry_zone->distance_outside_mm(entry_P)
                                 : metrics.entry_offset_P.norm();
}

AccessJudgement judge_access(const Judgement& judged) {
  const AttemptData& attempt = judged.attempt;
  const Vec3 entry_P = judged.expert.line_P.a + judged.measured.entry_offset_P;
  AccessJudgement access;
  const Segment way_P{entry_P, judged.measured.tip_P};
  if (!judged.measured.has_entered || way_P.length_mm() < kShortestPath_mm) return access;
  const tasks::PathAssessment found = tasks::assess_path(attempt.task, attempt.patient, attempt.needle, way_P);
  for (const tasks::PathFinding& finding : found.findings) {
    const anatomy::Label* const label = attempt.patient.label_table.find(finding.label);
    const tasks::RiskStructure* const risk = label != nullptr ? tasks::find_risk(attempt.task, *label) : nullptr;
    if (risk == nullptr) continue;
    const double missing_mm = risk->margin_mm - finding.clearance_mm;
    if (missing_mm <= access.missing_margin_mm) continue;
    access.missing_margin_mm = missing_mm;
    access.margin_label = finding.label;
    access.margin_mm = risk->margin_mm;
  }
  access.excess_angle_deg = std::max(0.0, found.entry_angle_deg - attempt.task.max_entry_angle_deg);
  if (const auto& zone = attempt.task.entry_zone) {
    access.outside_zone_mm = zone->distance_outside_mm(entry_P);
    if (access.outside_zone_mm > 0.0)
      access.to_zone_P = access.outside_zone_mm * (zone->centre_P - entry_P).normalized();
  }
  access.missing_away_mm = missing_away_mm(attempt, judged.measured.tip_P);
  access.missing_organ_mm = std::max(0.0, attempt.task.min_organ_path_mm - found.path.organ_path_mm);
  return access;
}

/// Everything that hurt; nothing if the skin was never pierced.
std::vector<PainEvent> find_pain(const AttemptData& attempt, bool has_entered) {
  std::vector<PainEvent> events;
  if (!has_entered) return events;
  PainWatch watch(attempt.task, attempt.patient);
  std::size_t next_action = 0;
  for (const telemetry::TickSample& sample : attempt.samples) {
    while (next_action < attempt.actions.size() && attempt.actions[next_action].time_s <= sample.time_s)
      watch.note(attempt.actions[next_action++]);
    if (auto event = watch.step(sample)) events.push_back(*std::move(event));
  }
  return events;
}

/// Cores of the shots inside the body.
std::vector<BiopsyCore> take_cores(const AttemptData& attempt) {
  std::vector<BiopsyCore> cores;
  for (const std::size_t shot : attempt.shots) {
    const telemetry::TickSample& sample = attempt.samples[shot];
    if (!telemetry::is_in_body(sample) || !sample.rest_tip_mm.allFinite() || !sample.rest_axis.allFinite()) continue;
    cores.push_back(take_core(attempt.task, attempt.patient, attempt.needle, sample.rest_tip_mm, sample.rest_axis));
    cores.back().time_s = sample.time_s;
  }
  return cores;
}

}  // namespace

Judgement judge(const AttemptData& attempt, std::size_t& expert) {
  const EndData end_data{attempt.samples, attempt.shots, attempt.actions, attempt.needle.is_biopsy,
                         attempt.task.confirmed_by};
  const std::optional<double> confirmed_s = confirmation_s(end_data);
  const std::optional<std::size_t> end = end_of_attempt(end_data);
  const metrics::AttemptTrack track =
      metrics::follow_attempt(attempt.patient, attempt.tissues, attempt.samples,
                              end ? std::optional(attempt.samples[*end].time_s) : std::nullopt);
  const auto measure = [&](const tasks::PlannedPath& path) {
    return metrics::measure_against(path, track, attempt.interruptions);
  };
  metrics::AttemptMetrics metrics = measure(attempt.experts.front());
  expert = metrics.has_entered ? nearest_expert(attempt, metrics) : 0;
  if (expert > 0) metrics = measure(attempt.experts[expert]);
  Judgement judged{attempt, attempt.experts[expert], std::move(metrics)};
  const tasks::TaskLabels labels(attempt.task, attempt.patient);
  judged.confirmed_s = confirmed_s;
  judged.is_parenchymal = labels.is_parenchymal();
  judged.is_planned_place = judged.is_parenchymal || attempt.task.target_P.has_value();
  if (attempt.needle.is_biopsy) {
    const Segment& plan_P = judged.expert.line_P;
    judged.possible_core_mm =
        take_core(attempt.task, attempt.patient, attempt.needle, plan_P.b, plan_P.direction()).target_mm;
    // A plan without a core is no reference.
    if (judged.possible_core_mm <= 0.0) judged.possible_core_mm = attempt.needle.notch_mm;
    if (judged.measured.has_entered) judged.cores = take_cores(attempt);
  }
  if (judged.measured.has_entered) {
    judged.target_mm = find_target_mm(judged, labels);
    judged.entry_mm = find_entry_mm(attempt, judged.expert, judged.measured);
    judged.access = judge_access(judged);
  }
  judged.harms = metrics::find_harms(attempt.task, attempt.patient, attempt.needle, attempt.samples, attempt.shots,
                                     attempt.interruptions, attempt.actions);
  judged.pain = find_pain(attempt, judged.measured.has_entered);
  if (judged.measured.has_entered) judged.bleeding = judge_bleeding(judged);
  judged.too_high_s = entered_too_high_s(attempt);
  judged.bevel = judge_bevel(attempt);
  return judged;
}

namespace {

/// Height of the centroid of a structure; empty: the patient lacks it.
std::optional<double> middle_z_mm(const anatomy::VirtualPatient& patient, const std::string& name) {
  const anatomy::Label* const label = patient.label_table.find(std::string_view(name));
  if (label == nullptr) return std::nullopt;
  const volume::LabelGrid& labels = patient.labels;
  Vec3 sum_V = Vec3::Zero();
  double count = 0.0;
  std::size_t n = 0;
  const volume::Index3 size = labels.geometry.size;
  for (std::int64_t k = 0; k < size[2]; ++k)
    for (std::int64_t j = 0; j < size[1]; ++j)
      for (std::int64_t i = 0; i < size[0]; ++i, ++n)
        if (labels.voxels[n] == label->id) {
          sum_V += Vec3(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k));
          count += 1.0;
        }
  if (count < 1.0) return std::nullopt;
  return labels.geometry.to_mm(sum_V / count).z();
}

}  // namespace

std::optional<double> entered_too_high_s(const AttemptData& attempt) {
  if (!attempt.task.highest_entry) return std::nullopt;
  const auto highest_mm = middle_z_mm(attempt.patient, attempt.task.highest_entry->above);
  if (!highest_mm) return std::nullopt;
  bool was_in_target = false;
  for (const telemetry::TickSample& sample : attempt.samples) {
    if (!sample.rest_tip_mm.allFinite() || !std::isfinite(sample.depth_mm) || !std::isfinite(sample.time_s)) continue;
    const anatomy::Label* const label =
        sample.depth_mm > 0.0 ? anatomy::find_label(attempt.patient, sample.rest_tip_mm) : nullptr;
    const bool is_in_target = label != nullptr && tasks::is_target(attempt.task, *label);
    if (is_in_target && !was_in_target && sample.rest_tip_mm.z() > *highest_mm) return sample.time_s;
    was_in_target = is_in_target;
  }
  return std::nullopt;
}

std::optional<metrics::WorstBevel::Puncture> judge_bevel(const AttemptData& attempt) {
  if (!attempt.task.bevel) return std::nullopt;
  metrics::WorstBevel bevel(attempt.task, attempt.patient, attempt.tissues.find_layer(attempt.task.bevel->layer));
  for (const telemetry::TickSample& sample : attempt.samples)
    if (sample.rest_tip_mm.allFinite() && sample.rest_axis.allFinite())
      bevel.step(sample.time_s, sample.rest_tip_mm, telemetry::felt_needle(sample).R(), sample.events);
  return bevel.worst();
}

double missing_away_mm(const AttemptData& attempt, const Vec3& tip_P) {
  const anatomy::Landmark* const landmark = tasks::find_landmark(attempt.patient, attempt.task.target_away_from);
  return landmark != nullptr ? std::max(0.0, attempt.task.target_away_mm - (tip_P - landmark->p_P).norm()) : 0.0;
}

}  // namespace trocar::scoring
