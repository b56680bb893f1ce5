#include "devices/simulated/replay_device.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "devices/detail/factories.h"
#include "devices/simulated/detail/hand_motion.h"

namespace trocar::devices {
namespace {

/// Distance from a recorded sample, as share of a period, below which the sample itself is used: a server at the same
/// rate gets identical bits.
constexpr double kSameSample = 1e-6;

Pose between(const Pose& a, const Pose& b, double share) noexcept {
  const Eigen::Quaterniond turned = Eigen::Quaterniond(a.R()).slerp(share, Eigen::Quaterniond(b.R())).normalized();
  return {turned.toRotationMatrix(), a.p() + share * (b.p() - a.p())};
}

}  // namespace

ReplayDevice::ReplayDevice(haptics::DevicePreset preset, std::string name, std::vector<Pose> poses, double rate_hz)
    : preset_(std::move(preset)), name_(std::move(name)), poses_(std::move(poses)), rate_hz_(rate_hz) {
  TROCAR_CHECK(!poses_.empty());
  TROCAR_CHECK(rate_hz_ > 0.0);
}

DeviceReading ReplayDevice::read(double now_s) noexcept {
  if (!std::isfinite(now_s)) now_s = last_s_;
  if (!is_started_) start_s_ = now_s;
  DeviceReading reading;
  if (is_started_ && !(now_s > last_s_)) reading.status = DeviceStatus::kRepeated;
  is_started_ = true;
  last_s_ = std::max(now_s, last_s_);

  const double last = static_cast<double>(poses_.size() - 1);
  const double sample = std::clamp((now_s - start_s_) * rate_hz_, 0.0, last);
  const double nearest = std::round(sample);
  if (std::abs(sample - nearest) < kSameSample) {
    reading.X_DS = poses_[static_cast<std::size_t>(nearest)];
    return reading;
  }
  const auto before = static_cast<std::size_t>(sample);
  reading.X_DS = between(poses_[before], poses_[before + 1], sample - std::floor(sample));
  return reading;
}

bool ReplayDevice::write(const Wrench& wrench_D) noexcept {
  return is_valid(wrench_D);
}

OpenedDevice open_replay(const DeviceSpec& spec, const DeviceOptions& options) {
  constexpr double kMaxRate_hz = 10000.0;
  if (options.motion.poses.empty()) {
    return fail("there are no poses to replay", spec.argument, "name a session with at least one sample");
  }
  for (std::size_t i = 0; i < options.motion.poses.size(); ++i) {
    if (options.motion.poses[i].is_finite()) continue;
    return fail("a recorded pose is not finite", spec.argument + ", sample " + std::to_string(i), "record it again");
  }
  if (!(options.motion.rate_hz > 0.0 && options.motion.rate_hz <= kMaxRate_hz)) {
    return fail("the rate of the recorded poses is not in 0..10000 Hz", spec.argument, "record it again");
  }
  TROCAR_TRY(haptics::DevicePreset preset, load_preset_of(options, "premium"));
  return std::make_unique<ReplayDevice>(std::move(preset), spec.argument, options.motion.poses, options.motion.rate_hz);
}

}  // namespace trocar::devices
