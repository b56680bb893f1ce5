#include "volume/spline_field.h"

#include <cmath>

namespace trocar::volume {

SplineWeights spline_weights(const GridGeometry& lattice, const Vec3& p) noexcept {
  SplineWeights result;
  const Vec3 index = lattice.to_index(p);
  result.is_inside = index.allFinite();
  for (std::size_t a = 0; a < 3 && result.is_inside; ++a) {
    const double x = index[static_cast<int>(a)];
    const double cell = std::floor(x);
    result.first[a] = static_cast<std::int64_t>(cell) - 1;
    if (result.first[a] < 0 || result.first[a] + 4 > lattice.size[a]) result.is_inside = false;
    const double t = x - cell;
    const double s = 1.0 - t;
    result.weight[a] = {s * s * s / 6.0, (3.0 * t * t * t - 6.0 * t * t + 4.0) / 6.0,
                        (3.0 * s * s * s - 6.0 * s * s + 4.0) / 6.0, t * t * t / 6.0};
    result.slope[a] = {-0.5 * s * s, 1.5 * t * t - 2.0 * t, -1.5 * s * s + 2.0 * s, 0.5 * t * t};
  }
  return result;
}

Vec3 displacement_at(const SplineField& field, const Vec3& p) noexcept {
  const SplineWeights w = spline_weights(field.lattice, p);
  Vec3 sum = Vec3::Zero();
  if (!w.is_inside) return sum;
  for (std::int64_t c = 0; c < 4; ++c)
    for (std::int64_t b = 0; b < 4; ++b)
      for (std::int64_t a = 0; a < 4; ++a) {
        const std::size_t node = field.lattice.offset({w.first[0] + a, w.first[1] + b, w.first[2] + c});
        sum += w.weight[0][static_cast<std::size_t>(a)] * w.weight[1][static_cast<std::size_t>(b)] *
               w.weight[2][static_cast<std::size_t>(c)] * field.coefficients_mm[node];
      }
  return sum;
}

double jacobian_at(const SplineField& field, const Vec3& p) noexcept {
  const SplineWeights w = spline_weights(field.lattice, p);
  if (!w.is_inside) return 1.0;
  Mat3 per_cell = Mat3::Zero();  // column: derivative along a lattice axis
  for (std::int64_t c = 0; c < 4; ++c)
    for (std::int64_t b = 0; b < 4; ++b)
      for (std::int64_t a = 0; a < 4; ++a) {
        const auto x = static_cast<std::size_t>(a), y = static_cast<std::size_t>(b), z = static_cast<std::size_t>(c);
        const Vec3& u = field.coefficients_mm[field.lattice.offset({w.first[0] + a, w.first[1] + b, w.first[2] + c})];
        per_cell.col(0) += w.slope[0][x] * w.weight[1][y] * w.weight[2][z] * u;
        per_cell.col(1) += w.weight[0][x] * w.slope[1][y] * w.weight[2][z] * u;
        per_cell.col(2) += w.weight[0][x] * w.weight[1][y] * w.slope[2][z] * u;
      }
  const Mat3 per_mm = per_cell * field.lattice.spacing_mm.cwiseInverse().asDiagonal() * field.lattice.R_PV.transpose();
  return (Mat3::Identity() + per_mm).determinant();
}

}  // namespace trocar::volume
