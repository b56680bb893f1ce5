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

/// Distribution of a duration, microseconds.
struct LatencySummary {
  double p50_us = 0.0, p99_us = 0.0, p999_us = 0.0, max_us = 0.0;
};
LatencySummary summarise(const LatencyHistogram& histogram) noexcept;

/// Statistics of a periodic loop since its start.
struct LoopSummary {
  double wanted_hz = 0.0;
  double achieved_hz = 0.0;   ///< Ticks divided by the elapsed time.
  std::uint64_t periods = 0;  ///< Periods that have begun, including skipped ones.
  std::uint64_t missed = 0;   ///< Periods whose tick was not finished before the next period, including skipped ones.
  std::uint64_t skipped = 0;  ///< Periods without a tick.
  LatencySummary lateness;    ///< Delay of the wake-up after the period's begin.
  LatencySummary tick;        ///< From wake-up to the end of the tick.
  double served() const noexcept {
    return periods == 0 ? 1.0 : 1.0 - static_cast<double>(missed) / static_cast<double>(periods);
  }
};

/// Updated by the loop's thread. Fixed size, real-time safe; do not call summary() in the loop.
class LoopStatistics {
 public:
  explicit LoopStatistics(std::int64_t period_ns = 1'000'000) noexcept : period_ns_(period_ns) {}
  /// Adds one tick: begin of its period, wake-up, end, and number of periods skipped before it.
  void add(std::int64_t begin_ns, std::int64_t woke_ns, std::int64_t done_ns, std::uint64_t skipped) noexcept;
  LoopSummary summary() const noexcept;

 private:
  std::int64_t period_ns_;
  std::int64_t first_ns_ = 0, last_ns_ = 0;
  std::uint64_t ticks_ = 0, missed_ = 0, skipped_ = 0;
  LatencyHistogram lateness_, tick_;
};

}  // namespace trocar::realtime
