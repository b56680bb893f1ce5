#include "scoring/detail/needle_rules.h"

#include <algorithm>
#include <cmath>

#include "tasks/fit_to_patient.h"
#include "telemetry/tick_pose.h"

namespace trocar::scoring {
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
