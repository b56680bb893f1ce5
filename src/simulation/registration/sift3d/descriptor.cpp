#include "registration/sift3d/descriptor.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "core/parallel.h"

namespace trocar::registration::detail {

/// Histograms of gradients in 4 x 4 x 4 regions, not yet normalised. Element ((region * 8) + theta) * 4 + phi.
class GradientHistogram {
 public:
  explicit GradientHistogram(double sample_sigma);
  /// Fills the histogram in the frame R_PK about a keypoint; returns the usable share of the samples, 0..1.
  double fill(const ScaleSpace& space, const Keypoint& keypoint, const Mat3& R_PK);
  std::array<float, kDescriptorSize>& elements() noexcept { return elements_; }

 private:
  static constexpr int kSamples = kRegions * kRegionSamples;
  static constexpr int kPadded = kSamples + 2;  ///< With a sample beside the first and the last, for differences.

  void sample(const volume::FloatGrid& gray, const Vec3& first, const Mat3& steps);
  void add(int i, int j, int k, const Eigen::Vector3f& gradient);
  float gray_at(int i, int j, int k) const noexcept {
    return gray_[static_cast<std::size_t>((k * kPadded + j) * kPadded + i)];
  }

  double sample_sigma_;
  std::vector<float> gray_;    ///< kPadded^3 samples.
  std::vector<float> window_;  ///< kSamples^3 weights.
  std::array<float, kDescriptorSize> elements_{};
};

}  // namespace trocar::registration::detail

namespace trocar::registration {
namespace {

Status check(const DescriptorOptions& options) {
  const auto is_within = [](double value, double low, double high) { return value >= low && value <= high; };
  if (!is_within(options.sample_sigma, 0.1, 4.0))
    return fail_usage("the distance between samples is out of range", fmt::format("{:g}", options.sample_sigma),
                      "give 0.1 to 4 times the scale");
  if (!is_within(options.least_usable, 0.0, 1.0))
    return fail_usage("the least share of usable samples is out of range", fmt::format("{:g}", options.least_usable),
                      "give 0 to 1");
  if (!is_within(options.largest_element, 0.02, 1.0))
    return fail_usage("the largest element is out of range", fmt::format("{:g}", options.largest_element),
                      "give 0.02 to 1");
  return {};
}

/// Scales to unit length, holds large elements down, scales again and rounds. Empty if all elements are 0.
std::optional<Descriptor> finish(std::array<float, kDescriptorSize>& histogram, double largest_element) {
  const auto length = [&] {
    double sum = 0.0;
    for (const float v : histogram) sum += static_cast<double>(v) * static_cast<double>(v);
    return std::sqrt(sum);
  };
  const double first = length();
  if (!(first > 0.0)) return std::nullopt;
  const auto most = static_cast<float>(largest_element * first);
  for (float& v : histogram) v = std::min(v, most);
  const double scale = kDescriptorNorm / length();
  Descriptor descriptor;
  for (std::size_t n = 0; n < kDescriptorSize; ++n)
    descriptor[n] = static_cast<std::int16_t>(std::lround(static_cast<double>(histogram[n]) * scale));
  return descriptor;
}

}  // namespace

Result<Features> describe(const ScaleSpace& space, const std::vector<Keypoint>& keypoints,
                          const DescriptorOptions& options, const Progress& progress) {
  TROCAR_TRY_STATUS(check(options));
  TROCAR_TRY(const OrientationFinder finder, OrientationFinder::make(options.orientation));
  constexpr std::size_t kTogether = 16;
  const std::size_t parts = (keypoints.size() + kTogether - 1) / kTogether;
  std::vector<Features> described(parts);
  report(progress, "describing keypoints", 0.0);
  parallel_for(parts, 1, [&](std::size_t first, std::size_t last) {
    detail::GradientHistogram histogram(options.sample_sigma);
    for (std::size_t part = first; part < last; ++part) {
      Features& own = described[part];
      for (std::size_t k = part * kTogether; k < std::min(keypoints.size(), (part + 1) * kTogether); ++k) {
        for (const Mat3& R_PK : finder.find(space, keypoints[k])) {
          if (histogram.fill(space, keypoints[k], R_PK) < options.least_usable) continue;
          const auto descriptor = finish(histogram.elements(), options.largest_element);
          if (!descriptor) continue;
          own.features.push_back({k, R_PK});
          own.descriptors.push_back(*descriptor);
        }
      }
    }
  });
  Features all;
  for (const Features& part : described) {
    all.features.insert(all.features.end(), part.features.begin(), part.features.end());
    all.descriptors.insert(all.descriptors.end(), part.descriptors.begin(), part.descriptors.end());
  }
  report(progress, "describing keypoints", 1.0);
  return all;
}

double descriptor_distance(const Descriptor& a, const Descriptor& b) noexcept {
  double sum = 0.0;
  for (std::size_t n = 0; n < kDescriptorSize; ++n) {
    const double d = static_cast<double>(a[n]) - static_cast<double>(b[n]);
    sum += d * d;
  }
  return std::sqrt(sum) / kDescriptorNorm;
}

}  // namespace trocar::registration

