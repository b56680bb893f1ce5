#include "registration/sift3d/descriptor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/parallel.h"
#include "registration/sift3d/detail/gradient_histogram.h"

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
