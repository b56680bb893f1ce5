#include "realtime/loop_statistics.h"

namespace trocar::realtime {

LatencySummary summarise(const LatencyHistogram& histogram) noexcept {
  constexpr double kUsPerNs = 1e-3;
  const auto us = [&](double share) { return static_cast<double>(histogram.quantile_ns(share)) * kUsPerNs; };
  return {us(0.5), us(0.99), us(0.999), static_cast<double>(histogram.max_ns()) * kUsPerNs};
}

void LoopStatistics::add(std::int64_t begin_ns, std::int64_t woke_ns, std::int64_t done_ns,
                         std::uint64_t skipped) noexcept {
  if (ticks_ == 0) first_ns_ = begin_ns;
  last_ns_ = begin_ns;
  ++ticks_;
  skipped_ += skipped;
  missed_ += skipped + (done_ns > begin_ns + period_ns_ ? 1U : 0U);
  lateness_.add(woke_ns - begin_ns);
  tick_.add(done_ns - woke_ns);
}

LoopSummary LoopStatistics::summary() const noexcept {
  constexpr double kNsPerS = 1e9;
  LoopSummary summary;
  summary.wanted_hz = kNsPerS / static_cast<double>(period_ns_);
  if (ticks_ > 1)
    summary.achieved_hz = static_cast<double>(ticks_ - 1) * kNsPerS / static_cast<double>(last_ns_ - first_ns_);
  summary.periods = ticks_ + skipped_;
  summary.missed = missed_;
  summary.skipped = skipped_;
  summary.lateness = summarise(lateness_);
  summary.tick = summarise(tick_);
  return summary;
}

}  // namespace trocar::realtime
