#pragma once

#include <cstdint>
#include <vector>

#include "geometry/shapes.h"
#include "geometry/vec.h"

namespace trocar::registration {

/// Straight tube with round ends.
struct Rod {
  Segment axis_W;
  double radius_mm = 3.0;
};

struct Ellipsoid {
  Vec3 centre_W{0, 0, 0};
  Mat3 R_WE = Mat3::Identity();  ///< Columns: half axes' directions.
  Vec3 half_mm{5, 5, 5};
  double level_db = 6.0;  ///< Above the tissue around it.
};

/// Tissue with vessels, ellipsoids and bone rods in a frame W (mm): the contents of generated ultrasound volumes.
struct TissueScene {
  std::vector<Rod> vessels;  ///< Parts of the vessels' paths.
  std::vector<Ellipsoid> ellipsoids;
  std::vector<Rod> bones;
  std::uint64_t seed = 1;

  /// Echo level without speckle and shadow, dB relative to plain tissue.
  double level_db(const Vec3& p_W) const noexcept;
};

struct SceneOptions {
  Vec3 first_W{0, 0, 0}, last_W{200, 100, 100};  ///< Box that the contents lie in.
  int vessels = 10;
  int ellipsoids = 14;
  int bones = 3;  ///< In the part of the box at the smallest coordinate of `bone_axis`.
  int bone_axis = 2;
};

/// A random scene; the same for the same seed.
TissueScene make_tissue_scene(const SceneOptions& options, std::uint64_t seed);

}  // namespace trocar::registration
