#include "xray/projection/detail/rest_lattice.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.h"

namespace trocar::xray::detail {

RestLattice::RestLattice(const motion::PatientMotion& motion, const volume::GridGeometry& now)
    : motion_(motion), now_(now) {
  for (std::size_t a = 0; a < 3; ++a) count_[a] = (now.size[a] - 1) / kStep + 2;
  nodes_.resize(static_cast<std::size_t>(count_[0] * count_[1] * count_[2]));
  const auto rows = static_cast<std::size_t>(count_[1] * count_[2]);
  parallel_for(rows, 8, [&](std::size_t first, std::size_t last) {
    for (auto row = static_cast<std::int64_t>(first); row < static_cast<std::int64_t>(last); ++row)
      for (std::int64_t i = 0; i < count_[0]; ++i)
        nodes_[static_cast<std::size_t>(row * count_[0] + i)] =
            exact(static_cast<double>(kStep) * volume::to_vec3({i, row % count_[1], row / count_[1]}));
  });
}

RestLattice::Node RestLattice::exact(const Vec3& index) const noexcept {
  const Vec3 p_A = motion_.to_rest(now_.to_mm(index));
  return {p_A.cast<float>(), static_cast<float>(1.0 / motion_.jacobian(p_A).determinant()), motion_.region(p_A)};
}

void RestLattice::row(std::int64_t j, std::int64_t k, std::span<Vec3f> rest_A, std::span<float> density) const {
  const float v = static_cast<float>(j % kStep) / kStep, w = static_cast<float>(k % kStep) / kStep;
  const auto line = [&](std::int64_t b, std::int64_t c) {
    return nodes_.data() + ((k / kStep + c) * count_[1] + j / kStep + b) * count_[0];
  };
  const std::array<const Node*, 4> lines{line(0, 0), line(1, 0), line(0, 1), line(1, 1)};
  const std::array<float, 4> weights{(1 - v) * (1 - w), v * (1 - w), (1 - v) * w, v * w};
  for (std::int64_t cell = 0; cell * kStep < now_.size[0]; ++cell) {
    Vec3f from = Vec3f::Zero(), to = Vec3f::Zero();
    float from_density = 0.0F, to_density = 0.0F;
    bool is_even = true;
    for (std::size_t n = 0; n < lines.size(); ++n) {
      const Node &a = lines[n][cell], &b = lines[n][cell + 1];
      is_even = is_even && a.region == lines[0][cell].region && b.region == lines[0][cell].region;
      from += weights[n] * a.p_A;
      to += weights[n] * b.p_A;
      from_density += weights[n] * a.density;
      to_density += weights[n] * b.density;
    }
    for (std::int64_t i = cell * kStep; i < std::min((cell + 1) * kStep, now_.size[0]); ++i) {
      const auto at = static_cast<std::size_t>(i);
      const float u = static_cast<float>(i - cell * kStep) / kStep;
      if (is_even) {
        rest_A[at] = from + u * (to - from);
        density[at] = from_density + u * (to_density - from_density);
        continue;
      }
      const Node node = exact(volume::to_vec3({i, j, k}));
      rest_A[at] = node.p_A;
      density[at] = node.density;
    }
  }
}

volume::GridGeometry grid_now(const motion::PatientMotion& motion, const volume::GridGeometry& rest) {
  constexpr std::int64_t kPlaces = 24;  // along each axis, on the faces and inside
  Eigen::AlignedBox3d box(Vec3::Zero(), volume::to_vec3(rest.size) - Vec3::Ones());
  for (std::int64_t c = 0; c <= kPlaces; ++c)
    for (std::int64_t b = 0; b <= kPlaces; ++b)
      for (std::int64_t a = 0; a <= kPlaces; ++a) {
        const Vec3 index =
            volume::to_vec3({a, b, c}).cwiseProduct(volume::to_vec3(rest.size) - Vec3::Ones()) / double{kPlaces};
        box.extend(rest.to_index(motion.to_now(rest.to_mm(index))));
      }
  volume::GridGeometry now = rest;
  const Vec3 low = box.min().array().floor(), high = box.max().array().ceil();
  now.origin_P = rest.to_mm(low);
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    now.size[a] = static_cast<std::int64_t>(high[axis] - low[axis]) + 1;
  }
  return now;
}

}  // namespace trocar::xray::detail
