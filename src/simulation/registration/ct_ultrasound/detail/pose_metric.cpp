#include "registration/ct_ultrasound/detail/pose_metric.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/parallel.h"
#include "volume/sampling.h"

namespace trocar::registration::detail {
namespace {

constexpr std::size_t kDerivativePart = 2048;  ///< Samples whose derivatives one sum contains.
constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

/// Rotation about a coordinate axis.
Mat3 turn(double rad, int axis) {
  return Eigen::AngleAxisd(rad, Vec3::Unit(axis)).toRotationMatrix();
}

/// Derivative of turn() by the angle.
Mat3 turn_slope(double rad, int axis) {
  Mat3 cross = Mat3::Zero();
  cross((axis + 2) % 3, (axis + 1) % 3) = 1.0;
  cross((axis + 1) % 3, (axis + 2) % 3) = -1.0;
  return cross * turn(rad, axis);
}

/// Fractional voxel indices of the CT at points from the centre: at + by * point.
struct ToIndex {
  Vec3 at;
  Mat3 by;
};

ToIndex to_index(const volume::GridGeometry& ct, const Motion& motion, const Vec3& centre) {
  const Pose moved = pose_of(motion, centre);
  return {ct.to_index(moved * centre), ct.spacing_mm.cwiseInverse().asDiagonal() * ct.R_PV.transpose() * moved.R()};
}

/// Trilinear field of a grid.
class Field {
 public:
  explicit Field(const volume::FloatGrid& grid)
      : voxels_(grid.voxels.data()), row_(grid.geometry.size[0]), plane_(row_ * grid.geometry.size[1]) {
    for (std::size_t a = 0; a < 3; ++a) last_[a] = static_cast<double>(grid.geometry.size[a] - 1);
  }

  /// Between voxel centres on all axes; not for NaN.
  bool has(const Vec3& at) const {
    return at[0] >= 0.0 && at[1] >= 0.0 && at[2] >= 0.0 && at[0] < last_[0] && at[1] < last_[1] && at[2] < last_[2];
  }

  double value(const Vec3& at) const {
    const Cell cell = cell_at(at);
    const auto& [x, y, z] = cell.share;
    return static_cast<double>(mix(mix(mix(cell.v[0], cell.v[1], x), mix(cell.v[2], cell.v[3], x), y),
                                   mix(mix(cell.v[4], cell.v[5], x), mix(cell.v[6], cell.v[7], x), y), z));
  }

  /// The value; `slope` receives its derivative per voxel, exact within the cell.
  double value(const Vec3& at, Vec3f& slope) const {
    const Cell cell = cell_at(at);
    const auto& [x, y, z] = cell.share;
    const float low_near = mix(cell.v[0], cell.v[1], x), high_near = mix(cell.v[2], cell.v[3], x);
    const float low_far = mix(cell.v[4], cell.v[5], x), high_far = mix(cell.v[6], cell.v[7], x);
    const float near = mix(low_near, high_near, y), far = mix(low_far, high_far, y);
    slope.x() = mix(mix(cell.v[1] - cell.v[0], cell.v[3] - cell.v[2], y),
                    mix(cell.v[5] - cell.v[4], cell.v[7] - cell.v[6], y), z);
    slope.y() = mix(high_near - low_near, high_far - low_far, z);
    slope.z() = far - near;
    return static_cast<double>(mix(near, far, z));
  }

 private:
  struct Cell {
    std::array<float, 8> v;  ///< i fastest.
    std::array<float, 3> share;
  };

  static float mix(float a, float b, float share) { return a + share * (b - a); }

  Cell cell_at(const Vec3& at) const {
    const auto i = static_cast<std::int64_t>(at[0]), j = static_cast<std::int64_t>(at[1]),
               k = static_cast<std::int64_t>(at[2]);
    const float* v = voxels_ + (k * plane_ + j * row_ + i);
    return {{v[0], v[1], v[row_], v[row_ + 1], v[plane_], v[plane_ + 1], v[plane_ + row_], v[plane_ + row_ + 1]},
            {static_cast<float>(at[0] - static_cast<double>(i)), static_cast<float>(at[1] - static_cast<double>(j)),
             static_cast<float>(at[2] - static_cast<double>(k))}};
  }

