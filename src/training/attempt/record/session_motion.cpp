#include "attempt/record/session_motion.h"

#include <algorithm>

#include "haptics/option_texts.h"
#include "metrics/metric.h"

namespace trocar::attempt {

SessionMotion::SessionMotion(const storage::Session& session, const anatomy::VirtualPatient& patient)
    : model_(session.info.motion_hash.empty() ? nullptr : patient.motion.get()) {
  for (const storage::SessionParameters& parameters : session.parameters) {
    haptics::HapticOptions options;
    stylus::DeviceCapability device;
    if (haptics::restore_options(parameters.options, options, device))
      drives_.emplace_back(parameters.time_s, options.motion);
  }
}

motion::PatientMotion SessionMotion::at(const telemetry::TickSample& sample) const noexcept {
  const auto next =
      std::ranges::upper_bound(drives_, sample.time_s, {}, &std::pair<double, motion::MotionDrive>::first);
  const bool is_moved = next != drives_.begin() && motion::moves(std::prev(next)->second);
  return metrics::recorded_motion(is_moved ? model_ : nullptr, sample);
}

}  // namespace trocar::attempt
