#pragma once

#include <optional>

#include "geometry/wrench.h"

namespace trocar::devices {

/// Converts a wrench about S for a device without torque: the axial force is kept, and the lateral force at S has
/// the moment about the entry point that force and torque have together (physics.md G10). `p_SE`: vector from S to the
/// entry point; empty outside the body, and then the force is unchanged. If the lever is shorter than kLeastLever_mm,
/// the share of the torque decreases to zero with the lever. `axis`: unit vector of the needle. All arguments are in
/// one frame. Do not use it for the weight compensation of the stylus. Real-time safe.
Wrench without_torque(const Wrench& wrench, const Vec3& axis, const std::optional<Vec3>& p_SE) noexcept;
inline constexpr double kLeastLever_mm = 20.0;

}  // namespace trocar::devices
