#pragma once

#include <limits>

/// Numbers that a device must refuse.
namespace trocar::testing {

inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace trocar::testing
