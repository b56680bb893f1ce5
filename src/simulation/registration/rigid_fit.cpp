#include "registration/rigid_fit.h"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <iterator>

namespace trocar::registration {
namespace {

constexpr std::size_t kFewestPairs = 3;
/// Spread of points across their main direction, relative to the spread along it. Below it, the rotation about the main
/// direction depends on the picking errors only.
constexpr double kCollinear = 1e-2;
constexpr double kFewestSpread_mm = 1e-3;
/// A reflection is reported if its residual is below this share of the rotation's, and the rotation's residual is above
/// this share of the spread of the points.
constexpr double kMirroredShare = 0.25;
constexpr double kMirroredSpread = 0.05;

/// Centred, weighted moments of the pairs.
struct Moments {
  Vec3 mean_A = Vec3::Zero(), mean_B = Vec3::Zero();
  double weight = 0.0;
  double variance_A = 0.0, variance_B = 0.0;  ///< mm²
  Mat3 covariance_A = Mat3::Zero(), covariance_B = Mat3::Zero();
  Mat3 cross_AB = Mat3::Zero();
};

double weight_of(std::span<const double> weights, std::size_t pair) {
  return weights.empty() ? 1.0 : weights[pair];
}

Status check_pairs(std::span<const Vec3> points_A, std::span<const Vec3> points_B, std::span<const double> weights) {
  if (points_A.size() != points_B.size())
    return fail(fmt::format("{} points cannot be paired with {}", points_A.size(), points_B.size()), "point pairs",
                "give the same points on both sides");
  if (!weights.empty() && weights.size() != points_A.size())
    return fail(fmt::format("{} weights for {} pairs", weights.size(), points_A.size()), "point pairs",
                "give one weight for each pair, or none");
  std::size_t used = 0;
  for (std::size_t pair = 0; pair < points_A.size(); ++pair) {
    const double weight = weight_of(weights, pair);
    if (!points_A[pair].allFinite() || !points_B[pair].allFinite() || !std::isfinite(weight) || weight < 0.0)
      return fail(fmt::format("pair {} has a value that cannot be used", pair + 1), "point pairs",
                  "give finite positions, and weights that are not negative");
    if (weight > 0.0) ++used;
  }
  if (used < kFewestPairs)
    return fail(fmt::format("{} point pair{}: a rigid fit needs at least {}", used, used == 1 ? "" : "s", kFewestPairs),
                "point pairs", "add pairs that do not lie on one line");
  return {};
}

Moments find_moments(std::span<const Vec3> points_A, std::span<const Vec3> points_B, std::span<const double> weights) {
  Moments moments;
  for (std::size_t pair = 0; pair < points_A.size(); ++pair) {
    const double weight = weight_of(weights, pair);
    moments.weight += weight;
    moments.mean_A += weight * points_A[pair];
    moments.mean_B += weight * points_B[pair];
  }
  moments.mean_A /= moments.weight;
  moments.mean_B /= moments.weight;
  for (std::size_t pair = 0; pair < points_A.size(); ++pair) {
    const double share = weight_of(weights, pair) / moments.weight;
    const Vec3 a = points_A[pair] - moments.mean_A;
    const Vec3 b = points_B[pair] - moments.mean_B;
    moments.covariance_A += share * a * a.transpose();
    moments.covariance_B += share * b * b.transpose();
    moments.cross_AB += share * a * b.transpose();
  }
  moments.variance_A = moments.covariance_A.trace();
  moments.variance_B = moments.covariance_B.trace();
  return moments;
}

bool is_on_a_line(const Mat3& covariance) {
  const Eigen::JacobiSVD<Mat3> svd(covariance);  // squares of the singular values of the points
  const double first = std::sqrt(svd.singularValues()[0]);
  const double second = std::sqrt(svd.singularValues()[1]);
  return second < std::max(kCollinear * first, kFewestSpread_mm);
}

/// Mean square residual of the best rotation (sign 1) or reflection (sign -1): eq. 41 of Umeyama at scale 1.
double mean_square(const Moments& moments, double trace) {
  return std::max(0.0, moments.variance_A + moments.variance_B - 2.0 * trace);
}

}  // namespace

Result<RigidFit> fit_rigid(std::span<const Vec3> points_A, std::span<const Vec3> points_B,
                           std::span<const double> weights) {
  TROCAR_TRY_STATUS(check_pairs(points_A, points_B, weights));
  const Moments moments = find_moments(points_A, points_B, weights);
  if (is_on_a_line(moments.covariance_A) || is_on_a_line(moments.covariance_B))
    return fail("the points lie on one line: the rotation about it is unknown", "point pairs",
                "add a pair at a distance from the line");

  const Eigen::JacobiSVD<Mat3> svd(moments.cross_AB, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vec3 singular = svd.singularValues();
  const double sign = svd.matrixU().determinant() * svd.matrixV().determinant() < 0.0 ? -1.0 : 1.0;
  const Mat3 R_AB = svd.matrixU() * Vec3(1.0, 1.0, sign).asDiagonal() * svd.matrixV().transpose();
  const double trace = singular[0] + singular[1] + sign * singular[2];
  const double rotated = mean_square(moments, trace);
  const double reflected = mean_square(moments, singular.sum());
  const double spread = moments.variance_A + moments.variance_B;
  if (sign < 0.0 && rotated > kMirroredSpread * kMirroredSpread * spread &&
      reflected < kMirroredShare * kMirroredShare * rotated)
    return fail("the point pairs are mirrored: a reflection fits, no rotation does", "point pairs",
                "check left and right of the labels, and the orientation of both volumes");

  RigidFit fit;
  fit.X_AB = Pose(R_AB, moments.mean_A - R_AB * moments.mean_B);
  fit.scale = trace / moments.variance_B;
  fit.residual_mm.reserve(points_A.size());
  double sum = 0.0;
  for (std::size_t pair = 0; pair < points_A.size(); ++pair) {
    fit.residual_mm.push_back((fit.X_AB * points_B[pair] - points_A[pair]).norm());
    sum += weight_of(weights, pair) * fit.residual_mm.back() * fit.residual_mm.back();
  }
  fit.rms_mm = std::sqrt(sum / moments.weight);
  return fit;
}

std::size_t worst_pair(const RigidFit& fit) noexcept {
  const auto worst = std::max_element(fit.residual_mm.begin(), fit.residual_mm.end());
  return worst == fit.residual_mm.end() ? 0 : static_cast<std::size_t>(worst - fit.residual_mm.begin());
}

}  // namespace trocar::registration
