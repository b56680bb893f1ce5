#pragma once

#include <cstdint>
#include <functional>

#include "geometry/pose.h"
#include "volume/grid.h"

namespace trocar::registration::testing {

/// A CT and an ultrasound volume of one generated anatomy, at a known pose.
struct GeneratedPair {
  volume::CtGrid ct;
  volume::LabelGrid us;  ///< Beams along +y.
  Pose X_CU;             ///< Points of the ultrasound to points of the CT.
};

struct PairOptions {
  std::int64_t size = 64;  ///< Voxels of an edge of both volumes.
  double spacing_mm = 2.0;
  double offset_mm = 0.0;   ///< Of the ultrasound's header from the true pose, in a random direction.
  double offset_rad = 0.0;  ///< The same, about a random axis through the middle.
  bool has_bone = true;     ///< Ribs with shadows behind them.
  std::uint64_t seed = 1;   ///< Of the anatomy, the offset and the speckle.
  /// Displacement (mm) of the anatomy at a point of the true CT frame while the ultrasound is taken; empty: none.
  std::function<Vec3(const Vec3&)> warp;
};

/// Random ellipsoids of organs and vessels in fat, each tissue with HU and an echogenicity unrelated to it; Rayleigh
/// speckle with a point spread of about a voxel, logarithmic gray levels, and dark shadows behind bone.
GeneratedPair make_pair(const PairOptions& options);

}  // namespace trocar::registration::testing
