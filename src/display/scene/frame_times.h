#pragma once

#include <array>
#include <cstddef>

namespace trocar::scene {

/// Recent frame times, ms.
class FrameTimes {
 public:
  void add(double frame_ms) noexcept;
  std::size_t count() const noexcept { return count_; }  ///< Number of all frames.
  double last_ms() const noexcept { return last_ms_; }
  /// Percentile of the last kKept frames; `share` in 0..1 (0.5: median). 0 without frames.
  double percentile_ms(double share) const noexcept;
  double p50_ms() const noexcept { return percentile_ms(0.5); }
  double p99_ms() const noexcept { return percentile_ms(0.99); }
  void clear() noexcept { *this = {}; }

  static constexpr std::size_t kKept = 256;

 private:
  std::array<double, kKept> kept_{};
  std::size_t count_ = 0;
  double last_ms_ = 0.0;
};

}  // namespace trocar::scene
