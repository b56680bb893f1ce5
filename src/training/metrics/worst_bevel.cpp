#include "metrics/worst_bevel.h"

#include <algorithm>

#include "tasks/bevel.h"

namespace trocar::metrics {

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
