#include "scene/detail/volume_copy.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace trocar::scene::detail {
namespace {

constexpr std::int16_t kAir_hu = -1000;
constexpr std::int16_t kFat_hu = -100;
constexpr std::int16_t kSoft_hu = 40;
/// Voxels farther outside the skin are table or blanket.
constexpr float kBeyondBody_mm = 1.0F;
/// Gas at this depth is not the air outside the skin.
constexpr float kInside_mm = -5.0F;
/// The partial volume edge of bone is also removed.
constexpr double kBoneEdge_mm = 2.0;

/// Labels in a block of voxels.
enum Flag : std::uint8_t { kHasBone = 1, kHasVessel = 2 };

std::array<std::uint8_t, 256> flags_of(const anatomy::LabelTable& table) {
  std::array<std::uint8_t, 256> flags{};
  for (const anatomy::Label& label : table.labels) {
    if (label.tissue == "bone" || label.tissue == "cartilage") flags[label.id] = kHasBone;
    if (label.tissue == "vessel") flags[label.id] = kHasVessel;
  }
  return flags;
}

/// Calls `act(i, j, k)` for each voxel of the grid, slices in parallel.
template <typename Act>
void for_each_voxel(const volume::GridGeometry& g, const Act& act) {
  parallel_for(static_cast<std::size_t>(g.size[2]), 4, [&](std::size_t first_k, std::size_t last_k) {
    for (auto k = static_cast<std::int64_t>(first_k); k < static_cast<std::int64_t>(last_k); ++k) {
      for (std::int64_t j = 0; j < g.size[1]; ++j) {
        for (std::int64_t i = 0; i < g.size[0]; ++i) act(i, j, k);
      }
    }
  });
}

volume::GridGeometry coarse_geometry(const volume::GridGeometry& g, const std::array<std::int64_t, 3>& steps) {
  volume::GridGeometry coarse = g;
  Vec3 first;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    coarse.size[a] = g.size[a] / steps[a];
    coarse.spacing_mm[axis] = static_cast<double>(steps[a]) * g.spacing_mm[axis];
    first[axis] = 0.5 * static_cast<double>(steps[a] - 1);
  }
  coarse.origin_P = g.to_mm(first);
  return coarse;
}

/// HU of a voxel for the volume rendering.
std::int16_t cloud_hu(const anatomy::VirtualPatient& patient, CloudContent content, std::size_t at) {
  const std::int16_t hu = patient.ct.voxels[at];
  if (patient.skin_distance_mm.empty()) return hu;
  const float skin_mm = patient.skin_distance_mm.voxels[at];
  if (skin_mm > kBeyondBody_mm) return kAir_hu;
  return content == CloudContent::kWithoutGas && skin_mm < kInside_mm ? std::max(hu, kFat_hu) : hu;
}

/// Replaces bone and its edge by soft tissue and keeps vessels next to it.
void take_bone_out(volume::CtGrid& cloud, const volume::LabelGrid& flags) {
  const volume::GridGeometry& g = cloud.geometry;
  std::array<std::int64_t, 3> reach;
  for (std::size_t a = 0; a < 3; ++a)
    reach[a] = static_cast<std::int64_t>(std::ceil(kBoneEdge_mm / g.spacing_mm[static_cast<Eigen::Index>(a)]));
  // The edge is extended along one direction after the other.
  volume::LabelGrid near = flags;
  for (std::size_t a = 0; a < 3; ++a) {
    const volume::LabelGrid before = near;
    for_each_voxel(g, [&](std::int64_t i, std::int64_t j, std::int64_t k) {
      volume::Index3 other{i, j, k};
      const std::int64_t low = std::max<std::int64_t>(0, other[a] - reach[a]);
      const std::int64_t high = std::min(g.size[a] - 1, other[a] + reach[a]);
      std::uint8_t& flag = near[{i, j, k}];
      for (other[a] = low; other[a] <= high; ++other[a])
        flag = static_cast<std::uint8_t>(flag | (before[other] & kHasBone));
    });
  }
  for_each_voxel(g, [&](std::int64_t i, std::int64_t j, std::int64_t k) {
    const volume::Index3 ijk{i, j, k};
    if (near[ijk] == kHasBone) cloud[ijk] = std::min(cloud[ijk], kSoft_hu);
  });
}

}  // namespace

