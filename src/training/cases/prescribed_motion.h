#pragma once

#include "geometry/pose.h"
#include "geometry/segment.h"
#include "haptics/tick.h"

namespace trocar::cases {

/// Moves a device along a needle path at constant speed, independent of forces (open loop), so that two scenes get the
/// same poses: from `before_mm` outside the skin to the path's end, with smooth drift and tilt inside the body, which
/// exercise the path constraint and the shaft.
struct PrescribedMotion {
  Segment line_P{Vec3::Zero(), Vec3::Zero()};  ///< Skin -> target.
  double speed_mm_per_s = 10.0;                ///< Range 0.1..500.
  double dt_s = 0.001;
  double before_mm = 10.0;
  double after_mm = 0.0;           ///< Distance straight on past the path's end.
  Vec3 drift_P = Vec3::Zero();     ///< Drift of the tip at the path's end, across the path.
  Vec3 tilt_rad_P = Vec3::Zero();  ///< Rotation vector about the tip at the path's end.
};

int tick_count(const PrescribedMotion& motion) noexcept;
/// Position of the tip along the path at a tick (1 = the first), mm; negative outside the skin.
double way_mm(const PrescribedMotion& motion, int tick) noexcept;
/// Input from the device to the scene at that tick.
haptics::HapticInput input_at(const PrescribedMotion& motion, int tick) noexcept;

}  // namespace trocar::cases
