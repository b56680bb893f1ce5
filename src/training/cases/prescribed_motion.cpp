#include "cases/prescribed_motion.h"

#include <algorithm>
#include <cmath>

namespace trocar::cases {
namespace {

/// 0 at the skin, 1 at the path's end, with continuous speed.
double share_of_drift(const PrescribedMotion& motion, double s_mm) noexcept {
  const double x = std::clamp(s_mm / std::max(motion.line_P.length_mm(), 1e-9), 0.0, 1.0);
  return x * x * (3.0 - 2.0 * x);
}

}  // namespace

int tick_count(const PrescribedMotion& motion) noexcept {
  const double step_mm = motion.speed_mm_per_s * motion.dt_s;
  return static_cast<int>((motion.before_mm + motion.line_P.length_mm() + motion.after_mm) / step_mm);
}

double way_mm(const PrescribedMotion& motion, int tick) noexcept {
  return motion.speed_mm_per_s * motion.dt_s * tick - motion.before_mm;
}

haptics::HapticInput input_at(const PrescribedMotion& motion, int tick) noexcept {
  const double s_mm = way_mm(motion, tick);
  const double share = share_of_drift(motion, s_mm);
  const Vec3 axis_P = motion.line_P.direction();
  const Vec3 tip_P = motion.line_P.a + s_mm * axis_P + share * motion.drift_P;
  const double angle_rad = share * motion.tilt_rad_P.norm();
  Mat3 R_PN = needle_pose(tip_P, axis_P).R();
  if (angle_rad > 0.0) R_PN = Eigen::AngleAxisd(angle_rad, motion.tilt_rad_P.normalized()).toRotationMatrix() * R_PN;
  haptics::HapticInput input;
  input.time_s = motion.dt_s * tick;
  input.dt_s = motion.dt_s;
  input.tool = telemetry::to_tool_pose({R_PN, tip_P});
  return input;
}

}  // namespace trocar::cases
