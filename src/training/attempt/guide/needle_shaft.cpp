#include "attempt/guide/needle_shaft.h"

#include "telemetry/tick_pose.h"

namespace trocar::attempt {

std::vector<Vec3> needle_shaft(const telemetry::TickSample& sample, const telemetry::NeedleShape& shape,
                               double length_mm) {
  std::vector<Vec3> points_P = telemetry::shaft_points(shape, telemetry::device_pose(sample), length_mm);
  const Vec3 lag_P = sample.tip_mm - points_P.back();
  for (Vec3& point_P : points_P) point_P += lag_P;
  points_P.back() = sample.tip_mm;
  return points_P;
}

std::vector<Vec3> shaft_outside(std::vector<Vec3> shaft_P, double inside_mm) {
  if (!(inside_mm > 0.0)) return shaft_P;
  while (shaft_P.size() >= 2) {
    const Vec3 tip_P = shaft_P.back();
    shaft_P.pop_back();
    const Vec3 piece_P = tip_P - shaft_P.back();
    const double length_mm = piece_P.norm();
    if (inside_mm < length_mm) {
      shaft_P.push_back(tip_P - inside_mm / length_mm * piece_P);
      return shaft_P;
    }
    inside_mm -= length_mm;
  }
  return {};
}

}  // namespace trocar::attempt
