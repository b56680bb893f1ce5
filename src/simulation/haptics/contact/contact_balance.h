#pragma once

#include <array>

#include "haptics/contact/contact_column.h"

namespace trocar::haptics {

/// A point of the face at or near the skin, at the tool's last displayed pose moved with the device.
struct PressedPoint {
  Vec3 arm_P = Vec3::Zero();      ///< Vector from the tool's origin to the point.
  Vec3 normal_P = Vec3::UnitZ();  ///< Normal of the skin, unit, outwards.
  /// Tangential stretch of the skin by friction: from the point's free position to the point.
  Vec3 stretch_P = Vec3::Zero();
  Vec3 stretch_before_P = Vec3::Zero();  ///< Stretch one tick ago.
  double depth_mm = 0.0;                 ///< Below the resting skin, negative outside.
  double depth_before_mm = 0.0;          ///< Depth one tick ago, at least 0.
  double area_mm2 = 0.0;                 ///< Area projected on the plane normal to the skin's normal.
  TissueColumn column;
};

/// One step of the virtual tool between the skin and its coupling to the device (physics.md B9). The tool has no mass;
/// its speed is its step over dt, so the step is implicit.
struct ContactBalance {
  int count = 0;
  std::array<PressedPoint, kMaxContactPoints> points{};
  Vec3 offset_P = Vec3::Zero();  ///< Vector from the origin of the device's tool to the tool's origin.
  Vec3 tilt_P = Vec3::Zero();    ///< Rotation vector of the tool against the device (rad).
  CouplingParams coupling;
  double lever_mm = 1.0;
  double friction_mu = 0.0;
  double engagement = 1.0;  ///< 0..1: share of the tissue's forces.
  double dt_s = 0.001;
};

struct ContactSolution {
  Vec3 move_P = Vec3::Zero();  ///< Displacement of the tool from the pose of the points.
  Vec3 turn_P = Vec3::Zero();
  Wrench wrench_P;   ///< Wrench of the coupling on the device, about the tool's origin.
  Wrench contact_P;  ///< Wrench of the skin on the tool; equal to wrench_P in balance.
  std::array<double, kMaxContactPoints> depth_mm{};
  std::array<double, kMaxContactPoints> normal_n{};
  std::array<Vec3, kMaxContactPoints> friction_P{};
  std::array<Vec3, kMaxContactPoints> stretch_P{};
  bool hit_bound = false;  ///< The bounded iteration ended before the normal forces balanced.
};

/// Solves one monotone, convex equation along the mean normal, and linear steps across it and in rotation, in bounded
/// sweeps. Real-time safe.
ContactSolution solve(const ContactBalance& balance) noexcept;

}  // namespace trocar::haptics
