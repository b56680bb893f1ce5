#include "anatomy/plausibility/detail/label_shapes.h"

#include <Eigen/Eigenvalues>
#include <memory>
#include <mutex>
#include <numbers>

#include "core/parallel.h"

namespace trocar::anatomy::detail {
namespace {

/// Sums over the voxels of a label, in voxels: n, i, j, k, ii, jj, kk, ij, ik, jk.
using Sums = std::array<double, 10>;
using AllSums = std::array<Sums, 256>;

void add_slice(const volume::LabelGrid& labels, std::int64_t k, AllSums& all) {
  const volume::GridGeometry& g = labels.geometry;
  const auto z = static_cast<double>(k);
  std::size_t n = g.offset({0, 0, k});
  for (std::int64_t j = 0; j < g.size[1]; ++j)
    for (std::int64_t i = 0; i < g.size[0]; ++i, ++n) {
      if (labels.voxels[n] == 0) continue;
      Sums& sum = all[labels.voxels[n]];
      const auto x = static_cast<double>(i), y = static_cast<double>(j);
      const Sums values{1.0, x, y, z, x * x, y * y, z * z, x * y, x * z, y * z};
      for (std::size_t m = 0; m < values.size(); ++m) sum[m] += values[m];
    }
}

LabelShape shape_of(const Sums& sum, const volume::GridGeometry& g) {
  LabelShape shape;
  shape.voxels = sum[0];
  if (sum[0] == 0.0) return shape;
  const Vec3 middle = Vec3(sum[1], sum[2], sum[3]) / sum[0];
  shape.middle_P = g.to_mm(middle);
  Mat3 squares;
  squares << sum[4], sum[7], sum[8], sum[7], sum[5], sum[9], sum[8], sum[9], sum[6];
  // A voxel is not a point: its own moment is a twelfth.
  const Mat3 in_voxels = squares / sum[0] - middle * middle.transpose() + Mat3::Identity() / 12.0;
  const Mat3 spread_mm2 = g.spacing_mm.asDiagonal() * in_voxels * g.spacing_mm.asDiagonal();
  const Vec3 variances = Eigen::SelfAdjointEigenSolver<Mat3>(spread_mm2, Eigen::EigenvaluesOnly).eigenvalues();
  shape.axes_mm = 2.0 * (5.0 * variances.cwiseMax(0.0)).cwiseSqrt();  // a solid ellipsoid's variance is (a/2)^2 / 5
  shape.fullness = sum[0] * g.voxel_volume_mm3() / (std::numbers::pi / 6.0 * shape.axes_mm.prod());
  return shape;
}

}  // namespace

LabelShapes find_label_shapes(const volume::LabelGrid& labels) {
  const volume::GridGeometry& g = labels.geometry;
  // Whole numbers below 2^53: the order in which the parts are added does not matter.
  AllSums all{};
  std::mutex adding;
  parallel_for(static_cast<std::size_t>(g.size[2]), 8, [&](std::size_t first, std::size_t last) {
    const auto part = std::make_unique<AllSums>();
    for (std::size_t k = first; k < last; ++k) add_slice(labels, static_cast<std::int64_t>(k), *part);
    const std::scoped_lock lock(adding);
    for (std::size_t id = 0; id < all.size(); ++id)
      for (std::size_t m = 0; m < all[id].size(); ++m) all[id][m] += (*part)[id][m];
  });
  LabelShapes shapes;
  for (std::size_t id = 1; id < all.size(); ++id) shapes[id] = shape_of(all[id], g);
  return shapes;
}

}  // namespace trocar::anatomy::detail
