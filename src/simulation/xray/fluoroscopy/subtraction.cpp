#include "xray/fluoroscopy/subtraction.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace trocar::xray {
namespace {

constexpr float kWeight = 0.7F;  ///< Of the road map where it is shown fully.
constexpr std::size_t kGrainSubtracted = 16384;

}  // namespace

void MaskSubtraction::clear() noexcept {
  sum_.clear();
  frames_ = 0;
}

void MaskSubtraction::add_mask(std::span<const float> signal) {
  if (sum_.size() != signal.size()) {
    sum_.assign(signal.size(), 0.0F);
    frames_ = 0;
  }
  for (std::size_t n = 0; n < signal.size(); ++n) sum_[n] += signal[n];
  ++frames_;
}

std::vector<float> MaskSubtraction::difference(std::span<const float> signal) const {
  std::vector<float> difference(signal.size(), 0.0F);
  if (frames_ == 0 || sum_.size() != signal.size()) return difference;
  const float share = 1.0F / static_cast<float>(frames_);
  parallel_for(signal.size(), kGrainSubtracted, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n)
      difference[n] = std::log(std::max(sum_[n] * share, kLeastSignal) / std::max(signal[n], kLeastSignal));
  });
  return difference;
}

void RoadMap::add(std::span<const float> difference) {
  if (greatest_.size() != difference.size()) {
    greatest_.assign(difference.begin(), difference.end());
    return;
  }
  for (std::size_t n = 0; n < difference.size(); ++n) greatest_[n] = std::max(greatest_[n], difference[n]);
}

void RoadMap::overlay(float least, float full, GrayImage& image) const {
  if (greatest_.size() != image.pixels.size()) return;
  const float scale = kWeight / std::max(full - least, 1e-6F);
  for (std::size_t n = 0; n < greatest_.size(); ++n) {
    const float share = std::clamp(scale * (greatest_[n] - least), 0.0F, kWeight);
    const auto gray = static_cast<float>(image.pixels[n]);
    image.pixels[n] = static_cast<std::uint8_t>(gray + share * (255.0F - gray) + 0.5F);
  }
}

}  // namespace trocar::xray