namespace trocar::registration::detail {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr double kWindow_samples = 6.0;  ///< Deviation of the weight of a sample about the middle.

/// atan2 within 1e-4 rad.
float fast_atan2(float y, float x) noexcept {
  const float ax = std::abs(x), ay = std::abs(y);
  const float quotient = std::min(ax, ay) / std::max(std::max(ax, ay), 1e-30F);
  const float s = quotient * quotient;
  float angle = ((-0.0464964749F * s + 0.15931422F) * s - 0.327622764F) * s * quotient + quotient;
  angle = ay > ax ? 0.5F * kPi - angle : angle;
  angle = x < 0.0F ? kPi - angle : angle;
  return y < 0.0F ? -angle : angle;
}

/// Lower of two bins and the share of the upper.
struct Between {
  int lower = 0;
  float part = 0.0F;
};
Between between(float at) noexcept {
  const float low = std::floor(at);
  return {static_cast<int>(low), at - low};
}

/// Trilinear; NaN outside of the grid and next to unusable voxels.
float trilinear_gray(const volume::FloatGrid& gray, const Eigen::Vector3f& index) noexcept {
  const auto& size = gray.geometry.size;
  const Eigen::Vector3f low = index.array().floor();
  const auto i = static_cast<std::int64_t>(low[0]), j = static_cast<std::int64_t>(low[1]),
             k = static_cast<std::int64_t>(low[2]);
  if (i < 0 || j < 0 || k < 0 || i + 1 >= size[0] || j + 1 >= size[1] || k + 1 >= size[2])
    return std::numeric_limits<float>::quiet_NaN();
  const Eigen::Vector3f f = index - low;
  const float* v = gray.voxels.data() + gray.geometry.offset({i, j, k});
  const std::int64_t row = size[0], plane = size[0] * size[1];
  const auto line = [&](const float* p) { return p[0] + f[0] * (p[1] - p[0]); };
  const auto face = [&](const float* p) {
    const float near = line(p);
    return near + f[1] * (line(p + row) - near);
  };
  const float near = face(v);
  return near + f[2] * (face(v + plane) - near);
}

/// One over the solid angle of a bin, as a multiple of that of an equatorial one.
constexpr float kPolarGain = 0.70710678F / (1.0F - 0.70710678F);

}  // namespace

GradientHistogram::GradientHistogram(double sample_sigma)
    : sample_sigma_(sample_sigma),
      gray_(static_cast<std::size_t>(kPadded) * kPadded * kPadded),
      window_(static_cast<std::size_t>(kSamples) * kSamples * kSamples) {
  std::size_t n = 0;
  const double middle = 0.5 * (kSamples - 1);
  for (int k = 0; k < kSamples; ++k) {
    for (int j = 0; j < kSamples; ++j) {
      for (int i = 0; i < kSamples; ++i) {
        const double away2 = (Vec3(i, j, k) - Vec3::Constant(middle)).squaredNorm();
        window_[n++] = static_cast<float>(std::exp(-0.5 * away2 / (kWindow_samples * kWindow_samples)));
      }
    }
  }
}

void GradientHistogram::sample(const volume::FloatGrid& gray, const Vec3& first, const Mat3& steps) {
  const Eigen::Matrix3f s = steps.cast<float>();
  std::size_t n = 0;
  for (int k = 0; k < kPadded; ++k) {
    for (int j = 0; j < kPadded; ++j) {
      Eigen::Vector3f index = first.cast<float>() + static_cast<float>(j) * s.col(1) + static_cast<float>(k) * s.col(2);
      for (int i = 0; i < kPadded; ++i, index += s.col(0)) gray_[n++] = trilinear_gray(gray, index);
    }
  }
}

