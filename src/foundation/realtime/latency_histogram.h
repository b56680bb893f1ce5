#pragma once

#include <array>
#include <bit>
#include <cstdint>

namespace trocar::realtime {

/// Counts durations in bins whose width is at most 1/32 of the duration: percentiles within 3 % from 1 ns to an hour.
/// Fixed size, copyable, real-time safe.
class LatencyHistogram {
 public:
  void add(std::int64_t ns) noexcept {
    const auto value = static_cast<std::uint64_t>(ns < 0 ? 0 : ns);
    ++bins_[bin_of(value)];
    ++count_;
    if (value > max_ns_) max_ns_ = value;
  }
  std::uint64_t count() const noexcept { return count_; }
  std::int64_t max_ns() const noexcept { return static_cast<std::int64_t>(max_ns_); }

  /// Quantile in ns: a share (0..1) of all durations does not exceed it. The middle of its bin, at most the maximum; 0
  /// for an empty histogram.
  std::int64_t quantile_ns(double share) const noexcept {
    if (count_ == 0) return 0;
    const double wanted = share * static_cast<double>(count_);
    std::uint64_t below = 0;
    for (std::size_t i = 0; i < bins_.size(); ++i) {
      below += bins_[i];
      if (bins_[i] == 0 || static_cast<double>(below) < wanted) continue;
      const std::uint64_t middle = (start_of(i) + start_of(i + 1) - 1) / 2;
      return static_cast<std::int64_t>(middle < max_ns_ ? middle : max_ns_);
    }
    return max_ns();
  }

 private:
  static constexpr int kSubBits = 5;
  static constexpr std::uint64_t kSub = 1U << kSubBits;  // bins per octave
  static constexpr std::size_t kBins = 38 * kSub;

  static std::size_t bin_of(std::uint64_t value) noexcept {
    if (value < kSub) return static_cast<std::size_t>(value);
    const int octave = static_cast<int>(std::bit_width(value)) - 1 - kSubBits;  // 0: values kSub..2 kSub - 1
    const std::size_t bin = (static_cast<std::size_t>(octave) << kSubBits) + static_cast<std::size_t>(value >> octave);
    return bin < kBins ? bin : kBins - 1;
  }
  static std::uint64_t start_of(std::size_t bin) noexcept {
    if (bin < 2 * kSub) return bin;
    const std::size_t octave = (bin >> kSubBits) - 1;
    return (kSub + (bin & (kSub - 1))) << octave;
  }

  std::array<std::uint32_t, kBins> bins_{};
  std::uint64_t count_ = 0;
  std::uint64_t max_ns_ = 0;
};

}  // namespace trocar::realtime
