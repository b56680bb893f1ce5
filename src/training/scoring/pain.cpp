#include "scoring/pain.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace trocar::scoring {
namespace {

constexpr double kSameContact_s = 1.0;  // contacts with one structure within this time hurt once [assumed]

}  // namespace

void PainWatch::note(const tasks::Action& action) noexcept {
  if (action.kind == tasks::ActionKind::kAnaesthetise) is_anaesthetised_ = true;
}

std::optional<PainEvent> PainWatch::step(const telemetry::TickSample& sample) {
  if (!sample.tip_mm.allFinite() || !std::isfinite(sample.depth_mm) || !std::isfinite(sample.time_s))
    return std::nullopt;
  const bool is_inside = sample.depth_mm > 0.0;
  const bool is_entry = is_inside && !std::exchange(was_inside_, is_inside);
  const bool is_first_entry = is_entry && !std::exchange(has_pierced_skin_, has_pierced_skin_ || is_entry);
  if (is_first_entry && task_->pain.needs_anaesthesia && !is_anaesthetised_) return PainEvent{sample.time_s, 0.0, {}};
  if (!is_inside) return std::nullopt;
  const std::vector<std::string>& tissues = task_->pain.tissues;
  const anatomy::Label* const label = anatomy::find_label(*patient_, sample.tip_mm);
  if (label == nullptr || std::find(tissues.begin(), tissues.end(), label->tissue) == tissues.end())
    return std::nullopt;
  const bool is_new = label != touched_ || sample.time_s - left_s_ > kSameContact_s;
  touched_ = label;
  left_s_ = sample.time_s;
  if (!is_new) return std::nullopt;
  return PainEvent{sample.time_s, sample.depth_mm, label->name};
}

}  // namespace trocar::scoring
