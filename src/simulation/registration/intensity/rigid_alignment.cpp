#include "registration/intensity/rigid_alignment.h"

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <span>

#include "core/parallel.h"
#include "core/result.h"

namespace trocar::registration {
namespace {

constexpr std::size_t kTogether = 4096;  ///< Points that are summed in order.
constexpr double kFirstDamping = 1e-3;
constexpr double kMostDamping = 1e3;

struct Sample {
  float value;
  Vec3f slope;  ///< Per voxel.
};

/// Trilinear value and slope; false outside and where a voxel has no value.
bool sample_at(const volume::FloatGrid& grid, const Vec3f& index, Sample& sample) noexcept {
  const auto& size = grid.geometry.size;
  const Vec3f low = index.array().floor();
  const auto i = static_cast<std::int64_t>(low[0]), j = static_cast<std::int64_t>(low[1]),
             k = static_cast<std::int64_t>(low[2]);
  if (!(i >= 0 && j >= 0 && k >= 0 && i + 1 < size[0] && j + 1 < size[1] && k + 1 < size[2])) return false;
  const Vec3f f = index - low;
  const float* v = grid.voxels.data() + grid.geometry.offset({i, j, k});
  const std::int64_t row = size[0], plane = size[0] * size[1];
  const auto line = [&](const float* p) { return p[0] + f[0] * (p[1] - p[0]); };
  const auto slope = [&](const float* p) { return p[1] - p[0]; };
  const float c00 = line(v), c10 = line(v + row), c01 = line(v + plane), c11 = line(v + plane + row);
  const float s0 = slope(v) + f[1] * (slope(v + row) - slope(v));
  const float s1 = slope(v + plane) + f[1] * (slope(v + plane + row) - slope(v + plane));
  const float c0 = c00 + f[1] * (c10 - c00), c1 = c01 + f[1] * (c11 - c01);
  sample.value = c0 + f[2] * (c1 - c0);
  sample.slope = {s0 + f[2] * (s1 - s0), (c10 - c00) + f[2] * ((c11 - c01) - (c10 - c00)), c1 - c0};
  return sample.value == sample.value;
}

/// A point in both volumes, with the derivative of the difference by a motion.
struct Term {
  float a, b;
  Eigen::Matrix<float, 6, 1> by_motion;
};

/// Maps points of A to indices of B, and slopes of B to A.
struct Mapping {
  Eigen::Matrix3f to_index;
  Vec3f offset;
  Eigen::Matrix3f slope_to_A;
  Mapping(const volume::GridGeometry& moving, const Pose& X_AB) {
    const Pose X_BA = X_AB.inverse();
    const Mat3 per_mm = moving.spacing_mm.cwiseInverse().asDiagonal() * moving.R_PV.transpose();
    to_index = (per_mm * X_BA.R()).cast<float>();
    offset = Vec3(per_mm * (X_BA.p() - moving.origin_P)).cast<float>();
    slope_to_A = Mat3((per_mm * X_BA.R()).transpose()).cast<float>();
  }
};

/// Sums over the points in use.
struct Sums {
  double n = 0.0, a = 0.0, b = 0.0, aa = 0.0, bb = 0.0, ab = 0.0;
  Vec3 middle = Vec3::Zero();
  Vector6 j = Vector6::Zero(), ja = Vector6::Zero(), jb = Vector6::Zero();
  Matrix6 jj = Matrix6::Zero();
  void add(const Sums& o) {
    n += o.n, a += o.a, b += o.b, aa += o.aa, bb += o.bb, ab += o.ab;
    middle += o.middle, j += o.j, ja += o.ja, jb += o.jb, jj += o.jj;
  }
};

template <bool HasMotion>
Sums sum_part(std::span<const AlignmentPoint> fixed, const volume::FloatGrid& moving, const Mapping& mapping,
              const Vec3f& centre) {
  Sums sums;
  Eigen::Matrix<float, 6, 6> jj = Eigen::Matrix<float, 6, 6>::Zero();
  Eigen::Matrix<float, 6, 1> j = Eigen::Matrix<float, 6, 1>::Zero(), ja = j, jb = j;
  Vec3f middle = Vec3f::Zero();
  for (const AlignmentPoint& point : fixed) {
    Sample sample;
    if (!sample_at(moving, mapping.to_index * point.p_A + mapping.offset, sample)) continue;
    const double a = static_cast<double>(point.value), b = static_cast<double>(sample.value);
    sums.n += 1.0, sums.a += a, sums.b += b, sums.aa += a * a, sums.bb += b * b, sums.ab += a * b;
    middle += point.p_A - centre;
    if constexpr (HasMotion) {
      const Vec3f slope = 0.5F * (mapping.slope_to_A * sample.slope + point.slope_A);
      Eigen::Matrix<float, 6, 1> motion;
      const Vec3f arm = point.p_A - centre;
      motion << arm.y() * slope.z() - arm.z() * slope.y(), arm.z() * slope.x() - arm.x() * slope.z(),
          arm.x() * slope.y() - arm.y() * slope.x(), slope;
      j += motion;
      ja += point.value * motion;
      jb += sample.value * motion;
      jj.noalias() += motion * motion.transpose();
    }
  }
  sums.middle = middle.cast<double>();
  sums.j = j.cast<double>(), sums.ja = ja.cast<double>(), sums.jb = jb.cast<double>(), sums.jj = jj.cast<double>();
  return sums;
}

template <bool HasMotion>
Sums sum_all(const std::vector<AlignmentPoint>& fixed, const volume::FloatGrid& moving, const Pose& X_AB,
             const Vec3& centre_A) {
  const Mapping mapping(moving.geometry, X_AB);
  const std::size_t parts = (fixed.size() + kTogether - 1) / kTogether;
  std::vector<Sums> of_part(parts);
  parallel_for(parts, 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t part = first; part < last; ++part) {
      const std::size_t begin = part * kTogether;
      of_part[part] = sum_part<HasMotion>(std::span(fixed).subspan(begin, std::min(kTogether, fixed.size() - begin)),
                                          moving, mapping, centre_A.cast<float>());
    }
  });
  Sums sums;
  for (const Sums& part : of_part) sums.add(part);
  return sums;
}

