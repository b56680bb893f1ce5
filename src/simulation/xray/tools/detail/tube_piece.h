#pragma once

#include <vector>

#include "xray/geometry/c_arm.h"

namespace trocar::xray::detail {

inline constexpr double kMg_per_g = 1000.0;  ///< Iodine is given in mg/ml, densities are in g/cm³.

/// A straight piece of a tube: a truncated cone around an axis, cut by a plane at each end.
struct TubePiece {
  Vec3 a_P = Vec3::Zero();         ///< Start of the axis.
  Vec3 axis_P = Vec3::UnitZ();     ///< Unit vector along the axis.
  double length_mm = 0.0;          ///< > 0.
  double radius_a_mm = 0.0;        ///< Radius at the start and
  double radius_b_mm = 0.0;        ///< at the end of the axis.
  Vec3 start_tilt = Vec3::Zero();  ///< At the offset q from the axis, the piece begins at -q · start_tilt and
  Vec3 end_tilt = Vec3::Zero();    ///< ends at length_mm - q · end_tilt. Both vectors are perpendicular to the axis.
  double end_softness_mm = 0.0;    ///< Width over which an end fades, the same on both sides of it. 0: sharp.
  bool has_free_end = false;       ///< An end does not meet another piece.
  double density_g_per_cm3 = 0.0;  ///< May be negative: a bore is subtracted from its tube.
};

/// Pixels of an image, of which the rows [first_row, last_row) are written.
struct PixelRows {
  const XrayRays& rays;
  int first_row, last_row;
  std::vector<float>& g_per_cm2;

  float& at(int column, int row) const noexcept {
    return g_per_cm2[static_cast<std::size_t>(row) * static_cast<std::size_t>(rays.columns) +
                     static_cast<std::size_t>(column)];
  }
};

/// Adds the mass per area of a piece: the chord of each ray, averaged over a pixel's surroundings with weights
/// that fall linearly to the neighbours, as light in a scintillator spreads: this keeps mass and place of a thin wire.
/// Pieces that reach behind the source are left out.
void add_piece(const TubePiece& piece, const PixelRows& pixels);

/// Pieces of the tube around a line; neighbours meet in the plane that halves their angle, so that nothing is missing
/// or counted twice. Points that repeat are skipped.
std::vector<TubePiece> pieces_along(const std::vector<Vec3>& line_P, double radius_mm, double density_g_per_cm3);

/// Adds all pieces, on all cores. The sum does not depend on the number of threads.
void add_pieces(const std::vector<TubePiece>& pieces, const XrayRays& rays, std::vector<float>& g_per_cm2);

}  // namespace trocar::xray::detail
