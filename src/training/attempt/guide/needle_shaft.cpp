#include "attempt/guide/needle_shaft.h"

#include <algorithm>

#include "telemetry/tick_pose.h"

namespace trocar::attempt {
namespace {

constexpr int kPoints = 17;

}  // namespace

std::vector<Vec3> needle_shaft(const telemetry::TickSample& sample, double length_mm) {
  const Vec3 grip_axis = telemetry::device_pose(sample).R().col(2);
  const Vec3 tip_axis = telemetry::felt_needle(sample).R().col(2);
  const double lag_mm = (sample.device_mm - sample.tip_mm).dot(grip_axis);
  const Vec3 hub_P = sample.device_mm - (length_mm + lag_mm) * grip_axis;
  const Vec3 way_P = sample.tip_mm - hub_P;
  const double span_mm = way_P.norm();
  std::vector<Vec3> points;
  points.reserve(kPoints);
  double bend_mm = 0.0;
  for (int i = 0; i < kPoints; ++i) {
    const double t = static_cast<double>(i) / (kPoints - 1);
    const double left = 1.0 - t;
    const Vec3 chord_P = hub_P + t * way_P;
    // Hermite curve with the chord's length, bent by the differences between end directions and chord.
    const Vec3 tangent_hub = span_mm * grip_axis - way_P, tangent_tip = span_mm * tip_axis - way_P;
    const Vec3 bend = t * left * (left * tangent_hub - t * tangent_tip);
    bend_mm = std::max(bend_mm, bend.norm());
    points.push_back(chord_P + bend);
  }
  if (bend_mm < kShaftBends_mm) return {hub_P, sample.tip_mm};
  points.back() = sample.tip_mm;
  return points;
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
