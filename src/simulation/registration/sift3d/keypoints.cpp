#include "registration/sift3d/keypoints.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/parallel.h"
#include "registration/sift3d/detail/extrema.h"

namespace trocar::registration {
namespace {

constexpr int kMostMoves = 5;         ///< To a neighbouring voxel or scale, while the extremum is refined.
constexpr double kBeyondVoxel = 0.6;  ///< An offset above this moves the candidate.

Status check(const KeypointOptions& options) {
  if (!(options.least_contrast >= 0.0 && options.least_contrast <= 10.0))
    return fail_usage("the least contrast is out of range", fmt::format("{:g}", options.least_contrast),
                      "give 0 to 10");
  if (!(options.scale_exponent >= 0.0 && options.scale_exponent <= 1.5))
    return fail_usage("the exponent of the scale is out of range", fmt::format("{:g}", options.scale_exponent),
                      "give 0 to 1.5");
  if (!(options.largest_ratio >= 1.0 && options.largest_ratio <= 1000.0))
    return fail_usage("the largest ratio of eigenvalues is out of range", fmt::format("{:g}", options.largest_ratio),
                      "give 1 to 1000");
  if (options.most < 1 || options.most > 1000000)
    return fail_usage("the number of keypoints is out of range", fmt::format("{}", options.most), "give 1 to 1000000");
  return {};
}

/// Weighted difference of Gaussians of an octave.
class Differences {
 public:
  Differences(const Octave& octave, double exponent_per_level) : octave_(octave), per_level_(exponent_per_level) {}
  double at(const volume::Index3& ijk, int level) const {
    const auto n = octave_.geometry.offset(ijk);
    const auto l = static_cast<std::size_t>(level);
    return std::exp2(per_level_ * level) *
           static_cast<double>(octave_.levels[l + 1].voxels[n] - octave_.levels[l].voxels[n]);
  }

 private:
  const Octave& octave_;
  double per_level_;
};

/// Second-order expansion about a voxel, in voxels and levels.
struct Expansion {
  double value = 0.0;
  Eigen::Vector4d gradient;
  Eigen::Matrix4d hessian;
};

Expansion expand(const Differences& d, const volume::Index3& at, int level) {
  const auto value = [&](int axis_a, int step_a, int axis_b, int step_b) {
    volume::Index3 ijk = at;
    int l = level;
    for (const auto& [axis, step] : {std::pair{axis_a, step_a}, std::pair{axis_b, step_b}}) {
      if (axis == 3) {
        l += step;
      } else {
        ijk[static_cast<std::size_t>(axis)] += step;
      }
    }
    return d.at(ijk, l);
  };
  Expansion e;
  e.value = d.at(at, level);
  for (int a = 0; a < 4; ++a) {
    const double up = value(a, 1, a, 0), down = value(a, -1, a, 0);
    e.gradient[a] = 0.5 * (up - down);
    e.hessian(a, a) = up + down - 2.0 * e.value;
    for (int b = 0; b < a; ++b) {
      e.hessian(a, b) = 0.25 * (value(a, 1, b, 1) - value(a, 1, b, -1) - value(a, -1, b, 1) + value(a, -1, b, -1));
      e.hessian(b, a) = e.hessian(a, b);
    }
  }
  return e;
}

/// |lambda_3| / |lambda_1| of the spatial Hessian; infinity if it has no definite sign.
double curvature_ratio(const Eigen::Matrix4d& hessian) {
  const Mat3 spatial = hessian.topLeftCorner<3, 3>();
  const Vec3 magnitudes = Eigen::SelfAdjointEigenSolver<Mat3>(spatial, Eigen::EigenvaluesOnly).eigenvalues().cwiseAbs();
  const double least = magnitudes.minCoeff();
  return least > 0.0 ? magnitudes.maxCoeff() / least : std::numeric_limits<double>::infinity();
}

bool has_neighbours(const volume::GridGeometry& geometry, const volume::Index3& ijk, int level, int scales) {
  for (std::size_t a = 0; a < 3; ++a)
    if (ijk[a] < 1 || ijk[a] >= geometry.size[a] - 1) return false;
  return level >= 1 && level <= scales;
}

std::optional<Keypoint> refine_keypoint(const ScaleSpace& space, std::size_t octave, const detail::Extremum& candidate,
                                        const KeypointOptions& options) {
  const Octave& o = space.octaves[octave];
  const Differences differences(o, options.scale_exponent / space.options.scales);
  volume::Index3 at = candidate.ijk;
  int level = candidate.level;
  for (int move = 0; move < kMostMoves; ++move) {
    const Expansion e = expand(differences, at, level);
    if (!e.hessian.allFinite() || !e.gradient.allFinite()) return std::nullopt;
    const Eigen::Vector4d offset = -e.hessian.fullPivLu().solve(e.gradient);
    if (!offset.allFinite()) return std::nullopt;
    if (offset.cwiseAbs().maxCoeff() > kBeyondVoxel) {
      for (int a = 0; a < 3; ++a)
        at[static_cast<std::size_t>(a)] += offset[a] > kBeyondVoxel ? 1 : offset[a] < -kBeyondVoxel ? -1 : 0;
      level += offset[3] > kBeyondVoxel ? 1 : offset[3] < -kBeyondVoxel ? -1 : 0;
      if (!has_neighbours(o.geometry, at, level, space.options.scales)) return std::nullopt;
      continue;
    }
    Keypoint keypoint;
    keypoint.contrast = e.value + 0.5 * e.gradient.dot(offset);
    keypoint.ratio = curvature_ratio(e.hessian);
    if (!(std::abs(keypoint.contrast) >= options.least_contrast) || !(keypoint.ratio < options.largest_ratio))
      return std::nullopt;
    keypoint.octave = octave;
    keypoint.level = level + offset[3];
    keypoint.p_P = o.geometry.to_mm(volume::to_vec3(at) + offset.head<3>());
    keypoint.sigma_mm = space.sigma_mm(octave, keypoint.level);
    return keypoint;
  }
  return std::nullopt;
}

}  // namespace

Result<std::vector<Keypoint>> find_keypoints(const ScaleSpace& space, const KeypointOptions& options) {
  TROCAR_TRY_STATUS(check(options));
  constexpr double kBeforeRefinement = 0.8;  // refinement raises the contrast by up to a quarter
  std::vector<Keypoint> keypoints;
  for (std::size_t octave = 0; octave < space.octaves.size(); ++octave) {
    const auto extrema = detail::find_extrema(space.octaves[octave], space.options.scales, options.scale_exponent,
                                              static_cast<float>(kBeforeRefinement * options.least_contrast));
    for (const detail::Extremum& candidate : extrema)
      if (const auto keypoint = refine_keypoint(space, octave, candidate, options)) keypoints.push_back(*keypoint);
  }
  std::stable_sort(keypoints.begin(), keypoints.end(),
                   [](const Keypoint& a, const Keypoint& b) { return std::abs(a.contrast) > std::abs(b.contrast); });
  if (keypoints.size() > options.most) keypoints.resize(options.most);
  return keypoints;
}

}  // namespace trocar::registration
