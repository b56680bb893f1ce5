#pragma once

#include <array>

#include "haptics/contact/contact_column.h"

namespace trocar::haptics {

/// A point of the face at or near the skin, with the tool as it was shown last, carried along by the device.
struct PressedPoint {
  Vec3 arm_P = Vec3::Zero();             ///< From the tool's origin.
  Vec3 normal_P = Vec3::UnitZ();         ///< Of the skin, unit, outwards.
  Vec3 stretch_P = Vec3::Zero();         ///< Of the skin by friction: from where the point would be free, tangential.
  Vec3 stretch_before_P = Vec3::Zero();  ///< A tick ago.
  double depth_mm = 0.0;                 ///< Below the resting skin, negative outside.
  double depth_before_mm = 0.0;          ///< A tick ago, at least 0.
  double area_mm2 = 0.0;                 ///< Across the normal.
  TissueColumn column;
};

/// One step of the virtual tool between the skin and its coupling to the device (physics.md B9). The tool has no mass;
/// its speed is its step over dt, so the step is implicit.
struct ContactBalance {
  int count = 0;
  std::array<PressedPoint, kMaxContactPoints> points{};
  Vec3 offset_P = Vec3::Zero();  ///< Tool's origin from the device's.
  Vec3 tilt_P = Vec3::Zero();    ///< Rotation vector of the tool against the device (rad).
  CouplingParams coupling;
  double lever_mm = 1.0;
  double friction_mu = 0.0;
  double engagement = 1.0;  ///< 0..1: share of the tissue's forces.
  double dt_s = 0.001;
};

struct ContactSolution {
  Vec3 move_P = Vec3::Zero();  ///< Of the tool against the pose of the points.
  Vec3 turn_P = Vec3::Zero();
  Wrench wrench_P;   ///< Of the coupling, on the device, about the tool's origin.
  Wrench contact_P;  ///< Of the skin on the tool: the same, once balanced.
  std::array<double, kMaxContactPoints> depth_mm{};
  std::array<double, kMaxContactPoints> normal_n{};
  std::array<Vec3, kMaxContactPoints> friction_P{};
  std::array<Vec3, kMaxContactPoints> stretch_P{};
  bool hit_bound = false;  ///< The bounded iteration ended before normal forces balanced.
};

/// Along the mean normal one monotone, convex equation, across it and in rotation linear steps, in bounded sweeps.
/// Real-time safe.
ContactSolution solve(const ContactBalance& balance) noexcept;

}  // namespace trocar::haptics
