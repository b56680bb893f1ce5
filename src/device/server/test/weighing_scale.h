#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "devices/simulated/virtual_haptic_device.h"
#include "server/device_trial.h"
#include "server/test/servo_rig.h"

/// Weighings of simulated devices in simulated time.
namespace trocar::server {

using devices::SimulatedDeviceParams;
using devices::VirtualHapticDevice;

inline constexpr double kPeriod_s = 1e-3;
inline constexpr double kLongest_s = 60.0;  // longer than any weighing
inline constexpr double kWeight_n = 0.01;   // tolerance: the force of a count on the hold's spring, 0.06 mm of 0.2 N/mm
inline constexpr double kLever_mm =
    0.5;  // tolerance: dry friction of 0.5 N mm would give 1 mm without the two directions
inline constexpr double kAttachment_n = 0.3;  // a needle's grip

inline const Pose kLevel(rotation_between(Vec3::UnitZ(), Vec3::UnitY()), Vec3::Zero());

inline std::vector<stylus::DevicePreset> presets_with_force() {
  auto presets = stylus::load_device_presets(testing::data_file("devices.toml"));
  TROCAR_CHECK(presets.has_value());
  std::erase_if(*presets, [](const stylus::DevicePreset& preset) { return !preset.has_force(); });
  TROCAR_CHECK(presets->size() == 9);
  return *presets;
}

inline SimulatedDeviceParams weighing(double weight_n, double lever_mm = 20.0) {
  SimulatedDeviceParams params;
  params.weight_n = weight_n;
  params.weight_lever_mm = lever_mm;
  return params;
}

/// What a device showed during a weighing.
struct Course {
  std::optional<WeighResult> result;
  double most_n = 0.0, last_n = 0.0;
  double fastest_mm_per_s = 0.0, farthest_mm = 0.0;
};

/// Runs a trial until its weighing ends.
class Scale {
 public:
  explicit Scale(devices::HapticDevice& device, double rate_hz = 1000.0)
      : device_(device), trial_(device, rate_hz), period_s_(1.0 / rate_hz) {}

  Course weigh(const std::optional<Pose>& placed_X_DS = kLevel) {
    trial_.weigh(placed_X_DS);
    return run(kLongest_s);
  }
  /// Until the weighing ends, or for a time.
  Course run(double longest_s) {
    Course course;
    for (const double end_s = now_s + longest_s; now_s < end_s && !course.result;) {
      const DeviceTrialRecord record = step();
      course.result = record.weighed;
      course.last_n = record.written_D.force_n.norm();
      course.most_n = std::max(course.most_n, course.last_n);
      if (const auto* simulated = dynamic_cast<VirtualHapticDevice*>(&device_)) {
        course.fastest_mm_per_s = std::max(course.fastest_mm_per_s, simulated->v_D().norm());
        course.farthest_mm = std::max(course.farthest_mm, simulated->X_DS().p().norm());
      }
    }
    return course;
  }
  DeviceTrialRecord step() {
    now_s += period_s_;
    return trial_.step(now_s, period_s_);
  }
  DeviceTrial& trial() { return trial_; }

  double now_s = 1.0;

 private:
  devices::HapticDevice& device_;
  DeviceTrial trial_;
  double period_s_;
};

inline Course weigh(const stylus::DevicePreset& preset, const SimulatedDeviceParams& params, const Pose& X_DS = kLevel,
                    double rate_hz = 1000.0) {
  VirtualHapticDevice device(preset, params);
  return Scale(device, rate_hz).weigh(X_DS);
}

inline WeighRefusal refusal_of(const Course& course) {
  EXPECT_TRUE(course.result.has_value()) << "the weighing does not end";
  EXPECT_EQ(course.last_n, 0.0) << "the weighing has ended";
  return course.result ? course.result->refusal : WeighRefusal::kNone;
}

inline void expect_weight(const Course& course, double weight_n, const std::string& what) {
  ASSERT_TRUE(course.result) << what;
  EXPECT_EQ(course.result->refusal, WeighRefusal::kNone) << what;
  EXPECT_NEAR(course.result->weight_n, weight_n, kWeight_n) << what;
}

/// A hand at this place, of this stiffness.
inline devices::DeviceHand hand_of(double stiffness_n_per_mm) {
  devices::DeviceHand hand;
  hand.X_DS = kLevel;
  hand.is_held = true;
  hand.stiffness_n_per_mm = stiffness_n_per_mm;
  hand.damping_ns_per_mm = 0.01 * stiffness_n_per_mm;
  hand.turning_nmm_per_rad = 100.0;
  hand.turning_damping_nmms_per_rad = 2.0;
  return hand;
}

}  // namespace trocar::server
