#pragma once

#include "haptics/patient_now.h"

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

}  // namespace trocar::haptics