double correlation_of(const Sums& s, std::size_t points, const AlignmentOptions& options) {
  if (points == 0 || s.n < 30.0 || s.n < options.least_overlap * static_cast<double>(points)) return -1.0;
  const double var_a = s.aa - s.a * s.a / s.n, var_b = s.bb - s.b * s.b / s.n;
  if (!(var_a > 0.0 && var_b > 0.0)) return -1.0;
  return (s.ab - s.a * s.b / s.n) / std::sqrt(var_a * var_b);
}

Alignment describe(const Sums& s, std::size_t points, const Pose& X_AB, const AlignmentOptions& options) {
  Alignment result;
  result.X_AB = X_AB;
  result.ncc = correlation_of(s, points, options);
  result.overlap = points == 0 ? 0.0 : s.n / static_cast<double>(points);
  return result;
}

/// Motion of the fixed frame: rotation vector about the centre, then translation.
Pose moved_about(const Pose& X_AB, const Vector6& step, const Vec3& centre_A) {
  const Vec3 rotation = step.head<3>();
  const double angle = rotation.norm();
  const Mat3 R = angle > 0.0 ? Eigen::AngleAxisd(angle, rotation / angle).toRotationMatrix() : Mat3::Identity();
  const Pose motion(R, centre_A + Vec3(step.tail<3>()) - R * centre_A);
  const Pose X = motion.inverse() * X_AB;
  return {Eigen::Quaterniond(X.R()).normalized().toRotationMatrix(), X.p()};
}

