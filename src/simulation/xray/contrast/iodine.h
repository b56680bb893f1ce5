#pragma once

#include <memory>
#include <vector>

#include "geometry/vec.h"
#include "volume/grid.h"

namespace trocar::xray {

inline constexpr double kMm3PerMl = 1000.0;

/// A piece of a duct or vessel filled with contrast agent: a truncated cone with round ends.
struct IodinePiece {
  Vec3 a_P, b_P;
  double radius_a_mm = 1.0, radius_b_mm = 1.0;
  double iodine_mg_per_ml = 0.0;
};

/// Contrast agent in the body at one moment: in ducts and vessels as pieces, elsewhere as grids (mg iodine per ml)
/// that cover only where it is and add up: one of tissue, one of fluid. All may be empty.
struct Iodine {
  std::vector<IodinePiece> pieces;
  std::vector<std::shared_ptr<const volume::FloatGrid>> grids_mg_per_ml;
};

}  // namespace trocar::xray
