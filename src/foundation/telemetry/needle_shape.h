#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/pose.h"

namespace trocar::telemetry {

/// How the shaft of a needle is bent at a tick, as the haptic tick computes it (physics.md B8): distances of its points
/// from the straight needle of the device. Equal spans from the grip (point 0, beside_mm = 0) to the tip; they keep
/// their length. Fixed size.
struct NeedleShape {
  static constexpr std::size_t kMostSpans = 33;
  double time_s = 0.0;     ///< Of its tick.
  std::uint8_t spans = 0;  ///< 0: straight.
  /// x and y in N of the device's needle, points 1 to `spans`. |x|, |y| <= kMostBeside_mm.
  std::array<std::array<float, 2>, kMostSpans> beside_mm{};
  bool operator==(const NeedleShape&) const = default;
};
inline constexpr double kMostBeside_mm = 1000.0;

/// Largest distance (mm) between the points of two shapes of the same number of spans; a straight one has any number.
double largest_difference_mm(const NeedleShape& a, const NeedleShape& b) noexcept;

/// The shaft's points in P, grip first, tip last, for the needle of the device at X_PN; two for a straight one.
std::vector<Vec3> shaft_points(const NeedleShape& shape, const Pose& X_PN, double length_mm);

}  // namespace trocar::telemetry
