#include "anatomy/phantom/texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/parallel.h"
#include "core/random.h"

namespace trocar::anatomy::phantom {
namespace {

constexpr float kSkinShare = 0.82F, kMiddleShare = 1.18F;  ///< Of the noise half way.
constexpr float kMiddleMm = 90.0F;
/// A Gaussian of 0.75 voxels in the slice, a weaker one across slices.
constexpr std::array<float, 5> kInPlane{0.0152F, 0.2186F, 0.5324F, 0.2186F, 0.0152F};
constexpr std::array<float, 3> kAcross{0.2F, 0.6F, 0.2F};

/// Shares of the standard deviation: their squares add up to 1. With them the noise power falls between 0.12 and 0.44
/// cycles a mm as much as in the liver of a real CT (docs/validation.md).
constexpr float kSmoothShare = 0.787F, kRoughShare = 0.617F;

template <std::size_t N>
constexpr float energy(const std::array<float, N>& kernel) {
  float sum = 0.0F;
  for (const float w : kernel) sum += w * w;
  return sum;
}

/// Nearly normal, mean 0, variance 1: the sum of four uniform 16-bit numbers.
float white(std::uint64_t key, std::uint64_t counter) {
  const std::uint64_t bits = mix64(key ^ counter);
  const auto sum =
      static_cast<float>((bits & 0xffffU) + ((bits >> 16) & 0xffffU) + ((bits >> 32) & 0xffffU) + (bits >> 48));
  return (sum - 131070.0F) * (1.7320508F / 65536.0F);
}

class SliceNoise {
 public:
  SliceNoise(const volume::GridGeometry& geometry, std::uint64_t key)
      : columns_(geometry.size[0]),
        rows_(geometry.size[1]),
        key_(key),
        rough_(static_cast<std::size_t>((columns_ + 4) * (rows_ + 4))),
        values_(static_cast<std::size_t>(columns_ * rows_)) {}

  /// Noise of slice k, variance 1.
  const std::vector<float>& make(std::int64_t k) {
    fill_rough(k);
    filter(k);
    return values_;
  }

 private:
  void fill_rough(std::int64_t k) {
    const auto plane = static_cast<std::uint64_t>(rough_.size());
    for (std::uint64_t n = 0; n < plane; ++n) {
      float sum = 0.0F;
      for (std::uint64_t s = 0; s < kAcross.size(); ++s)
        sum += kAcross[s] * white(key_, (static_cast<std::uint64_t>(k) + s) * plane + n);
      rough_[n] = sum;
    }
  }

  void filter(std::int64_t k) {
    const float scale = 1.0F / (energy(kInPlane) * std::sqrt(energy(kAcross)));
    const auto wide = static_cast<std::size_t>(columns_ + 4);
    for (std::size_t j = 0; j < static_cast<std::size_t>(rows_ + 4); ++j)
      for (std::size_t i = 0; i < static_cast<std::size_t>(columns_); ++i) {
        float sum = 0.0F;
        for (std::size_t s = 0; s < kInPlane.size(); ++s) sum += kInPlane[s] * rough_[j * wide + i + s];
        rough_[j * wide + i] = sum;  // only overwrites values that are no longer needed
      }
    for (std::size_t j = 0; j < static_cast<std::size_t>(rows_); ++j)
      for (std::size_t i = 0; i < static_cast<std::size_t>(columns_); ++i) {
        float sum = 0.0F;
        for (std::size_t s = 0; s < kInPlane.size(); ++s) sum += kInPlane[s] * rough_[(j + s) * wide + i];
        values_[j * static_cast<std::size_t>(columns_) + i] = kSmoothShare * scale * sum;
      }
    add_rough_share(k);
  }

  /// The part of the noise that the reconstruction leaves at the highest frequencies.
  void add_rough_share(std::int64_t k) {
    const std::uint64_t first = static_cast<std::uint64_t>(k) * static_cast<std::uint64_t>(values_.size());
    for (std::uint64_t n = 0; n < values_.size(); ++n) values_[n] += kRoughShare * white(~key_, first + n);
  }

  std::int64_t columns_, rows_;
  std::uint64_t key_;
  std::vector<float> rough_;
  std::vector<float> values_;
};

}  // namespace

void add_scanner_noise(volume::CtGrid& ct, const volume::FloatGrid& skin_distance_mm, std::uint64_t seed,
                       double sigma_hu) {
  const auto half_way_hu = static_cast<float>(sigma_hu);
  const auto plane = static_cast<std::size_t>(ct.geometry.size[0] * ct.geometry.size[1]);
  parallel_for(static_cast<std::size_t>(ct.geometry.size[2]), 4, [&](std::size_t first, std::size_t last) {
    SliceNoise noise(ct.geometry, mix64(seed ^ 0x6e6f697365U));
    for (std::size_t k = first; k < last; ++k) {
      const std::vector<float>& values = noise.make(static_cast<std::int64_t>(k));
      for (std::size_t n = 0; n < plane; ++n) {
        const std::size_t offset = k * plane + n;
        const float depth = std::clamp(-skin_distance_mm.voxels[offset] / kMiddleMm, 0.0F, 1.0F);
        const float sigma = half_way_hu * (kSkinShare + (kMiddleShare - kSkinShare) * depth);
        const float hu = static_cast<float>(ct.voxels[offset]) + sigma * values[n];
        ct.voxels[offset] = static_cast<std::int16_t>(std::clamp(std::lround(hu), -1024L, 3071L));
      }
    }
  });
}

}  // namespace trocar::anatomy::phantom
