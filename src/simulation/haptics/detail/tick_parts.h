#pragma once

#include <algorithm>
#include <cmath>

#include "geometry/clamp_norm.h"
#include "haptics/tick.h"
#include "telemetry/tick_events.h"

/// Parts of the tick common to all tools. Private to `haptics`; all functions are real-time safe.
namespace trocar::haptics {

/// Adds events to a sample. Overwrites the last entry with kEventsDropped if there are more.
class EventList {
 public:
  explicit EventList(telemetry::TickSample& sample) noexcept : sample_(sample) {}
  void add(telemetry::TickEvent event) noexcept {
    if (!telemetry::add_event(sample_, event))
      sample_.events.back() = telemetry::limit_event(telemetry::LimitReason::kEventsDropped);
  }
  void add(telemetry::LimitReason reason) noexcept { add(telemetry::limit_event(reason)); }

 private:
  telemetry::TickSample& sample_;
};

/// Wrench that compensates for the weight of links and stylus, so that the user feels only the tool (paper A;
/// physics.md W1).
inline Wrench weight_compensation(const HapticScene& scene, const Mat3& R_PS) noexcept {
  if (!scene.options.has_weight_compensation) return {};
  const Vec3 lift_P = -scene.gravity_P * scene.device.stylus_weight_n;
  const Vec3 arm_P = R_PS * Vec3(0.0, 0.0, -scene.device.stylus_lever_mm);
  return {lift_P, arm_P.cross(lift_P)};
}

/// Last step of every tick. Limits `device_f_n`, the torque and its part about the stylus to the device's peaks and
/// adds limit events. Rotates them, and their parts of tissue and weight, to W.
/// Tip and axis of a sample in the anatomy at rest.
inline void note_rest(const motion::PatientMotion& motion, telemetry::TickSample& sample) noexcept {
  telemetry::set_at_rest(sample);
  if (motion.is_rest()) return;
  sample.rest_tip_mm = motion.to_rest(sample.tip_mm);
  sample.rest_axis = motion.line_to_rest(sample.rest_tip_mm, sample.axis).normalized();
}

inline void limit_to_device(HapticOutput& output, const Wrench& tissue_P, const Wrench& weight_P,
                            const Vec3& stylus_axis_P, EventList& events, const HapticScene& scene) noexcept {
  telemetry::TickSample& sample = output.sample;
  Vec3 torque_P = sample.tau_nmm;
  const bool force_limited = clamp_norm(sample.device_f_n, scene.device.peak_force_n);
  const bool has_torque = scene.device.has_torque();
  bool torque_limited = has_torque && clamp_norm(torque_P, scene.device.peak_torque_nmm);
  const double roll_nmm = torque_P.dot(stylus_axis_P);
  const double most_nmm = scene.device.peak_roll_nmm;
  if (has_torque && most_nmm > 0.0 && std::abs(roll_nmm) > most_nmm) {
    torque_P += (std::clamp(roll_nmm, -most_nmm, most_nmm) - roll_nmm) * stylus_axis_P;
    torque_limited = true;
  }
  if (force_limited) events.add(telemetry::LimitReason::kForceClamped);
  if (torque_limited) events.add(telemetry::LimitReason::kTorqueClamped);
  sample.limited = force_limited || torque_limited;

  const Mat3 R_WP = scene.X_PW.R().transpose();
  if (!has_torque) torque_P.setZero();
  sample.device_tau_nmm = torque_P;
  output.total_W = R_WP * Wrench{sample.device_f_n, torque_P};
  output.weight_W = R_WP * Wrench{weight_P.force_n, has_torque ? weight_P.torque_nmm : Vec3(Vec3::Zero())};
  output.tissue_W = R_WP * tissue_P;
  if (force_limited) output.tissue_W.force_n = output.total_W.force_n - output.weight_W.force_n;
  if (torque_limited) output.tissue_W.torque_nmm = output.total_W.torque_nmm - output.weight_W.torque_nmm;
}

}  // namespace trocar::haptics
