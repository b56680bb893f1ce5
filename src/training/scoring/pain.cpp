#include "scoring/pain.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "telemetry/tick_sample.h"
#include "volume/sampling.h"

namespace trocar::scoring {
namespace {

constexpr double kSameContact_s = 1.0;  // contacts with one structure within this time hurt once [assumed]
constexpr double kNearSkin_mm = 5.0;    // of a tip that shows where to inject [assumed]
constexpr double kOnBone_mm = 0.5;      // from a tip that presses on bone to its label

}  // namespace

std::string why_not_numb(const tasks::Action& injection, const anatomy::VirtualPatient& patient) {
  if (!(injection.amount > 0.0)) return "no anaesthetic was injected";
  if (injection.depth_mm > 0.0 || patient.skin_distance_mm.empty()) return {};
  const bool is_near = volume::sample_linear(patient.skin_distance_mm, injection.tip_A) <= kNearSkin_mm;
  return is_near ? std::string() : "the anaesthetic was injected into the air";
}

void PainWatch::note(const tasks::Action& action) {
  if (action.kind == tasks::ActionKind::kAnaesthetise && why_not_numb(action, *patient_).empty())
    numb_A_.push_back(action.tip_A);
}

/// What the tip is in, or the bone that it presses on.
const anatomy::Label* PainWatch::touched_now(const telemetry::TickSample& sample) const {
  const bool is_pressing = sample.phase == telemetry::InsertionPhase::kLoading && sample.layer_displacement_mm > 0.0;
  const Vec3 ahead_P = sample.rest_tip_mm + (is_pressing ? kOnBone_mm : 0.0) * sample.rest_axis;
  const anatomy::Label* const ahead = anatomy::find_label(*patient_, ahead_P);
  if (ahead != nullptr && ahead->tissue == "bone") return ahead;
  return anatomy::find_label(*patient_, telemetry::pierced_rest_tip_mm(sample));
}

std::optional<PainEvent> PainWatch::step(const telemetry::TickSample& sample) {
  if (!sample.rest_tip_mm.allFinite() || !sample.rest_axis.allFinite() || !std::isfinite(sample.depth_mm) ||
      !std::isfinite(sample.time_s))
    return std::nullopt;
  const bool is_inside = telemetry::is_in_body(sample);
  const bool is_entry = is_inside && !std::exchange(was_inside_, is_inside);
  const auto is_near = [&](const Vec3& numb_A) { return (numb_A - sample.rest_tip_mm).norm() <= kNumb_mm; };
  if (is_entry && task_->pain.needs_anaesthesia && !has_hurt_skin_ && std::ranges::none_of(numb_A_, is_near)) {
    has_hurt_skin_ = true;
    return PainEvent{sample.time_s, 0.0, {}};
  }
  if (!is_inside) return std::nullopt;
  const std::vector<std::string>& tissues = task_->pain.tissues;
  const anatomy::Label* const label = touched_now(sample);
  if (label == nullptr || std::find(tissues.begin(), tissues.end(), label->tissue) == tissues.end())
    return std::nullopt;
  const bool is_new = label != touched_ || sample.time_s - left_s_ > kSameContact_s;
  touched_ = label;
  left_s_ = sample.time_s;
  if (!is_new) return std::nullopt;
  return PainEvent{sample.time_s, sample.depth_mm, label->name};
}

}  // namespace trocar::scoring
