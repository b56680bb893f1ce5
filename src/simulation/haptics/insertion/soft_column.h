#pragma once

#include <array>

#include "haptics/patient_now.h"

namespace trocar::haptics {

/// The soft tissue below a layer that the tip presses on: cells in series along the needle, each of which is compressed
/// under its share of the load (physics.md P6). Fixed size; no cell: rigid.
struct SoftColumn {
  int cells = 0;
  double area_mm2 = 1.0;  ///< Of the disc that carries the load.
  std::array<double, kColumnCells> thickness_mm{};
  std::array<double, kColumnCells> share{};            ///< Share of the load at the cell's depth, 0..1.
  std::array<double, kColumnCells> plane_n_per_mm2{};  ///< E/(1 - nu^2) > 0.

  /// Depression (mm) of the column's surface under a force (N); 0 for a force <= 0. Concave and bounded by the column's
  /// length: soft tissue cannot be compressed to less than nothing. Real-time safe.
  double depression_mm(double force_n) const noexcept;
};

/// Column of the tissue along `inward_P` (unit) from a point on a layer, loaded over a disc. Ends at rigid tissue, at
/// fluid or gas (modulus 0: they are displaced, not compressed) or after kColumn_mm. Soft tissue has at least the
/// modulus `least_kpa`. Real-time safe.
SoftColumn soft_column(const PatientNow& now, const Vec3& surface_P, const Vec3& inward_P, double radius_mm,
                       double least_kpa = 0.0) noexcept;

/// Time constant with which the compressed tissue recoils after a puncture. Range 0.05..0.5. [assumed]
inline constexpr double kTissueRecoil_s = 0.2;

}  // namespace trocar::haptics
