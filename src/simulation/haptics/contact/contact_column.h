#pragma once

#include "haptics/haptic_scene.h"

namespace trocar::haptics {

/// The tissue that carries a unit of area of a tool's face (physics.md B9).
struct TissueColumn {
  double stiffness_n_per_mm3 = 0.0;  ///< Pressure a mm of indentation, for small ones.
  double length_mm = kColumn_mm;     ///< Down to what is rigid, or kColumn_mm: it cannot be pressed flatter than that.
  double stiffening_per_mm = 0.0;    ///< >= 0: how much earlier the soft layers are flat than all of the column.
};

/// Pressure (N/mm^2) and its derivative (N/mm^3).
struct ColumnResponse {
  double pressure = 0.0;
  double tangent = 0.0;
};

inline constexpr double kRigid_kpa = 1e4;    ///< Modulus from which on tissue is rigid and ends the column (bone).
                                             ///< [assumed]
inline constexpr double kSoftest_kpa = 1.0;  ///< Fluid and gas are held by what is around them. Range 0.2..3. [assumed]
inline constexpr double kPoisson = 0.5;      ///< Soft tissue hardly changes its volume.

/// Column under a point of the skin, looking inwards (unit vector), loaded by the scene's face: layers in series. At
/// most kColumnCells samples and a few to find the bone's border. Real-time safe.
TissueColumn tissue_column(const HapticScene& scene, const Vec3& skin_point_P, const Vec3& inward_P) noexcept;

/// Of a column pressed by `indentation_mm`: k p (1 + q p)/(1 - p/L), from 98 % of L on its tangent; zero below zero.
/// Convex, without steps. Real-time safe.
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

}  // namespace trocar::haptics