CloudContent content_of(VolumePreset preset) noexcept {
  switch (preset) {
    case VolumePreset::kVessels:
      return CloudContent::kWithoutBone;
    case VolumePreset::kSkinAndBone:
      return CloudContent::kWithoutGas;
    default:
      return CloudContent::kWhole;
  }
}

std::array<std::int64_t, 3> cloud_steps(const volume::GridGeometry& ct, std::int64_t most_voxels) noexcept {
  double longest_mm = 0.0;
  for (std::size_t a = 0; a < 3; ++a)
    longest_mm = std::max(longest_mm, static_cast<double>(ct.size[a]) * ct.spacing_mm[static_cast<Eigen::Index>(a)]);
  const double edge_mm = longest_mm / static_cast<double>(std::max<std::int64_t>(1, most_voxels));
  std::array<std::int64_t, 3> steps;
  for (std::size_t a = 0; a < 3; ++a)
    steps[a] = std::clamp<std::int64_t>(std::llround(edge_mm / ct.spacing_mm[static_cast<Eigen::Index>(a)]), 1,
                                        std::max<std::int64_t>(1, ct.size[a]));
  return steps;
}

volume::CtGrid make_cloud(const anatomy::VirtualPatient& patient, CloudContent content,
                          const std::array<std::int64_t, 3>& steps) {
  const volume::GridGeometry& g = patient.ct.geometry;
  volume::CtGrid cloud(coarse_geometry(g, steps));
  const bool has_labels = content == CloudContent::kWithoutBone && !patient.labels.empty();
  const std::array<std::uint8_t, 256> flag_of_label = flags_of(patient.label_table);
  volume::LabelGrid flags;
  if (has_labels) flags = volume::LabelGrid(cloud.geometry);
  const std::int64_t count = steps[0] * steps[1] * steps[2];
  for_each_voxel(cloud.geometry, [&](std::int64_t i, std::int64_t j, std::int64_t k) {
    std::int64_t sum = 0;
    std::uint8_t flag = 0;
    for (std::int64_t n = 0; n < count; ++n) {
      const volume::Index3 ijk{i * steps[0] + n % steps[0], j * steps[1] + n / steps[0] % steps[1],
                               k * steps[2] + n / (steps[0] * steps[1])};
      const std::size_t at = g.offset(ijk);
      sum += cloud_hu(patient, content, at);
      if (has_labels) flag = static_cast<std::uint8_t>(flag | flag_of_label[patient.labels.voxels[at]]);
    }
    cloud[{i, j, k}] = static_cast<std::int16_t>(sum / count);
    if (has_labels) flags[{i, j, k}] = flag;
  });
  if (has_labels) take_bone_out(cloud, flags);
  return cloud;
}

std::vector<Vec3> skin_points(const anatomy::VirtualPatient& patient) {
  constexpr std::int64_t kStep = 4;
  const volume::FloatGrid& distance_mm = patient.skin_distance_mm;
  const volume::GridGeometry& geometry = distance_mm.geometry;
  const double near_mm = static_cast<double>(kStep) * geometry.spacing_mm.maxCoeff();
  std::vector<Vec3> points_P;
  for (std::int64_t k = 0; k < geometry.size[2]; k += kStep)
    for (std::int64_t j = 0; j < geometry.size[1]; j += kStep)
      for (std::int64_t i = 0; i < geometry.size[0]; i += kStep)
        if (std::abs(distance_mm[{i, j, k}]) < near_mm) points_P.push_back(geometry.centre_mm({i, j, k}));
  return points_P;
}

}  // namespace trocar::scene::detail
