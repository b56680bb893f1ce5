#pragma once

#include <array>

#include "haptics/haptic_scene.h"

namespace trocar::haptics {

/// The tissue that carries a unit of area of a tool's face (physics.md B9).
struct TissueColumn {
  double stiffness_n_per_mm3 = 0.0;  ///< Pressure per mm of indentation, at small indentation.
  double length_mm = kColumn_mm;     ///< Length down to rigid tissue, or kColumn_mm: upper bound of the indentation.
  /// >= 0. Stiffening because the soft layers are fully compressed before the whole column.
  double stiffening_per_mm = 0.0;
};

/// Pressure (N/mm^2) and its derivative (N/mm^3).
struct ColumnResponse {
  double pressure = 0.0;
  double tangent = 0.0;
};

/// Smallest modulus of rigid tissue, which ends the column (bone). [assumed]
inline constexpr double kRigid_kpa = 1e4;
/// Lower limit of the modulus: surrounding tissue supports fluid and gas. Range 0.2..3. [assumed]
inline constexpr double kSoftest_kpa = 1.0;
inline constexpr double kPoisson = 0.5;  ///< Soft tissue is nearly incompressible.

/// Column under a point of the skin along `inward_P` (unit vector), loaded by the scene's face: layers in series. Takes
/// at most kColumnCells samples and a few more to find the bone's border. Real-time safe.
TissueColumn tissue_column(const PatientNow& now, const Vec3& skin_point_P, const Vec3& inward_P) noexcept;

/// Response of a column pressed by `indentation_mm` (p): k p (1 + q p)/(1 - p/L), from 98 % of L on along its tangent;
/// zero below zero. Convex, without steps. Real-time safe.
inline ColumnResponse respond(const TissueColumn& column, double indentation_mm) noexcept {
  if (!(indentation_mm > 0.0)) return {};
  constexpr double kMaxStrain = 0.98;
  const double flat_mm = kMaxStrain * column.length_mm;
  const double p = indentation_mm < flat_mm ? indentation_mm : flat_mm;
  const double shorter = 1.0 / (column.length_mm - p);
  const double k = column.stiffness_n_per_mm3 * column.length_mm * shorter;
  const double pressure = k * p * (1.0 + column.stiffening_per_mm * p);
  const double tangent = k * (1.0 + 2.0 * column.stiffening_per_mm * p) + pressure * shorter;
  return {pressure + (indentation_mm - p) * tangent, tangent};
}

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
  stylus::CouplingParams coupling;
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
