#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "anatomy/patient.h"
#include "geometry/vec.h"

namespace trocar::anatomy {

inline constexpr int kGasBelow_hu = -300;
inline constexpr int kBoneAbove_hu = 350;

/// One line for each label: voxels, volume, extent; used by `patient show` and `patient check`.
struct LabelStatistics {
  std::uint8_t id = 0;
  std::size_t voxels = 0;
  double volume_ml = 0.0;
  double mean_hu = 0.0;
  double gas_share = 0.0;   ///< Of its voxels, below kGasBelow_hu.
  double bone_share = 0.0;  ///< Of its voxels, above kBoneAbove_hu.
  bool touches_border = false;
  Vec3 centroid_P = Vec3::Zero();
};
std::vector<LabelStatistics> label_statistics(const VirtualPatient& patient);

}  // namespace trocar::anatomy
