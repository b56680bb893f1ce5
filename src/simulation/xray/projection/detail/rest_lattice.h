#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "motion/patient_motion.h"
#include "volume/grid.h"

namespace trocar::xray::detail {

/// Where the tissue at each voxel of a grid that is in the patient now is at rest. Exact at every kStep-th voxel along
/// each axis; between eight of these trilinear if they belong to one region, else exact.
class RestLattice {
 public:
  static constexpr std::int64_t kStep = 6;

  /// All cores.
  RestLattice(const motion::PatientMotion& motion, const volume::GridGeometry& now);

  /// Tissue at rest (frame A, mm) of the voxels of row (j, k), and its density now relative to rest: 1/det J.
  void row(std::int64_t j, std::int64_t k, std::span<Vec3f> rest_A, std::span<float> density) const;

 private:
  struct Node {
    Vec3f p_A;
    float density;
    int region;
  };
  Node exact(const Vec3& index) const noexcept;

  const motion::PatientMotion& motion_;
  volume::GridGeometry now_;
  volume::Index3 count_;
  std::vector<Node> nodes_;
};

/// Grid with the spacing and directions of `rest` that contains all of its tissue now.
volume::GridGeometry grid_now(const motion::PatientMotion& motion, const volume::GridGeometry& rest);

}  // namespace trocar::xray::detail
