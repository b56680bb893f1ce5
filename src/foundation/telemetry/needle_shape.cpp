#include "telemetry/needle_shape.h"

#include <algorithm>
#include <cmath>

namespace trocar::telemetry {

double largest_difference_mm(const NeedleShape& a, const NeedleShape& b) noexcept {
  double largest = 0.0;
  for (std::size_t i = 0; i < std::min<std::size_t>(std::max(a.spans, b.spans), NeedleShape::kMostSpans); ++i) {
    const auto at = [i](const NeedleShape& shape, std::size_t axis) {
      return i < shape.spans ? static_cast<double>(shape.beside_mm[i][axis]) : 0.0;
    };
    largest = std::max(largest, std::hypot(at(a, 0) - at(b, 0), at(a, 1) - at(b, 1)));
  }
  return largest;
}

std::vector<Vec3> shaft_points(const NeedleShape& shape, const Pose& X_PN, double length_mm) {
  const std::size_t spans = std::min<std::size_t>(shape.spans, NeedleShape::kMostSpans);
  Vec3 at_N(0.0, 0.0, -length_mm);
  std::vector<Vec3> points_P{X_PN * at_N};
  if (spans == 0) return {points_P.front(), X_PN.p()};
  points_P.reserve(spans + 1);
  const double span_mm = length_mm / static_cast<double>(spans);
  for (std::size_t i = 0; i < spans; ++i) {
    const Vec3 beside_N(shape.beside_mm[i][0], shape.beside_mm[i][1], 0.0);
    const double across_mm2 = (beside_N - Vec3(at_N.x(), at_N.y(), 0.0)).squaredNorm();
    const double along_mm = std::sqrt(std::max(0.0, span_mm * span_mm - across_mm2));
    at_N = beside_N + Vec3(0.0, 0.0, at_N.z() + along_mm);
    points_P.push_back(X_PN * at_N);
  }
  return points_P;
}

}  // namespace trocar::telemetry
