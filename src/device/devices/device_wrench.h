#pragma once

#include <optional>

#include "haptics/insertion/path_constraint.h"  // Wrench

namespace trocar::devices {

/// A wrench about S for a device that gives forces alone: its axial force kept, and that lateral force at S which turns
/// the needle about the entry point as force and torque together would (all in one frame; physics.md G10). `p_SE`: from
/// S to the entry point on the skin; none: outside, the force stays. Nearer than kLeastLever_mm the torque's share
/// fades to nothing, without a step. `axis`: unit, of the needle. Not for the compensation of the stylus' weight.
/// Real-time safe.
haptics::Wrench without_torque(const haptics::Wrench& wrench, const Vec3& axis,
                               const std::optional<Vec3>& p_SE) noexcept;
inline constexpr double kLeastLever_mm = 20.0;

}  // namespace trocar::devices
