#include "metrics/attempt_metrics.h"

#include <algorithm>
#include <cmath>

#include "geometry/pose.h"
#include "metrics/detail/body.h"
#include "metrics/detail/uniform_sampler.h"
#include "tasks/fit_to_patient.h"
#include "telemetry/tick_sample.h"
#include "volume/sampling.h"

namespace trocar::metrics {
namespace {

constexpr double kSkinSearch_mm = 40.0;  // from the tip that pierced the skin back to the resting skin

bool is_valid(const telemetry::TickSample& sample) noexcept {
  return sample.tip_mm.allFinite() && sample.axis.allFinite() && std::isfinite(sample.depth_mm) &&
         std::isfinite(sample.time_s);
}

bool has_punctured(const telemetry::TickSample& sample, std::optional<std::uint8_t> layer) noexcept {
  return std::any_of(sample.events.begin(), sample.events.end(), [&](const telemetry::TickEvent& event) {
    return event.kind == telemetry::EventKind::kPuncture && event.id == layer;
  });
}

/// Intersection of the line through a tip with the resting skin: the skin is indented at its puncture.
Vec3 skin_crossing(const anatomy::VirtualPatient& patient, const Vec3& tip_P, const Vec3& axis_P) noexcept {
  if (patient.skin_distance_mm.empty()) return tip_P;
  const auto outside_mm = [&](double back_mm) {
    return volume::sample_linear(patient.skin_distance_mm, tip_P - back_mm * axis_P);
  };
  double before_mm = outside_mm(0.0);
  const double step_mm = before_mm < 0.0 ? detail::kTestedEvery_mm : -detail::kTestedEvery_mm;
  for (double back_mm = step_mm; std::abs(back_mm) <= kSkinSearch_mm; back_mm += step_mm) {
    const double now_mm = outside_mm(back_mm);
    if ((now_mm < 0.0) != (before_mm < 0.0)) {
      const double crossing_mm = back_mm - step_mm * now_mm / (now_mm - before_mm);
      return tip_P - crossing_mm * axis_P;
    }
    before_mm = now_mm;
  }
  return tip_P;
}

/// Inward travel of the tip, counted between turning points that are further apart than tremor.
double inward_travel_mm(std::span<const telemetry::TickSample> samples) noexcept {
  detail::Strokes strokes(detail::kTremor_mm, true);
  for (const telemetry::TickSample& sample : samples)
    if (is_valid(sample)) strokes.add(std::max(0.0, sample.depth_mm));
  return strokes.travel_mm();
}

std::optional<std::size_t> end_of_attempt(std::span<const telemetry::TickSample> samples,
                                          std::optional<std::size_t> given_end) {
  if (given_end && *given_end < samples.size() && is_valid(samples[*given_end])) return given_end;
  std::optional<std::size_t> deepest;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!is_valid(samples[i])) continue;
    if (!deepest || samples[i].depth_mm > samples[*deepest].depth_mm) deepest = i;
  }
  return deepest;
}

/// The last skin puncture before `end`, and their number. A model without puncture events enters where the depth
/// becomes positive.
struct Entry {
  std::optional<std::size_t> sample;
  int count = 0;
};
Entry find_entry(std::span<const telemetry::TickSample> samples, std::size_t end,
                 std::optional<std::uint8_t> skin_layer) {
  Entry entry;
  for (std::size_t i = 0; i <= end; ++i)
    if (is_valid(samples[i]) && has_punctured(samples[i], skin_layer)) entry = {i, entry.count + 1};
  if (entry.sample) return entry;
  bool is_inside = false;
  for (std::size_t i = 0; i <= end; ++i) {
    if (!is_valid(samples[i])) continue;
    if (samples[i].depth_mm <= 0.0) {
      is_inside = false;
    } else if (!is_inside && samples[i].phase != telemetry::InsertionPhase::kLoading) {
      is_inside = true;
      entry = {i, entry.count + 1};
    }
  }
  return entry;
}

}  // namespace

AttemptMetrics measure_attempt(const anatomy::VirtualPatient& patient, const anatomy::TissueTable& tissues,
                               const tasks::PlannedPath& plan, std::span<const telemetry::TickSample> samples,
                               std::optional<std::size_t> given_end,
                               std::span<const tasks::Interruption> interruptions) {
  AttemptMetrics metrics;
  const auto touch = std::find_if(samples.begin(), samples.end(), [](const telemetry::TickSample& sample) {
    return is_valid(sample) && (sample.phase != telemetry::InsertionPhase::kOutside || sample.depth_mm > 0.0);
  });
  metrics.has_touched_skin = touch != samples.end();
  const std::optional<std::size_t> end = end_of_attempt(samples, given_end);
  if (!metrics.has_touched_skin || !end) return metrics;
  const Entry entry = find_entry(samples, *end, tissues.find_layer("skin"));
  if (!entry.sample) return metrics;

  metrics.has_entered = true;
  metrics.entries = entry.count;
  const telemetry::TickSample& entered = samples[*entry.sample];
  metrics.entry_offset_P = skin_crossing(patient, entered.rest_tip_mm, entered.rest_axis) - plan.line_P.a;
  const telemetry::TickSample& last = samples[*end];
  metrics.entry_s = entered.time_s;
  metrics.end_s = last.time_s;
  metrics.axis_P = last.rest_axis;
  metrics.angle_deg = degrees(angle_between_rad(last.rest_axis, plan.line_P.b - plan.line_P.a));
  metrics.tip_P = last.rest_tip_mm;
  metrics.pierced_tip_P = telemetry::pierced_rest_tip_mm(last);
  metrics.target_offset_P = last.rest_tip_mm - plan.line_P.b;
  metrics.travel_mm = inward_travel_mm(samples.first(*end + 1));
  for (const telemetry::TickSample& sample : samples.first(*end + 1))
    if (is_valid(sample)) metrics.deepest_mm = std::max(metrics.deepest_mm, sample.depth_mm);
  metrics.time_s = tasks::active_time_s(touch->time_s, last.time_s, interruptions);
  return metrics;
}

void WorstBevel::step(double time_s, const Vec3& tip_P, const Mat3& R_PN, const telemetry::TickEvents& events) {
  if (!task_->bevel || !layer_) return;
  const bool is_puncture = std::ranges::any_of(events, [&](const telemetry::TickEvent& event) {
    return event.kind == telemetry::EventKind::kPuncture && event.id == *layer_;
  });
  if (!is_puncture) return;
  has_punctured_ = true;
  const auto fibres_P = tasks::find_fibres(*task_, *patient_, tip_P);
  if (!fibres_P) return;
  const double angle_deg = tasks::bevel_to_fibres_deg(R_PN, *fibres_P);
  if (!worst_ || angle_deg > worst_->to_fibres_deg) worst_ = Puncture{angle_deg, time_s};
}

}  // namespace trocar::metrics
