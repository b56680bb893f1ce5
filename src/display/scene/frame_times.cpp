#include "scene/frame_times.h"

#include <algorithm>
#include <cmath>

namespace trocar::scene {

void FrameTimes::add(double frame_ms) noexcept {
  kept_[count_ % kKept] = frame_ms;
  ++count_;
  last_ms_ = frame_ms;
}

double FrameTimes::percentile_ms(double share) const noexcept {
  const std::size_t n = std::min(count_, kKept);
  if (n == 0) return 0.0;
  std::array<double, kKept> sorted = kept_;
  const auto rank = static_cast<std::size_t>(std::ceil(std::clamp(share, 0.0, 1.0) * static_cast<double>(n)));
  const auto at = sorted.begin() + static_cast<std::ptrdiff_t>(rank == 0 ? 0 : rank - 1);
  std::nth_element(sorted.begin(), at, sorted.begin() + static_cast<std::ptrdiff_t>(n));
  return *at;
}

}  // namespace trocar::scene
