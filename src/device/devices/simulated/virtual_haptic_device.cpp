#include "devices/simulated/virtual_haptic_device.h"

#include <algorithm>
#include <cmath>

#include "devices/detail/factories.h"
#include "devices/simulated/detail/hand_motion.h"
#include "devices/workspace_map.h"
#include "geometry/vec.h"

namespace trocar::devices {
namespace {

constexpr double kFastestHand_mm_per_s = 1000.0;  // below what the safety gate takes for impossible [assumed]
constexpr double kMaxStep_s = 1e-3;               ///< physics.md H2 holds at 1 kHz.
/// Twice the stiffest hand of physics.md H1, and the same at the end of a 30 mm grip. A stiffer hand would oscillate.
constexpr double kStiffestHand_n_per_mm = 10.0;
constexpr double kStiffestTurn_nmm_per_rad = 1e4;

template <class T, std::size_t n>
void push_front(std::array<T, n>& values, const T& value) noexcept {
  for (std::size_t i = n - 1; i > 0; --i) values[i] = values[i - 1];
  values[0] = value;
}

}  // namespace

VirtualHapticDevice::VirtualHapticDevice(stylus::DevicePreset preset, const SimulatedDeviceParams& params) noexcept
    : preset_(std::move(preset)), params_(params) {
  params_.force_delay = std::clamp(params_.force_delay, 0, kMaxDelay);
  params_.reading_delay = std::clamp(params_.reading_delay, 0, kMaxDelay);
}

void VirtualHapticDevice::hold(const DeviceHand& hand) noexcept {
  if (!is_valid(hand)) return;
  hand_ = hand;
  hand_.stiffness_n_per_mm = std::min(hand.stiffness_n_per_mm, kStiffestHand_n_per_mm);
  hand_.turning_nmm_per_rad = std::min(hand.turning_nmm_per_rad, kStiffestTurn_nmm_per_rad);
  if (hand.is_placed && (!was_ever_held_ || hand.time_s != placed_s_)) {
    stylus_ = {};
    stylus_.X_PS = hand.X_DS;
    placed_s_ = hand.time_s;
    was_ever_held_ = true;
  }
  if (hand.is_held && !was_ever_held_) {  // first hold: the stylus starts at the pose of the hand
    stylus_ = {};
    stylus_.X_PS = hand_at(hand, last_s_).X_DS;
    was_ever_held_ = true;
  }
}

bool VirtualHapticDevice::write(const Wrench& wrench_D) noexcept {
  if (!is_valid(wrench_D)) return false;
  Wrench wrench = wrench_D;
  clamp_norm(wrench.force_n, preset_.has_force() ? preset_.capability.peak_force_n : 0.0);
  clamp_norm(wrench.torque_nmm, preset_.capability.peak_torque_nmm);
  commanded_D_ = wrench;
  return true;
}

DeviceReading VirtualHapticDevice::read(double now_s) noexcept {
  if (!std::isfinite(now_s)) now_s = last_s_;
  if (!is_started_) {
    is_started_ = true;
    last_s_ = now_s;
    readings_.fill(tell());
    return readings_[0];
  }
  const double gap_s = std::clamp(now_s - last_s_, 0.0, kMaxGap_s);
  if (!(gap_s > 0.0)) {
    DeviceReading again = readings_[static_cast<std::size_t>(params_.reading_delay)];
    again.status = DeviceStatus::kRepeated;
    return again;
  }
  push_front(written_, commanded_D_);
  acting_D_ = written_[static_cast<std::size_t>(params_.force_delay)];
  const int steps = std::max(1, static_cast<int>(std::ceil(gap_s / kMaxStep_s - 1e-9)));
  const double dt_s = gap_s / steps;
  for (int i = 1; i <= steps; ++i) step(now_s - gap_s + i * dt_s, dt_s);
  last_s_ = now_s;
  push_front(readings_, tell());
  return readings_[static_cast<std::size_t>(params_.reading_delay)];
}

DeviceReading VirtualHapticDevice::tell() noexcept {
  DeviceReading reading;
  reading.X_DS = stylus::quantise(X_DS(), preset_.encoder);
  if (preset_.sensed_dof == 3) reading.X_DS = Pose::translation(reading.X_DS.p());
  reading.buttons = hand_.buttons;
  return reading;
}

/// Force of the end stops on S: a spring, with half of critical damping against outward motion.
Vec3 VirtualHapticDevice::wall_n() const noexcept {
  const Vec3 p_D = X_DS().p();
  const double beyond_mm = p_D.norm() - preset_.workspace_radius_mm;
  if (!(beyond_mm > 0.0)) return Vec3::Zero();
  const Vec3 outwards = p_D.normalized();
  const double k = params_.wall_stiffness_n_per_mm;
  const double damping = std::sqrt(k * preset_.apparent_mass_kg / kMmPerM);
  const double speed = std::max(0.0, v_D().dot(outwards));
  return -(k * beyond_mm + damping * speed) * outwards;
}

stylus::StylusHold VirtualHapticDevice::grip(const HandNow& hand) const noexcept {
  stylus::StylusHold hold;
  if (!hand_.is_held) return hold;
  hold.X_PS = hand.X_DS;
  hold.velocity_P = hand.v_D;
  hold.angular_velocity_P = hand.w_D;
  hold.point_mm = hand_.point_mm;
  hold.stiffness_n_per_mm = hand_.stiffness_n_per_mm;
  hold.damping_ns_per_mm = hand_.damping_ns_per_mm;
  hold.mass_kg = hand_.mass_kg;
  hold.turning_nmm_per_rad = hand_.turning_nmm_per_rad;
  hold.turning_damping_nmms_per_rad = hand_.turning_damping_nmms_per_rad;
  hold.inertia_kg_mm2 = hand_.inertia_kg_mm2;
  return hold;
}

stylus::VirtualStylusParams VirtualHapticDevice::stylus_params() const noexcept {
  stylus::VirtualStylusParams params;
  params.mass_kg = preset_.apparent_mass_kg;
  params.inertia_kg_mm2 = params_.inertia_kg_mm2;
  const stylus::DeviceCapability& capability = preset_.capability;
  params.weight_n = params_.weight_n.value_or(capability.stylus_weight_n);
  // A gimbal without motors has no lever: it is balanced, and the weight acts at S.
  params.weight_lever_mm = preset_.has_torque() ? params_.weight_lever_mm.value_or(capability.stylus_lever_mm) : 0.0;
  params.viscosity_ns_per_mm = preset_.viscosity_ns_per_mm;
  params.turning_viscosity_nmms = params_.gimbal_viscosity_nmms;
  params.friction_n = preset_.friction_n;
  params.turning_friction_nmm = params_.gimbal_friction_nmm;
  return params;
}

void VirtualHapticDevice::step(double time_s, double dt_s) noexcept {
  if (!was_ever_held_) return;
  const HandNow hand = hand_at(hand_, time_s);
  if (hand_.is_held && hand_.is_rigid) {
    Vec3 way_D = hand.X_DS.p() - stylus_.X_PS.p();
    clamp_norm(way_D, kFastestHand_mm_per_s * dt_s);  // a late target is caught up with, not jumped to
    stylus_ = {Pose(hand.X_DS.R(), stylus_.X_PS.p() + way_D), hand.v_D, hand.w_D};
    return;
  }
  const Wrench push{acting_D_.force_n + wall_n(), acting_D_.torque_nmm};
  stylus::step_stylus(stylus_, stylus_params(), grip(hand), push, -Vec3::UnitZ(), dt_s);
}

OpenedDevice open_virtual(const DeviceSpec& spec, const DeviceOptions& options) {
  const std::string& named = spec.argument.empty() ? options.preset : spec.argument;
  TROCAR_TRY(stylus::DevicePreset preset,
             stylus::load_device_preset(options.devices_file, named.empty() ? "premium" : named));
  SimulatedDeviceParams params;  // the stylus keeps its weight, also if another one is compensated
  params.weight_n = preset.capability.stylus_weight_n;
  params.weight_lever_mm = preset.capability.stylus_lever_mm;
  const std::string name = "virtual:" + preset.name;
  TROCAR_TRY(preset, with_stylus_profile(std::move(preset), options.stylus_folder, name));
  return std::make_unique<VirtualHapticDevice>(std::move(preset), params);
}

}  // namespace trocar::devices
