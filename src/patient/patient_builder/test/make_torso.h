#pragma once

#include <cmath>

#include "volume/grid.h"

namespace trocar::patient_builder {

/// A trunk of simple shapes for tests: elliptic, 300 x 220 mm, at belly and back 20 mm of fat around 15 mm of muscle (a
/// third more at the sides) around a cavity of visceral fat with a "liver", a lung and a gas-filled bowel in it; below
/// its back a CT table, over its belly a sheet.
struct Torso {
  static constexpr double kHalfWidthMm = 150.0;
  static constexpr double kHalfDepthMm = 110.0;
  static constexpr std::int16_t kAir = -1000, kLung = -820, kGas = -990, kFat = -100, kMuscle = 55, kLiver = 110,
                                kTable = 150, kCloth = -150;
  double table_gap_mm = 12.0;  ///< Between the back and the table.
  double sheet_gap_mm = 6.0;   ///< Between the belly and the sheet.
  bool has_lung = true;

  /// Ellipse radius of a point in the axial plane: 1 on the skin.
  static double radius(const Vec3& p_P) { return std::hypot(p_P.x() / kHalfWidthMm, p_P.y() / kHalfDepthMm); }
  static bool is_inside(const Vec3& p_P) { return radius(p_P) < 1.0; }
  static bool is_liver(const Vec3& p_P) { return (p_P - Vec3(-50.0, -10.0, p_P.z())).norm() < 40.0; }
  bool is_lung(const Vec3& p_P) const { return has_lung && (p_P - Vec3(60.0, 20.0, p_P.z())).norm() < 35.0; }
  static bool is_bowel_gas(const Vec3& p_P) { return (p_P - Vec3(45.0, -45.0, 0.0)).norm() < 14.0; }

  std::int16_t hu(const Vec3& p_P) const {
    if (is_inside(p_P)) {
      if (is_liver(p_P)) return kLiver;
      if (is_lung(p_P)) return kLung;
      if (is_bowel_gas(p_P)) return kGas;
      const double depth_mm = (1.0 - radius(p_P)) * kHalfDepthMm;
      return depth_mm < 20.0 || depth_mm > 35.0 ? kFat : kMuscle;
    }
    // The table: a curved plate, 5 mm thick, 400 mm wide; y points to the back.
    const double table_y_mm = kHalfDepthMm + table_gap_mm - p_P.x() * p_P.x() / 1500.0;
    if (std::abs(p_P.x()) < 200.0 && p_P.y() >= table_y_mm && p_P.y() < table_y_mm + 5.0) return kTable;
    // The sheet: a plane 3 mm thick over the belly.
    if (p_P.y() < -kHalfDepthMm - sheet_gap_mm && p_P.y() > -kHalfDepthMm - sheet_gap_mm - 3.0) return kCloth;
    return kAir;
  }

  static volume::GridGeometry grid(const Vec3& spacing_mm, double length_mm = 120.0) {
    volume::GridGeometry geometry;
    const Vec3 extent_mm(440.0, 320.0, length_mm);
    for (int a = 0; a < 3; ++a)
      geometry.size[static_cast<std::size_t>(a)] = static_cast<std::int64_t>(std::floor(extent_mm[a] / spacing_mm[a]));
    geometry.spacing_mm = spacing_mm;
    geometry.origin_P = -0.5 * extent_mm + 0.5 * spacing_mm;
    return geometry;
  }

  volume::CtGrid ct(const volume::GridGeometry& geometry) const {
    volume::CtGrid grid(geometry);
    for_each(geometry, [&](std::size_t n, const Vec3& p_P) { grid.voxels[n] = hu(p_P); });
    return grid;
  }

  /// Calls visit(offset, point) for every voxel.
  static void for_each(const volume::GridGeometry& geometry, const auto& visit) {
    for (std::size_t n = 0; n < geometry.voxel_count(); ++n) {
      const volume::Index3 ijk = geometry.index_of(n);
      visit(n, geometry.centre_mm(ijk));
    }
  }

  static volume::LabelGrid mask(const volume::GridGeometry& geometry, const auto& is_set, std::uint8_t value = 1) {
    volume::LabelGrid grid(geometry);
    for_each(geometry, [&](std::size_t n, const Vec3& p_P) { grid.voxels[n] = is_set(p_P) ? value : 0; });
    return grid;
  }
};

}  // namespace trocar::patient_builder
