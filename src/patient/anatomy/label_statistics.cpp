#include "anatomy/label_statistics.h"

#include <array>

namespace trocar::anatomy {
namespace {

struct Sums {
  std::size_t voxels = 0;
  std::int64_t hu = 0;
  std::size_t gas = 0, bone = 0;
  std::array<std::int64_t, 3> index{0, 0, 0};
  bool touches_border = false;
};

}  // namespace

std::vector<LabelStatistics> label_statistics(const VirtualPatient& patient) {
  const volume::GridGeometry& geometry = patient.labels.geometry;
  std::array<Sums, 256> sums{};
  std::size_t n = 0;
  for (std::int64_t k = 0; k < geometry.size[2]; ++k) {
    for (std::int64_t j = 0; j < geometry.size[1]; ++j) {
      const bool border_row = k == 0 || j == 0 || k == geometry.size[2] - 1 || j == geometry.size[1] - 1;
      for (std::int64_t i = 0; i < geometry.size[0]; ++i, ++n) {
        Sums& sum = sums[patient.labels.voxels[n]];
        ++sum.voxels;
        sum.hu += patient.ct.voxels[n];
        sum.gas += patient.ct.voxels[n] < kGasBelow_hu ? 1U : 0U;
        sum.bone += patient.ct.voxels[n] > kBoneAbove_hu ? 1U : 0U;
        sum.index[0] += i;
        sum.index[1] += j;
        sum.index[2] += k;
        sum.touches_border |= border_row || i == 0 || i == geometry.size[0] - 1;
      }
    }
  }

  std::vector<LabelStatistics> all;
  for (const Label& label : patient.label_table.labels) {
    const Sums& sum = sums[label.id];
    LabelStatistics statistics;
    statistics.id = label.id;
    statistics.voxels = sum.voxels;
    if (sum.voxels > 0) {
      const auto count = static_cast<double>(sum.voxels);
      statistics.volume_ml = count * geometry.voxel_volume_mm3() / 1000.0;
      statistics.mean_hu = static_cast<double>(sum.hu) / count;
      statistics.gas_share = static_cast<double>(sum.gas) / count;
      statistics.bone_share = static_cast<double>(sum.bone) / count;
      statistics.touches_border = sum.touches_border;
      const Vec3 index = volume::to_vec3(sum.index);
      statistics.centroid_P = geometry.to_mm(index / count);
    }
    all.push_back(statistics);
  }
  return all;
}

}  // namespace trocar::anatomy
