#include "devices/pointer/pointer_device.h"

#include <algorithm>
#include <cmath>

#include "devices/detail/factories.h"
#include "devices/simulated/detail/hand_motion.h"
#include "geometry/clamp_norm.h"
#include "haptics/closed_loop/rotation.h"

namespace trocar::devices {
PointerDevice::PointerDevice(haptics::DevicePreset preset, const PointerParams& params) noexcept
    : preset_(std::move(preset)), params_(params) {}

void PointerDevice::hold(const DeviceHand& hand) noexcept {
  if (!is_valid(hand)) return;
  hand_ = hand;
  const bool is_new_place = hand.is_placed && (!was_ever_held_ || hand.time_s != placed_s_);
  if (is_new_place) placed_s_ = hand.time_s;
  if (is_new_place || (hand.is_held && !was_ever_held_)) {
    X_DS_ = hand.X_DS;
    was_ever_held_ = true;
  }
}

DeviceReading PointerDevice::read(double now_s) noexcept {
  if (!std::isfinite(now_s)) now_s = last_s_;
  DeviceReading reading;
  reading.buttons = hand_.buttons;
  const double dt_s = is_started_ ? std::clamp(now_s - last_s_, 0.0, kMaxGap_s) : 0.0;
  if (is_started_ && !(dt_s > 0.0)) reading.status = DeviceStatus::kRepeated;
  last_s_ = is_started_ ? std::max(now_s, last_s_) : now_s;
  is_started_ = true;
  if (dt_s > 0.0 && hand_.is_held) {
    const Pose X_DS_wanted = hand_at(hand_, now_s).X_DS;
    if (hand_.is_rigid) {
      X_DS_ = X_DS_wanted;
    } else {
      const double share = 1.0 - std::exp(-dt_s / std::max(params_.time_constant_s, 1e-6));
      const Vec3 step = clamped_norm(share * (X_DS_wanted.p() - X_DS_.p()), params_.max_speed_mm_per_s * dt_s);
      const Vec3 left = haptics::rotation_vector(X_DS_wanted.R() * X_DS_.R().transpose());
      const Vec3 turn = clamped_norm(share * left, params_.max_turn_rad_per_s * dt_s);
      const Eigen::Quaterniond turned(haptics::rotation_from_vector(turn) * X_DS_.R());
      X_DS_ = Pose(turned.normalized().toRotationMatrix(), X_DS_.p() + step);
    }
  }
  reading.X_DS = X_DS_;
  return reading;
}

bool PointerDevice::write(const Wrench& wrench_D) noexcept {
  return is_valid(wrench_D);
}

OpenedDevice open_pointer(const DeviceSpec&, const DeviceOptions& options) {
  TROCAR_TRY(haptics::DevicePreset preset, load_preset_of(options, "mouse"));
  return std::make_unique<PointerDevice>(std::move(preset), PointerParams{});
}

}  // namespace trocar::devices
