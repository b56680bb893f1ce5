#include "xray/projection/moved_volume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/parallel.h"
#include "xray/projection/detail/rest_lattice.h"
#include "xray/projection/detail/row_stack.h"

namespace trocar::xray {
namespace {

using Densities = Eigen::Array2f;  ///< Of water and bone, in kPackedUnit_g_per_cm3.

Densities unpack(detail::PackedVoxel voxel) noexcept {
  const auto bits = static_cast<std::uint32_t>(voxel);
  return {static_cast<float>(static_cast<std::int16_t>(bits & 0xFFFFU)),
          static_cast<float>(static_cast<std::int16_t>(bits >> 16))};
}

detail::PackedVoxel pack(const Densities& densities) noexcept {
  const auto rounded = [](float value) {
    constexpr float kLimit = 32767.0F;
    return static_cast<std::uint32_t>(
        static_cast<std::uint16_t>(static_cast<std::int16_t>(std::lround(std::clamp(value, -kLimit, kLimit)))));
  };
  return static_cast<detail::PackedVoxel>(rounded(densities[1]) << 16 | rounded(densities[0]));
}

/// Trilinear; beyond the volume there is nothing.
Densities sample(const detail::RowStack<detail::PackedVoxel>& stack, const Vec3f& index) noexcept {
  const Vec3f low = index.array().floor();
  const Vec3f part = index - low;
  const auto i = static_cast<std::int64_t>(low.x()), j = static_cast<std::int64_t>(low.y()),
             k = static_cast<std::int64_t>(low.z());
  Densities sum = Densities::Zero();
  for (std::int64_t n = 0; n < 4; ++n) {
    const std::int64_t a = j + (n & 1), b = k + n / 2;
    if (a < 0 || b < 0 || a >= stack.size_a || b >= stack.size_b) continue;
    const detail::RowSpan& row = stack.rows[static_cast<std::size_t>(a + b * stack.size_a)];
    const float weight = ((n & 1) != 0 ? part.y() : 1.0F - part.y()) * (n / 2 != 0 ? part.z() : 1.0F - part.z());
    const detail::PackedVoxel* const voxels = stack.voxels.data() + row.first;
    if (i >= row.begin && i < row.end) sum += weight * (1.0F - part.x()) * unpack(voxels[i]);
    if (i + 1 >= row.begin && i + 1 < row.end) sum += weight * part.x() * unpack(voxels[i + 1]);
  }
  return sum;
}

/// Calls take(offset, index at rest, density) for each voxel of a grid in the patient now.
template <class Take>
void for_voxels(const motion::PatientMotion& motion, const volume::GridGeometry& rest, const volume::GridGeometry& now,
                const Take& take) {
  const detail::RestLattice lattice(motion, now);
  const Eigen::Matrix3f to_index = (rest.spacing_mm.cwiseInverse().asDiagonal() * rest.R_PV.transpose()).cast<float>();
  const Vec3f shift = -to_index * rest.origin_P.cast<float>();
  parallel_for(static_cast<std::size_t>(now.size[2]), 1, [&](std::size_t first, std::size_t last) {
    std::vector<Vec3f> rest_A(static_cast<std::size_t>(now.size[0]));
    std::vector<float> density(rest_A.size());
    for (auto k = static_cast<std::int64_t>(first); k < static_cast<std::int64_t>(last); ++k)
      for (std::int64_t j = 0; j < now.size[1]; ++j) {
        lattice.row(j, k, rest_A, density);
        const std::size_t row = now.offset({0, j, k});
        for (std::size_t i = 0; i < rest_A.size(); ++i) take(row + i, Vec3f(to_index * rest_A[i] + shift), density[i]);
      }
  });
}

}  // namespace

std::shared_ptr<const XrayVolume> moved_volume(std::shared_ptr<const XrayVolume> rest,
                                               const motion::PatientMotion& motion) {
  if (motion.is_rest()) return rest;
  const XrayVolume::Impl& from = rest->impl();
  auto impl = std::make_shared<XrayVolume::Impl>();
  impl->geometry = detail::grid_now(motion, from.geometry);
  impl->patient = from.patient;
  impl->motion = motion;
  std::vector<detail::PackedVoxel> voxels(impl->geometry.voxel_count());
  for_voxels(motion, from.geometry, impl->geometry, [&](std::size_t n, const Vec3f& index, float density) {
    const Densities densities = sample(from.rows, index);
    voxels[n] = (densities == 0.0F).all() ? 0 : pack(density * densities);
  });
  impl->fill([&](std::size_t n) { return voxels[n]; });
  return std::make_shared<const XrayVolume>(std::move(impl));
}

volume::FloatGrid moved_grid(const volume::FloatGrid& rest, const motion::PatientMotion& motion) {
  if (motion.is_rest() || rest.empty()) return rest;
  volume::FloatGrid now(detail::grid_now(motion, rest.geometry));
  const volume::Index3& size = rest.geometry.size;
  for_voxels(motion, rest.geometry, now.geometry, [&](std::size_t n, const Vec3f& index, float density) {
    const Vec3f low = index.array().floor(), part = index - low;
    float sum = 0.0F;
    for (std::int64_t c = 0; c < 8; ++c) {
      const volume::Index3 ijk{static_cast<std::int64_t>(low.x()) + (c & 1),
                               static_cast<std::int64_t>(low.y()) + (c >> 1 & 1),
                               static_cast<std::int64_t>(low.z()) + (c >> 2)};
      if (ijk[0] < 0 || ijk[1] < 0 || ijk[2] < 0 || ijk[0] >= size[0] || ijk[1] >= size[1] || ijk[2] >= size[2])
        continue;
      sum += rest[ijk] * ((c & 1) != 0 ? part.x() : 1.0F - part.x()) *
             ((c >> 1 & 1) != 0 ? part.y() : 1.0F - part.y()) * (c >> 2 != 0 ? part.z() : 1.0F - part.z());
    }
    now.voxels[n] = density * sum;
  });
  return now;
}

}  // namespace trocar::xray
