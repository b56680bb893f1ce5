#pragma once

#include <gtest/gtest.h>

#include <optional>

#include "core/files/folders.h"
#include "devices/simulated/virtual_haptic_device.h"
#include "stylus/virtual_stylus.h"

namespace trocar::testing {

inline constexpr double kDt_s = 0.001;

inline stylus::DevicePreset preset_of(const char* name) {
  const auto preset = stylus::load_device_preset(data_dir() / "devices.toml", name);
  EXPECT_TRUE(preset) << preset.error().text();
  return *preset;
}

/// A preset with exact sensors and no friction, for comparison with closed-form solutions.
inline stylus::DevicePreset ideal() {
  stylus::DevicePreset preset = preset_of("premium");
  preset.encoder = {0.0, 0.0};
  preset.friction_n = 0.0;
  preset.viscosity_ns_per_mm = 0.0;
  return preset;
}
inline devices::SimulatedDeviceParams without_friction() {
  devices::SimulatedDeviceParams params;
  params.gimbal_friction_nmm = 0.0;
  params.gimbal_viscosity_nmms = 0.0;
  return params;
}

inline devices::DeviceHand placed_at(const Pose& X_DS) {
  devices::DeviceHand hand;
  hand.X_DS = X_DS;
  hand.is_placed = true;
  return hand;
}
/// The hand of physics.md H1.
inline devices::DeviceHand holding(const Pose& X_DS, double time_s) {
  const stylus::StylusHold made = stylus::make_hand();
  devices::DeviceHand hand;
  hand.X_DS = X_DS;
  hand.time_s = time_s;
  hand.stiffness_n_per_mm = made.stiffness_n_per_mm;
  hand.damping_ns_per_mm = made.damping_ns_per_mm;
  hand.mass_kg = made.mass_kg;
  hand.turning_nmm_per_rad = made.turning_nmm_per_rad;
  hand.turning_damping_nmms_per_rad = made.turning_damping_nmms_per_rad;
  hand.inertia_kg_mm2 = made.inertia_kg_mm2;
  hand.is_held = true;
  return hand;
}

/// The tick's compensation of links and stylus (physics.md W1), from the pose of the reading.
inline Wrench weight_compensation(const stylus::DevicePreset& preset, const Pose& X_DS) {
  const Vec3 lift = Vec3::UnitZ() * preset.capability.stylus_weight_n;
  const Vec3 arm = X_DS.R() * Vec3(0.0, 0.0, -preset.capability.stylus_lever_mm);
  return {lift, arm.cross(lift)};
}

/// A simulated device and its clock; runs periods like the server.
struct Bench {
  devices::VirtualHapticDevice device;
  double time_s = 100.0;

  explicit Bench(const stylus::DevicePreset& preset, const devices::SimulatedDeviceParams& params = {})
      : device(preset, params) {
    device.read(time_s);
  }
  devices::DeviceReading period(const std::optional<devices::DeviceHand>& hand, const Wrench& wrench,
                                double dt_s = kDt_s) {
    time_s += dt_s;
    const devices::DeviceReading reading = device.read(time_s);
    if (hand) device.hold(*hand);
    EXPECT_TRUE(device.write(wrench));
    return reading;
  }
};

}  // namespace trocar::testing
