#pragma once

namespace trocar::devices {

inline constexpr double kMmPerM = 1000.0;

}  // namespace trocar::devices
