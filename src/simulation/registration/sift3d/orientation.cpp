#include "registration/sift3d/orientation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace trocar::registration {
namespace {

constexpr int kDirections = 320;         ///< About 11 degrees apart.
constexpr double kNeighbour_rad = 0.33;  ///< Directions nearer than this are neighbours.
constexpr double kWindow_sigma = 3.0;    ///< Deviation of the weight of a gradient, in units of the scale.
constexpr double kReach_sigma = 6.0;     ///< Radius of the gradients in use, the same.
constexpr double kLattice_sigma = 0.8;   ///< Distance between gradients, the same.
constexpr std::size_t kLeastGradients = 60;
constexpr int kRollBins = 36;
constexpr int kDirectionRefinements = 4;
constexpr double kSmallestAcross = 1e-9;

struct Gradient {
  Vec3 direction_P;
  double weight = 0.0;
};

/// Points of a Fibonacci spiral on the sphere: about the same solid angle each.
std::vector<Vec3> spread_directions() {
  std::vector<Vec3> directions;
  const double golden = std::numbers::pi * (3.0 - std::sqrt(5.0));
  for (int n = 0; n < kDirections; ++n) {
    const double z = 1.0 - (2.0 * n + 1.0) / kDirections;
    const double across = std::sqrt(1.0 - z * z);
    directions.emplace_back(across * std::cos(golden * n), across * std::sin(golden * n), z);
  }
  return directions;
}

/// cos^8 for angles below pi/2, else 0: half its height at 23 degrees.
double closeness(double cosine) {
  if (cosine <= 0.0) return 0.0;
  const double square = cosine * cosine, fourth = square * square;
  return fourth * fourth;
}

/// Gradients per mm at a lattice of voxels about the keypoint.
std::vector<Gradient> gather_gradients(const ScaleSpace& space, const Keypoint& keypoint) {
  const Octave& octave = space.octaves[keypoint.octave];
  const auto& geometry = octave.geometry;
  const auto level = static_cast<std::size_t>(
      std::clamp<long>(std::lround(keypoint.level), 0, static_cast<long>(octave.levels.size()) - 1));
  const volume::FloatGrid& gray = octave.levels[level];
  const double sigma = keypoint.sigma_mm / geometry.spacing_mm.x();  // voxels
  const std::int64_t stride = std::max<std::int64_t>(1, std::llround(kLattice_sigma * sigma));
  const auto reach = static_cast<std::int64_t>(kReach_sigma * sigma / static_cast<double>(stride)) * stride;
  const Vec3 centre = geometry.to_index(keypoint.p_P);
  volume::Index3 middle;
  for (int a = 0; a < 3; ++a) middle[static_cast<std::size_t>(a)] = std::llround(centre[a]);
  std::vector<Gradient> gradients;
  volume::Index3 at;
  for (at[2] = middle[2] - reach; at[2] <= middle[2] + reach; at[2] += stride) {
    for (at[1] = middle[1] - reach; at[1] <= middle[1] + reach; at[1] += stride) {
      for (at[0] = middle[0] - reach; at[0] <= middle[0] + reach; at[0] += stride) {
        const double away2 = (volume::to_vec3(at) - centre).squaredNorm() / (sigma * sigma);
        if (away2 > kReach_sigma * kReach_sigma) continue;
        bool is_within = true;
        for (std::size_t a = 0; a < 3; ++a) is_within = is_within && at[a] >= 1 && at[a] < geometry.size[a] - 1;
        if (!is_within) continue;
        Vec3 slope_V;
        for (std::size_t a = 0; a < 3; ++a) {
          volume::Index3 up = at, down = at;
          ++up[a];
          --down[a];
          slope_V[static_cast<Eigen::Index>(a)] = static_cast<double>(gray[up] - gray[down]);
        }
        const double size = slope_V.norm();
        if (!(size > 0.0)) continue;  // also where a neighbour is not usable
        const double weight = size * std::exp(-0.5 * away2 / (kWindow_sigma * kWindow_sigma));
        gradients.push_back({geometry.R_PV * (slope_V / size), weight});
      }
    }
  }
  return gradients;
}

/// Sum of the gradients near each direction. Loops over directions, one coordinate after the other, for the compiler's
/// vectors.
std::vector<float> density_of(const std::vector<Gradient>& gradients, const std::vector<Vec3>& directions) {
  const std::size_t count = directions.size();
  std::vector<float> x(count), y(count), z(count), density(count, 0.0F);
  for (std::size_t d = 0; d < count; ++d) {
    x[d] = static_cast<float>(directions[d].x());
    y[d] = static_cast<float>(directions[d].y());
    z[d] = static_cast<float>(directions[d].z());
  }
  for (const Gradient& g : gradients) {
    const Vec3f direction = g.direction_P.cast<float>();
    const auto weight = static_cast<float>(g.weight);
    for (std::size_t d = 0; d < count; ++d) {
      const float cosine = std::max(0.0F, direction[0] * x[d] + direction[1] * y[d] + direction[2] * z[d]);
      const float square = cosine * cosine, fourth = square * square;
      density[d] += weight * fourth * fourth;
    }
  }
  return density;
}

struct Peak {
  double height = 0.0;
  Vec3 direction{1, 0, 0};
};

/// Moves a direction to the weighted mean of the gradients near it.
Vec3 refine_direction(const std::vector<Gradient>& gradients, Vec3 direction) {
  for (int n = 0; n < kDirectionRefinements; ++n) {
    Vec3 sum = Vec3::Zero();
    for (const Gradient& g : gradients) sum += g.weight * closeness(direction.dot(g.direction_P)) * g.direction_P;
    if (sum.norm() > 0.0) direction = sum.normalized();
  }
  return direction;
}

void keep_highest(std::vector<Peak>& peaks, double least_share, std::size_t most) {
  std::stable_sort(peaks.begin(), peaks.end(), [](const Peak& a, const Peak& b) { return a.height > b.height; });
  const auto low = std::find_if(peaks.begin(), peaks.end(),
                                [&](const Peak& peak) { return peak.height < least_share * peaks.front().height; });
  peaks.erase(low, peaks.end());
  if (peaks.size() > most) peaks.resize(most);
}

/// Dominant directions of the parts of the gradients across x.
std::vector<Peak> find_rolls(const std::vector<Gradient>& gradients, const Vec3& x, double least_share) {
  const Vec3 u = x.unitOrthogonal(), v = x.cross(u);
  std::array<double, kRollBins> density{}, cosines{}, sines{};
  for (std::size_t bin = 0; bin < kRollBins; ++bin) {
    cosines[bin] = std::cos(2.0 * std::numbers::pi * static_cast<double>(bin) / kRollBins);
    sines[bin] = std::sin(2.0 * std::numbers::pi * static_cast<double>(bin) / kRollBins);
  }
  for (const Gradient& g : gradients) {
    const double gu = g.direction_P.dot(u), gv = g.direction_P.dot(v);
    const double across = std::hypot(gu, gv);
    if (across < kSmallestAcross) continue;
    for (std::size_t bin = 0; bin < kRollBins; ++bin)
      density[bin] += g.weight * across * closeness((gu * cosines[bin] + gv * sines[bin]) / across);
  }
  std::vector<Peak> peaks;
  for (int bin = 0; bin < kRollBins; ++bin) {
    const auto at = [&](int n) { return density[static_cast<std::size_t>((n + kRollBins) % kRollBins)]; };
    if (!(at(bin) > at(bin - 1) && at(bin) >= at(bin + 1))) continue;
    const double bend = at(bin - 1) - 2.0 * at(bin) + at(bin + 1);
    const double shift = bend < 0.0 ? 0.5 * (at(bin - 1) - at(bin + 1)) / bend : 0.0;
    const double angle = 2.0 * std::numbers::pi * (bin + shift) / kRollBins;
    peaks.push_back({at(bin), std::cos(angle) * u + std::sin(angle) * v});
  }
  if (!peaks.empty()) keep_highest(peaks, least_share, peaks.size());
  return peaks;
}

}  // namespace

