#pragma once

#include "devices/haptic_device.h"

namespace trocar::devices {

/// A hand target is carried on by its velocity for at most this long, then it stands still: beyond it the next one is
/// lost rather than late. Five of a trainer's heartbeats.
inline constexpr double kMaxExtrapolation_s = 0.05;

/// Where the hand is at a time.
struct HandNow {
  Pose X_DS;
  Vec3 v_D = Vec3::Zero();  ///< mm/s
  Vec3 w_D = Vec3::Zero();  ///< rad/s
};
/// Real-time safe.
HandNow hand_at(const DeviceHand& hand, double time_s) noexcept;

/// Everything in it is finite, and nothing negative that must not be. Real-time safe.
bool is_valid(const DeviceHand& hand) noexcept;

/// A wrench that some gate may have written: finite, and less than any device of the table could give a hundred times
/// over. Real-time safe.
bool is_valid(const haptics::Wrench& wrench) noexcept;
inline constexpr double kAbsurdForce_n = 2e4;
inline constexpr double kAbsurdTorque_nmm = 5e5;

}  // namespace trocar::devices
