#include "registration/sift3d/keypoints.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "core/parallel.h"
#include "registration/sift3d/scale_space.h"

namespace trocar::registration::detail {

/// Voxel whose difference of Gaussians exceeds, or falls below, that of its 26 neighbours and of 27 each at the scales
/// above and below.
struct Extremum {
  volume::Index3 ijk{0, 0, 0};
  int level = 0;  ///< Of the difference: level + 1 less level. 1..scales.
};

/// Extrema of an octave of absolute value `least` or more, in the order of voxels in memory, levels within. Voxels with
/// a neighbour that is not usable are no extrema. Parallel.
/// `scale_exponent`: differences are multiplied by 2^(scale_exponent * level / scales) before they are compared.
std::vector<Extremum> find_extrema(const Octave& octave, int scales, double scale_exponent, float least);

}  // namespace trocar::registration::detail

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

namespace trocar::registration::detail {
namespace {

/// Difference of two levels, of three neighbouring k planes.
class DifferencePlanes {
 public:
  DifferencePlanes(const Octave& octave, int level, float gain)
      : gain_(gain),
        low_(octave.levels[static_cast<std::size_t>(level)].voxels.data()),
        high_(octave.levels[static_cast<std::size_t>(level) + 1].voxels.data()),
        plane_(static_cast<std::size_t>(octave.geometry.size[0] * octave.geometry.size[1])) {
    for (auto& plane : planes_) plane.resize(plane_);
  }
  void load(std::int64_t k) {
    const std::size_t begin = static_cast<std::size_t>(k) * plane_;
    std::vector<float>& plane = planes_[static_cast<std::size_t>(k % 3)];
    for (std::size_t n = 0; n < plane_; ++n) plane[n] = gain_ * (high_[begin + n] - low_[begin + n]);
  }
  const float* plane(std::int64_t k) const { return planes_[static_cast<std::size_t>(k % 3)].data(); }

 private:
  float gain_;
  const float* low_;
  const float* high_;
  std::size_t plane_;
  std::array<std::vector<float>, 3> planes_;
};

/// True if `value` is above (sign 1) or below (sign -1) all values of a 3 x 3 x 3 neighbourhood, except its own centre
/// where `is_own`. False if one is NaN.
bool exceeds(const DifferencePlanes& planes, std::int64_t k, std::size_t at, std::ptrdiff_t row, float value,
             float sign, bool is_own) {
  for (std::int64_t dk = -1; dk <= 1; ++dk) {
    const float* centre = planes.plane(k + dk) + at;
    for (std::ptrdiff_t dj = -1; dj <= 1; ++dj) {
      for (std::ptrdiff_t di = -1; di <= 1; ++di) {
        if (is_own && dk == 0 && dj == 0 && di == 0) continue;
        if (!(sign * value > sign * centre[dj * row + di])) return false;
      }
    }
  }
  return true;
}

class ExtremumSearch {
 public:
  ExtremumSearch(const Octave& octave, int scales, double scale_exponent, float least)
      : octave_(octave), scales_(scales), least_(least) {
    for (int level = 0; level < scales + 2; ++level)
      differences_.emplace_back(octave, level, static_cast<float>(std::exp2(scale_exponent * level / scales)));
  }

  void search(std::int64_t first_k, std::int64_t last_k, std::vector<Extremum>& found) {
    for (std::int64_t k = first_k - 1; k < first_k + 1; ++k) load(k);
    for (std::int64_t k = first_k; k < last_k; ++k) {
      load(k + 1);
      search_plane(k, found);
    }
  }

 private:
  void load(std::int64_t k) {
    for (DifferencePlanes& planes : differences_) planes.load(k);
  }

  void search_plane(std::int64_t k, std::vector<Extremum>& found) const {
    const auto& size = octave_.geometry.size;
    for (std::int64_t j = 1; j + 1 < size[1]; ++j) {
      for (int level = 1; level <= scales_; ++level) {
        const auto row = static_cast<std::size_t>(j * size[0]);
        const float* values = differences_[static_cast<std::size_t>(level)].plane(k) + row;
        for (std::int64_t i = 1; i + 1 < size[0]; ++i) {
          const float value = values[i];
          if (std::abs(value) >= least_ && is_extremum(k, row + static_cast<std::size_t>(i), level, value))
            found.push_back({{i, j, k}, level});
        }
      }
    }
  }

  bool is_extremum(std::int64_t k, std::size_t at, int level, float value) const {
    const float sign = value > 0.0F ? 1.0F : -1.0F;
    const auto row = static_cast<std::ptrdiff_t>(octave_.geometry.size[0]);
    const auto l = static_cast<std::size_t>(level);
    return exceeds(differences_[l], k, at, row, value, sign, true) &&
           exceeds(differences_[l - 1], k, at, row, value, sign, false) &&
           exceeds(differences_[l + 1], k, at, row, value, sign, false);
  }

  const Octave& octave_;
  int scales_;
  float least_;
  std::vector<DifferencePlanes> differences_;
};

}  // namespace

std::vector<Extremum> find_extrema(const Octave& octave, int scales, double scale_exponent, float least) {
  const std::int64_t planes = octave.geometry.size[2] - 2;
  if (planes <= 0) return {};
  constexpr std::int64_t kPlanesTogether = 8;
  const auto parts = static_cast<std::size_t>((planes + kPlanesTogether - 1) / kPlanesTogether);
  std::vector<std::vector<Extremum>> found(parts);
  parallel_for(parts, 1, [&](std::size_t first, std::size_t last) {
    ExtremumSearch search(octave, scales, scale_exponent, least);
    for (std::size_t part = first; part < last; ++part) {
      const std::int64_t begin = 1 + static_cast<std::int64_t>(part) * kPlanesTogether;
      search.search(begin, std::min(begin + kPlanesTogether, planes + 1), found[part]);
    }
  });
  std::vector<Extremum> extrema;
  for (const auto& part : found) extrema.insert(extrema.end(), part.begin(), part.end());
  return extrema;
}

}  // namespace trocar::registration::detail
