#include "link/client/detail/clock_offset.h"

namespace trocar::link::detail {
namespace {

/// Quartz clocks drift by about 50 ppm [assumed]: 0.25 ms in this time, below the jitter of a loaded link.
constexpr double kRemembered_s = 5.0;

}  // namespace

bool ClockOffset::add(double sent_s, double their_s, double received_s) {
  const double round_trip_s = received_s - sent_s;
  if (!(round_trip_s >= 0.0)) return false;
  while (!pings_.empty() && received_s - pings_.front().received_s > kRemembered_s) pings_.pop_front();
  while (!pings_.empty() && pings_.back().estimate.round_trip_s >= round_trip_s) pings_.pop_back();
  pings_.push_back({received_s, {their_s - (sent_s + round_trip_s / 2.0), round_trip_s}});
  return true;
}

std::optional<ClockOffset::Estimate> ClockOffset::best() const {
  if (pings_.empty()) return {};
  return pings_.front().estimate;
}

}  // namespace trocar::link::detail