Result<OrientationFinder> OrientationFinder::make(const OrientationOptions& options) {
  if (!(options.least_peak >= 0.1 && options.least_peak <= 1.0))
    return fail_usage("the least peak of an orientation is out of range", fmt::format("{:g}", options.least_peak),
                      "give 0.1 to 1");
  if (options.most < 1 || options.most > 16)
    return fail_usage("the number of orientations is out of range", fmt::format("{}", options.most), "give 1 to 16");
  OrientationFinder finder;
  finder.options_ = options;
  finder.directions_ = spread_directions();
  finder.neighbours_.resize(finder.directions_.size());
  for (std::size_t a = 0; a < finder.directions_.size(); ++a) {
    for (std::size_t b = 0; b < finder.directions_.size(); ++b) {
      if (a != b && finder.directions_[a].dot(finder.directions_[b]) > std::cos(kNeighbour_rad))
        finder.neighbours_[a].push_back(static_cast<int>(b));
    }
  }
  return finder;
}

std::vector<Mat3> OrientationFinder::find(const ScaleSpace& space, const Keypoint& keypoint) const {
  const std::vector<Gradient> gradients = gather_gradients(space, keypoint);
  if (gradients.size() < kLeastGradients) return {};
  const std::vector<float> density = density_of(gradients, directions_);
  std::vector<Peak> peaks;
  for (std::size_t d = 0; d < directions_.size(); ++d) {
    const bool is_peak = std::all_of(neighbours_[d].begin(), neighbours_[d].end(),
                                     [&](int other) { return density[d] >= density[static_cast<std::size_t>(other)]; });
    if (is_peak && density[d] > 0.0F) peaks.push_back({static_cast<double>(density[d]), directions_[d]});
  }
  if (peaks.empty()) return {};
  keep_highest(peaks, options_.least_peak, static_cast<std::size_t>(options_.most));
  std::vector<Mat3> orientations;
  for (const Peak& peak : peaks) {
    const Vec3 x = refine_direction(gradients, peak.direction);
    for (const Peak& roll : find_rolls(gradients, x, options_.least_peak)) {
      if (orientations.size() == static_cast<std::size_t>(options_.most)) return orientations;
      Mat3 R_PK;
      R_PK << x, roll.direction, x.cross(roll.direction);
      orientations.push_back(R_PK);
    }
  }
  return orientations;
}

}  // namespace trocar::registration