double GradientHistogram::fill(const ScaleSpace& space, const Keypoint& keypoint, const Mat3& R_PK) {
  elements_.fill(0.0F);
  const Octave& octave = space.octaves[keypoint.octave];
  const auto level = static_cast<std::size_t>(
      std::clamp<long>(std::lround(keypoint.level), 0, static_cast<long>(octave.levels.size()) - 1));
  const auto& geometry = octave.geometry;
  const Mat3 steps = geometry.R_PV.transpose() * R_PK * (sample_sigma_ * keypoint.sigma_mm / geometry.spacing_mm.x());
  const Vec3 first = geometry.to_index(keypoint.p_P) - steps * Vec3::Constant(0.5 * (kPadded - 1));
  sample(octave.levels[level], first, steps);
  std::size_t usable = 0;
  for (int k = 0; k < kSamples; ++k) {
    for (int j = 0; j < kSamples; ++j) {
      for (int i = 0; i < kSamples; ++i) {
        const Eigen::Vector3f gradient(gray_at(i + 2, j + 1, k + 1) - gray_at(i, j + 1, k + 1),
                                       gray_at(i + 1, j + 2, k + 1) - gray_at(i + 1, j, k + 1),
                                       gray_at(i + 1, j + 1, k + 2) - gray_at(i + 1, j + 1, k));
        if (!(gradient.squaredNorm() >= 0.0F)) continue;  // not usable
        ++usable;
        add(i, j, k, gradient);
      }
    }
  }
  for (std::size_t n = 0; n < kDescriptorSize; n += kPhiBins) {
    elements_[n] *= kPolarGain;
    elements_[n + kPhiBins - 1] *= kPolarGain;
  }
  return static_cast<double>(usable) / static_cast<double>(window_.size());
}

void GradientHistogram::add(int i, int j, int k, const Eigen::Vector3f& gradient) {
  const float across = std::hypot(gradient.x(), gradient.y());
  const float size = gradient.norm() * window_[static_cast<std::size_t>((k * kSamples + j) * kSamples + i)];
  const Between theta = between((fast_atan2(gradient.y(), gradient.x()) / kPi + 1.0F) * (0.5F * kThetaBins) - 0.5F);
  const Between phi = between((fast_atan2(gradient.z(), across) / kPi + 0.5F) * kPhiBins - 0.5F);
  const int theta_bins[2] = {(theta.lower + kThetaBins) % kThetaBins, (theta.lower + 1) % kThetaBins};
  const int phi_bins[2] = {std::max(phi.lower, 0), std::min(phi.lower + 1, kPhiBins - 1)};
  float angular[4];
  int bins[4];
  for (int t = 0; t < 2; ++t) {
    for (int p = 0; p < 2; ++p) {
      angular[2 * t + p] = size * (t == 0 ? 1.0F - theta.part : theta.part) * (p == 0 ? 1.0F - phi.part : phi.part);
      bins[2 * t + p] = theta_bins[t] * kPhiBins + phi_bins[p];
    }
  }
  const int at[3] = {i, j, k};
  Between region[3];
  for (int a = 0; a < 3; ++a) region[a] = between((static_cast<float>(at[a]) + 0.5F) / kRegionSamples - 0.5F);
  for (int corner = 0; corner < 8; ++corner) {
    int index = 0;
    float weight = 1.0F;
    bool is_inside = true;
    for (int a = 2; a >= 0; --a) {
      const int upper = (corner >> a) & 1;
      const int r = region[a].lower + upper;
      weight *= upper != 0 ? region[a].part : 1.0F - region[a].part;
      is_inside = is_inside && r >= 0 && r < kRegions;
      index = index * kRegions + r;
    }
    if (!is_inside) continue;
    float* histogram = elements_.data() + static_cast<std::ptrdiff_t>(index) * kThetaBins * kPhiBins;
    for (int b = 0; b < 4; ++b) histogram[bins[b]] += weight * angular[b];
  }
}

}  // namespace trocar::registration::detail
