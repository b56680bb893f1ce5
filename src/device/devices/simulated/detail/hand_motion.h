#pragma once

#include "devices/haptic_device.h"

namespace trocar::devices {

/// A hand target is extrapolated by its velocity for at most this time, then the hand is at rest: after this time the
/// next target counts as lost, not late. Five heartbeats of a trainer.
inline constexpr double kMaxExtrapolation_s = 0.05;
/// Longest time between two readings. Longer gaps: the process was stopped (debugger, suspended machine).
inline constexpr double kMaxGap_s = 0.1;

/// Pose and velocity of the hand at a time.
struct HandNow {
  Pose X_DS;
  Vec3 v_D = Vec3::Zero();  ///< mm/s
  Vec3 w_D = Vec3::Zero();  ///< rad/s
};
/// Real-time safe.
HandNow hand_at(const DeviceHand& hand, double time_s) noexcept;

/// True if all values are finite and no stiffness, damping, mass, inertia or point_mm is negative. Real-time safe.
bool is_valid(const DeviceHand& hand) noexcept;

/// True if a gate can have written the wrench: finite and within kMostPlausibleForce_n and kMostPlausibleTorque_nmm,
/// which are more than a hundred times the peaks of any device in data/devices.toml. Real-time safe.
bool is_valid(const Wrench& wrench) noexcept;
inline constexpr double kMostPlausibleForce_n = 2e4;
inline constexpr double kMostPlausibleTorque_nmm = 5e5;

}  // namespace trocar::devices
