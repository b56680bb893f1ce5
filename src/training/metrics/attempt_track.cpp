#include "metrics/attempt_track.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/pose.h"
#include "metrics/detail/body.h"
#include "metrics/detail/uniform_sampler.h"
#include "tasks/fit_to_patient.h"
#include "telemetry/tick_sample.h"
#include "volume/sampling.h"

namespace trocar::metrics {
namespace {

constexpr double kSkinSearch_mm = 40.0;  // from the tip that pierced the skin back to the resting skin

bool is_inside(const Moment& moment) noexcept {
  return moment.depth_mm && *moment.depth_mm > 0.0;
}

}  // namespace

Vec3 AttemptTrack::skin_crossing_A(const Entry& entry) const noexcept {
  const Vec3 tip_A = entry.moment.tip_A(), axis_A = entry.moment.axis_A();
  const Vec3 by_depth_A = tip_A - entry.moment.depth_mm.value_or(0.0) * axis_A;
  if (facts_.patient == nullptr || facts_.patient->skin_distance_mm.empty()) return by_depth_A;
  const auto outside_mm = [&](double back_mm) {
    return volume::sample_linear(facts_.patient->skin_distance_mm, tip_A - back_mm * axis_A);
  };
  double before_mm = outside_mm(0.0);
  const double step_mm = before_mm < 0.0 ? detail::kTestedEvery_mm : -detail::kTestedEvery_mm;
  for (double back_mm = step_mm; std::abs(back_mm) <= kSkinSearch_mm; back_mm += step_mm) {
    const double now_mm = outside_mm(back_mm);
    if ((now_mm < 0.0) != (before_mm < 0.0)) {
      const double crossing_mm = back_mm - step_mm * now_mm / (now_mm - before_mm);
      return tip_A - crossing_mm * axis_A;
    }
    before_mm = now_mm;
  }
  return by_depth_A;  // a recording with few moments, whose first one inside is deep
}

void AttemptTrack::note_entry(const Moment& now) {
  const auto next = [&](const std::optional<Entry>& last) { return Entry{now, last ? last->count + 1 : 1}; };
  const bool has_punctured =
      facts_.skin_layer && now.events && std::ranges::any_of(*now.events, [&](const telemetry::TickEvent& event) {
        return event.kind == telemetry::EventKind::kPuncture && event.id == *facts_.skin_layer;
      });
  const bool is_outside = now.phase ? *now.phase == telemetry::InsertionPhase::kOutside : !is_inside(now);
  if (has_punctured) punctured_ = next(punctured_);
  has_left_ = !has_punctured && (has_left_ || is_outside);
  if (has_punctured) is_newest_by_depth_ = false;
  if (!is_inside(now)) {
    is_sunk_ = false;
  } else if (!is_sunk_ && now.phase != telemetry::InsertionPhase::kLoading) {
    is_sunk_ = true;
    sunk_ = next(sunk_);
    is_newest_by_depth_ = has_left_;
  }
}

void AttemptTrack::take(const Moment& now) {
  end_ = End{now, punctured_ && !is_newest_by_depth_ ? punctured_ : sunk_, strokes_.travel_mm(), deepest_mm_};
}

void AttemptTrack::step(const Moment& now) {
  if (is_over_) return;
  const bool touches = now.phase && *now.phase != telemetry::InsertionPhase::kOutside;
  if (!contact_s_ && (touches || is_inside(now))) contact_s_ = now.time_s;
  note_entry(now);
  if (now.depth_mm) {
    strokes_.add(std::max(0.0, *now.depth_mm));
    deepest_mm_ = std::max(deepest_mm_, *now.depth_mm);
  }
  if (facts_.end_s && now.time_s >= *facts_.end_s) {
    is_over_ = true;
    return take(now);
  }
  if (now.depth_mm) {
    if (is_inside(now) && (!end_ || !end_->moment.depth_mm || *now.depth_mm > *end_->moment.depth_mm)) take(now);
    return;
  }
  if (end_ && end_->moment.depth_mm) return;
  double nearest_mm = std::numeric_limits<double>::infinity();
  for (const Vec3& target_P : facts_.target_points_P)
    nearest_mm = std::min(nearest_mm, (target_P - now.tip_A()).norm());
  if (!std::isfinite(nearest_mm) || (end_ && nearest_mm >= nearest_mm_)) return;
  nearest_mm_ = nearest_mm;
  take(now);
}

AttemptTrack follow_attempt(const anatomy::VirtualPatient& patient, const anatomy::TissueTable& tissues,
                            std::span<const telemetry::TickSample> samples, std::optional<double> end_s) {
  AttemptTrack track({&patient, tissues.find_layer("skin"), end_s, {}});
  for (const telemetry::TickSample& sample : samples)
    if (sample.tip_mm.allFinite() && sample.axis.allFinite() && std::isfinite(sample.depth_mm) &&
        std::isfinite(sample.time_s))
      track.step(moment_of(sample));
  return track;
}

AttemptMetrics measure_against(const tasks::PlannedPath& plan, const AttemptTrack& track,
                               std::span<const tasks::Interruption> interruptions) {
  AttemptMetrics metrics;
  metrics.has_touched_skin = track.contact_s().has_value();
  if (!metrics.has_touched_skin || !track.end() || !track.end()->entry) return metrics;
  const AttemptTrack::End& end = *track.end();
  const Moment& last = end.moment;
  metrics.has_entered = true;
  metrics.entries = end.entry->count;
  metrics.entry_offset_P = track.skin_crossing_A(*end.entry) - plan.line_P.a;
  metrics.entry_s = end.entry->moment.time_s;
  metrics.end_s = last.time_s;
  metrics.axis_P = last.axis_A();
  metrics.angle_deg = degrees(angle_between_rad(last.axis_A(), plan.line_P.b - plan.line_P.a));
  metrics.tip_P = last.tip_A();
  metrics.pierced_tip_P = last.tip_A() - last.pressed_mm * last.axis_A();
  metrics.target_offset_P = last.tip_A() - plan.line_P.b;
  metrics.travel_mm = end.travel_mm;
  metrics.deepest_mm = end.deepest_mm;
  metrics.time_s = tasks::active_time_s(*track.contact_s(), last.time_s, interruptions);
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