/// Normal equations of sum((a - mean a)/sd a - (b - mean b)/sd b)^2 for a small motion of the points of A.
void normal_equations(const Sums& s, Matrix6& H, Vector6& g) {
  const double var_a = s.aa - s.a * s.a / s.n, var_b = s.bb - s.b * s.b / s.n;
  const double scale_a = 1.0 / std::sqrt(var_a), scale_b = 1.0 / std::sqrt(var_b);
  H = scale_b * scale_b * (s.jj - s.j * s.j.transpose() / s.n);
  g = scale_b * (scale_a * (s.ja - s.a / s.n * s.j) - scale_b * (s.jb - s.b / s.n * s.j));
}

}  // namespace

std::vector<AlignmentPoint> alignment_points(const volume::FloatGrid& fixed, int stride) {
  TROCAR_CHECK(stride >= 1);
  std::vector<AlignmentPoint> points;
  const auto& geometry = fixed.geometry;
  const std::int64_t begin = std::max(1, stride / 2);
  for (std::int64_t k = begin; k + 1 < geometry.size[2]; k += stride) {
    for (std::int64_t j = begin; j + 1 < geometry.size[1]; j += stride) {
      for (std::int64_t i = begin; i + 1 < geometry.size[0]; i += stride) {
        Vec3 slope_V;
        slope_V.x() = static_cast<double>(fixed[{i + 1, j, k}] - fixed[{i - 1, j, k}]);
        slope_V.y() = static_cast<double>(fixed[{i, j + 1, k}] - fixed[{i, j - 1, k}]);
        slope_V.z() = static_cast<double>(fixed[{i, j, k + 1}] - fixed[{i, j, k - 1}]);
        const Vec3 slope_P = geometry.R_PV * Vec3(0.5 * slope_V.cwiseQuotient(geometry.spacing_mm));
        const float value = fixed[{i, j, k}];
        if (!slope_P.allFinite() || !(value == value)) continue;
        points.push_back({geometry.centre_mm({i, j, k}).cast<float>(), slope_P.cast<float>(), value});
      }
    }
  }
  return points;
}

Alignment correlate(const std::vector<AlignmentPoint>& fixed, const volume::FloatGrid& moving, const Pose& X_AB,
                    const AlignmentOptions& options) {
  return describe(sum_all<false>(fixed, moving, X_AB, Vec3::Zero()), fixed.size(), X_AB, options);
}

Alignment align(const std::vector<AlignmentPoint>& fixed, const volume::FloatGrid& moving, const Pose& X_AB,
                const AlignmentOptions& options) {
  Sums sums = sum_all<true>(fixed, moving, X_AB, Vec3::Zero());
  Alignment best = describe(sums, fixed.size(), X_AB, options);
  if (best.ncc <= -1.0) return best;
  const Vec3 centre_A = sums.middle / sums.n;
  sums = sum_all<true>(fixed, moving, X_AB, centre_A);
  Matrix6 H = Matrix6::Zero();
  Vector6 g;
  double damping = kFirstDamping;
  for (int n = 0; n < options.iterations && damping < kMostDamping; ++n) {
    normal_equations(sums, H, g);
    Matrix6 damped = H;
    damped.diagonal() *= 1.0 + damping;
    const Vector6 step = damped.ldlt().solve(g);
    if (!step.allFinite()) break;
    const Pose X = moved_about(best.X_AB, step, centre_A);
    const Sums next = sum_all<true>(fixed, moving, X, centre_A);
    const Alignment candidate = describe(next, fixed.size(), X, options);
    if (candidate.ncc <= best.ncc) {
      damping *= 10.0;
      continue;
    }
    damping = std::max(damping * 0.1, 1e-6);
    best = candidate;
    sums = next;
    constexpr double kArm_mm = 30.0;  // of the volume, for the effect of a rotation
    if (step.tail<3>().norm() + kArm_mm * step.head<3>().norm() < options.enough_mm) break;
  }
  normal_equations(sums, H, g);
  // In units of the residual's variance, which is 2 (1 - ncc) over all points.
  best.information = H / std::max(2.0 * (1.0 - best.ncc), 1e-6) * sums.n;
  best.middle_A = centre_A;
  return best;
}

}  // namespace trocar::registration