  const float* voxels_;
  std::int64_t row_, plane_;
  std::array<double, 3> last_{};
};

std::vector<float> contrasts_at(const volume::FloatGrid& us, std::span<const Vec3> points) {
  std::vector<float> values(points.size());
  for (std::size_t n = 0; n < points.size(); ++n) values[n] = static_cast<float>(volume::sample_linear(us, points[n]));
  return values;
}

/// Sums over samples: derivative by the index in the CT, and its products with the point.
struct Derivatives {
  Vec3 by_index = Vec3::Zero();
  Mat3 by_index_and_point = Mat3::Zero();
};

}  // namespace

Pose pose_of(const Motion& motion, const Vec3& centre) {
  const Mat3 R = turn(motion[2], 2) * turn(motion[0], 0) * turn(motion[1], 1);
  return {R, centre + motion.tail<3>() - R * centre};
}

Motion motion_of(const Pose& pose, const Vec3& centre) {
  const Mat3& R = pose.R();  // Rz Rx Ry
  Motion motion;
  motion[0] = std::asin(std::clamp(R(2, 1), -1.0, 1.0));
  motion[1] = std::atan2(-R(2, 0), R(2, 2));
  motion[2] = std::atan2(-R(0, 1), R(1, 1));
  motion.tail<3>() = pose * centre - centre;
  return motion;
}

PoseMetric::PoseMetric(const Level& level, std::span<const Vec3> points, const Vec3& centre)
    : ct_(level.ct),
      centre_(centre),
      points_(points.begin(), points.end()),
      information_(contrasts_at(level.us, points)) {
  for (Vec3& p : points_) p -= centre;
}

double PoseMetric::value(const Motion& motion) {
  const Field field(ct_);
  const ToIndex index = to_index(ct_.geometry, motion, centre_);
  values_.resize(points_.size());
  parallel_for(points_.size(), kDerivativePart, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) {
      const Vec3 at = index.at + index.by * points_[n];
      values_[n] = field.has(at) ? field.value(at) : kNoValue;
    }
  });
  return information_.value(values_);
}

PoseMetric::Slope PoseMetric::slope(const Motion& motion) {
  const Field field(ct_);
  const ToIndex index = to_index(ct_.geometry, motion, centre_);
  values_.resize(points_.size());
  gradients_.resize(points_.size());
  parallel_for(points_.size(), kDerivativePart, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) {
      const Vec3 at = index.at + index.by * points_[n];
      values_[n] = field.has(at) ? field.value(at, gradients_[n]) : kNoValue;
    }
  });
  Slope result;
  result.value = information_.evaluate(values_, slopes_);

  std::vector<Derivatives> parts((points_.size() + kDerivativePart - 1) / kDerivativePart);
  parallel_for(parts.size(), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t part = first; part < last; ++part)
      for (std::size_t n = part * kDerivativePart; n < std::min(points_.size(), (part + 1) * kDerivativePart); ++n) {
        if (slopes_[n] == 0.0) continue;
        const Vec3 by_index = slopes_[n] * gradients_[n].cast<double>();
        parts[part].by_index += by_index;
        parts[part].by_index_and_point += by_index * points_[n].transpose();
      }
  });
  Derivatives sum;
  for (const Derivatives& part : parts) {
    sum.by_index += part.by_index;
    sum.by_index_and_point += part.by_index_and_point;
  }
  const Mat3 mm_of_index = ct_.geometry.R_PV * ct_.geometry.spacing_mm.cwiseInverse().asDiagonal();
  const Mat3 by_rotation = mm_of_index * sum.by_index_and_point;  // dI/dR
  const Mat3 x = turn(motion[0], 0), y = turn(motion[1], 1), z = turn(motion[2], 2);
  result.gradient[0] = by_rotation.cwiseProduct(z * turn_slope(motion[0], 0) * y).sum();
  result.gradient[1] = by_rotation.cwiseProduct(z * x * turn_slope(motion[1], 1)).sum();
  result.gradient[2] = by_rotation.cwiseProduct(turn_slope(motion[2], 2) * x * y).sum();
  result.gradient.tail<3>() = mm_of_index * sum.by_index;
  return result;
}

Summit climb(PoseMetric& metric, const Motion& start, const ClimbOptions& options) {
  Motion mm_per_unit = Motion::Ones();
  mm_per_unit.head<3>().setConstant(options.radius_mm);
  Summit summit{start, 0.0};
  Motion motion = start;
  Motion last = Motion::Zero();
  double step_mm = options.step_mm;
  for (int n = 0; n < options.most_steps && step_mm > options.shortest_mm; ++n) {
    const PoseMetric::Slope slope = metric.slope(motion);
    if (n == 0 || slope.value > summit.value) summit = {motion, slope.value};
    Motion uphill = slope.gradient.cwiseQuotient(mm_per_unit);
    const double norm = uphill.norm();
    if (!(norm > 0.0)) break;
    uphill /= norm;
    if (uphill.dot(last) < 0.0) step_mm *= 0.5;
    last = uphill;
    motion += step_mm * uphill.cwiseQuotient(mm_per_unit);
  }
  return summit;
}

}  // namespace trocar::registration::detail
