#pragma once

#include <optional>

#include "haptics/insertion/path_constraint.h"  // Wrench

namespace trocar::devices {

/// Converts a wrench about S for a device without torque: the axial force is kept, and a lateral force at S turns the
/// needle about the entry point as force and torque together would (physics.md G10). `p_SE`: vector from S to the entry
/// point; none outside the body: the force is unchanged. Below kLeastLever_mm the torque's share fades to zero. `axis`:
/// unit vector of the needle. All arguments are in one frame. Do not use it for the weight compensation of the stylus.
/// Real-time safe.
haptics::Wrench without_torque(const haptics::Wrench& wrench, const Vec3& axis,
                               const std::optional<Vec3>& p_SE) noexcept;
inline constexpr double kLeastLever_mm = 20.0;

}  // namespace trocar::devices
